"""An adaptive co-simulation master that repeats steps, for the contact and a circuit: error over work.

The contact is the FMU, under FMPy, shaken by 400 m/s2 (41 g) at 1 kHz: it opens in every period. The circuit is that
of circuit.py, solved in closed form over a step, with the conductance of the contact held.

A communication step: the component goes first, with the contact current of the start; the circuit follows with the
mean of the contact's conductances at both ends. That is of second order where the conductance is smooth, but of first
order over an opening or closing, which falls anywhere within the step. Three masters:

fixed            steps of one length.
adaptive         step doubling: one step of h, back to the start (fmi2SetFMUstate), two of h / 2. A third of the
                 difference of the circuit's states estimates the error of the two. Above the tolerance: back again,
                 with a shorter h. Knows nothing of the contact, so it has to close in on every opening by halving; and
                 it is blind to an opening in the second half of a step, as the mean of a closed and an open contact
                 conducts as well as a closed one: then both ways agree, and both are wrong.
adaptive, told   the same, but where the component reports an instant in contact.lastOpening or contact.lastClosing that
                 lies within the step, it goes back and puts a communication point there. The rest is
                 smooth, and as the tolerance bounds the error h^3 of each step, that of the run, of order h^2,
                 is proportional to the tolerance to the power of 2/3.

The work is the number of doStep calls, those of rejected steps included. The error is that of the load current, the
largest of instants 1 us apart, against the third master at a tolerance of 1e-8.
"""

import sys
import time as clock
from dataclasses import dataclass, field
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import NullFormatter
from tqdm import tqdm

from circuit import LOAD, PERIOD, SOURCE, closed_form, contact_voltage, shaken
from common import BLACK, BLUE, ORANGE, SKY, legend_beside, parser, read_arguments, save, write_table
from relay_contact import Array, Component, Contact

SCALE = np.array([SOURCE / LOAD, SOURCE])  # A and V: tolerances are relative to these
SHORTEST, LONGEST = 1e-9, 1e-4  # s: the component locates its instants to 1 ns
FIXED = [20e-6, 10e-6, 5e-6, 2e-6, 1e-6, 0.5e-6, 0.2e-6, 0.1e-6]  # s
TOLERANCES = [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7]
REFERENCE = 1e-8
SHOWN = 1e-4
"""Tolerance whose steps are drawn."""


@dataclass
class Master:
    """The coupled pair at a communication point, and the way it came."""

    contact: Contact
    state: Array
    """Load current and capacitor's voltage."""
    conductance: float
    work: int = 0
    """Calls of doStep."""
    rejected: int = 0
    """Steps taken back."""
    states: int = 0
    """FMU states saved and not freed yet."""
    seconds: float = 0.0
    """Wall time."""
    rows: list[list[float]] = field(default_factory=list)
    """For every accepted communication step: start, length, load current and voltage there, conductance held."""

    def step(self, time: float, length: float, can_return: int) -> list[float]:
        """Take one communication step; give its row."""
        current, voltage = self.state
        drop = contact_voltage(current, voltage, self.conductance)
        self.contact.set("contact.current", float(self.conductance * drop))
        self.contact.fmu.doStep(time, length, 1 - can_return)
        self.work += 1
        after = self.contact.get("contact.conductance")
        mean = (self.conductance + after) / 2
        exponential, rest = closed_form(np.array(mean), np.array(length))
        self.state, self.conductance = rest + exponential @ (self.state - rest), after
        return [time, length, current, voltage, mean]

    def currents(self, times: Array) -> Array:
        """Give the load current at instants: the closed form within the accepted steps."""
        start, _, current, voltage, mean = np.array(self.rows).T
        index = np.searchsorted(start, times, side="right") - 1
        exponential, rest = closed_form(mean[index], times - start[index])
        states = np.stack([current, voltage], axis=-1)[index]
        currents: Array = (rest + (exponential @ (states - rest)[..., None])[..., 0])[:, 0]
        return currents


def begin(contact: Contact) -> Master:
    """Give the pair in the steady state of the closed contact."""
    conductance = contact.get("contact.conductance")
    _, rest = closed_form(np.array(conductance), np.array(0.0))
    return Master(contact, rest, conductance)


def follow(master: Master, points: list[tuple[float, float]]) -> None:
    """Take given steps, of start and length, and never go back."""
    started = clock.perf_counter()
    for time, length in points:
        master.rows.append(master.step(time, length, can_return=0))
    master.seconds = clock.perf_counter() - started


def adapt(master: Master, stop: float, tolerance: float, told: bool) -> None:
    """Step with a length that keeps the error of every step within the tolerance."""
    started, time, length = clock.perf_counter(), 0.0, 1e-6
    events = ["contact.lastOpening", "contact.lastClosing"]
    contact = master.contact
    while stop - time > SHORTEST:
        length = min(length, LONGEST, stop - time)
        saved, state, conductance = contact.fmu.getFMUstate(), master.state, master.conductance
        master.states += 1
        wanted = length
        try:
            while True:
                master.step(time, length, can_return=1)
                whole = master.state
                instants = [at for at in contact.real(*events) if time + SHORTEST < at < time + length - SHORTEST]
                contact.fmu.setFMUstate(saved)
                master.state, master.conductance = state, conductance
                if told and instants:
                    length = min(instants) - time
                    master.rejected += 1
                    continue
                half = length / 2
                rows = [master.step(at, half, can_return=1) for at in (time, time + half)]
                error = np.abs((master.state - whole) / SCALE).max() / 3
                factor = min(4.0, max(0.2, 0.9 * (tolerance / max(error, 1e-300)) ** (1 / 3)))
                if error <= tolerance or length <= 2 * SHORTEST:
                    break
                contact.fmu.setFMUstate(saved)
                master.state, master.conductance = state, conductance
                master.rejected += 1
                length = wanted = factor * length
        finally:
            contact.fmu.freeFMUstate(saved)
            master.states -= 1
        master.rows += rows
        time += length
        # A step cut short by an instant says little about the next one's length.
        length = max(wanted / 4, factor * length)
    master.seconds = clock.perf_counter() - started


@dataclass
class Run:
    """A finished run."""

    method: str
    setting: float
    """Tolerance, or step [s]."""
    master: Master
    error: float = 0.0
    """Largest error of the load current [A]."""


def instants(master: Master, stop: float) -> list[tuple[float, float]]:
    """Give from when to when the contact was open, from the conductances held."""
    start, _, _, _, mean = np.array(master.rows).T
    opened = mean < 1e-6  # S: far below a closed contact's, far above an open one's
    begins, ends = (np.flatnonzero(np.diff(opened.astype(int), prepend=0, append=0) == sign) for sign in (1, -1))
    return [(start[a], start[b] if b < len(start) else stop) for a, b in zip(begins, ends, strict=True)]


LOOKS = {
    "fixed": (BLACK, "o", "fixed steps"),
    "adaptive": (ORANGE, "s", "adaptive"),
    "adaptive, told": (BLUE, "D", "adaptive, with the instants of opening and closing"),
}
"""Colour, marker and label of each master."""


def draw_work(runs: list[Run], path: Path) -> None:
    """Draw the error over the work."""
    figure, (left, right) = plt.subplots(1, 2, sharey=True, figsize=(10, 4.5), layout="constrained")
    for method, (colour, marker, label) in LOOKS.items():
        chosen = [run for run in runs if run.method == method]
        errors = [1e3 * run.error for run in chosen]
        left.loglog([run.master.work for run in chosen], errors, marker=marker, color=colour, label=label)
        right.loglog([1e3 * run.master.seconds for run in chosen], errors, marker=marker, color=colour)
    left.set_xlabel("calls of doStep")
    right.set_xlabel("wall time [ms]")
    left.set_ylabel("largest error of the load current [mA]")
    for axes in (left, right):
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.grid(alpha=0.3, which="both")
    figure.legend(loc="outside lower center", ncols=3, frameon=False)
    figure.suptitle(
        "Error over cost: fixed communication steps, and adaptive ones that can be repeated", fontsize="medium"
    )
    save(figure, path)


def draw_steps(runs: list[Run], stop: float, path: Path) -> None:
    """Draw the steps chosen around the first opening."""
    figure, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(9, 6.5), layout="constrained")
    chosen = {run.method: run.master for run in runs if run.setting == SHOWN and run.method != "fixed"}
    times: Array = np.linspace(0.0, 1.5 * PERIOD, 3000)
    for method, master in chosen.items():
        start, length, current, _, _ = np.array(master.rows).T
        colour, marker, label = LOOKS[method]
        above.plot(1e3 * times, 1e3 * master.currents(times), color=colour, linewidth=1)
        above.plot(
            1e3 * start,
            1e3 * current,
            linestyle="",
            marker=marker,
            markersize=4,
            color=colour,
            label=label.replace(", ", ",\n"),
        )
        below.semilogy(1e3 * start, 1e6 * length, marker=marker, markersize=4, color=colour, linewidth=0.6)
    opening, closing = instants(chosen["adaptive, told"], stop)[0]
    for axes in (above, below):
        axes.axvspan(1e3 * opening, 1e3 * closing, color=SKY, alpha=0.25, linewidth=0, label="contact open")
        axes.set_xlim(1e3 * opening - 0.1, 1e3 * closing + 0.1)
        axes.grid(alpha=0.3)
    above.set_ylabel("load current [mA]")
    below.set_ylabel("communication step [µs]")
    below.set_xlabel("time [ms]")
    legend_beside(above)
    figure.suptitle(f"Communication steps around an opening at a tolerance of {SHOWN:g}", fontsize="medium")
    figure.align_ylabels()
    save(figure, path)


def main() -> int:
    """Run the three masters over tolerances and steps."""
    line = parser("Adaptive master with FMU states. Takes half a minute, with --quick five seconds.")
    line.add_argument("--quick", action="store_true", help="2.5 ms instead of 10 ms, fixed steps down to 0.5 µs only")
    given = read_arguments(line)
    stop, lengths = (2.5 * PERIOD, FIXED[:-2]) if given.quick else (10 * PERIOD, FIXED)
    component = Component(given.fmu)
    settings = [("adaptive, told", REFERENCE), *(("fixed", length) for length in lengths)]
    settings += [(method, tolerance) for method in ("adaptive", "adaptive, told") for tolerance in TOLERANCES]
    times: Array = np.linspace(0.0, stop, round(stop / 1e-6), endpoint=False)
    runs: list[Run] = []
    for method, setting in (bar := tqdm(settings, unit="run")):
        bar.set_description(f"{method}, {setting:g}")
        with shaken(component) as contact:
            master = begin(contact)
            if method == "fixed":
                follow(master, [(index * setting, setting) for index in range(round(stop / setting))])
            else:
                adapt(master, stop, setting, told=method == "adaptive, told")
        runs.append(Run(method, setting, master))
    exact = runs[0].master.currents(times)
    # The accepted steps once more, never going back: nothing of what was taken back may be left in the result.
    shown = next(run.master for run in runs if run.method == "adaptive, told" and run.setting == SHOWN)
    with shaken(component) as contact:
        again = begin(contact)
        follow(again, [(row[0], row[1]) for row in shown.rows])
    same = again.rows == shown.rows and bool(np.array_equal(again.state, shown.state))
    print(f"{'master':15} {'setting':>10} {'doSteps':>8} {'taken back':>11} {'wall time':>10} {'largest error':>14}")
    for run in runs[1:]:
        run.error = float(np.abs(run.master.currents(times) - exact).max())
        setting = f"{1e6 * run.setting:g} us" if run.method == "fixed" else f"{run.setting:g}"
        cost = f"{run.master.work:8} {run.master.rejected:11} {1e3 * run.master.seconds:7.0f} ms"
        print(f"{run.method:15} {setting:>10} {cost} {1e3 * run.error:11.5f} mA")
    print(f"the accepted steps again without going back: {'the same bits' if same else 'DIFFERENT RESULTS'}")
    print(f"FMU states not freed: {sum(run.master.states for run in runs)}")
    names = ["rollback.csv", "rollback-steps.csv", "rollback.png", "rollback-steps.png"]
    paths = [given.out / name for name in names]
    with paths[0].open("w", encoding="utf-8") as file:
        file.write("master,setting,steps.done,steps.takenBack,wallTime,error.load.current\n")
        for run in runs[1:]:
            label, master = run.method.replace(",", ""), run.master
            values = f"{run.setting:g},{master.work},{master.rejected},{master.seconds:.6f},{run.error:.12g}"
            file.write(f"{label},{values}\n")
    write_table(paths[1], "time,step,load.current,capacitor.voltage,contact.conductance.mean", shown.rows, digits=17)
    draw_work(runs[1:], paths[2])
    draw_steps(runs[1:], stop, paths[3])
    print(*paths, sep="\n")
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main())
