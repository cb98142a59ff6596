"""Couple the contact with a 6 V RL circuit: it opens in every period of a vibration, and the circuit answers.

The contact is the FMU, under FMPy, shaken by 400 m/s2 (41 g) at 1 kHz. The circuit is ngspice, through its shared
library, or the same equations solved in closed form (`--circuit built-in`):

    6 V --- R 60 Ohm --- L 1 mH ---+--- contact ------------------- 0 V
                                   +--- Rq 47 Ohm --- Cq 220 nF --- 0 V

Rq and Cq are the usual quench: without them an ideal inductor drives any voltage over an opening contact, and the
component knows no arcs (it holds below about 12 V and 0.4 A; the summary says what was reached). With the load
current i and the capacitor's voltage q: contact voltage v = (i + q / Rq) / (1 / Rc + 1 / Rq), L di/dt = V - R i - v,
Rq Cq dq/dt = v - q.

Both sides step in parallel. At every communication point the circuit takes `contact.resistance` and the component
takes the contact current that the circuit has with it; each keeps what it took, constant, until the next point. So an
opening or closing is felt up to one step late, and the load current, whose slope changes by up to V / L there, is wrong
by up to h V / L: order one in the step h. No smoother course of the resistance would help, as nearly all its change,
from milliohms to the open contact, falls within one step. (rollback.py shows what does: communication points at those
instants.)

The error is taken against the circuit in closed form on steps of 50 ns, with a point at each opening and closing
(halving these steps changes the load current by 2 uA at most).

ngspice makes one `tran ... uic` analysis per communication step, with the states as initial conditions: so its
integrator starts afresh after every jump of the resistance. (One analysis with `stop`, `alter` and `resume` misses
stops in ngspice 39.)
"""

import argparse
import contextlib
import ctypes
import ctypes.util
import shutil
import sys
from collections import deque
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from fmpy import extract, instantiate_fmu, read_model_description
from numpy.typing import NDArray
from tqdm import tqdm

mpl.use("Agg")
import matplotlib.pyplot as plt

ROOT = Path(__file__).resolve().parents[2]
SOURCE, LOAD, COIL = 6.0, 60.0, 1e-3  # V, Ohm, H
QUENCH, CAPACITOR = 47.0, 220e-9  # Ohm, F
RANGE = (12.0, 0.4)  # V and A: below them a contact draws no arc
PERIOD = 1e-3  # s, of the vibration
INNER_STEP, RELATIVE_TOLERANCE = 1e-7, 1e-7  # of ngspice: s, longest; 1
STEPS = [20e-6, 10e-6, 5e-6, 2e-6, 1e-6, 0.5e-6, 0.2e-6]  # s, of the study of convergence
REFERENCE_STEP = 5e-8  # s
NODES, WEIGHTS = np.polynomial.legendre.leggauss(8)
LIBRARIES = ["libngspice.so.0", "libngspice.so", "libngspice.0.dylib", "libngspice.dylib", "ngspice.dll"]
LIBRARIES += ["libngspice-0.dll", "/opt/homebrew/lib/libngspice.dylib"]
COLUMNS = ["time", "contact.resistance", "contact.voltage", "contact.lastOpening", "contact.lastClosing"]
COLUMNS += ["load.current", "capacitor.voltage", "circuit.voltage", "circuit.current"]
COLUMNS += ["energy.source", "energy.load", "energy.quench", "energy.contact", "energy.stored"]

Array = NDArray[np.float64]


def contact_voltage(current: Any, capacitor: Any, resistance: Any) -> Any:  # noqa: ANN401
    """Give the voltage over the contact from the load current and the capacitor's voltage, numbers or arrays."""
    return (current + capacitor / QUENCH) / (1 / resistance + 1 / QUENCH)


def stored(current: float, capacitor: float) -> float:
    """Give the energy in coil and capacitor."""
    return (COIL * current**2 + CAPACITOR * capacitor**2) / 2


@dataclass
class Course:
    """What the circuit does within a communication step: at instants since its start, from the start to the end."""

    time: Array
    current: Array
    capacitor: Array
    weights: Array
    """A power times these is the energy over the step."""
    error: float
    """How far the energies of this step may miss their balance."""


class BuiltIn:
    """Closed form. Energies by Gauss quadrature of 16th order: exact but for rounding."""

    def advance(self, start: tuple[float, float], resistance: float, step: float) -> Course:
        """Step once."""
        times, weights = np.pad((NODES + 1) / 2 * step, 1), np.pad(WEIGHTS * step / 2, 1)
        times[-1] = step
        exponentials, rest = closed_form(np.array(resistance), times)
        current, capacitor = (rest + exponentials @ (np.array(start) - rest)).T
        # Some ten roundings of what flows and of what is stored.
        error = 10 * np.finfo(float).eps * (SOURCE**2 / LOAD * step + stored(current[-1], capacitor[-1]))
        return Course(times, current, capacitor, weights, error)


def closed_form(resistance: Array, time: Array) -> tuple[Array, Array]:
    """Give exp(A time) and the state at rest of the circuit, d(i, q)/dt = A ((i, q) - rest), at a held resistance."""
    a = 1 / (1 / resistance + 1 / QUENCH)
    load = np.stack([-(LOAD + a) / COIL, -a / QUENCH / COIL], axis=-1)
    quench = np.stack([a / (QUENCH * CAPACITOR), (a / QUENCH - 1) / (QUENCH * CAPACITOR)], axis=-1)
    matrix = np.stack([load, quench], axis=-2)
    current = SOURCE / (LOAD + resistance)
    # The exponential of a matrix of two rows, by Cayley and Hamilton. Half the trace, half the eigenvalues' distance
    # (the tiny number only keeps it from 0).
    middle = np.trace(matrix, axis1=-2, axis2=-1) / 2
    half = np.sqrt(middle**2 - np.linalg.det(matrix) + 0j) + 1e-30
    even, odd = np.cosh(half * time) * np.exp(middle * time), np.sinh(half * time) / half * np.exp(middle * time)
    shifted = matrix - middle[..., None, None] * np.eye(2)
    exponential = (even[..., None, None] * np.eye(2) + odd[..., None, None] * shifted).real
    return exponential, np.stack([current, current * resistance], axis=-1)


class Vector(ctypes.Structure):
    """A result of ngspice, as its shared library gives it."""

    _fields_ = [("name", ctypes.c_char_p), ("type", ctypes.c_int), ("flags", ctypes.c_short)]
    _fields_ += [("real", ctypes.POINTER(ctypes.c_double)), ("complex", ctypes.c_void_p), ("length", ctypes.c_int)]


def load_library() -> ctypes.CDLL:
    """Load ngspice's shared library; `OSError` where there is none."""
    for name in [ctypes.util.find_library("ngspice"), *LIBRARIES]:
        with contextlib.suppress(OSError):
            if name:
                return ctypes.CDLL(name)
    raise OSError("ngspice's shared library is missing")


class NgSpice:
    """ngspice by its shared library."""

    def __init__(self) -> None:
        """Load the library and the circuit."""
        self.library = load_library()
        self.library.ngGet_Vec_Info.restype = ctypes.POINTER(Vector)
        self.said: deque[str] = deque(maxlen=10)
        # ngspice keeps these two functions: they must live as long as this object.
        number, pointer = ctypes.c_int, ctypes.c_void_p
        self.print = ctypes.CFUNCTYPE(number, ctypes.c_char_p, number, pointer)(self.hear)
        self.quit = ctypes.CFUNCTYPE(number, number, ctypes.c_bool, ctypes.c_bool, number, pointer)(lambda *_: 0)
        self.library.ngSpice_Init(self.print, None, self.quit, None, None, None, None)
        lines = f"""relay contact
            V1 supply 0 {SOURCE}
            R1 supply coil {LOAD}
            L1 coil contact {COIL} ic=0
            RC contact 0 1
            RQ contact quench {QUENCH}
            CQ quench 0 {CAPACITOR} ic=0
            .options method=trap reltol={RELATIVE_TOLERANCE} abstol=1e-13 vntol=1e-10
            .end""".splitlines()
        netlist = (ctypes.c_char_p * (len(lines) + 1))(*[line.strip().encode() for line in lines], None)
        if self.library.ngSpice_Circ(netlist):
            raise RuntimeError(f"ngspice refused the circuit: {' / '.join(self.said)}")

    def hear(self, text: bytes, _library: int, _user: object) -> int:
        """Keep what ngspice says, for errors."""
        self.said.append(text.decode(errors="replace"))
        return 0

    def command(self, text: str) -> None:
        """Have ngspice do something."""
        if self.library.ngSpice_Command(text.encode()):
            raise RuntimeError(f"ngspice refused `{text}`: {' / '.join(self.said)}")

    def result(self, name: str) -> Array:
        """Give a vector of the last analysis."""
        vector = self.library.ngGet_Vec_Info(name.encode())
        if not vector:
            raise RuntimeError(f"ngspice gave no {name}: {' / '.join(self.said)}")
        return np.ctypeslib.as_array(vector.contents.real, (vector.contents.length,)).copy()

    def advance(self, start: tuple[float, float], resistance: float, step: float) -> Course:
        """Step once."""
        inner = min(INNER_STEP, step / 10)
        for name, value in (("RC", resistance), ("@L1[ic]", start[0]), ("@CQ[ic]", start[1])):
            self.command(f"alter {name} = {value!r}")
        self.command(f"tran {inner!r} {step!r} 0 {inner!r} uic")
        # What `uic` starts from is not a result, or not in every version.
        late = self.result("time") > 0
        time = np.append(0.0, self.result("time")[late])
        current = np.append(start[0], self.result("l1#branch")[late])
        capacitor = np.append(start[1], self.result("quench")[late])
        self.command("destroy all")
        if not abs(time[-1] - step) < 1e-9 * step:
            raise RuntimeError(f"ngspice stopped {time[-1]} s into a step of {step} s: {' / '.join(self.said)}")
        # Integrator and quadrature are both the trapezoidal rule. By Tellegen's theorem the powers of all branches, and
        # the products of their changes, sum to zero; so the balance misses by a quarter of the sum of
        # step * change of voltage * change of current over coil and capacitor, and no more. The first inner step is
        # backward Euler, which misses half of step * change * value. Besides, ngspice iterates to its tolerance.
        steps, weights = np.diff(time), np.convolve(np.diff(time), [0.5, 0.5])
        drop = contact_voltage(current, capacitor, resistance)
        coil, charging = np.diff(SOURCE - LOAD * current - drop), np.diff((drop - capacitor) / QUENCH)
        error = steps @ np.abs(coil * np.diff(current) + charging * np.diff(capacitor)) / 4
        error += steps[0] * (abs(coil[0] * current[0]) + abs(charging[0] * capacitor[0])) / 2
        error += RELATIVE_TOLERANCE * SOURCE**2 / LOAD * step
        return Course(time, current, capacitor, weights, float(error))


Circuit = BuiltIn | NgSpice


class Contact:
    """The component, initialised for the vibration."""

    def __init__(self, folder: str, description: Any) -> None:  # noqa: ANN401
        """Start it."""
        self.references = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.fmu = instantiate_fmu(folder, description, fmi_type="CoSimulation")
        self.fmu.setupExperiment(startTime=0.0)
        choices, numbers = (
            ["effects.excitation", "effects.axialForce"],
            ["excitation.amplitude", "excitation.frequency"],
        )
        self.fmu.setInteger([self.references[name] for name in choices], [2, 2])  # Sine, None
        self.fmu.setReal([self.references[name] for name in numbers], [400.0, 1 / PERIOD])
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def get(self, *names: str) -> list[float]:
        """Give outputs."""
        values: list[float] = self.fmu.getReal([self.references[name] for name in names])
        return values

    def step(self, time: float, length: float, current: float = 0.0) -> None:
        """Step once with a current through the contact."""
        self.fmu.setReal([self.references["contact.current"]], [current])
        self.fmu.doStep(currentCommunicationPoint=time, communicationStepSize=length)

    def close(self) -> None:
        """Release it."""
        self.fmu.terminate()
        self.fmu.freeInstance()


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
    outputs = contact.get(*COLUMNS[1:5])
    current = SOURCE / (LOAD + outputs[0])
    state = (current, current * outputs[0])
    first, energies, error = stored(*state), np.zeros(5), 0.0
    rows, waves = [], []
    for index in tqdm(range(count + 1), desc=label, unit="step", leave=False):
        resistance = outputs[0]
        voltage = float(contact_voltage(*state, resistance))
        energies[4] = stored(*state) - first
        rows.append([index * step, *outputs, *state, voltage, voltage / resistance, *energies])
        if index == count:
            break
        course = circuit.advance(state, resistance, step)
        contact.step(index * step, step, voltage / resistance)
        drop = contact_voltage(course.current, course.capacitor, resistance)
        waves.append(np.stack([index * step + course.time, course.current, drop, drop / resistance]))
        powers = SOURCE * course.current, LOAD * course.current**2, (drop - course.capacitor) ** 2 / QUENCH
        energies[:4] += [power @ course.weights for power in (*powers, drop**2 / resistance)]
        state, error = (float(course.current[-1]), float(course.capacitor[-1])), error + course.error
        outputs = contact.get(*COLUMNS[1:5])
    contact.close()
    return Result(dict(zip(COLUMNS, np.array(rows).T, strict=True)), np.concatenate(waves, axis=1), error)


def reference(contact: Contact, stop: float) -> Array:
    """Give the load current every `REFERENCE_STEP`, converged: the circuit in closed form, a point at each event.

    The current does not act on the contact's motion, so the component goes ahead alone here. The circuit takes the
    mean of the conductances at both ends of a step, which makes this second order.
    """
    times, conductances, events = [0.0], contact.get("contact.conductance"), [-1.0, -1.0]
    for index in range(round(stop / REFERENCE_STEP)):
        contact.step(index * REFERENCE_STEP, REFERENCE_STEP)
        conductance, *instants = contact.get("contact.conductance", "contact.lastOpening", "contact.lastClosing")
        for instant, before in zip(instants, events, strict=True):
            if instant > before and times[-1] < instant < (index + 1) * REFERENCE_STEP:
                times.append(instant)
                conductances.append(1e-9)
        events = instants
        times.append((index + 1) * REFERENCE_STEP)
        conductances.append(conductance)
    resistances = 2 / np.add(conductances[1:], conductances[:-1])
    exponentials, rests = closed_form(resistances, np.diff(times))
    state = SOURCE / (LOAD + 1 / conductances[0]) * np.array([1, 1 / conductances[0]])
    currents = [state[0]]
    for exponential, rest in zip(exponentials, rests, strict=True):
        state = rest + exponential @ (state - rest)
        currents.append(state[0])
    contact.close()
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
    up to {columns["contact.voltage"].max():.1e} V for one step, the current of before times the resistance of now:
    take the voltage from the circuit."""


def draw(result: Result, study: Array, order: float, title: str, path: Path) -> None:
    """Draw waveforms with the openings marked, and the error over the step."""
    figure, (above, middle, below) = plt.subplots(3, 1, figsize=(9, 9), layout="constrained")
    shown = result.waves[0] <= 2.5 * PERIOD
    time, load, voltage, current = result.waves[:, shown]
    # Colours of Okabe and Ito, told apart also by the colour-blind.
    above.plot(1e3 * time, voltage, color="#D55E00", linewidth=1)
    above.set_ylabel("contact voltage [V]")
    middle.plot(1e3 * time, 1e3 * load, color="#0072B2", linewidth=1.4, label="load")
    middle.plot(1e3 * time, 1e3 * current, color="#E69F00", linewidth=1, linestyle="--", label="contact")
    middle.set_ylabel("current [mA]")
    for axes in (above, middle):
        for number, (start, end) in enumerate(result.spans()):
            label = None if number else "open, as the\ncomponent tells"
            axes.axvspan(1e3 * start, 1e3 * end, color="#56B4E9", alpha=0.25, linewidth=0, label=label)
        axes.set_xlim(0, 1e3 * time[-1])
        axes.set_xlabel("time [ms]")
    steps, root, largest = study.T
    below.loglog(1e6 * steps, 1e3 * largest, "o-", color="#D55E00", label="largest")
    below.loglog(1e6 * steps, 1e3 * root, "s-", color="#0072B2", label=f"root mean square,\nobserved order {order:.2f}")
    bound = "h V / L: slope of the current\ntimes one step of delay"
    below.loglog(1e6 * steps, 1e3 * steps * SOURCE / COIL, "--", color="#666666", label=bound)
    below.set_xlabel("communication step h [µs]")
    below.set_ylabel("error of the load current [mA]")
    for axes in (above, middle, below):
        axes.grid(alpha=0.3, which="both")
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize="small", frameon=False)
    figure.suptitle(title, fontsize="medium")
    figure.align_ylabels()
    figure.savefig(path, dpi=150)
    plt.close(figure)


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


def main() -> int:
    """Run the coupling, then the study of convergence."""
    parser = argparse.ArgumentParser(
        description="The contact in a 6 V RL circuit. Takes a minute or two, with --quick 10 seconds."
    )
    parser.add_argument("--fmu", type=Path, default=ROOT / "dist" / "RelayContact.fmu", help="the component")
    parser.add_argument("--out", type=Path, default=ROOT / "out", help="folder for the tables and the figure")
    parser.add_argument("--quick", action="store_true", help="2.5 ms instead of 10 ms, fewer steps in the study")
    parser.add_argument("--circuit", choices=["ngspice", "built-in"], help="default: ngspice where it is installed")
    parser.add_argument("--step", type=float, default=2.0, help="communication step of the waveforms [us], 2")
    arguments = parser.parse_args()
    if not arguments.fmu.is_file():
        print(f"{arguments.fmu} is missing: build it with `cargo xtask fmu`", file=sys.stderr)
        return 1
    if not 0.1 <= arguments.step <= 50:
        parser.error(f"--step is {arguments.step}: 0.1 to 50 us are allowed")
    name, circuit = chosen(arguments.circuit)
    stop, steps = (2.5 * PERIOD, STEPS[:-1]) if arguments.quick else (10 * PERIOD, STEPS)
    step = 1e-6 * arguments.step
    description, folder = read_model_description(arguments.fmu), extract(str(arguments.fmu))
    try:

        def run(circuit: Circuit, step: float, label: str) -> Result:
            return simulate(Contact(folder, description), circuit, step, round(stop / step), label)

        result = run(circuit, step, f"{name}, step {arguments.step:g} us")
        other = run(BuiltIn(), step, "built-in, to compare") if name == "ngspice" else None
        exact = reference(Contact(folder, description), stop)
        study = []
        for length in steps:
            columns = run(circuit, length, f"{name}, step {1e6 * length:g} us").columns
            errors = columns["load.current"] - exact[:: round(length / REFERENCE_STEP)]
            study.append([length, np.sqrt(np.mean(errors**2)), np.abs(errors).max()])
    except RuntimeError as error:
        print(error, file=sys.stderr)
        return 1
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    table = np.array(study)
    order = float(np.polyfit(np.log(table[:, 0]), np.log(table[:, 1]), 1)[0])
    print(f"{name}, communication step {arguments.step:g} us, {1e3 * stop:g} ms\n{summary(result, step)}")
    if other:
        gaps = [np.abs(result.columns[name] - other.columns[name]).max() for name in COLUMNS[5:7]]
        print(f"ngspice and the closed form differ by {gaps[0]:.1e} A and {gaps[1]:.1e} V at most")
    for length, root, largest in 1e3 * table:
        print(f"step {1e3 * length:g} us: error of the load current {root:.4f} mA rms, {largest:.4f} mA at most")
    print(f"observed order: {order:.2f} (1 by theory)")
    arguments.out.mkdir(parents=True, exist_ok=True)
    paths = [arguments.out / f"circuit-rl{end}" for end in (".csv", "-convergence.csv", ".png")]
    rows = np.column_stack(list(result.columns.values()))
    np.savetxt(paths[0], rows, delimiter=",", header=",".join(COLUMNS), comments="", fmt="%.12g")
    head = "communication.step,error.load.current.rms,error.load.current.largest"
    np.savetxt(paths[1], table, delimiter=",", header=head, comments="", fmt="%.12g")
    title = f"Relay contact shaken by 400 m/s² at 1 kHz in a 6 V RL circuit ({name}, step {arguments.step:g} µs)"
    draw(result, table, order, title, paths[2])
    print(*paths, sep="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
