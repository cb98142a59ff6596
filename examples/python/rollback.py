"""An adaptive co-simulation master that repeats steps, for the contact and a circuit: error over cost.

The contact is the FMU, under FMPy, in the scene chatter-41g: it opens in every period. The circuit is that of
circuit.py, solved in closed form over a step with a constant conductance of the contact.

In a communication step the component goes first, then the circuit with the mean of the contact's conductances at both
ends. This is of second order where the conductance is smooth, but of first order in a step that contains an opening or
closing. Three masters:

fixed                  steps of one length.
adaptive               step doubling: one step of h, back to the start (fmi2SetFMUstate), two of h / 2. A third of the
                       difference of the circuit's states estimates the error of the two. Above the tolerance: back
                       again, with a shorter h. It does not know the contact, so it has to find every opening by
                       halving; and it misses an opening in the second half of a step, as the mean of a closed and an
                       open contact conducts as well as a closed one: both solutions agree, and both are wrong.
adaptive with events   the same, but if the component reports a time in contact.lastOpening or contact.lastClosing
                       within the step, the master goes back and places a communication point there. The rest is
                       smooth: the tolerance bounds the error h^3 of each step, so that of the run, of order h^2, is
                       proportional to the tolerance to the power of 2/3.

The cost is the number of doStep calls, including those of rejected steps. The error is that of the load current, its
maximum over times 1 us apart, relative to the third master at a tolerance of 1e-8.
"""

import sys
import time as clock
from dataclasses import dataclass, field
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from tqdm import tqdm

from circuit import Circuit, State
from common import parser, read_arguments, save
from relay_contact import Array, Component, Contact, Scene, write_table
from relay_contact.figures import BLACK, BLUE, ORANGE

CIRCUIT = Circuit()
PERIOD = 1e-3  # s, of the vibration
SCALE: Array = np.array([CIRCUIT.supply / CIRCUIT.load, CIRCUIT.supply])  # A and V, to which tolerances are relative
SHORTEST, LONGEST = 1e-9, 1e-4  # s: the component locates events to 1 ns
FIXED = [20e-6, 10e-6, 5e-6, 2e-6, 1e-6, 0.5e-6, 0.2e-6, 0.1e-6]  # s
TOLERANCES = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7]
REFERENCE = 1e-8
SHOWN = 1e-4
"""Tolerance whose steps are drawn."""
LOOKS = {
    "fixed": (BLACK, "o", "fixed steps"),
    "adaptive": (ORANGE, "s", "adaptive"),
    "adaptive with events": (BLUE, "D", "adaptive, with points at openings and closings"),
}
"""Colour, marker and label of each master."""


@dataclass
class Master:
    """The coupled pair at a communication point, and how it got there."""

    method: str
    setting: float
    """Tolerance, or step [s]."""
    contact: Contact
    conductance: float
    state: State
    work: int = 0
    """Calls of doStep."""
    rejected: int = 0
    """Steps repeated."""
    seconds: float = 0.0
    """Wall time."""
    error: float = 0.0
    """Largest error of the load current [A]."""
    rows: list[list[float]] = field(default_factory=list)
    """For every accepted communication step: start, length, load current and capacitor voltage there, conductance."""

    def step(self, time: float, length: float, can_return: int) -> list[float]:
        """Take one communication step; give its row."""
        self.contact.fmu.doStep(time, length, 1 - can_return)
        self.work += 1
        after = self.contact.get("contact.conductance")
        row = [time, length, *self.state, (self.conductance + after) / 2]
        self.state, self.conductance = CIRCUIT.after(self.state, row[4], length), after
        return row

    def currents(self, times: Array) -> Array:
        """Give the load current at times: the closed form within the accepted steps."""
        indices = np.searchsorted([row[0] for row in self.rows], times, side="right") - 1
        rows = [self.rows[index] for index in indices]
        steps = zip(rows, times.tolist(), strict=True)
        return np.array([CIRCUIT.after((i, q), mean, time - start)[0] for (start, _, i, q, mean), time in steps])


def begin(method: str, setting: float, contact: Contact) -> Master:
    """Give the pair in the steady state of the closed contact."""
    conductance = contact.get("contact.conductance")
    return Master(method, setting, contact, conductance, CIRCUIT.at_rest(conductance))


def follow(master: Master, points: list[tuple[float, float]]) -> None:
    """Take given steps (start, length) without repeating any."""
    for time, length in points:
        master.rows.append(master.step(time, length, can_return=0))


def adapt(master: Master, stop: float, tolerance: float, events: bool) -> None:
    """Choose each step so that its error is within the tolerance."""
    time, length, contact = 0.0, 1e-6, master.contact
    while stop - time > SHORTEST:
        length = min(length, LONGEST, stop - time)
        saved, before = contact.fmu.getFMUstate(), (master.state, master.conductance)

        def go_back(saved: object = saved, before: tuple[State, float] = before) -> None:
            contact.fmu.setFMUstate(saved)
            master.state, master.conductance = before

        wanted = length
        try:
            while True:
                master.step(time, length, can_return=1)
                whole = master.state
                found = contact.real("contact.lastOpening", "contact.lastClosing") if events else []
                inside = [at for at in found if time + SHORTEST < at < time + length - SHORTEST]
                go_back()
                if inside:
                    length = min(inside) - time
                    master.rejected += 1
                    continue
                half = length / 2
                rows = [master.step(at, half, can_return=1) for at in (time, time + half)]
                error = np.abs(np.subtract(master.state, whole) / SCALE).max() / 3
                factor = min(4.0, max(0.2, 0.9 * (tolerance / max(error, 1e-300)) ** (1 / 3)))
                if error <= tolerance or length <= 2 * SHORTEST:
                    break
                go_back()
                master.rejected += 1
                length = wanted = factor * length
        finally:
            contact.fmu.freeFMUstate(saved)
        master.rows += rows
        time += length
        # A step shortened by an event says little about the length of the next one.
        length = max(wanted / 4, factor * length)


def draw(masters: list[Master], path: Path) -> None:
    """Draw the error over the cost, and the steps chosen around the first opening."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(12, 4.8), layout="constrained")
    for method, (colour, marker, label) in LOOKS.items():
        chosen = [each for each in masters if each.method == method]
        errors = [1e3 * each.error for each in chosen]
        left.loglog([each.work for each in chosen], errors, marker=marker, color=colour, label=label)
        shown = next((each for each in chosen if each.setting == SHOWN), None)
        if shown:
            start, length = np.array(shown.rows).T[:2]
            right.semilogy(1e3 * start, 1e6 * length, marker=marker, markersize=4, color=colour, linewidth=0.6)
    left.set(xlabel="calls of doStep", ylabel="maximum error of the load current [mA]")
    left.legend(fontsize="small")
    left.set_title("Error over cost of fixed and adaptive communication steps", fontsize="medium")
    right.set(xlabel="time [ms]", ylabel="communication step [µs]", xlim=(0.6, 1.2))
    right.set_title(f"Steps around the first opening at a tolerance of {SHOWN:g}", fontsize="medium")
    for axes in (left, right):
        axes.grid(alpha=0.3)
        axes.yaxis.set_major_formatter("{x:g}")
    left.xaxis.set_major_formatter("{x:g}")
    save(figure, path)


def main() -> int:
    """Run the three masters over tolerances and steps."""
    quick = "2.5 ms instead of 10 ms, fixed steps down to 0.5 µs only"
    given = read_arguments(parser(__doc__, quick, "half a minute, with --quick five seconds"))
    stop, lengths = (2.5 * PERIOD, FIXED[:-2]) if given.quick else (10 * PERIOD, FIXED)
    component = Component(given.fmu)
    settings = [("adaptive with events", REFERENCE), *(("fixed", length) for length in lengths)]
    settings += [(method, tolerance) for method in ("adaptive", "adaptive with events") for tolerance in TOLERANCES]
    times: Array = np.linspace(0.0, stop, round(stop / 1e-6), endpoint=False)
    masters: list[Master] = []
    for method, setting in (bar := tqdm(settings, unit="run")):
        bar.set_description(f"{method}, {setting:g}")
        with component.started(Scene.read("chatter-41g").values) as contact:
            master, started = begin(method, setting, contact), clock.perf_counter()
            if method == "fixed":
                follow(master, [(index * setting, setting) for index in range(round(stop / setting))])
            else:
                adapt(master, stop, setting, method != "adaptive")
            master.seconds = clock.perf_counter() - started
        masters.append(master)
    exact, compared = masters[0].currents(times), masters[1:]
    for master in compared:
        master.error = float(np.abs(master.currents(times) - exact).max())
    # The accepted steps again, without repeating any: nothing of the rejected steps may be left in the result.
    shown = next(each for each in compared if (each.method, each.setting) == ("adaptive with events", SHOWN))
    with component.started(Scene.read("chatter-41g").values) as contact:
        again = begin(shown.method, SHOWN, contact)
        follow(again, [(row[0], row[1]) for row in shown.rows])
    same = again.rows == shown.rows and again.state == shown.state
    rows = [[each.method, each.setting, each.work, each.rejected, each.seconds, each.error] for each in compared]
    columns = ["master", "setting", "steps.done", "steps.repeated", "wallTime", "error.load.current"]
    table = pd.DataFrame(rows, columns=columns)
    print(f"{table.to_string(index=False, float_format='{:.3g}'.format)}\nfixed steps and wall times in s, errors in A")
    print(f"the accepted steps again without repetition: {'the same bits' if same else 'DIFFERENT RESULTS'}")
    paths = [given.out / f"rollback{end}" for end in (".csv", "-steps.csv", ".png")]
    table.to_csv(paths[0], index=False, float_format="%.12g")
    write_table(paths[1], "time,step,load.current,capacitor.voltage,contact.conductance.mean", shown.rows, digits=17)
    draw(compared, paths[2])
    print(*paths, sep="\n")
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main())
