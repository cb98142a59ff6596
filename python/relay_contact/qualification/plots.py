"""Figures of an assessment: each is readable in grey, by markers and dashes beside colours."""

from textwrap import fill
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.patches import Rectangle
from matplotlib.textpath import text_to_path

from relay_contact.component import Array
from relay_contact.figures import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, RED, SKY, three
from relay_contact.figures import GRAVITY as G
from relay_contact.qualification.judgement import QUALITY
from relay_contact.qualification.level import MOST
from relay_contact.qualification.parts import CLOSED, CONTACT, CORE, OPEN, PUSHER, STOP
from relay_contact.qualification.results import Finding, Tested
from relay_contact.qualification.standards import Contacts
from relay_contact.qualification.words import FAILURES, QUANTITIES, failing, failures, is_open, time_text

STYLES: tuple[dict[str, Any], ...] = tuple(
    {"color": colour, "marker": marker, "markersize": 3.5}
    for colour, marker in zip((BLUE, RED, BLACK, ORANGE, GREEN, PURPLE, GREY, SKY), "os^Dv<>p", strict=True)
)
"""Of the curves in a panel."""
MARKS = 9  # on a curve
MARKERS = {"pass": "o", "FAIL": "X", "undecided": "D"}
LINES = {"pass": GREEN, "FAIL": RED, "undecided": ORANGE}
DASHES = {CLOSED: "-", OPEN: "--", CORE: ":", STOP: ":", PUSHER: "-."}
PARTS = {CONTACT: "s", CORE: "^", STOP: "^", PUSHER: "v"}
WIDTH = 8.27  # inches: a page of A4
LEFT, RIGHT, BOTTOM, TOP = 0.6, 0.06, 0.45, 0.27  # inches beside panels, of labels and titles
OFF = 0.17  # inches, of a label from the edge of the figure
BETWEEN = 0.34  # inches from panel to panel
KEY = 0.55  # inches, of a legend beside its texts
BESIDE: dict[str, Any] = {"loc": "upper left", "bbox_to_anchor": (1.01, 1.0), "borderaxespad": 0.0}

SHALLOWEST = 1e-8
"""Part of the largest density from which on it is drawn."""


def styled(number: int, count: int) -> dict[str, Any]:
    """Return the style of a curve of so many points."""
    style = STYLES[number % len(STYLES)]
    return style | {"markevery": (int(count / MARKS * number / len(STYLES)), max(1, count // MARKS)), "linewidth": 1}


def panels(figure: Figure, count: int = 1, left: float = LEFT, right: float = RIGHT) -> list[Axes]:
    """Add panels one above the other, so far (inches) from the sides.

    Their places are given: matplotlib would draw all twice more to find them.
    """
    height = figure.get_figheight()
    each = (height - TOP - BOTTOM - (count - 1) * BETWEEN) / count
    found = []
    for row in reversed(range(count)):
        low = BOTTOM + row * (each + BETWEEN)
        axes = figure.add_axes((left / WIDTH, low / height, 1 - (left + right) / WIDTH, each / height))
        axes.xaxis.set_label_coords(0.5, (OFF - low) / each)
        axes.yaxis.set_label_coords((OFF - left) / (WIDTH - left - right), 0.5)
        found.append(axes)
    return found


def breadth(texts: list[str], size: float) -> float:
    """Return the width (inches) of the longest of some texts, which may have several lines."""
    font = FontProperties(size=size)
    lines = [line for text in texts for line in text.splitlines()]
    return max((text_to_path.get_text_width_height_descent(line, font, False)[0] for line in lines), default=0.0) / 72


def sketch(position: Finding, parameters: dict[str, float]) -> Figure:
    """Draw what is judged: a spring that is clamped and rests on its contact, both shaken by the base."""
    figure = Figure(figsize=(WIDTH, 2.0))
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(-1.2, 11.5), ylim=(-1.35, 1.5))
    axes.axis("off")
    along = np.linspace(0, 8, 50)
    bend = 0.5 * (along / 8) ** 2
    axes.add_patch(Rectangle((-0.7, -0.75), 0.7, 1.5, facecolor="0.8", edgecolor="black", hatch="//"))
    axes.plot(along, bend, color="black", linewidth=3)
    axes.plot(along, np.zeros(50), color="black", linewidth=0.8, linestyle=":")
    # The rivet reaches down to a closed contact.
    axes.add_patch(Rectangle((7.75, 0.05), 0.5, 0.45, facecolor="black"))
    axes.add_patch(Rectangle((7.3, -0.75), 1.4, 0.8 if not is_open(position.margin) else 0.5, facecolor="0.8",
                             edgecolor="black", hatch="//"))  # fmt: skip
    if OPEN in position.margin.rest and not is_open(position.margin):
        axes.add_patch(Rectangle((7.3, 0.95), 1.4, 0.4, facecolor="0.8", edgecolor="black", hatch="//"))
    rest = position.margin.rest
    texts = {
        "length": ("spring {} mm", 1e3, (3.2, 0.6)), "tip": ("rivet {} mg", 1e6, (8.9, 0.3)),
        "overtravel": ("{} mm " + ("gap" if is_open(position.margin) else "overtravel"), 1e3, (8.9, -0.1)),
    }  # fmt: skip
    for name, (text, factor, place) in texts.items():
        if parameters.get(name):
            axes.text(*place, text.format(three(factor * abs(parameters[name]))), fontsize=8)
    if CLOSED in rest:
        axes.text(8.9, -0.5, f"preload {three(100 * rest[CLOSED])} cN", fontsize=8)
    if OPEN in rest and CLOSED in rest:
        axes.text(8.9, 1.1, f"gap {three(1e3 * rest[OPEN])} mm", fontsize=8)
    held(axes, rest)
    axes.annotate("", (3.5, -0.55), (3.5, -1.25), arrowprops={"arrowstyle": "<->"})
    axes.text(3.7, -1.0, "base acceleration of clamp and fixed contacts alike", fontsize=8)
    axes.text(-0.7, 0.9, "clamp", fontsize=8)
    return figure


def held(axes: Axes, rest: dict[str, float]) -> None:
    """Draw pusher and armature above the spring, with the forces that hold them."""
    texts = {PUSHER: "pusher, {} cN", CORE: "armature, {} cN at its core", STOP: "armature, {} cN at its stop"}
    told = [texts[name].format(three(100 * value)) for name, value in rest.items() if name in texts]
    if not told:
        return
    if PUSHER in rest:
        axes.add_patch(Rectangle((5.2, 0.27), 0.25, 0.6, facecolor="0.6", edgecolor="black"))
    if CORE in rest or STOP in rest:
        axes.add_patch(Rectangle((4.6, 0.87), 1.45, 0.22, facecolor="0.6", edgecolor="black"))
    axes.text(5.3, 1.18, "; ".join(told), fontsize=8, ha="center")


def margins(tests: list[Tested]) -> Figure:
    """Draw all margins on one scale, of each model."""
    judged = [(tested, each) for tested in tests for each in tested.models if each.judged]
    several = len({tested.first.position for tested in tests}) > 1
    labels = []
    for tested, each in judged:
        place = f", {each.position}" if several else ""
        model = f", {each.model}" if len(tested.models) > 1 else ""
        labels.append(f"{each.named}{place}{model}: {each.verdict}")
    figure = Figure(figsize=(WIDTH, 1.0 + 0.24 * len(judged)))
    (axes,) = panels(figure, left=breadth(labels, mpl.rcParams["font.size"]) + OFF)
    parts: dict[str, None] = {}
    for row, (_, each) in enumerate(judged):
        colour, own = LINES[each.verdict], each.margin
        axes.plot([max(own.low, 1e-3), own.high], [row, row], color=colour, linewidth=4, solid_capstyle="butt",
                  alpha=0.5)  # fmt: skip
        axes.plot(own.margin, row, MARKERS[each.verdict], color=colour, markeredgecolor="black", markersize=5)
        for name, part in own.parts.items():
            if part.margin < MOST:
                axes.plot(part.margin, row, PARTS[name], color="none", markeredgecolor=GREY, markersize=7)
        parts |= dict.fromkeys(own.parts)
    axes.set(
        yticks=range(len(judged)),
        # `verbatim` has those of ticks as they are.
        yticklabels=[label.replace("$", r"\$") for label in labels],
        xscale="log",
        xlabel="level that fails / level of the test (logarithmic)",
    )
    for name in parts:
        axes.plot([], [], PARTS[name], color="none", markeredgecolor=GREY, markersize=7, label=name)
    if parts:
        axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=4, borderaxespad=0.2)
    axes.set_ylim(len(judged) - 0.4, -0.6)
    axes.axvline(1.0, color=GREY, linewidth=1)
    low, high = axes.get_xlim()
    axes.set_xlim(min(low, 0.5), max(high, 2.0))
    ticked(axes)
    return figure


def ticked(axes: Axes) -> None:
    """Set the numbers of a logarithmic scale: 1, 2 and 5 of each decade, or decades alone if there are over three.

    Other ticks would take as long to draw as curves; a scale with less than two of these has matplotlib's.
    """
    low, high = axes.get_xlim()
    digits = (1, 2, 5) if high < 1e3 * low else (1,)
    ticks = [tick for power in range(-3, 5) for digit in digits if low < (tick := digit * 10.0**power) < high]
    if len(ticks) > 1:
        axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        axes.set_xticks([], minor=True)


def above(axes: Axes, title: str) -> None:
    """Write the title at the left above a panel, and its legend beside it, off the data."""
    axes.set_title(title, loc="left", y=1.0)
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.99), ncols=4, borderaxespad=0.2, handlelength=2)


def beside(figure: Figure, labels: list[str], title: str) -> Axes:
    """Add a panel with its title, and room for a legend of these labels to its right, off the data."""
    (axes,) = panels(figure, right=KEY + breadth(labels, mpl.rcParams["legend.fontsize"]))
    axes.set_title(title, loc="left", y=1.0)
    return axes


def sweeps(rows: list[Axes], findings: list[Finding], contacts: Contacts) -> None:
    """Draw level, what is left of force and gap, and failures over frequency."""
    level, left, length = rows
    most = 0.0
    limits = {CLOSED: contacts.opening, OPEN: contacts.false_make}
    for number, finding in enumerate(findings):
        own = finding.margin
        frequency = np.array(own.curves["frequency"])
        style = styled(number, len(frequency))
        level.plot(frequency, np.array(own.curves["level"]) / G, label=finding.named, **style)
        for name, values in own.curves["least"].items():
            left.plot(frequency, 100 * np.array(values) / own.rest[name], linestyle=DASHES[name], **style)
            if name not in limits:
                continue
            lengths = 1e6 * np.array(own.curves["length"][name])
            length.plot(frequency, lengths, linestyle=DASHES[name], **style)
            if name in own.failed:
                most = max(most, lengths.max())
                longest(length, frequency, lengths, style["color"])
    above(level, "Sine: amplitude of the base acceleration")
    level.set(ylabel="acceleration [g]", ylim=(0, None))
    within: dict[str, Any] = {}
    for name in findings[0].margin.rest:
        left.plot([], [], DASHES[name], color=GREY, label=f"{QUANTITIES[name]} of the {name}")
        if name not in limits:
            # More than fits above the panel.
            within = {"loc": "lower left", "ncols": 2}
            continue
        told = f"{name} {FAILURES[name]}, limit {1e6 * limits[name]:g} µs"
        length.plot([], [], DASHES[name], color=GREY, label=told)
        length.axhline(1e6 * limits[name], color=GREY, linestyle=DASHES[name], linewidth=0.6)
    above(left, "Least force and gap in steady vibration")
    if within:
        left.legend(**within)
    left.set(ylabel="of that at rest [%]", ylim=(-5, 105))
    above(length, "Longest failure")
    length.set(ylim=(0, max(1.5e6 * limits[next(iter(findings[0].margin.rest))], 1.25 * most)))
    length.set(ylabel="duration [µs]", xlabel="frequency [Hz]")
    for axes in rows:
        axes.set_xscale("log")
        ticked(axes)
        axes.tick_params(labelbottom=axes is length)


def longest(axes: Axes, frequency: Array, lengths: Array, colour: str) -> None:
    """Write where a sweep fails beside its longest failure."""
    failing, at = frequency[lengths > 0], int(lengths.argmax())
    note = f"{three(failing.min())} to {three(failing.max())} Hz, longest {time_text(1e-6 * lengths[at])}"
    left_half = frequency[at] ** 2 < frequency[0] * frequency[-1]
    axes.annotate(
        note, (frequency[at], lengths[at]), (8 if left_half else -8, -3), textcoords="offset points",
        ha="left" if left_half else "right", color=colour,
    )  # fmt: skip


def courses(figure: Figure, findings: list[Finding], title: str) -> None:
    """Draw force or gap over time: of shocks in the worse direction, or around the largest dip.

    The blows of closing are many times the force at rest: what is beyond the panel is marked, and its largest value at
    the points of the curve written.
    """
    name, rest = next(iter(findings[0].margin.rest.items()))
    scale, unit = (1e3, "mm") if name == OPEN else (100, "cN")
    both = any(OPEN in finding.margin.failed for finding in findings) and name == CLOSED
    ends = np.array((-3.0 if both else -0.2, 3.0)) * scale * rest
    labels = [fill(f"{finding.named}: {failures(finding.margin)}", 34) for finding in findings]
    axes = beside(figure, labels, title + "; below 0: force of the open contact" * both)
    for number, (finding, label) in enumerate(zip(findings, labels, strict=True)):
        time, course = (np.array(finding.margin.curves[each]) for each in ("time", "course"))
        axes.plot(1e3 * time, scale * course, label=label, **styled(number, len(time)))
        clipped(axes, 1e3 * time, scale * course, ends, unit, number)
    axes.axhline(scale * rest, color=GREY, linestyle=":", label="at rest")
    axes.axhline(0.0, color=GREY, linewidth=0.6)
    axes.set(xlabel="time [ms]", ylabel=f"{'gap' if name == OPEN else 'force'} [{unit}]", ylim=ends)
    axes.legend(**BESIDE)


def clipped(axes: Axes, time: Array, course: Array, ends: Array, unit: str, number: int) -> None:
    """Mark the peaks of a course that are beyond the ends of a panel, and write the largest at each end, row by row."""
    colour = STYLES[number % len(STYLES)]["color"]
    for end, sign, marker in zip(ends, (-1, 1), ("v", "^"), strict=True):
        beyond = sign * course > sign * end
        if not beyond.any():
            continue
        runs = np.split(np.flatnonzero(beyond), np.flatnonzero(np.diff(np.flatnonzero(beyond)) > 1) + 1)
        peaks = [int(run[np.argmax(sign * course[run])]) for run in runs]
        axes.plot(time[peaks], np.full(len(peaks), end), marker, color=colour, markersize=5, clip_on=False)
        most = max(peaks, key=lambda at: sign * course[at])
        value = f"≥ {three(abs(float(course[most])))} {unit}"
        row = (6, -9 * (number + 1) * sign)
        axes.annotate(value, (time[most], end), row, textcoords="offset points", color=colour, fontsize=7)


def record(finding: Finding) -> Figure:
    """Draw a course: the whole, its density, its shock response spectrum, and the force around the failure."""
    curves = finding.margin.curves
    figure = Figure(figsize=(WIDTH, 4.6), layout="constrained")
    whole, power, near, srs = figure.subplots(2, 2).flat
    time, least, greatest = (np.array(each) for each in curves["whole"])
    whole.fill_between(time, least / G, greatest / G, color=GREY, linewidth=0.6, edgecolor=BLACK)
    whole.set(xlabel="time [s]", ylabel="acceleration [g]", title=f"{finding.named}: base acceleration")
    frequency, response = (np.array(each) for each in curves["srs"])
    spectrum = np.array(curves["spectrum"]) / G**2
    power.loglog(frequency, spectrum, color=BLUE)
    # Below is what rounding leaves.
    power.set_ylim(bottom=SHALLOWEST * spectrum.max())
    power.set(xlabel="frequency [Hz]", ylabel="density [g²/Hz]", title="Power spectral density")
    srs.loglog(frequency, response / G, color=BLUE, label="of the acceleration")
    if "required" in curves:
        required = np.array(curves["required"])
        srs.loglog(frequency, required / G, color=BLACK, linestyle="--", label="required")
        decibels = 20 * np.log10(response / required)
        srs.plot([], [], " ", label=f"{three(decibels.min())} to {three(decibels.max())} dB above it")
        srs.legend(loc="best")
    # That of a required one is with its level.
    quality = "" if "required" in curves else f", Q = {QUALITY:g}"
    srs.set(xlabel="frequency [Hz]", ylabel="peak response [g]", title=f"Shock response spectrum{quality}")
    name, rest = next(iter(finding.margin.rest.items()))
    scale, unit = (1e3, "mm") if name == OPEN else (100, "cN")
    at = np.array(curves["time"])
    near.plot(at, scale * np.array(curves["course"]), color=BLUE)
    near.axhline(scale * rest, color=GREY, linestyle=":")
    near.set(xlabel="time [s]", ylabel=f"{QUANTITIES[name]} [{unit}]", title=failing(finding.margin),
             ylim=(-0.2 * scale * rest, 3 * scale * rest))  # fmt: skip
    for axes in (whole, power, near, srs):
        axes.title.set_fontsize(8)
    return figure


def wear(figure: Figure, findings: list[Finding]) -> None:
    """Draw the margins over the overtravel, or the gap of a contact that is open alone."""
    first = findings[0].margin
    over, why = ("gap", "") if is_open(first) else ("overtravel", "; wear reduces it")
    present = "present"
    labels = [present, *(finding.named for finding in findings)]
    axes = beside(figure, labels, f"Margins by linear response over the {over}{why}")
    for number, finding in enumerate(findings):
        own = finding.margin.wear
        style = styled(number, len(own["margin"])) | {"markevery": 1}
        axes.plot(1e3 * np.array(own["overtravel"]), own["margin"], label=finding.named, **style)
    axes.axhline(1.0, color=GREY, linewidth=1)
    axes.axvline(1e3 * first.overtravel, color=GREY, linestyle=":", label=present)
    axes.set(xlabel=f"{over} [mm]", ylabel="margin", ylim=(0, None))
    axes.legend(**BESIDE)


def position_figures(tests: list[Tested], contacts: Contacts) -> list[Figure]:
    """Draw what the tests showed in a position of the coil, by the first model."""
    judged = [tested.first for tested in tests if tested.judged]
    kinds: dict[str, list[Finding]] = {}
    for finding in judged:
        kinds.setdefault(finding.kind, []).append(finding)
    figures: list[Figure] = []

    def added(height: float) -> Figure:
        figures.append(Figure(figsize=(WIDTH, height)))
        return figures[-1]

    def height(findings: list[Finding]) -> float:
        return 1.3 + 0.4 * max(2, len(findings))

    if "sine" in kinds:
        sweeps(panels(added(5.6), 3), kinds["sine"], contacts)
    if "random" in kinds:
        title = "Random: around the largest dip expected in the time of the test"
        courses(added(height(kinds["random"])), kinds["random"], title)
    if "shock" in kinds:
        way = "closes the contact" if is_open(judged[0].margin) else "opens the contact"
        courses(added(height(kinds["shock"])), kinds["shock"], f"Shock in the direction that {way}")
    figures += [record(finding) for kind in ("spectrum", "history") for finding in kinds.get(kind, [])]
    if judged:
        wear(added(height(judged) if len(judged) > 6 else 2.3), judged)
    return figures
