"""The figure of a scene's outputs: a panel for each, the times shaded at which no contact is closed.

Where there is a second contact, its force is drawn beside that of the first, and bars show when either is closed.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from textwrap import wrap

import numpy as np
from fmpy import read_model_description
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from relay_contact.component import Array, Unit, Value, units
from relay_contact.figures import BLACK, BLUE, GREEN, ORANGE, PURPLE, RED, save
from relay_contact.files import RelayContactError, description_path
from relay_contact.scene import read_table

COLOURS = [BLUE, RED, GREEN, PURPLE, BLACK, ORANGE]
# Of the two contacts.
FIRST, SECOND = BLUE, RED
# By which it is told whether a contact is closed.
FORCES = {"first": "contact.force", "second": "second.force"}
PARALLEL = "parallel.force"
# Beyond this ratio of greatest to least a logarithmic axis is used.
DECADES = 1e3
# What the outputs are called in words, where it is not the words of their names.
WORDS = {
    "contact.elasticForce": "elastic force\nof the contact",
    "contact.lastOpening": "last opening",
    "contact.lastClosing": "last closing",
    "contact.indentation": "indentation\n(negative: gap)",
    "contact.tangentialForce": "friction force",
    "contact.slip": "slip",
    "contact.slipDistance": "distance\nslipped",
    "friction.energy": "energy\ndissipated\nby slip",
    "tip.displacement": "deflection\nof the spring",
    "tip.velocity": "velocity\nof the spring",
    "step.minimumForce": "least contact force\nin a step",
    "step.maximumForce": "greatest contact force\nin a step",
    "step.maximumResistance": "greatest contact\nresistance in a step",
    "chatter.count": "interruptions",
    "chatter.longestInterruption": "longest\ninterruption",
    "chatter.totalInterruption": "time interrupted",
    "chatter.falseMakes": "false makes",
    "second.force": "force of the\nsecond contact",
    "second.resistance": "resistance of the\nsecond contact",
    "second.falseMakes": "makes of the\nsecond contact",
    "step.minimumGap": "least gap at the\nsecond contact\nin a step",
    "energy.balance": "energy balance",
    "solver.rejectedSteps": "rejected\nsolver steps",
}


def panel(axes: Axes, time: Array, name: str, values: Array, unit: Unit | None, colour: str) -> None:
    """Draw one output."""
    least, greatest = float(values.min()), float(values.max())
    logarithmic = least > 0 and greatest > DECADES * least
    label = ""
    if logarithmic:
        axes.set_yscale("log")
        label = unit.si if unit else ""
    elif unit:
        values, label = unit.factor * values + unit.offset, unit.shown
    whole = unit is None and bool((values == np.round(values)).all())
    axes.plot(time, values, color=colour, linewidth=1.2, drawstyle="steps-post" if whole else "default")
    if whole:
        axes.yaxis.set_major_locator(MaxNLocator(integer=True))
        axes.set_ylim(-0.1 * max(1.0, greatest), 1.1 * max(1.0, greatest))
    words = WORDS.get(name, name.replace(".", "\n"))
    axes.set_ylabel(words + (f" [{label}]" if label else ""), fontsize="small")
    axes.grid(alpha=0.3)


def open_times(columns: Mapping[str, Array]) -> NDArray[np.bool_] | None:
    """Tell when no contact is closed, of those whose forces are there."""
    closed = [columns[name] > 0 for name in (*FORCES.values(), PARALLEL) if name in columns]
    return ~np.logical_or.reduce(closed) if closed else None


def bars(axes: Axes, time: Array, closed: Mapping[str, NDArray[np.bool_]]) -> None:
    """Draw when each contact is closed."""
    for row, when in enumerate(closed.values()):
        axes.fill_between(
            time, row + 0.15, row + 0.85, where=when.tolist(), step="post", color=[FIRST, SECOND][row], linewidth=0
        )
    axes.set_yticks([row + 0.5 for row in range(len(closed))], list(closed), fontsize="small")
    axes.set_ylim(len(closed), 0)
    axes.set_ylabel("closed", fontsize="small")


def sweep_of(values: Mapping[str, Value]) -> list[float] | None:
    """Give first and last frequency (Hz), start and duration (s) where a scene has a sweep that it describes whole."""
    names = ["excitation.frequency", "excitation.endFrequency", "excitation.startTime", "excitation.duration"]
    if values.get("effects.excitation") != "LogSweep":
        return None
    known = {"excitation.startTime": 0.0, **values}
    return [float(known[name]) for name in names] if all(name in known for name in names) else None


def draw(table: Path, title: str, sweep: Sequence[float] | None = None) -> Path:
    """Draw a table of outputs, over time or over the frequency of a sweep (first and last Hz, start and duration s).

    The figure stands beside the table, as a PNG file of the same name.
    """
    columns = read_table(table)
    if "time" not in columns or len(columns) == 1:
        text = f"columns {', '.join(columns)}: not allowed, allowed is time and one or more outputs"
        raise RelayContactError(f"{table}: {text}")
    time = columns.pop("time")
    known = units(read_model_description(str(description_path()), validate=False))
    scale, shown = (1.0, "s") if time[-1] > 0.2 else (1e3, "ms")
    label = f"time [{shown}]"
    if sweep:
        first, last, start, duration = sweep
        scale, label = 1.0, "frequency of the sweep [Hz]"
        inside = (time >= start) & (time <= start + duration)
        if not inside.any():
            raise RelayContactError(
                f"{table}: no row from {start:g} to {start + duration:g} s, in the time of the sweep"
            )
        columns = {name: values[inside] for name, values in columns.items()}
        time = first * (last / first) ** ((time[inside] - start) / duration)
    closed = {words: columns[name] > 0 for words, name in FORCES.items() if name in columns}
    both = len(closed) == 2
    drawn = [name for name in columns if not (both and name == FORCES["second"])]
    colours = [colour for colour in COLOURS if not (both and colour == SECOND)]
    heights = [1.0] * len(drawn) + [0.4] * both
    figure = Figure(figsize=(9, 1.2 + 1.7 * sum(heights)), layout="constrained")
    grid = figure.subplots(len(heights), 1, sharex=True, squeeze=False, height_ratios=heights)
    for index, (axes, name) in enumerate(zip(grid[:, 0], drawn, strict=False)):
        panel(axes, scale * time, name, columns[name], known.get(name), colours[index % len(colours)])
        if both and name == FORCES["first"]:
            axes.lines[0].set(label="first contact", color=FIRST)
            force = known[name].factor * columns[FORCES["second"]]
            axes.plot(scale * time, force, color=SECOND, linewidth=1.2, label="second contact")
            axes.legend(loc="upper right", fontsize="small")
    if both:
        bars(grid[-1, 0], scale * time, closed)
    is_open = open_times(columns)
    if is_open is not None and is_open.any():
        words = ["open", "both open", "all open"][both + (PARALLEL in columns)]
        for axes in grid[:, 0]:
            axes.fill_between(
                scale * time, 0, 1, where=is_open.tolist(), step="post", transform=axes.get_xaxis_transform(),
                color="#999999", alpha=0.25, linewidth=0, label=words,
            )  # fmt: skip
        grid[0, 0].legend(loc="upper right", fontsize="small")
    grid[0, 0].set_title("\n".join(wrap(title, 100)), fontsize="medium")
    if sweep:
        grid[-1, 0].set_xscale("log")
        grid[-1, 0].xaxis.set_major_formatter("{x:g}")
    grid[-1, 0].set_xlabel(label)
    grid[-1, 0].set_xlim(scale * time[0], scale * time[-1])
    figure.align_ylabels()
    path = table.with_name(table.name.removesuffix(".csv") + ".png")
    save(figure, path)
    return path
