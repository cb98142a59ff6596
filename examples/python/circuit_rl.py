"""Couple the contact to a 6 V RL circuit: a vibration opens the contact in every period, and the circuit responds.

The contact is the FMU, under FMPy, in the scene chatter-41g: 400 m/s2 at 1 kHz. The circuit (diagram and equations:
circuit.py) is ngspice, through its shared library, or solved in closed form (`--circuit built-in`).

At every communication point the circuit takes `contact.conductance` and holds it until the next one. It therefore sees
an opening or closing up to one step late, and the load current, whose slope changes by up to V / L there, is wrong by
up to h V / L: first order in the step h. Interpolating the conductance would not help, as nearly all of its change,
from the closed to the open contact, happens within one step. Communication points at those instants do: rollback.py,
which also measures this error over the step.

The current has no effect on the motion, so it is not passed back; with `effects.heating`, set `contact.current` before
each step. The voltage is taken from the circuit: a current of the step before says nothing about a contact that has
opened since.
"""

from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from tqdm import tqdm

from circuit import Circuit
from common import legend_beside, parser, read_arguments, save
from ngspice import NgSpice
from relay_contact import Array, Component, Contact, Scene, write_table
from relay_contact.figures import BLUE, GREY, ORANGE, RED, SKY

CIRCUIT = Circuit()
PERIOD = 1e-3  # s, of the vibration
RANGE = (12.0, 0.4)  # V and A: below these a contact draws no arc
OUTPUTS = ["contact.conductance", "contact.lastOpening", "contact.lastClosing"]
COLUMNS = ["time", *OUTPUTS, "load.current", "capacitor.voltage", "circuit.voltage", "circuit.current"]
Solver = Circuit | NgSpice


@dataclass
class Result:
    """A coupled run."""

    columns: dict[str, Array]
    """`COLUMNS`, SI units, at the communication points."""
    waves: Array
    """Time, load current, contact voltage and contact current, within the steps too."""

    def spans(self) -> list[tuple[float, float]]:
        """Give the intervals during which the contact was open."""
        openings, closings = (np.unique(self.columns[f"contact.last{name}"])[1:] for name in ("Opening", "Closing"))
        return list(zip(openings, np.append(closings, self.columns["time"][-1]), strict=False))


def simulate(contact: Contact, solver: Solver, step: float, count: int, label: str) -> Result:
    """Run both from the steady state of the closed contact."""
    outputs = contact.real(*OUTPUTS)
    state = CIRCUIT.at_rest(outputs[0])
    rows, waves = [], []
    for index in tqdm(range(count + 1), desc=label, unit="step", leave=False):
        conductance = outputs[0]
        voltage = CIRCUIT.voltage(*state, conductance)
        rows.append([index * step, *outputs, *state, voltage, voltage * conductance])
        if index == count:
            break
        course = solver.advance(state, conductance, step)
        contact.step(index * step, step)
        drop = CIRCUIT.voltage(course.current, course.capacitor, conductance)
        waves.append(np.stack([index * step + course.time, course.current, drop, drop * conductance]))
        state = float(course.current[-1]), float(course.capacitor[-1])
        outputs = contact.real(*OUTPUTS)
    return Result(dict(zip(COLUMNS, np.array(rows).T, strict=True)), np.concatenate(waves, axis=1))


def summary(result: Result) -> str:
    """Describe the openings, the range reached and the heat in the contact."""
    spans, (time, _, voltages, currents) = result.spans(), result.waves
    voltage, current = np.abs(voltages).max(), np.abs(currents).max()
    inside = "inside" if voltage < RANGE[0] and current < RANGE[1] else "OUTSIDE"
    return f"""openings: {len(spans)}; {", ".join(f"{1e6 * a:.3f} to {1e6 * b:.3f} us" for a, b in spans[:3])}
contact: at most {voltage:.3f} V and {current:.4f} A, {inside} the range without arcs ({RANGE[0]:g} V, {RANGE[1]:g} A)
heat in the contact: {1e6 * np.trapezoid(voltages * currents, time):.3f} uJ"""


def draw(result: Result, title: str, path: Path) -> None:
    """Draw waveforms with the openings marked."""
    figure, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(9, 6), layout="constrained")
    shown = result.waves[0] <= 2.5 * PERIOD
    time, load, voltage, current = result.waves[:, shown]
    above.plot(1e3 * time, voltage, color=RED, linewidth=1, label="contact")
    above.axhline(CIRCUIT.supply, color=GREY, linestyle=":", label="source")
    above.set_ylabel("voltage [V]")
    below.plot(1e3 * time, 1e3 * load, color=BLUE, linewidth=1.4, label="load")
    below.plot(1e3 * time, 1e3 * current, color=ORANGE, linewidth=1, linestyle="--", label="contact")
    below.set(ylabel="current [mA]", xlabel="time [ms]", xlim=(0, 1e3 * time[-1]))
    for axes in (above, below):
        for number, (start, end) in enumerate(result.spans()):
            label = None if number else "contact open"
            axes.axvspan(1e3 * start, 1e3 * end, color=SKY, alpha=0.25, linewidth=0, label=label)
        axes.grid(alpha=0.3)
        legend_beside(axes)
    figure.suptitle(title, fontsize="medium")
    figure.align_ylabels()
    save(figure, path)


def chosen(name: str | None) -> tuple[str, Solver]:
    """Give the solver asked for; by default ngspice if it is installed, else the closed form with a message."""
    if name != "built-in":
        try:
            return "ngspice", NgSpice(CIRCUIT)
        except OSError as error:
            advice = "install libngspice0 (Debian, Ubuntu), libngspice (Homebrew), or put ngspice.dll on the PATH"
            if name == "ngspice":
                raise SystemExit(f"{error}: {advice}, or choose --circuit built-in") from error
            print(f"{error}: {advice}. The built-in circuit is used instead.")
    return "built-in", CIRCUIT


def main() -> None:
    """Run the coupling."""
    step_ = (2.0, 0.1, 50.0, "µs", "communication step of the waveforms")
    line = parser(__doc__, "2.5 ms instead of 10 ms", "half a minute, with --quick some seconds", step=step_)
    line.add_argument("--circuit", choices=["ngspice", "built-in"], help="default: ngspice if it is installed")
    given = read_arguments(line)
    name, solver = chosen(given.circuit)
    stop, step = (2.5 if given.quick else 10) * PERIOD, 1e-6 * given.step
    component = Component(given.fmu)

    def run(solver: Solver, label: str) -> Result:
        with component.started(Scene.read("chatter-41g").values) as contact:
            return simulate(contact, solver, step, round(stop / step), label)

    try:
        result = run(solver, name)
    except RuntimeError as error:
        raise SystemExit(str(error)) from error
    print(f"{name}, communication step {given.step:g} us, {1e3 * stop:g} ms\n{summary(result)}")
    if name == "ngspice":
        other = run(CIRCUIT, "built-in, to compare")
        gaps = [np.abs(result.columns[each] - other.columns[each]).max() for each in COLUMNS[4:6]]
        print(f"ngspice and the closed form differ by {gaps[0]:.1e} A and {gaps[1]:.1e} V at most")
    paths = [given.out / f"circuit-rl{end}" for end in (".csv", ".png")]
    write_table(paths[0], ",".join(COLUMNS), np.column_stack(list(result.columns.values())))
    draw(result, f"Relay contact, 400 m/s² at 1 kHz, in a 6 V RL circuit ({name}, step {given.step:g} µs)", paths[1])
    print(*paths, sep="\n")


if __name__ == "__main__":
    main()
