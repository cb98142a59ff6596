"""Couple the relay contact to a partner FMU: connected by hand in FMPy, and as a system (SSP 1.0) in libcosim.

The partner, TestBench.fmu, which PythonFMU makes of two_fmus_bench.py, is a vibration table with a sine acceleration
and the circuit of circuit.py, which starts in its steady state. Three connections, updated at every communication
point: table.acceleration to base.acceleration, contact.conductance to contact.conductance, contact.current back.
The voltage shown is that of the circuit; the contact is valid below about 12 V and 0.4 A, where no arc burns.

Both FMUs step at the same time with constant inputs (a Jacobi coupling), so the error is of first order in the
communication step h: a sine held over h is late by h/2, and so are the openings. The circuit receives an opening at the
next communication point, on average another h/2 later. The reference: the contact with its own generator (the same sine
without steps), and the circuit at a finer step.

libcosim
- cannot set enumerations, so effects.excitation remains None and the table vibrates the contact (the variant of the
  component that `cargo xtask fmu --plain` makes has numbers instead);
- counts time in whole nanoseconds and passes differences of times. FMPy gives the same bits at the same times;
- applies only the first ParameterBinding of each component of an .ssp, and silently ignores all others and those of the
  system: here each component has one. It recognises the prefixes ssd, ssc, ssv by their letters;
- terminates its process if a start value is rejected.
It is installed on 64-bit x86 Linux only; elsewhere FMPy runs the system, and system.ssp is still written.

TestBench.fmu runs in the Python of the process that loads it and needs no packages: the FMU contains its part of
PythonFMU. A tool that is not a Python program must load one: on Linux by LD_PRELOAD=libpython3.11.so.1.0 (the binary in
the FMU is not linked to any), on Windows by python3.dll in the PATH. PythonFMU has binaries for 64-bit x86 Linux and
Windows.
"""

import os
import platform
import sys
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from pythonfmu import FmuBuilder
from tqdm import tqdm

from common import parser, read_arguments, save, within
from relay_contact import Array, Component, Contact, write_table
from relay_contact.figures import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, RED
from two_fmus_bench import PARAMETERS
from two_fmus_system import WIRES, Fmus, Starts, write_system

try:
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimObserver import CosimObserver

    # It warns of every variable that is an enumeration.
    log_output_level(CosimLogLevel.ERROR)
    NO_LIBCOSIM = ""
except (ImportError, OSError) as error:
    NO_LIBCOSIM = str(error)

BENCH, CIRCUIT = (Path(__file__).with_name(f"{name}.py") for name in ("two_fmus_bench", "circuit"))
FINER = 8  # steps of the reference in a communication step

RECORDED = [("bench", each) for each in ("table.acceleration", "contact.voltage", "contact.current")]
RECORDED += [("contact", f"contact.{each}") for each in ("force", "conductance", "lastOpening", "lastClosing")]

Run = dict[str, Array]  # time and what is recorded, SI units


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
            values = [instances[source].get(output) for source, output, *_ in wires]
            for (_, _, sink, variable, _), value in zip(wires, values, strict=True):
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
    return as_run(time, rows)


def as_run(time: Array, rows: list[list[float]]) -> Run:
    """Name the columns."""
    return {"time": time} | {name: column for (_, name), column in zip(RECORDED, np.array(rows).T, strict=True)}


def find(execution: Any, name: str, variable: str) -> tuple[int, int]:  # noqa: ANN401
    """Give the index of an instance in libcosim and the value reference of its variable."""
    index = execution.slave_index_from_instance_name(name)
    variables = execution.slave_variables(index)
    return index, next(each.reference for each in variables if each.name == variable.encode())


def by_libcosim(execution: Any, time: Array, bar: "tqdm[Any]") -> Run:  # noqa: ANN401
    """Run what libcosim was given. Values can be read after the first step, not before."""
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer)
    recorded = [find(execution, *each) for each in RECORDED]
    rows = []
    for _ in time[1:]:
        if not execution.step():
            raise RuntimeError("libcosim could not do a step")
        rows.append([observer.last_real_values(index, [reference])[0] for index, reference in recorded])
        bar.update()
    return as_run(time[1:], rows)


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


def draw(run: Run, convergence: Array, shaken: str, path: Path) -> None:
    """Draw the last openings and the convergence."""
    figure = plt.figure(figsize=(12, 7), layout="constrained")
    left, right = figure.subfigures(1, 2, squeeze=False, width_ratios=(1.5, 1))[0]
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
    rows = left.subplots(len(shown), 1, sharex=True)
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
    left.align_ylabels()
    left.suptitle(f"Relay contact in a circuit with a quench, {shaken} (shaded: open)", fontsize="medium")

    steps = 1e6 * convergence[:, 0]
    late = ("mean delay of the openings [µs]", 1e6 * convergence[:, 1], BLUE)
    difference = ("mean error of the contact voltage [mV]", 1e3 * convergence[:, 2], GREEN)
    for axes, (label, values, colour) in zip(right.subplots(2, 1), (late, difference), strict=True):
        axes.set(xlabel="communication step [µs]", ylabel=label)
        axes.grid(alpha=0.3)
        if not np.all(values > 0):
            axes.text(0.5, 0.5, "nothing to compare", ha="center", transform=axes.transAxes)
            continue
        axes.plot(steps, values, color=colour, marker="o", label=f"computed, order {order(steps, values):.2f}")
        first_order = steps * np.exp(np.mean(np.log(values / steps)))
        axes.plot(steps, first_order, color=GREY, linestyle=":", label="order 1")
        axes.set_xscale("log", base=2)
        axes.set_yscale("log", base=2)
        axes.xaxis.set_major_formatter("{x:g}")
        axes.yaxis.set_major_formatter("{x:g}")
        axes.legend(frameon=False)
    right.suptitle("Error of the coupling", fontsize="medium")
    save(figure, path)


def summary(runs: dict[str, Run], convergence: Array) -> str:
    """Describe the results."""
    run = runs["FMPy"]
    opened = len(instants(run, "contact.lastOpening"))
    voltage, current = (np.max(np.abs(run[f"contact.{each}"])) for each in ("voltage", "current"))
    lines = [
        f"{opened} openings, {100 * np.mean(run['contact.force'] <= 0):.1f} % of the time open",
        f"at most {voltage:.3f} V and {current:.4f} A; the contact is valid below 12 V and 0.4 A"
        + ("" if voltage < 12 and current < 0.4 else ": above, it would burn an arc"),
        "largest difference from FMPy at the times of libcosim",
    ]
    for name, other in list(runs.items())[1:]:
        first = len(run["time"]) - len(other["time"])
        names = ("contact.force", "contact.voltage")
        force, voltage = (np.max(np.abs(other[each] - run[each][first:])) for each in names)
        lines.append(f"  {name:14} {force:8.1e} N  {voltage:8.1e} V")
    lines.append("  step [µs]  openings late [µs]  mean voltage difference [mV]")
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
        "bench": FmuBuilder.build_FMU(BENCH, dest=given.out, project_files=[CIRCUIT]).resolve(),
    }
    bench = {name: start for name, _, start, _ in PARAMETERS}
    bench |= {"supply.voltage": given.voltage, "table.amplitude": given.amplitude, "table.frequency": given.frequency}
    starts: Starts = {"contact": {"solver.tolerance": 1e-7}, "bench": bench}
    system = given.out / "system.ssp"
    write_system(system, fmus, starts)

    steps = count * ((1 if NO_LIBCOSIM else 2) + FINER) + sum(count // 2**each for each in range(1, halvings + 1))
    # Whole nanoseconds in s, rounded once, as libcosim has them.
    time = np.arange(count + 1) * nanoseconds / 1e9
    with tqdm(total=steps, unit="step", desc="communication steps") as bar:
        runs = {"FMPy": by_fmpy(fmus, starts, time, bar)}
        if not NO_LIBCOSIM:
            runs["libcosim"] = by_libcosim(CosimExecution.from_ssp_file(str(system), nanoseconds), time, bar)
        coarser = [by_fmpy(fmus, starts, time[:: 2**halving], bar) for halving in range(1, halvings + 1)]
        fine = np.arange(FINER * count + 1) * (nanoseconds / FINER) / 1e9
        reference = by_fmpy(fmus, starts, fine, bar, generator=True)
    convergence = np.array([(run["time"][1], *errors(run, reference)) for run in [runs["FMPy"], *coarser]])

    if NO_LIBCOSIM:
        print(f"libcosim is not here ({NO_LIBCOSIM}): only FMPy ran the coupling, and system.ssp was not run")
    print(summary(runs, convergence))
    for name, run in runs.items():
        write_table(given.out / f"two-fmus-{name}.csv", ",".join(run), np.column_stack(list(run.values())), digits=17)
    write_table(given.out / "two-fmus-convergence.csv", "step,openings.late,voltage.meanDifference", convergence)
    shaken = f"shaken with {given.amplitude:g} m/s² at {given.frequency:g} Hz"
    draw(runs["FMPy"], convergence, shaken, given.out / "two-fmus.png")
    for name in (
        "TestBench.fmu",
        "system.ssp",
        *(f"two-fmus-{run}.csv" for run in [*runs, "convergence"]),
        "two-fmus.png",
    ):
        print(given.out / name)
    return 0


if __name__ == "__main__":
    code = main()
    sys.stdout.flush()
    # Without the exit functions: that of PythonFMU 0.7.0 frees its state a second time, which may end in an abort.
    os._exit(code)
