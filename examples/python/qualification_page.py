"""Results of qualification.py, as a page and as tables."""

from dataclasses import dataclass, field
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.transforms import Bbox

from common import save
from relay_contact import Array, write_table
from relay_contact.figures import BLUE, GREEN, GREY, ORANGE, RED
from relay_contact.figures import GRAVITY as G
from standards import LIMIT, Level


@dataclass
class Outcome:
    """Result of a test."""

    name: str
    level: str
    interruptions: int
    longest: float  # s
    least_force: float  # relative to the preload
    weakest: str  # where interruptions begin as the level rises
    margin: float  # level that interrupts, relative to that of the test
    uncertainty: float  # of the margin, relative

    HEAD = ("test", "level", "verdict", "interruptions", "longest", "min. force", "weakest at", "margin")

    @property
    def verdict(self) -> str:
        """Compare the margin with 1; within its uncertainty the verdict is open."""
        if abs(self.margin - 1) <= self.uncertainty * self.margin:
            return "undecided"
        return "FAIL" if self.margin < 1 else "pass"

    def row(self) -> list[str]:
        """Give the row of a table."""
        long = f"{1e3 * self.longest:.2f} ms" if self.longest > 1e-3 else f"{1e6 * self.longest:.1f} µs"
        longest = long if self.interruptions else "none"
        least = f"{100 * self.least_force:.1f} %"
        margin = f"{self.margin:.3f} ± {self.uncertainty * self.margin:.3f}"
        return [self.name, self.level, self.verdict, str(self.interruptions), longest, least, self.weakest, margin]


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


@dataclass
class Shock:
    """Contact force (N) during a shock; number of interruptions and the longest (s)."""

    time: Array
    force: Array
    least_force: float
    count: int
    longest: float


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
    few = len(sweeps) + 3  # notes at the bottom
    figure.text(0.05, 0.965, "Relay contact under vibration and shock", fontsize=12.5, weight="bold")
    figure.text(0.05, 0.955, "\n".join(notes[:-few]), fontsize=7.5, va="top", linespacing=1.4)
    table = top.table(
        [outcome.row() for outcome in outcomes],
        colLabels=Outcome.HEAD,
        colWidths=[0.13, 0.28, 0.09, 0.11, 0.09, 0.09, 0.09, 0.13],
        cellLoc="center",
        bbox=Bbox.from_bounds(-0.07, 0, 1.07, 0.95),
    )
    table.auto_set_font_size(False)
    table.set_fontsize(7.5)
    for row, outcome in enumerate(outcomes, 1):
        table[row, 2].set_facecolor({"pass": "#BFE5D8", "FAIL": "#F5CDB8"}.get(outcome.verdict, "#FBE8B0"))
    preload = shocks["closing"].force[0]
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
    level.set(ylabel="acceleration [g]", ylim=(0, None), title="Amplitude of the base acceleration")
    force.set(ylabel="force [% of preload]", ylim=(-5, 105), title="Minimum contact force in each frequency bin")
    length.axhline(1e6 * LIMIT, color=GREY, linestyle="--", label="limit, 10 µs")
    length.legend(loc="upper left")
    length.set(ylim=(0, max(15.0, 1.25e6 * max(run.longest[0] for run in sweeps))), ylabel="duration [µs]")
    length.set(
        xlabel="frequency [Hz]", title="Interruptions of 10 µs or more: mean in each frequency bin; dot: longest"
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
    save(figure, path)


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
    columns = np.column_stack([shocks["closing"].time] + [hit.force for hit in shocks.values()])
    head = "time [s],contact.force closing [N],contact.force opening [N]"
    write_table(folder / "qualification-shock.csv", head, columns, digits=9)
