"""Couple the contact with a 6 V RL circuit: it opens in every period of a vibration, and the circuit answers.

The contact is the FMU, under FMPy, shaken by 400 m/s2 (41 g) at 1 kHz. The circuit (its diagram and its equations:
circuit.py) is ngspice, through its shared library, or solved in closed form (`--circuit built-in`).

Both sides step in parallel. At every communication point the circuit takes `contact.resistance`, and the component
takes the contact current that results; each holds its input until the next point. So the circuit
learns of an opening or closing up to one step late, and the load current, whose slope changes by up to V / L there, is
wrong by up to h V / L: first order in the step h. No smoother interpolation of the resistance would help, as nearly all
of its change, from milliohms to the open contact, happens within one step. Communication points at those instants
help: rollback.py.

The error is taken against the circuit in closed form on steps of 50 ns, with a point at each opening and closing
(halving these steps changes the load current by 2 uA at most).
"""

from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from tqdm import tqdm

from circuit import COIL, LOAD, PERIOD, QUENCH, SOURCE, BuiltIn, at_rest, closed_form, contact_voltage, shaken, stored
from common import BLUE, GREY, ORANGE, RED, SKY, legend_beside, parser, read_arguments, save, within, write_table
from ngspice import NgSpice
from relay_contact import Array, Component, Contact

RANGE = (12.0, 0.4)  # V and A: below them a contact draws no arc
STEPS = [20e-6, 10e-6, 5e-6, 2e-6, 1e-6, 0.5e-6, 0.2e-6]  # s, of the study of convergence
REFERENCE_STEP = 5e-8  # s
COLUMNS = ["time", "contact.resistance", "contact.voltage", "contact.lastOpening", "contact.lastClosing"]
COLUMNS += ["load.current", "capacitor.voltage", "circuit.voltage", "circuit.current"]
COLUMNS += ["energy.source", "energy.load", "energy.quench", "energy.contact", "energy.stored"]

Circuit = BuiltIn | NgSpice


@dataclass
class Result:
    """A coupled run."""

    columns: dict[str, Array]
    """`COLUMNS`, SI units, at the communication points; energies since the start."""
    waves: Array
    """Time, load current, contact voltage and contact current, within the steps too."""
    error: float
    """How far the energies may miss their balance."""

    def spans(self) -> list[tuple[float, float]]:
        """Give from when to when the contact was open."""
        openings, closings = (np.unique(self.columns[f"contact.last{name}"])[1:] for name in ("Opening", "Closing"))
        return list(zip(openings, np.append(closings, self.columns["time"][-1]), strict=False))


def simulate(contact: Contact, circuit: Circuit, step: float, count: int, label: str) -> Result:
    """Run both sides in parallel from the closed contact's steady state."""
    outputs = contact.real(*COLUMNS[1:5])
    state = at_rest(outputs[0])
    first, energies, error = stored(*state), np.zeros(5), 0.0
    rows, waves = [], []
    for index in tqdm(range(count + 1), desc=label, unit="step", leave=False):
        resistance = outputs[0]
        voltage = float(contact_voltage(*state, 1 / resistance))
        energies[4] = stored(*state) - first
        rows.append([index * step, *outputs, *state, voltage, voltage / resistance, *energies])
        if index == count:
            break
        course = circuit.advance(state, resistance, step)
        contact.set("contact.current", voltage / resistance)
        contact.step(index * step, step)
        drop = contact_voltage(course.current, course.capacitor, 1 / resistance)
        waves.append(np.stack([index * step + course.time, course.current, drop, drop / resistance]))
        powers = SOURCE * course.current, LOAD * course.current**2, (drop - course.capacitor) ** 2 / QUENCH
        energies[:4] += [power @ course.weights for power in (*powers, drop**2 / resistance)]
        state, error = (float(course.current[-1]), float(course.capacitor[-1])), error + course.error
        outputs = contact.real(*COLUMNS[1:5])
    return Result(dict(zip(COLUMNS, np.array(rows).T, strict=True)), np.concatenate(waves, axis=1), error)


def reference(contact: Contact, stop: float) -> Array:
    """Give the load current every `REFERENCE_STEP`, converged: the circuit in closed form, a point at each event.

    The current does not act on the contact's motion, so the component goes ahead alone here. The circuit takes the
    mean of the conductances at both ends of a step, which makes this second order.
    """
    times, conductances, events = [0.0], contact.real("contact.conductance"), [-1.0, -1.0]
    for index in range(round(stop / REFERENCE_STEP)):
        contact.step(index * REFERENCE_STEP, REFERENCE_STEP)
        conductance, *instants = contact.real("contact.conductance", "contact.lastOpening", "contact.lastClosing")
        for instant, before in zip(instants, events, strict=True):
            if instant > before and times[-1] < instant < (index + 1) * REFERENCE_STEP:
                times.append(instant)
                conductances.append(1e-9)
        events = instants
        times.append((index + 1) * REFERENCE_STEP)
        conductances.append(conductance)
    resistances = 2 / np.add(conductances[1:], conductances[:-1])
    exponentials, rests = closed_form(1 / resistances, np.diff(times))
    state = np.array(at_rest(1 / conductances[0]))
    currents = [state[0]]
    for exponential, rest in zip(exponentials, rests, strict=True):
        state = rest + exponential @ (state - rest)
        currents.append(state[0])
    wanted: Array = np.interp(np.arange(round(stop / REFERENCE_STEP) + 1) * REFERENCE_STEP, times, currents)
    return wanted


def summary(result: Result, step: float) -> str:
    """Say what came out: openings, range, energies, interface."""
    columns, spans = result.columns, result.spans()
    energies = {name.split(".")[1]: 1e6 * columns[name][-1] for name in COLUMNS if name.startswith("energy")}
    miss = 2 * energies["source"] - sum(energies.values())
    voltage, current = np.abs(result.waves[2:]).max(axis=1)
    inside = "inside" if voltage < RANGE[0] and current < RANGE[1] else "OUTSIDE"
    # What the component takes for the contact's power, against what the circuit gives off there.
    power = columns["contact.voltage"][1:] * columns["circuit.current"][:-1]
    heat = np.diff(columns["energy.contact"])
    closed = columns["contact.resistance"] < LOAD
    both = closed[1:] & closed[:-1]
    gap = np.abs(power * step - heat)[both].sum()
    return f"""openings: {len(spans)}; {", ".join(f"{1e6 * a:.3f} to {1e6 * b:.3f} us" for a, b in spans[:3])}
contact: at most {voltage:.3f} V and {current:.4f} A, {inside} the range without arcs ({RANGE[0]:g} V, {RANGE[1]:g} A)
energy: {", ".join(f"{name} {value:.6f} uJ" for name, value in energies.items())}
energy balance: missed by {abs(miss):.2e} uJ; quadrature and integrator explain {1e6 * result.error:.2e} uJ
interface: contact.voltage times contact.current misses the contact's heat by {1e6 * gap:.4f} uJ of
    {1e6 * heat[both].sum():.4f} uJ while closed, as one of them is a step old. Where it opens, contact.voltage reads
    {columns["contact.voltage"].max():g} V for one step, its limit contact.openVoltage, as the current of before
    cannot flow over the resistance of now: take the voltage from the circuit."""


def draw(result: Result, study: Array, order: float, title: str, path: Path) -> None:
    """Draw waveforms with the openings marked, and the error over the step."""
    figure, (above, middle, below) = plt.subplots(3, 1, figsize=(9, 9), layout="constrained")
    shown = result.waves[0] <= 2.5 * PERIOD
    time, load, voltage, current = result.waves[:, shown]
    above.plot(1e3 * time, voltage, color=RED, linewidth=1)
    above.set_ylabel("contact voltage [V]")
    middle.plot(1e3 * time, 1e3 * load, color=BLUE, linewidth=1.4, label="load")
    middle.plot(1e3 * time, 1e3 * current, color=ORANGE, linewidth=1, linestyle="--", label="contact")
    middle.set_ylabel("current [mA]")
    for axes in (above, middle):
        for number, (start, end) in enumerate(result.spans()):
            label = None if number else "contact open"
            axes.axvspan(1e3 * start, 1e3 * end, color=SKY, alpha=0.25, linewidth=0, label=label)
        axes.set_xlim(0, 1e3 * time[-1])
        axes.set_xlabel("time [ms]")
    steps, root, largest = study.T
    below.loglog(1e6 * steps, 1e3 * largest, "o-", color=RED, label="largest")
    below.loglog(1e6 * steps, 1e3 * root, "s-", color=BLUE, label=f"root mean square,\nobserved order {order:.2f}")
    bound = "h V / L: slope of the current\ntimes one step of delay"
    below.loglog(1e6 * steps, 1e3 * steps * SOURCE / COIL, "--", color=GREY, label=bound)
    below.set_xlabel("communication step h [µs]")
    below.set_ylabel("error of the load current [mA]")
    for axes in (above, middle, below):
        axes.grid(alpha=0.3, which="both")
        legend_beside(axes)
    figure.suptitle(title, fontsize="medium")
    figure.align_ylabels()
    save(figure, path)


def chosen(name: str | None) -> tuple[str, Circuit]:
    """Give the circuit asked for; without a wish ngspice where it is, else the built-in one, and say so."""
    if name != "built-in":
        try:
            return "ngspice", NgSpice()
        except OSError as error:
            advice = "install libngspice0 (Debian, Ubuntu), libngspice (Homebrew), or put ngspice.dll on the PATH"
            if name == "ngspice":
                raise SystemExit(f"{error}: {advice}, or choose --circuit built-in") from error
            print(f"{error}: {advice}. The built-in circuit is taken instead.")
    return "built-in", BuiltIn()


def main() -> None:
    """Run the coupling, then the study of convergence."""
    line = parser("The contact in a 6 V RL circuit. Takes a minute or two, with --quick 10 seconds.")
    line.add_argument("--quick", action="store_true", help="2.5 ms instead of 10 ms, fewer steps in the study")
    line.add_argument("--circuit", choices=["ngspice", "built-in"], help="default: ngspice where it is installed")
    line.add_argument(
        "--step", type=within(0.1, 50, "µs"), default=2.0, help="communication step of the waveforms [µs] (%(default)s)"
    )
    given = read_arguments(line)
    name, circuit = chosen(given.circuit)
    stop, steps = (2.5 * PERIOD, STEPS[:-1]) if given.quick else (10 * PERIOD, STEPS)
    step = 1e-6 * given.step
    component = Component(given.fmu)

    def run(circuit: Circuit, step: float, label: str) -> Result:
        with shaken(component) as contact:
            return simulate(contact, circuit, step, round(stop / step), label)

    try:
        result = run(circuit, step, f"{name}, step {given.step:g} us")
        other = run(BuiltIn(), step, "built-in, to compare") if name == "ngspice" else None
        with shaken(component) as contact:
            exact = reference(contact, stop)
        study = []
        for length in steps:
            columns = run(circuit, length, f"{name}, step {1e6 * length:g} us").columns
            errors = columns["load.current"] - exact[:: round(length / REFERENCE_STEP)]
            study.append([length, np.sqrt(np.mean(errors**2)), np.abs(errors).max()])
    except RuntimeError as error:
        raise SystemExit(str(error)) from error
    table = np.array(study)
    order = float(np.polyfit(np.log(table[:, 0]), np.log(table[:, 1]), 1)[0])
    print(f"{name}, communication step {given.step:g} us, {1e3 * stop:g} ms\n{summary(result, step)}")
    if other:
        gaps = [np.abs(result.columns[name] - other.columns[name]).max() for name in COLUMNS[5:7]]
        print(f"ngspice and the closed form differ by {gaps[0]:.1e} A and {gaps[1]:.1e} V at most")
    for length, root, largest in 1e3 * table:
        print(f"step {1e3 * length:g} us: error of the load current {root:.4f} mA rms, {largest:.4f} mA at most")
    print(f"observed order: {order:.2f} (1 by theory)")
    paths = [given.out / f"circuit-rl{end}" for end in (".csv", "-convergence.csv", ".png")]
    write_table(paths[0], ",".join(COLUMNS), np.column_stack(list(result.columns.values())))
    write_table(paths[1], "communication.step,error.load.current.rms,error.load.current.largest", table)
    title = f"Relay contact shaken by 400 m/s² at 1 kHz in a 6 V RL circuit ({name}, step {given.step:g} µs)"
    draw(result, table, order, title, paths[2])
    print(*paths, sep="\n")


if __name__ == "__main__":
    main()
