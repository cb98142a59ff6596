"""Make and break of a contact by an electromagnet that is another FMU, in FMPy and in libcosim.

The partner, Actuator.fmu, which PythonFMU makes of actuator_magnet.py, is a coil that is switched on and off, its
magnet, and an armature between two stops (its equations are there). The contact has effects.pusher Prescribed. Two
connections, updated at every communication point: pusher.displacement of the actuator to that of the contact, and
pusher.force of the contact back.

FMPy also hands over the velocity of the pusher, as the derivative of the contact's input: within a step the pusher then
moves on in a straight line, and only the force is late, by the step. libcosim hands over no derivatives of inputs: the
pusher is late by a step, too. With --libcosim the coupled FMUs run there as well, and in FMPy without derivatives,
which has to be the same. It needs libcosimpy, and the component with choices as numbers
(`cargo xtask fmu --plain`). Other tools couple the component by files: conformance/SystemStructure.ssd is a system for
libcosim and Ecos.

Actuator.fmu runs in the Python of the process that loads it and needs no packages: the FMU contains its part of
PythonFMU. A tool that is not a Python program must load one: on Linux by LD_PRELOAD=libpython3.11.so.1.0 (the binary in
the FMU is not linked to any), on Windows by python3.dll in the PATH. PythonFMU has binaries for 64-bit x86 Linux and
Windows.

Operate time: from switching on to the first touch. Bounce at make: from there to the last closing before switching off.
Release time: from switching off to the first opening. Bounce at break: from there to the last opening.
"""

import platform
import sys
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from pythonfmu import FmuBuilder
from tqdm import tqdm

from actuator_magnet import PARAMETERS
from common import leave, parser, read_arguments, save, within
from relay_contact import Array, Component, Contact, write_table
from relay_contact.figures import BLUE, GREEN, ORANGE, PURPLE, RED

# From instance and output to instance and input.
WIRES = [
    ("actuator", "pusher.displacement", "contact", "pusher.displacement"),
    ("contact", "pusher.force", "actuator", "pusher.force"),
]
MAGNET = Path(__file__).with_name("actuator_magnet.py")
# A contact of clean metal, open without the pusher.
CONTACT = {"contact.overtravel": -5e-5, "contact.damping": 1e-6}
PUSHER, PRESCRIBED = "effects.pusher", 2  # libcosim knows no choices, but their numbers
END = 0.036  # s
RECORDED = [("actuator", each) for each in ("coil.current", "pusher.displacement")]
RECORDED += [
    ("contact", each) for each in ("pusher.force", "contact.force", "contact.lastOpening", "contact.lastClosing")
]

Run = dict[str, Array]  # time and what is recorded, SI units
Starts = dict[str, dict[str, float]]  # start values of each instance


def by_fmpy(fmus: dict[str, Path], starts: Starts, time: Array, bar: "tqdm[Any]", derivative: bool = True) -> Run:
    """Run the wired FMUs through the instants in FMPy, with the derivative of the contact's input or without."""
    rows = []
    with ExitStack() as stack:
        instances = {name: stack.enter_context(Contact(Component(fmu))) for name, fmu in fmus.items()}
        instances["contact"].set(PUSHER, "Prescribed")
        for name, instance in instances.items():
            instance.fmu.setupExperiment(startTime=0.0)
            for variable, value in starts[name].items():
                instance.set(variable, value)
            instance.fmu.enterInitializationMode()
        actuator, contact = instances["actuator"], instances["contact"]

        def carry(length: float = 0.0) -> None:
            place, velocity = actuator.real("pusher.displacement", "pusher.velocity")
            actuator.set("pusher.force", contact.get("pusher.force"))
            if derivative and length:
                contact.change("pusher.displacement", place, place + velocity * length, length)
            else:
                contact.set("pusher.displacement", place)

        def record() -> None:
            rows.append([instances[name].get(variable) for name, variable in RECORDED])

        actuator.fmu.exitInitializationMode()
        carry()
        contact.fmu.exitInitializationMode()
        record()
        for now, length in zip(time[:-1].tolist(), np.diff(time).tolist(), strict=True):
            carry(length)
            for instance in instances.values():
                instance.step(now, length)
            record()
            bar.update()
        for instance in instances.values():
            instance.fmu.terminate()
    return {"time": time} | {name: column for (_, name), column in zip(RECORDED, np.array(rows).T, strict=True)}


def by_libcosim(fmus: dict[str, Path], starts: Starts, steps: int, nanoseconds: int) -> Run:
    """Run the same in libcosim, in steps of whole nanoseconds."""
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    log_output_level(CosimLogLevel.ERROR)
    execution = CosimExecution.from_step_size(nanoseconds)
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer)
    indices: dict[str, int] = {}
    known: dict[tuple[str, str], tuple[int, int]] = {}
    for name, fmu in fmus.items():
        execution.add_local_slave(CosimLocalSlave(str(fmu), name))
        index = indices[name] = execution.slave_index_from_instance_name(name)
        known |= {(name, each.name.decode()): (index, each.reference) for each in execution.slave_variables(index)}
        for variable, value in starts[name].items():
            execution.real_initial_value(*known[name, variable], value)
    execution.real_initial_value(*known["contact", PUSHER], PRESCRIBED)
    for source, output, sink, variable in WIRES:
        execution.connect_real_variables(*known[source, output], *known[sink, variable])
    references = {name: [known[name, each][1] for owner, each in RECORDED if owner == name] for name in fmus}
    rows: list[list[float]] = []
    for _ in range(steps):
        if not execution.step():
            raise SystemExit(f"libcosim failed after {len(rows)} steps")
        values = {name: observer.last_real_values(indices[name], references[name]) for name in fmus}
        rows.append([*values["actuator"], *values["contact"]])
    time = np.arange(1, steps + 1) * nanoseconds / 1e9
    return {"time": time} | {name: column for (_, name), column in zip(RECORDED, np.array(rows).T, strict=True)}


def instants(run: Run, name: str, begin: float, end: float) -> Array:
    """Give the instants of all openings or closings in a span of time."""
    found = np.unique(run[name])
    return found[(found > begin) & (found < end)]


def times(run: Run, on: float, off: float) -> dict[str, float]:
    """Give operate and release time and the bounce at both, s; without a touch or an opening they are no numbers."""
    end = float(run["time"][-1])
    closings = instants(run, "contact.lastClosing", on, off)
    openings = instants(run, "contact.lastOpening", off, end)
    made, left = (each if len(each) else np.array([np.nan]) for each in (closings, openings))
    return {
        "operate time": made[0] - on,
        "bounce at make": made[-1] - made[0],
        "release time": left[0] - off,
        "bounce at break": left[-1] - left[0],
    }


def draw(run: Run, on: float, off: float, found: dict[str, float], path: Path) -> None:
    """Draw the make and the break, each beside the other."""
    shown = [
        (1e3 * run["coil.current"], "coil current\n[mA]", PURPLE),
        (1e6 * run["pusher.displacement"], "pusher\n[µm]", GREEN),
        (run["pusher.force"], "pusher force\n[N]", RED),
        (run["contact.force"], "contact force\n[N]", BLUE),
    ]
    spans = [("make", on, "operate time"), ("break", off, "release time")]
    figure, grid = plt.subplots(len(shown), 2, sharex="col", sharey="row", figsize=(10, 7), layout="constrained")
    for column, (title, switched, name) in enumerate(spans):
        bounce = 1e3 * found[f"bounce at {title}"]
        said = f"{name.capitalize()} {1e3 * found[name]:.2f} ms, bounce at {title} {bounce:.2f} ms"
        grid[0, column].set_title(said, fontsize="medium")
        grid[-1, column].set_xlabel(f"time after switching {'on' if switched == on else 'off'} [ms]")
        for axes, (values, label, colour) in zip(grid[:, column], shown, strict=True):
            axes.plot(1e3 * (run["time"] - switched), values, color=colour, linewidth=1.2)
            axes.axvline(1e3 * found[name], color=ORANGE, linewidth=1, linestyle="--")
            axes.set_xlim(-1, 1e3 * (run["time"][-1] - off))
            axes.grid(alpha=0.3)
            if column == 0:
                axes.set_ylabel(label)
    # The first touch strikes with many times the force that rests: linear below 1 N, logarithmic above.
    grid[-1, 0].set_yscale("symlog", linthresh=1.0)
    grid[-1, 0].set_yticks([0.0, 0.5, 1.0, 10.0], ["0", "0.5", "1", "10"])
    grid[-1, 0].set_ylim(bottom=-0.1)
    figure.align_ylabels()
    save(figure, path)


def summary(run: Run, results: list[tuple[float, dict[str, float]]]) -> str:
    """Describe the results of all steps, the finest first."""
    most = {name: np.max(run[name]) for name in ("coil.current", "pusher.force", "contact.force")}
    lines = [
        f"at most {1e3 * most['coil.current']:.1f} mA in the coil, {most['pusher.force']:.2f} N at the pusher, "
        f"{most['contact.force']:.1f} N at the contact",
        "  step [µs]" + "".join(f"{name + ' [ms]':>22}" for name in results[0][1]),
    ]
    lines += [
        f"{1e6 * step:11.2f}" + "".join(f"{1e3 * each:22.4f}" for each in found.values()) for step, found in results
    ]
    return "\n".join(lines)


def main() -> int:
    """Build the partner, run all, compare."""
    line = parser("Switch a contact by an electromagnet, which is another FMU (half a minute).")
    add = line.add_argument
    add("--quick", action="store_true", help="steps of 5 and 10 µs in place of 2, 4 and 8")
    add("--voltage", type=within(1, 100, "V"), default=12.0, help="of the source [V], 1 to 100 (%(default)s)")
    add("--mass", type=within(1e-4, 0.1, "kg"), default=2e-3, help="of the armature [kg], 1e-4 to 0.1 (%(default)s)")
    add("--libcosim", action="store_true", help="run it in libcosim, too, and compare")
    given = read_arguments(line)
    if not FmuBuilder.has_binary() or platform.machine() not in ("x86_64", "AMD64"):
        print("PythonFMU has no binary for this machine: it needs 64-bit x86 Linux or Windows", file=sys.stderr)
        return 1
    plain = given.fmu.resolve().with_name("RelayContact-plain.fmu")
    if given.libcosim and not plain.is_file():
        print(f"{plain} is missing: build it with `cargo xtask fmu --plain`", file=sys.stderr)
        return 1
    fmus = {
        "contact": given.fmu.resolve(),
        "actuator": FmuBuilder.build_FMU(MAGNET, dest=given.out).resolve(),
    }
    magnet = {name: start for name, _, start, _ in PARAMETERS}
    magnet |= {"supply.voltage": given.voltage, "armature.mass": given.mass}
    starts: Starts = {"contact": CONTACT, "actuator": magnet}
    on, off = magnet["supply.onTime"], magnet["supply.offTime"]
    nanoseconds = [5000, 10000] if given.quick else [2000, 4000, 8000]
    counts = [round(1e9 * END / each) for each in nanoseconds]
    grids = [np.arange(count + 1) * each / 1e9 for count, each in zip(counts, nanoseconds, strict=True)]
    late: Run = {}
    with tqdm(total=sum(counts) + given.libcosim * counts[0], unit="step", desc="communication steps") as bar:
        runs = [by_fmpy(fmus, starts, grid, bar) for grid in grids]
        if given.libcosim:
            late = by_fmpy(fmus, starts, grids[0], bar, derivative=False)
    found = [(float(run["time"][1]), times(run, on, off)) for run in runs]
    print(summary(runs[0], found))
    if given.libcosim:
        other = by_libcosim(fmus | {"contact": plain}, starts, counts[0], nanoseconds[0])
        away = max(float(np.max(np.abs(other[name] - late[name][1:]))) for name in ("pusher.force", "contact.force"))
        print(f"libcosim: {1e3 * times(other, on, off)['operate time']:.4f} ms; {away:.1e} N from FMPy, both without "
              "derivatives")  # fmt: skip
    paths = [given.out / name for name in ("actuator.csv", "actuator-steps.csv", "actuator.png")]
    write_table(paths[0], ",".join(runs[0]), np.column_stack(list(runs[0].values())), digits=17)
    write_table(paths[1], "step,operate,make.bounce,release,break.bounce",
                np.array([(step, *each.values()) for step, each in found]))  # fmt: skip
    draw(runs[0], on, off, found[0][1], paths[2])
    print(fmus["actuator"], *paths, sep="\n")
    return 0


if __name__ == "__main__":
    leave(main())
