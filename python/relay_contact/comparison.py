"""A run beside a measurement: interruptions by time and duration, or resistance over time.

The run is a table of `relay-contact run` with the column contact.resistance. The measurement is a CSV file with columns
`start` (or `time`) and `duration` of interruptions, as a chatter detector logs them, or `time` and `resistance`.
"""

import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from relay_contact import tables
from relay_contact.component import Array
from relay_contact.figures import BLUE, RED, save, three
from relay_contact.files import RelayContactError, at_once, spare
from relay_contact.scene import read_table
from relay_contact.tables import TIMES, Units

if TYPE_CHECKING:
    import pandas as pd

RESISTANCES = {"Ohm": 1.0, "ohm": 1.0, "mOhm": 1e-3, "kOhm": 1e3, "\N{GREEK CAPITAL LETTER OMEGA}": 1.0}
COLUMNS: Units = {"start": TIMES, "time": TIMES, "duration": TIMES, "resistance": RESISTANCES}
RESISTANCE, COUNT = "contact.resistance", "chatter.count"
HEAD = ("interruptions", "simulated", "measured", "simulated / measured")
SIMULATED, MEASURED = "simulated", "measured"
FILES = ("comparison.csv", "comparison.png")
OVERLAP = 1.01  # times the time to the next start that an interruption may last, as a detector rounds


@dataclass(frozen=True)
class Interruptions:
    """Interruptions by their starts and durations (s), and the resistance (Ohm) over time (s), if it is known."""

    start: Array
    duration: Array
    time: Array
    resistance: Array
    counted: int | None = None
    """How many the component counted itself, if the table has it."""

    @property
    def times(self) -> Array:
        """Return the times (s) that are known: of a log those of its interruptions."""
        return self.time if len(self.time) else np.append(self.start, self.start + self.duration)

    @property
    def figures(self) -> dict[str, float]:
        """Return number, longest, median and total duration (s); not durations where more were counted than seen."""
        some = len(self.duration) > 0
        if self.counted and self.counted > len(self.duration):
            return {"count": float(self.counted)} | dict.fromkeys(("longest", "median", "total"), math.nan)
        return {
            "count": float(len(self.duration)), "longest": float(self.duration.max()) if some else 0.0,
            "median": float(np.median(self.duration)) if some else 0.0, "total": float(self.duration.sum()),
        }  # fmt: skip


@dataclass(frozen=True)
class Comparison:
    """A run and a measurement, whose times are those of the run."""

    simulated: Interruptions
    measured: Interruptions
    notes: list[str]
    paths: list[Path]

    @property
    def rows(self) -> list[list[str]]:
        """Return counts and durations side by side, in words."""
        found = []
        for name, own in self.simulated.figures.items():
            other = self.measured.figures[name]
            told = [f"{each:.0f}" if name == "count" else f"{three(1e6 * each)} µs" for each in (own, other)]
            if math.isnan(own):
                found.append([name, "unknown", told[1], ""])
            else:
                found.append([name, *told, three(own / other) if other else ""])
        return found

    @property
    def table(self) -> "pd.DataFrame":
        """A row for each interruption of either; `attrs["units"]` has the units."""
        import pandas as pd

        both = ((SIMULATED, self.simulated), (MEASURED, self.measured))
        table = pd.concat(
            [pd.DataFrame({"by": name, "start": own.start, "duration": own.duration}) for name, own in both],
            ignore_index=True,
        )
        table.attrs["units"] = {"start": "s", "duration": "s"}
        return table


def interruptions(time: Array, resistance: Array, threshold: float) -> Interruptions:
    """Return when a resistance is above a threshold, by straight lines between its values, on a logarithmic scale."""
    above = np.log(np.maximum(resistance, 1e-12) / threshold)
    change = np.flatnonzero(np.diff(above > 0))
    at = time[change] - above[change] * np.diff(time)[change] / (above[change + 1] - above[change])
    # One that the record begins or ends with lasts from there, or up to there.
    if above[0] > 0:
        at = np.insert(at, 0, time[0])
    if above[-1] > 0:
        at = np.append(at, time[-1])
    return Interruptions(at[::2], at[1::2] - at[::2], time, resistance)


def simulated(path: Path, threshold: float) -> Interruptions:
    """Read the interruptions of a run."""
    columns = read_table(path)
    if not {"time", RESISTANCE} <= columns.keys():
        raise RelayContactError(f"{path}: no columns time and {RESISTANCE}: run it with --output {RESISTANCE}")
    counted = int(columns[COUNT][-1]) if COUNT in columns else None
    return replace(interruptions(columns["time"], columns[RESISTANCE], threshold), counted=counted)


def measured(path: Path, threshold: float) -> Interruptions:
    """Read the interruptions of a measurement."""
    table = tables.read(path, COLUMNS)
    there = set(table.places)
    begin = next((name for name in ("start", "time") if name in there), "")
    if not begin or not there & {"duration", "resistance"}:
        raise table.wrong("columns: not allowed, allowed are start and duration, or time and resistance")
    table.ascending(begin)
    if "duration" in there:
        table.refuse("duration", table["duration"] <= 0, "greater than 0")
        until = np.append(np.diff(table[begin]), np.inf)
        table.refuse("duration", table["duration"] > OVERLAP * until, "up to the next start; is the unit right?")
        return Interruptions(table[begin], table["duration"], np.zeros(0), np.zeros(0))
    table.refuse("resistance", table["resistance"] < -threshold, "0 or more; change its sign")
    return interruptions(table[begin], table["resistance"], threshold)


def compare(
    run: Path, log: Path, *, out: Path | None = None, threshold: float = 60.0, shift: float | None = None
) -> Comparison:
    """Compare a run with a measurement; with `out` write table and figure into this folder.

    `threshold` is the resistance (Ohm) above which a contact is interrupted, `shift` the time (s) to add to that
    measured; without it both begin at their first interruption.
    """
    paths = [out / name for name in FILES] if out else []
    spare(paths, (run, log))
    own, other = simulated(run, threshold), measured(log, threshold)
    notes = []
    shortest = min((*own.duration, *other.duration), default=0.0)
    for name, times in (("run", own.time), ("measurement", other.time)):
        step = np.diff(times).max(initial=0.0)
        if shortest < 10 * step:
            text = "shorter steps tell interruptions better"
            notes.append(f"The {name} has a value every {three(1e6 * step)} µs: {text}.")
    if own.counted is not None and own.counted != len(own.duration):
        limits = "chatter.resistanceThreshold and chatter.minimumDuration"
        text = f"by its own {limits}, the resistance shows {len(own.duration)}"
        notes.append(f"The component counted {own.counted} interruptions {text}.")
    if shift is None:
        some = len(own.start) and len(other.start)
        shift = float(own.start[0] - other.start[0]) if some else 0.0
        notes.append(f"The measurement is shifted by {shift:.6g} s, so that both begin at their first interruption."
                     if some else "The measurement is not shifted: not both are interrupted.")  # fmt: skip
    other = Interruptions(other.start + shift, other.duration, other.time + shift, other.resistance)
    for name, each, record, times in ((MEASURED, other, "run", own.time), (SIMULATED, own, "measurement", other.times)):
        # A log without interruptions does not say when it was.
        outside = [(each.start > times.max()) | (each.start + each.duration < times.min())] if len(times) else []
        if beyond := int(np.sum(outside)):
            text = f"{beyond} are outside the time of the {record}, and counted all the same"
            notes.append(f"Of the {name} interruptions {text}.")
    found = Comparison(own, other, notes, paths)
    if out:
        out.mkdir(parents=True, exist_ok=True)
        table = found.table
        with at_once(paths[0]) as part:
            table.to_csv(part, index=False, header=["by", "start [s]", "duration [s]"], float_format="%.9g")
        draw(found, threshold, paths[1])
    return found


def draw(found: Comparison, threshold: float, path: Path) -> None:
    """Draw both over each other: resistance, or when each is interrupted; and the durations."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9, 5), layout="constrained")
    course, durations = figure.subplots(2, 1, height_ratios=[1.4, 1], sharex=True)
    both = ((SIMULATED, found.simulated, BLUE, "o", "-"), (MEASURED, found.measured, RED, "s", "--"))
    whole = len(found.measured.resistance) > 0
    for row, (name, own, colour, marker, line) in enumerate(both):
        if whole:
            course.plot(1e3 * own.time, own.resistance, line, color=colour, linewidth=1, label=name)
        else:
            spans = [(1e3 * start, 1e3 * length) for start, length in zip(own.start, own.duration, strict=True)]
            course.broken_barh(spans, (row + 0.15, 0.7), color=colour, edgecolor=colour)
        durations.plot(
            1e3 * own.start, 1e6 * own.duration, marker, color=colour, fillstyle=("full", "none")[row], label=name
        )
    if whole:
        course.axhline(threshold, color="black", linewidth=0.6, linestyle=":")
        course.set(ylabel="resistance [Ω]", yscale="log")
    else:
        course.set(yticks=[0.5, 1.5], yticklabels=[SIMULATED, MEASURED], ylim=(2, 0), ylabel="interrupted")
    durations.set(xlabel="time [ms]", ylabel="duration [µs]", ylim=(0, 1.1 * durations.get_ylim()[1]))
    figure.legend(*durations.get_legend_handles_labels(), loc="outside upper center", ncols=2, frameon=False)
    shown = np.append(found.simulated.times, found.measured.times)
    course.set_xlim(1e3 * shown.min(), 1e3 * shown.max())
    save(figure, path)
