"""Vibration and shock of MIL-STD-202 on a relay contact under FMPy: one page for a qualification file.

Method 204: a sine whose frequency goes logarithmically up and down again, the lesser of an acceleration and a double
amplitude. Method 213: a half-sine shock, here in both directions along the motion of the contact. A test fails where
the contact resistance stays above 60 Ohm for 10 us or more (MIL-PRF-28776; MIL-STD-202 method 310).

The component generates the sweep and times every interruption to a nanosecond inside its steps, however long they are:
a communication step is a bin of frequency here. The shock that presses is generated inside too; the one that pulls is
the input base.acceleration, linear over steps of 10 us (off the sine by 1e-6 of its peak).

The specimen is that of the component's start values: the equivalent beam identified from Zhang et al., "Machines" 2025,
13(1), 52. SPECIMEN below changes it. The contact is at rest before each sweep, up or down, and before each shock: the
sudden start of a sweep is part of it, and seen in the first bin downwards.

Condition A of both methods is checked; the other conditions and those of MIL-PRF-28776 are from memory and not verified
against the standards' texts. The standards also ask for two directions across the contact's motion and for repetitions:
the model has the one direction, and repeats exactly.

A faster sweep (--sweep-time) is not conservative: the force lags behind the frequency, and a resonance with little
damping has no time to build up. In 1 s the sweep at 30 g shows interruptions of 49 us upwards and 57 us downwards,
instead of 54 us. The summary says in how many of its decay times the resonance is crossed. A bin of a fast sweep may
also be shorter than a period at low frequencies: its least force is then that of a part of a period.
"""

import argparse
import sys
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from textwrap import wrap
from typing import Any

import matplotlib as mpl
import numpy as np
from fmpy import extract, read_model_description
from fmpy.simulation import apply_start_values, instantiate_fmu
from numpy.typing import NDArray
from tqdm import tqdm

mpl.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.transforms import Bbox

ROOT = Path(__file__).resolve().parents[2]
SPECIMEN: dict[str, float] = {}
"""Parameters that differ from the component's start values, for example {"contact.overtravel": 0.25e-3}."""
SHOWN = ["beam.length", "beam.width", "beam.thickness", "beam.youngsModulus", "beam.density", "beam.stiffnessDamping"]
SHOWN += ["tip.mass", "contact.overtravel", "contact.curvatureRadius", "contact.damping", "chatter.resistanceThreshold"]
"""Parameters on the page."""
G = 9.80665  # m/s2
LIMIT = 10e-6  # s
SINE, LOG_SWEEP, HALF_SINE = 2, 3, 4  # of effects.excitation
SHOCK_STEP = 1e-5  # s
RESOLUTION = 1e-4  # of margins
ENOUGH = (
    1000  # decay times a sweep should take to cross the resonance: the lag then changes an interruption by per cents
)
BLUE, ORANGE, RED, GREEN, GREY = "#0072B2", "#E69F00", "#D55E00", "#009E73", "#666666"  # of Okabe and Ito

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Level:
    """A sweep that a standard asks for: g, Hz, displacement from end to end (m), time up and down (s)."""

    name: str
    acceleration: float
    frequencies: tuple[float, float]
    double_amplitude: float
    sweep_time: float

    def amplitude(self, frequency: Array) -> Array:
        """Give the amplitude at frequencies (Hz), m/s2."""
        stroke = 0.5 * self.double_amplitude * (2 * np.pi * frequency) ** 2
        return np.asarray(np.minimum(G * self.acceleration, stroke))

    def __str__(self) -> str:
        """Tell the level."""
        low, high = self.frequencies
        return f"{self.acceleration:g} g or {1e3 * self.double_amplitude:g} mm, {low:g}-{high:g}-{low:g} Hz"


VIBRATION = {
    "A": Level("method 204 A", 10, (10, 500), 1.524e-3, 900),
    "B": Level("method 204 B", 15, (10, 2000), 1.524e-3, 1200),
    "C": Level("method 204 C", 10, (10, 2000), 1.524e-3, 1200),
    "D": Level("method 204 D", 20, (10, 2000), 1.524e-3, 1200),
}
RELAYS = Level("MIL-PRF-28776", 30, (10, 3000), 4.95e-3, 1200)
SHOCKS = {"A": (50, 11e-3), "B": (75, 6e-3), "C": (100, 6e-3)}
"""Peak (g) and duration (s) of the half sines of method 213."""


class Contact:
    """One instance of the component."""

    description: Any
    unzipped: str

    def __init__(self, **values: float) -> None:
        """Start at rest; parameters have _ for the dot."""
        self.references = {variable.name: variable.valueReference for variable in self.description.modelVariables}
        self.fmu = instantiate_fmu(self.unzipped, self.description, "CoSimulation")
        self.fmu.setupExperiment(startTime=0.0)
        parameters = {name.replace("_", "."): value for name, value in values.items()}
        apply_start_values(self.fmu, self.description, SPECIMEN | {"chatter.minimumDuration": LIMIT} | parameters)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()
        self.time = 0.0

    def __enter__(self) -> "Contact":
        """Be used in a with statement."""
        return self

    def __exit__(self, *_: object) -> None:
        """End the instance."""
        self.fmu.terminate()
        self.fmu.freeInstance()

    def step(self, length: float, begin: float = 0.0, end: float = 0.0) -> None:
        """Advance by a length (s) while base.acceleration goes from begin to end (m/s2)."""
        reference = [self.references["base.acceleration"]]
        self.fmu.setReal(reference, [begin])
        self.fmu.setRealInputDerivatives(reference, [1], [(end - begin) / length])
        self.fmu.doStep(self.time, length)
        self.time += length

    def real(self, *names: str) -> list[float]:
        """Give variables by name."""
        values: list[float] = self.fmu.getReal([self.references[name] for name in names])
        return values

    def monitor(self) -> tuple[int, float, float]:
        """Give interruptions so far that count, the time (s) of them all and of the longest."""
        count: int = self.fmu.getInteger([self.references["chatter.count"]])[0]
        total, longest = self.real("chatter.totalInterruption", "chatter.longestInterruption")
        return count, total, longest


@dataclass
class Outcome:
    """What came of a test."""

    name: str
    level: str
    interruptions: int
    longest: float  # s
    least_force: float  # of the preload
    weakest: str  # where a test that grows first interrupts
    margin: float  # level that interrupts, over that of the test

    HEAD = ("test", "level", "verdict", "interruptions", "longest", "least force", "weakest at", "margin")

    def row(self) -> list[str]:
        """Tell it as a row of a table."""
        long = f"{1e3 * self.longest:.2f} ms" if self.longest > 1e-3 else f"{1e6 * self.longest:.1f} µs"
        longest = long if self.interruptions else "none"
        verdict = "FAIL" if self.interruptions else "pass"
        least = f"{100 * self.least_force:.1f} %"
        margin = f"{self.margin:.4f}"
        return [self.name, self.level, verdict, str(self.interruptions), longest, least, self.weakest, margin]


@dataclass
class Sweep:
    """A sweep by bins of frequency."""

    level: Level
    frequency: Array  # centre of each bin, Hz
    bins: dict[str, Array] = field(default_factory=dict)  # up, down: least force (N), interruptions, mean length (s)
    longest: tuple[float, float] = (0.0, np.nan)  # longest interruption that counts (s), and where (Hz)

    def least_force(self) -> Array:
        """Give the least force of up and down in each bin, N."""
        return np.asarray(np.min([found[:, 0] for found in self.bins.values()], axis=0))

    def interruption(self) -> Array:
        """Give the longer mean interruption of up and down in each bin, s."""
        return np.asarray(np.max([found[:, 2] for found in self.bins.values()], axis=0))


def sweep(level: Level, bins: int) -> Sweep:
    """Sweep up and down. A logarithmic sweep takes equally long for equal ratios: a bin is one communication step."""
    edges = np.geomspace(*level.frequencies, bins + 1)
    run = Sweep(level, np.sqrt(edges[1:] * edges[:-1]))
    for way, order in (("up", slice(None)), ("down", slice(None, None, -1))):
        begin, end = np.array(level.frequencies)[order]
        found = np.zeros((bins, 3))
        bar = tqdm(run.frequency[order], bar_format="{desc} |{bar}|")
        with Contact(
            effects_excitation=LOG_SWEEP,
            excitation_amplitude=G * level.acceleration,
            excitation_displacementLimit=level.double_amplitude / 2,
            excitation_frequency=float(begin),
            excitation_endFrequency=float(end),
            excitation_duration=level.sweep_time / 2,
        ) as contact:
            before = contact.monitor()
            for row, frequency in zip(found, bar, strict=True):
                bar.set_description_str(f"{level.acceleration:g} g, {way:4} {frequency:5.0f} Hz", refresh=False)
                contact.step(level.sweep_time / 2 / bins)
                now = contact.monitor()
                new = now[0] - before[0]
                row[:] = contact.real("step.minimumForce")[0], new, (now[1] - before[1]) / new if new else 0
                if now[0] and now[2] > max(before[2], run.longest[0]):
                    run.longest = now[2], float(frequency)
                before = now
        run.bins[way] = found[order]
    return run


def threshold(interrupts: Callable[[float], bool]) -> float:
    """Give the least factor of a level that interrupts: by steps of a tenth, then by bisection."""
    failed = interrupts(1.0)
    low = high = 1.0
    while interrupts(low if failed else high) == failed:
        low, high = (low / 1.1, low) if failed else (high, high * 1.1)
        if not 1e-3 < high < 1e3:
            return high
    while high > (1 + RESOLUTION) * low:
        middle = (low * high) ** 0.5
        low, high = (low, middle) if interrupts(middle) else (middle, high)
    return high


def weakest(run: Sweep, preload: float) -> float:
    """Give the frequency (Hz) at which a growing level first opens the contact, from one that leaves it closed."""
    if run.least_force().min() > 0.1 * preload:
        return float(run.frequency[run.least_force().argmin()])
    level = run.level
    half = replace(level, acceleration=level.acceleration / 2, double_amplitude=level.double_amplitude / 2)
    return weakest(sweep(half, len(run.frequency)), preload)


def vibration(level: Level, bins: int, preload: float, decay: float) -> tuple[Sweep, Outcome]:
    """Sweep; where the contact is weakest, seek the level that interrupts in steady vibration."""
    run = sweep(level, bins)
    count = int(sum(found[:, 1].sum() for found in run.bins.values()))
    frequency = weakest(run, preload)
    amplitude = float(level.amplitude(np.array(frequency)))

    def interrupts(factor: float) -> bool:
        values = {"excitation_frequency": frequency, "excitation_amplitude": factor * amplitude}
        with Contact(effects_excitation=SINE, **values) as contact:
            contact.step(max(10 * decay, 2 / frequency))  # of the sudden start, 5e-5 are left
            settled = contact.monitor()[0]
            contact.step(5 / frequency)
            return contact.monitor()[0] > settled

    least = float(run.least_force().min()) / preload
    margin = threshold(interrupts)
    return run, Outcome(level.name, str(level), count, run.longest[0], least, f"{frequency:.0f} Hz", margin)


@dataclass
class Shock:
    """A shock, and what the monitor says of it: count and longest (s)."""

    time: Array
    force: Array
    least_force: float
    count: int
    longest: float


def half_sine(peak: float, duration: float, pulls: bool) -> Shock:
    """Run a shock (m/s2, s) and as long again."""
    inside = {"effects_excitation": HALF_SINE, "excitation_amplitude": peak, "excitation_duration": duration}
    time = SHOCK_STEP * np.arange(round(2 * duration / SHOCK_STEP) + 1, dtype=np.float64)
    pulse = -peak * np.sin(np.pi * np.minimum(time / duration, 1)) * pulls
    force, least = np.zeros(len(time)), np.inf
    with Contact(**({} if pulls else inside)) as contact:
        force[0] = contact.real("contact.force")[0]
        for index in range(1, len(time)):
            contact.step(SHOCK_STEP, pulse[index - 1], pulse[index])
            force[index], in_step = contact.real("contact.force", "step.minimumForce")
            least = min(least, in_step)
        count, _, longest = contact.monitor()
    return Shock(time, force, least, count, longest)


def shock(condition: str, preload: float) -> tuple[dict[str, Shock], Outcome]:
    """Run a shock in both directions."""
    peak, duration = SHOCKS[condition]

    def run(way: str, factor: float = 1.0) -> Shock:
        return half_sine(factor * G * peak, duration, way == "pulling")

    runs = {way: run(way) for way in ("pressing", "pulling")}
    margins = {
        "pressing": threshold(lambda factor: run("pressing", factor).count > 0),
        "pulling": threshold(lambda factor: run("pulling", factor).count > 0),
    }
    way = min(margins, key=lambda way: margins[way])
    count, longest = sum(hit.count for hit in runs.values()), max(hit.longest for hit in runs.values())
    least = min(hit.least_force for hit in runs.values()) / preload
    level = f"half sine of {peak:g} g, {1e3 * duration:g} ms"
    return runs, Outcome(f"method 213 {condition}", level, count, longest, least, way, margins[way])


def page(path: Path, sweeps: list[Sweep], shocks: dict[str, Shock], outcomes: list[Outcome], notes: list[str]) -> None:
    """Draw the page, A4."""
    plt.rcParams |= {"font.size": 8, "axes.titlesize": 9, "legend.fontsize": 7.5, "legend.frameon": False}
    plt.rcParams |= {"axes.grid": True, "grid.alpha": 0.3}
    figure = plt.figure(figsize=(8.27, 11.69))
    heights = {"height_ratios": [0.72, 1, 1, 1, 0.06, 1.15], "hspace": 0.38}
    top, level, force, length, gap, below = figure.subplots(6, 1, gridspec_kw=heights)
    figure.subplots_adjust(left=0.11, right=0.96, top=0.88, bottom=0.165)
    top.axis("off")
    gap.axis("off")
    few = len(sweeps) + 3  # of the notes go below
    failed = [outcome.name for outcome in outcomes if outcome.interruptions]
    verdict = "fails " + ", ".join(failed) if failed else "passes"
    figure.text(0.05, 0.965, f"Relay contact under vibration and shock: {verdict}", fontsize=12.5, weight="bold")
    figure.text(0.05, 0.955, "\n".join(notes[:-few]), fontsize=7.5, va="top", linespacing=1.4)
    table = top.table(
        [outcome.row() for outcome in outcomes],
        colLabels=Outcome.HEAD,
        colWidths=[0.14, 0.3, 0.07, 0.11, 0.1, 0.1, 0.1, 0.08],
        cellLoc="center",
        bbox=Bbox.from_bounds(-0.07, 0, 1.07, 0.95),
    )
    table.auto_set_font_size(False)
    table.set_fontsize(7.5)
    for row, outcome in enumerate(outcomes, 1):
        table[row, 2].set_facecolor("#F5CDB8" if outcome.interruptions else "#BFE5D8")
    preload = shocks["pressing"].force[0]
    for run, colour in zip(sweeps, (BLUE, RED), strict=False):
        level.plot(run.frequency, run.level.amplitude(run.frequency) / G, color=colour, label=run.level.name)
        force.plot(run.frequency, 100 * run.least_force() / preload, color=colour)
        length.plot(run.frequency, 1e6 * run.interruption(), color=colour)
        if run.longest[0]:
            interrupted = run.frequency[run.interruption() > 0]
            note = f"from {interrupted.min():.0f} to {interrupted.max():.0f} Hz, {1e6 * run.longest[0]:.1f} µs at "
            note += f"{run.longest[1]:.0f} Hz"
            peak = run.longest[1], 1e6 * run.longest[0]
            length.plot(*peak, "o", color=colour, markersize=3)
            length.annotate(note, peak, (-8, -3), textcoords="offset points", ha="right", color=colour)
    level.legend(loc="upper left")
    level.set(ylabel="level [g]", ylim=(0, None), title="Amplitude of the base acceleration")
    force.set(ylabel="force [% of preload]", ylim=(-5, 105), title="Least contact force in each bin of frequency")
    length.axhline(1e6 * LIMIT, color=GREY, linestyle="--", label="limit, 10 µs")
    length.legend(loc="upper left")
    length.set(ylim=(0, max(15.0, 1.25e6 * max(run.longest[0] for run in sweeps))), ylabel="interruption [µs]")
    length.set(
        xlabel="frequency [Hz]", title="Interruptions that last 10 µs: mean in each bin of frequency, dot: longest"
    )
    ends = min(run.frequency[0] for run in sweeps), max(run.frequency[-1] for run in sweeps)
    for axes in (level, force, length):
        axes.set_xscale("log")
        axes.set_xlim(0.9 * ends[0], 1.1 * ends[1])
        axes.xaxis.set_major_formatter("{x:g}")
        axes.tick_params(labelbottom=axes is length)
    for (way, hit), colour in zip(shocks.items(), (GREEN, ORANGE), strict=True):
        note = f", interrupted for {1e3 * hit.longest:.2f} ms" if hit.count else ""
        below.plot(1e3 * hit.time, 100 * hit.force, color=colour, label=way + note)
    below.axhline(100 * preload, color=GREY, linestyle=":", label="preload")
    below.legend(loc="upper right")
    below.set(xlabel="time [ms]", ylabel="contact force [cN]", title=f"{outcomes[-1].name}: {outcomes[-1].level}")
    figure.align_ylabels()
    figure.text(0.05, 0.115, "\n".join(notes[-few:]), fontsize=7, va="top", linespacing=1.4)
    figure.savefig(path, dpi=150)


def write(folder: Path, sweeps: list[Sweep], shocks: dict[str, Shock]) -> None:
    """Write the tables."""
    lines = [
        "test,direction,frequency [Hz],acceleration [m/s2],step.minimumForce [N],interruptions,mean interruption [s]"
    ]
    for run in sweeps:
        level = run.level.amplitude(run.frequency)
        for way, found in run.bins.items():
            for values in zip(run.frequency, level, *found.T, strict=True):
                lines.append(f"{run.level.name},{way}," + ",".join(f"{value:.9g}" for value in values))
    (folder / "qualification.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    columns = np.column_stack([shocks["pressing"].time] + [hit.force for hit in shocks.values()])
    head = "time [s],contact.force pressing [N],contact.force pulling [N]"
    np.savetxt(folder / "qualification-shock.csv", columns, delimiter=",", header=head, comments="", fmt="%.9g")


def arguments() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=str(__doc__).splitlines()[0], epilog="Takes under a minute.")
    add = parser.add_argument
    add("--fmu", type=Path, default=ROOT / "dist" / "RelayContact.fmu", help="the component")
    add("--out", type=Path, default=ROOT / "out", help="folder for the page and the tables")
    add("--quick", action="store_true", help="short form: sweeps of 60 s, 400 bins")
    add("--vibration", choices=VIBRATION, default="A", help="condition of method 204; B to D are from memory")
    add("--acceleration", type=float, default=30, help="of a second sweep, g (default 30); 0: no second sweep")
    add("--frequencies", type=float, nargs=2, default=(10, 3000), help="of the second, Hz", metavar=("LOW", "HIGH"))
    add("--double-amplitude", type=float, default=4.95, help="of the second, end to end, mm (default 4.95)")
    add("--sweep-time", type=float, help="up and down, s (default: 900 for condition A, else 1200)")
    add("--shock", choices=SHOCKS, default="A", help="condition of method 213; B and C are from memory")
    given = parser.parse_args()
    low, high = given.frequencies
    demands = {
        f"--frequencies {low:g} {high:g}: from 1e-3 to 1e6 Hz, the first below the second": 1e-3 <= low < high <= 1e6,
        f"--acceleration {given.acceleration:g}: from 0 to 1e4 g": 0 <= given.acceleration <= 1e4,
        f"--double-amplitude {given.double_amplitude:g}: above 0, to 1000 mm": 0 < given.double_amplitude <= 1000,
        f"--sweep-time {given.sweep_time}: from 0.1 to 1e5 s": given.sweep_time is None
        or 0.1 <= given.sweep_time <= 1e5,
    }
    for demand, met in demands.items():
        if not met:
            parser.error(f"{demand} is allowed")
    return given


def asked(given: argparse.Namespace) -> list[Level]:
    """Give the levels that the command line asks for."""
    levels = [VIBRATION[given.vibration]]
    if given.acceleration > 0:
        changes = (given.acceleration, tuple(given.frequencies), 1e-3 * given.double_amplitude)
        same = changes == (RELAYS.acceleration, RELAYS.frequencies, RELAYS.double_amplitude)
        levels.append(RELAYS if same else Level("as given", *changes, RELAYS.sweep_time))
    if given.sweep_time is None and not given.quick:
        return levels
    return [replace(level, sweep_time=given.sweep_time or 60) for level in levels]


def pace(level: Level, natural: float, decay: float) -> str:
    """Tell whether a sweep is slow enough for the first resonance (Hz, s)."""
    low, high = level.frequencies
    octaves = 2 * 60 * np.log2(high / low) / level.sweep_time
    line = f"{level.name}: swept up and down in {level.sweep_time:g} s, {octaves:.3g} octaves/min"
    if not low < natural < high:
        return f"{line}; the first resonance is not in its range."
    band = 2 / (decay * 2 * np.pi * natural)  # half-power band, relative to the resonance
    times = band * level.sweep_time / (2 * np.log(high / low)) / decay
    slow = "slow enough" if times >= ENOUGH else "TOO FAST to rely on"
    return f"{line}; crosses the first resonance in {times:.0f} decay times: {slow}."


def main() -> int:
    """Run the tests."""
    given = arguments()
    if not given.fmu.is_file():
        print(f"{given.fmu} is missing: build it with `cargo xtask fmu`", file=sys.stderr)
        return 1
    levels = asked(given)
    with TemporaryDirectory() as folder:
        Contact.description = read_model_description(given.fmu)
        Contact.unzipped = extract(given.fmu, folder)
        with Contact() as contact:
            preload, natural, alpha, beta = contact.real(
                "preload.force", "preload.frequency", "beam.massDamping", "beam.stiffnessDamping"
            )
            types = {variable.name: variable.declaredType for variable in Contact.description.modelVariables}
            shown = [f"{name} {contact.real(name)[0]:g} {types[name].unit}" for name in SHOWN]
        decay = 2 / max(alpha + beta * (2 * np.pi * natural) ** 2, 1.0)
        runs = [vibration(level, 400 if given.quick else 3000, preload, decay) for level in levels]
        shocks, shocked = shock(given.shock, preload)
    sweeps, outcomes = [run for run, _ in runs], [outcome for _, outcome in runs] + [shocked]
    notes = [
        *wrap(f"Equivalent beam, identified: {', '.join(shown)}.", 125),
        f"Preload {100 * preload:.2f} cN, first resonance {natural:.0f} Hz. Component {Contact.description.guid}.",
        *(pace(level, natural, decay) for level in levels),
        "Margin: level that interrupts, where the contact is weakest and in steady vibration, over that of the test.",
        "Model: along the motion of the contact alone; no resonances of the case, no bounce after switching.",
        "Method 204 B, C, D, 213 B, C and MIL-PRF-28776 are from memory, not verified against the standards' texts.",
    ]
    given.out.mkdir(parents=True, exist_ok=True)
    write(given.out, sweeps, shocks)
    page(given.out / "qualification.png", sweeps, shocks, outcomes, notes)
    widths = (15, 37, 9, 15, 12, 13, 12, 8)
    for row in [list(Outcome.HEAD), *(outcome.row() for outcome in outcomes)]:
        print("".join(f"{cell:{width}}" for cell, width in zip(row, widths, strict=True)))
    print("\n".join(notes))
    for name in ("qualification.csv", "qualification-shock.csv", "qualification.png"):
        print(given.out / name)
    return 0


if __name__ == "__main__":
    sys.exit(main())
