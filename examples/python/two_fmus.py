"""Couple the relay contact to a partner FMU, connected by hand in FMPy.

The partner, TestBench.fmu, which PythonFMU makes of two_fmus_bench.py, is a vibration table with a sine acceleration
and the circuit of circuit.py, which starts in its steady state. Three connections, updated at every communication
point: table.acceleration to base.acceleration, contact.conductance to contact.conductance, contact.current back.
The voltage shown is that of the circuit; the contact is valid below about 12 V and 0.4 A, where no arc burns.

Both FMUs step at the same time with constant inputs (a Jacobi coupling), so the error is of first order in the
communication step h: a sine held over h is late by h/2, and so are the openings. The circuit receives an opening at the
next communication point, on average another h/2 later. The reference: the contact with its own generator (the same sine
without steps), and the circuit at a finer step.

Other tools couple the component by files: conformance/SystemStructure.ssd is a system for libcosim and Ecos.

TestBench.fmu runs in the Python of the process that loads it and needs no packages: the FMU contains its part of
PythonFMU. A tool that is not a Python program must load one: on Linux by LD_PRELOAD=libpython3.11.so.1.0 (the binary in
the FMU is not linked to any), on Windows by python3.dll in the PATH. PythonFMU has binaries for 64-bit x86 Linux and
Windows.
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

from common import leave, parser, read_arguments, save, within
from relay_contact import Array, Component, Contact, write_table
from relay_contact.figures import BLACK, BLUE, GREEN, ORANGE, PURPLE, RED
from two_fmus_bench import PARAMETERS

# From instance and output to instance and input. The first is the vibration.
WIRES = [
    ("bench", "table.acceleration", "contact", "base.acceleration"),
    ("contact", "contact.conductance", "bench", "contact.conductance"),
    ("bench", "contact.current", "contact", "contact.current"),
]
BENCH, *PARTS = (Path(__file__).with_name(f"{name}.py") for name in ("two_fmus_bench", "circuit", "fmu_slave"))
FINER = 8  # steps of the reference in a communication step

RECORDED = [("bench", each) for each in ("table.acceleration", "contact.voltage", "contact.current")]
RECORDED += [("contact", f"contact.{each}") for each in ("force", "conductance", "lastOpening", "lastClosing")]

Run = dict[str, Array]  # time and what is recorded, SI units
Fmus = dict[str, Path]  # the file of each instance
Starts = dict[str, dict[str, float]]  # start values of each instance


def by_fmpy(fmus: Fmus, starts: Starts, time: Array, bar: "tqdm[Any]", generator: bool = False) -> Run:
    """Run the wired FMUs through the instants in FMPy; the contact shaken by its own generator if asked."""
    wires, rows = WIRES, []
    sine: dict[str, float | str] = {}
    if generator:
        sine = {f"excitation.{each}": starts["bench"][f"table.{each}"] for each in ("amplitude", "frequency")}
        sine["effects.excitation"] = "Sine"
        wires = WIRES[1:]
    with ExitStack() as stack:
        instances = {name: stack.enter_context(Contact(Component(fmu))) for name, fmu in fmus.items()}
        for name, instance in instances.items():
            instance.fmu.setupExperiment(startTime=0.0)
            for variable, value in (starts[name] | (sine if name == "contact" else {})).items():
                instance.set(variable, value)
            instance.fmu.enterInitializationMode()

        def carry() -> None:
            values = [instances[source].get(output) for source, output, _, _ in wires]
            for (_, _, sink, variable), value in zip(wires, values, strict=True):
                instances[sink].set(variable, value)

        def record() -> None:
            rows.append([instances[name].get(variable) for name, variable in RECORDED])

        carry()
        for instance in instances.values():
            instance.fmu.exitInitializationMode()
        record()
        for now, length in zip(time[:-1].tolist(), np.diff(time).tolist(), strict=True):
            carry()
            for instance in instances.values():
                instance.step(now, length)
            record()
            bar.update()
        for instance in instances.values():
            instance.fmu.terminate()
    return {"time": time} | {name: column for (_, name), column in zip(RECORDED, np.array(rows).T, strict=True)}


def instants(run: Run, name: str) -> Array:
    """Give the instants of all openings or closings."""
    found = np.unique(run[name])
    return found[found >= 0]


def errors(run: Run, reference: Run) -> tuple[float, float]:
    """Give how late the openings are on the average, s, and the mean difference of the voltage, V."""
    found, true = instants(run, "contact.lastOpening"), instants(reference, "contact.lastOpening")
    late = float(np.mean(found - true)) if len(found) == len(true) > 0 else float("nan")
    every = (len(reference["time"]) - 1) // (len(run["time"]) - 1)
    difference = run["contact.voltage"] - reference["contact.voltage"][::every]
    return late, float(np.mean(np.abs(difference)))


def order(steps: Array, values: Array) -> float:
    """Give the order of convergence: the slope in logarithms."""
    return float(np.polyfit(np.log(steps), np.log(values), 1)[0])


def draw(run: Run, shaken: str, path: Path) -> None:
    """Draw the last openings."""
    time, end = 1e3 * run["time"], run["time"][-1]
    closings = instants(run, "contact.lastClosing")
    gaps = [(opening, min([*closings[closings > opening], end])) for opening in instants(run, "contact.lastOpening")]
    shown = [
        (run["table.acceleration"], "base\nacceleration\n[m/s²]", BLACK),
        (run["contact.force"], "contact\nforce\n[N]", BLUE),
        (1 / run["contact.conductance"], "contact\nresistance\n[Ω]", RED),
        (run["contact.voltage"], "contact\nvoltage\n[V]", GREEN),
        (run["contact.current"], "contact\ncurrent\n[A]", PURPLE),
    ]
    begin = gaps[-3][0] - 3e-4 if len(gaps) > 2 else 0.0
    figure, rows = plt.subplots(len(shown), 1, sharex=True, figsize=(8, 7), layout="constrained")
    for axes, (values, label, colour) in zip(rows, shown, strict=True):
        axes.plot(time, values, color=colour, linewidth=1.2)
        for opening, closing in gaps:
            axes.axvspan(1e3 * opening, 1e3 * closing, color=ORANGE, alpha=0.25, linewidth=0)
        axes.set(ylabel=label, xlim=(1e3 * begin, 1e3 * end))
        axes.grid(alpha=0.3)
    # A closing strikes with many times the preload: linear below 1 N, logarithmic above.
    rows[1].set_yscale("symlog", linthresh=1.0)
    rows[1].set_yticks([0.0, 0.5, 1.0, 10.0], ["0", "0.5", "1", "10"])
    rows[2].set_yscale("log")
    rows[-1].set_xlabel("time [ms]")
    figure.align_ylabels()
    figure.suptitle(f"Relay contact in a circuit with a quench, {shaken} (shaded: open)", fontsize="medium")
    save(figure, path)


def summary(run: Run, convergence: Array) -> str:
    """Describe the results."""
    opened = len(instants(run, "contact.lastOpening"))
    voltage, current = (np.max(np.abs(run[f"contact.{each}"])) for each in ("voltage", "current"))
    lines = [
        f"{opened} openings, {100 * np.mean(run['contact.force'] <= 0):.1f} % of the time open",
        f"at most {voltage:.3f} V and {current:.4f} A; the contact is valid below 12 V and 0.4 A"
        + ("" if voltage < 12 and current < 0.4 else ": above, it would burn an arc"),
        "  step [µs]  openings late [µs]  mean voltage difference [mV]",
    ]
    lines += [f"{1e6 * step:11.3f}{1e6 * late:20.4f}{1e3 * difference:30.3f}" for step, late, difference in convergence]
    steps, late, difference = convergence.T
    lines.append(f"{'order':>11}{order(steps, late):20.2f}{order(steps, difference):30.2f}")
    return "\n".join(lines)


def main() -> int:
    """Build the partner, run all, compare."""
    line = parser("Couple the contact to a partner FMU (a quarter of a minute).")
    add = line.add_argument
    add("--quick", action="store_true", help="4 periods from a step of 2 µs in place of 10 from 1 µs")
    wide, heard, mains = within(1, 1e4, "m/s2"), within(100, 5000, "Hz"), within(0.01, 100, "V")
    add("--amplitude", type=wide, default=400.0, help="of the table [m/s2], 1 to 1e4 (%(default)s)")
    add("--frequency", type=heard, default=1000.0, help="of the table [Hz], 100 to 5000 (%(default)s)")
    add("--voltage", type=mains, default=6.0, help="of the source [V], 0.01 to 100 (%(default)s)")
    given = read_arguments(line)
    if not FmuBuilder.has_binary() or platform.machine() not in ("x86_64", "AMD64"):
        print("PythonFMU has no binary for this machine: it needs 64-bit x86 Linux or Windows", file=sys.stderr)
        return 1
    periods, nanoseconds, halvings = (4, 2000, 2) if given.quick else (10, 1000, 4)
    coarsest = 2**halvings
    count = coarsest * round(1e9 * periods / given.frequency / nanoseconds / coarsest)

    fmus = {
        "contact": given.fmu.resolve(),
        "bench": FmuBuilder.build_FMU(BENCH, dest=given.out, project_files=PARTS).resolve(),
    }
    bench = {name: start for name, _, start, _ in PARAMETERS}
    bench |= {"supply.voltage": given.voltage, "table.amplitude": given.amplitude, "table.frequency": given.frequency}
    starts: Starts = {"contact": {"solver.tolerance": 1e-7}, "bench": bench}
    steps = count * (1 + FINER) + sum(count // 2**each for each in range(1, halvings + 1))
    time = np.arange(count + 1) * nanoseconds / 1e9
    with tqdm(total=steps, unit="step", desc="communication steps") as bar:
        run = by_fmpy(fmus, starts, time, bar)
        coarser = [by_fmpy(fmus, starts, time[:: 2**halving], bar) for halving in range(1, halvings + 1)]
        fine = np.arange(FINER * count + 1) * (nanoseconds / FINER) / 1e9
        reference = by_fmpy(fmus, starts, fine, bar, generator=True)
    convergence = np.array([(each["time"][1], *errors(each, reference)) for each in [run, *coarser]])
    print(summary(run, convergence))
    paths = [given.out / name for name in ("two-fmus.csv", "two-fmus-convergence.csv", "two-fmus.png")]
    write_table(paths[0], ",".join(run), np.column_stack(list(run.values())), digits=17)
    write_table(paths[1], "step,openings.late,voltage.meanDifference", convergence)
    draw(run, f"shaken with {given.amplitude:g} m/s² at {given.frequency:g} Hz", paths[2])
    print(fmus["bench"], *paths, sep="\n")
    return 0


if __name__ == "__main__":
    leave(main())
