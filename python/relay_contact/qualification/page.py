"""The results of an assessment as figures, one HTML page, one PDF and tables."""

import csv
from html import escape
from pathlib import Path
from textwrap import fill
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_pdf import PdfPages
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from relay_contact.figures import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, RED, SKY
from relay_contact.figures import GRAVITY as G
from relay_contact.html import STYLE, document, svg, table
from relay_contact.qualification.assessment import CHANCE, MODEL, Part
from relay_contact.qualification.relay import Relay
from relay_contact.qualification.standards import Contacts, Standard
from relay_contact.qualification.trials import CLOSED, OPEN

LINE_COLOURS = (BLUE, RED, PURPLE, ORANGE, GREEN, SKY, BLACK, GREY)
COLOURS = (BLUE, RED, PURPLE, ORANGE, GREEN)
FILLS = {"pass": "#BFE5D8", "FAIL": "#F5CDB8", "undecided": "#FBE8B0", "not judged": "#E4E4E4"}
LINES = {"pass": GREEN, "FAIL": RED, "undecided": ORANGE}
HEAD = ("test", "level", "verdict", "margin", "weakest at", "fails first", "at this level", "left at least")
QUANTITIES = {CLOSED: "force", OPEN: "gap"}
FAILURES = {CLOSED: "interrupted", OPEN: "makes"}
DASHES = {CLOSED: "-", OPEN: "--"}
TIMES = {CLOSED: "closed contact interrupted [s]", OPEN: "open contact makes [s]"}
LEAST = {CLOSED: "closed contact least force [N]", OPEN: "open contact least gap [m]"}
FILES = ("qualification.html", "qualification.pdf", "qualification.csv", "sweeps.csv")
WIDTHS, LINE = (0.13, 0.18, 0.08, 0.1, 0.09, 0.1, 0.21, 0.11), 135
"""Of the columns in the PDF, as parts of the table, and letters across it."""
REASONS = ("test", "what limits", "uncertainty of the margin", "chance of failing", "passes from")
UNVERIFIED = "Not verified: not, or not all, read in the standard's text"
NOTES = """Margin: the level that interrupts the closed contact, or closes the open one, for the time that the standard
allows, relative to that of the test, with its uncertainty at 95 %. If they allow both, the verdict is undecided. Fails
first: the contact that fails at that level. At this level: which contacts fail in the test, and for how long. Left at
least: of the force of the closed contact and the gap of the open one, in parts of those at rest. Chance of failing: of
a relay whose parameters scatter as they are uncertain. Passes: the overtravel of the closed contact, or the gap of one
that is open alone, from which on the margin exceeds 1 by its uncertainty.
Open contact: that of a changeover relay is reached only after the closed one has opened, so that an interruption comes
first, unless the gap is crossed within the time allowed for one.
Sine: steady vibration, its level raised gently; the slow sweep of a test is close to it. A contact at rest that is
vibrated suddenly may fail at a lower level.
Random: the level at which the largest dip of force or gap in the time of the test fails with a chance of one half, by
Rice's rate of crossings; the response is that of the component, and its largest dips in a record of one minute were
simulated in full. Gaussian, without clipping at three times the rms.
Shock: half sine in both directions along the motion of the contact; the worse one is shown.
Model: along the motion of the contact only, without resonances of the case."""


def mark(part: Part) -> str:
    """Give the mark of a test whose numbers were not all read in the standard's text."""
    return "" if part["verified"] else " *"


def time_text(seconds: float) -> str:
    """Give a short time in words."""
    return f"{1e3 * seconds:.2f} ms" if seconds > 1e-3 else f"{1e6 * seconds:.0f} µs"


def shares(part: Part) -> dict[str, float]:
    """Give what a test left at least of the force of the closed contact and of the gap of the open one, of 1."""
    return {name: max(least, 0.0) / part["rest"][name] for name, least in part["least"].items()}


def failures(part: Part) -> str:
    """Give which contacts fail at the level of the test, and for how long, in words."""
    told = [f"{name} {FAILURES[name]} for {time_text(length)}" for name, length in part["failed"].items()]
    return ", ".join(told) or "none fails"


def at_rest(part: Part) -> str:
    """Give force and gap at rest, in words."""
    texts = {CLOSED: ("closed contact {:.2f} cN", 100), OPEN: ("gap of the open contact {:.3g} mm", 1e3)}
    return ", ".join(texts[name][0].format(texts[name][1] * value) for name, value in part["rest"].items())


def is_open(part: Part) -> bool:
    """Tell whether the first contact was open, so that its gap was observed."""
    return CLOSED not in part["rest"]


def cells(part: Part) -> list[str]:
    """Give the row of a test in the table."""
    if "margin" not in part:
        return [part["test"], part["level"], part["verdict"], "", part["limits"], "", "", ""]
    left = [f"{QUANTITIES[name]} {100 * share:.0f} %" for name, share in shares(part).items()]
    margin = f"{part['margin']:.3f} ± {part['uncertainty']:.3f}"
    first = " and ".join(part["decides"]) or "none"
    return [
        part["test"], part["level"], part["verdict"], margin, part["weakest"], first, failures(part), ", ".join(left)
    ]  # fmt: skip


def names(effects: dict[str, float]) -> str:
    """Give what contributes most to an uncertainty, in words."""
    found = sorted(effects.items(), key=lambda item: -item[1])[:3]
    words = {MODEL: "the model", CHANCE: CHANCE}
    return ", ".join(f"{words.get(name, name)} {100 * effect:.2g} %" for name, effect in found if effect > 1e-4)


def reasons(part: Part) -> list[str]:
    """Give the row of a test in the table of reasons."""
    if "margin" not in part:
        return [part["test"], part["limits"], "", "", ""]
    passes = (
        "nothing up to 1.2 times this"
        if part["passes"] is None
        else f"{1e3 * part['passes']:.3g} mm {'gap' if is_open(part) else 'overtravel'}"
    )
    return [part["test"], part["limits"], names(part["effects"]), f"{100 * part['chance']:.0f} %", passes]


def margins(parts: list[Part]) -> Figure:
    """Draw all margins on one scale."""
    judged = [part for part in parts if "margin" in part]
    figure = Figure(figsize=(8.27, 1.0 + 0.24 * len(judged)), layout="constrained")
    axes = figure.subplots()
    several = len({part["position"] for part in judged}) > 1
    for row, part in enumerate(judged):
        colour = LINES[part["verdict"]]
        low, high = (part["margin"] + sign * part["uncertainty"] for sign in (-1, 1))
        axes.plot([max(low, 1e-3), high], [row, row], color=colour, linewidth=4, solid_capstyle="butt", alpha=0.5)
        axes.plot(part["margin"], row, "o", color=colour, markersize=4)
    labels = [f"{part['test']}{', ' + part['position'] if several else ''}: {part['verdict']}" for part in judged]
    axes.set(yticks=range(len(judged)), yticklabels=labels, xscale="log", xlabel="level that fails / level of the test")
    axes.set_ylim(len(judged) - 0.4, -0.6)
    axes.axvline(1.0, color=GREY, linewidth=1)
    low, high = axes.get_xlim()
    axes.set_xlim(min(low, 0.5), max(high, 2.0))
    ticks = [tick for tick in (0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50) if axes.get_xlim()[0] < tick < axes.get_xlim()[1]]
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.set_xticks([], minor=True)
    return figure


def sweeps(panels: list[Axes], parts: list[Part], contacts: Contacts) -> None:
    """Draw level, what is left of force and gap, and failures over frequency."""
    level, left, length = panels
    most = 0.0
    for part, colour in zip(parts, COLOURS, strict=False):
        curves = part["curves"]
        frequency = np.array(curves["frequency"])
        level.plot(frequency, np.array(curves["level"]) / G, color=colour, label=part["test"])
        for name, values in curves["least"].items():
            left.plot(frequency, 100 * np.array(values) / part["rest"][name], DASHES[name], color=colour)
            lengths = 1e6 * np.array(curves["length"][name])
            length.plot(frequency, lengths, DASHES[name], color=colour)
            if name in part["failed"]:
                failing, at = frequency[lengths > 0], int(lengths.argmax())
                note = f"{failing.min():.0f} to {failing.max():.0f} Hz, {lengths[at]:.0f} µs at {frequency[at]:.0f} Hz"
                length.plot(frequency[at], lengths[at], "o", color=colour, markersize=3)
                place = frequency[at], lengths[at]
                length.annotate(note, place, (-8, -3), textcoords="offset points", ha="right", color=colour)
                most = max(most, lengths[at])
    level.legend(loc="best")
    level.set(ylabel="acceleration [g]", ylim=(0, None), title="Sine: amplitude of the base acceleration")
    limits = {CLOSED: contacts.opening, OPEN: contacts.false_make}
    for name in parts[0]["rest"]:
        left.plot([], [], DASHES[name], color=GREY, label=f"{QUANTITIES[name]} of the {name}")
        told = f"{name} {FAILURES[name]}, limit {1e6 * limits[name]:g} µs"
        length.plot([], [], DASHES[name], color=GREY, label=told)
        length.axhline(1e6 * limits[name], color=GREY, linestyle=DASHES[name], linewidth=0.6)
    left.legend(loc="lower left")
    left.set(ylabel="part of rest [%]", ylim=(-5, 105), title="What is left at least in steady vibration")
    length.legend(loc="upper left")
    length.set(ylim=(0, max(1.5e6 * limits[next(iter(parts[0]["rest"]))], 1.25 * most)))
    length.set(ylabel="duration [µs]", xlabel="frequency [Hz]")
    length.set_title("Mean length of a failure in steady vibration; dot: longest")
    for axes in panels:
        axes.set_xscale("log")
        axes.xaxis.set_major_formatter("{x:g}")
        axes.tick_params(labelbottom=axes is length)


def courses(axes: Axes, parts: list[Part], title: str) -> None:
    """Draw force or gap over time: of shocks in the worse direction, or around the largest dip in random vibration."""
    name, rest = next(iter(parts[0]["rest"].items()))
    scale = 1e3 if name == OPEN else 100
    for part, colour in zip(parts, COLOURS, strict=False):
        label = f"{part['test']}: {failures(part)}"
        time, course = (np.array(part["curves"][each]) for each in ("time", "course"))
        axes.plot(1e3 * time, scale * course, color=colour, label=label, linewidth=1)
    axes.axhline(scale * rest, color=GREY, linestyle=":", label="at rest")
    axes.axhline(0.0, color=GREY, linewidth=0.6)
    axes.legend(loc="upper right", frameon=True)
    # The blows of closing are many times the force at rest.
    both = any(OPEN in part["failed"] for part in parts) and name == CLOSED
    low, high = (-3, 3) if both else (-0.2, 3)
    label = "gap [mm]" if name == OPEN else "force [cN]"
    if both:
        title += "; below 0: force of the open contact"
    axes.set(xlabel="time [ms]", ylabel=label, title=title, ylim=(low * scale * rest, high * scale * rest))


def wear(axes: Axes, parts: list[Part]) -> None:
    """Draw the margins over the overtravel, or the gap of a contact that is open alone."""
    for part, colour in zip(parts, LINE_COLOURS, strict=False):
        axes.plot(1e3 * np.array(part["wear"]["overtravel"]), part["wear"]["margin"], color=colour, label=part["test"])
    axes.axhline(1.0, color=GREY, linewidth=1)
    axes.axvline(1e3 * parts[0]["overtravel"], color=GREY, linestyle=":", label="as it is")
    axes.legend(loc="upper left", ncols=2)
    over = "gap" if is_open(parts[0]) else "overtravel"
    why = "" if is_open(parts[0]) else ", which wear takes away"
    axes.set(xlabel=f"{over} [mm]", ylabel="margin", title=f"Margins over the {over}{why}")
    axes.set_ylim(0, None)


def position_figure(parts: list[Part], contacts: Contacts) -> Figure | None:
    """Draw what the tests showed in a position of the coil."""
    kinds = {
        kind: [part for part in parts if part["kind"] == kind and "margin" in part]
        for kind in ("sine", "random", "shock")
    }
    judged = [part for part in parts if "margin" in part]
    if not judged:
        return None
    way = "closes the contact" if is_open(judged[0]) else "opens the contact"
    rows = 3 * bool(kinds["sine"]) + bool(kinds["random"]) + bool(kinds["shock"]) + 1
    figure = Figure(figsize=(8.27, 1.95 * rows + 0.4), layout="constrained")
    panels = list(figure.subplots(rows, 1, squeeze=False)[:, 0])
    if kinds["sine"]:
        sweeps(panels[:3], kinds["sine"], contacts)
    if kinds["random"]:
        title = "Random: the last 10 ms around the largest dip in a minute"
        courses(panels[-2 - bool(kinds["shock"])], kinds["random"], title)
    if kinds["shock"]:
        courses(panels[-2], kinds["shock"], f"Shock in the direction that {way}")
    wear(panels[-1], judged)
    figure.align_ylabels()
    return figure


def html(relay: Relay, standard: Standard, parts: list[Part], component: str) -> str:
    """Give the page."""
    counts = {verdict: sum(part["verdict"] == verdict for part in parts) for verdict in FILLS}
    told = ", ".join(f"{count} {verdict}" for verdict, count in counts.items() if count)
    body = [f"<h1>{escape(relay.title)}</h1>", f"<p>{escape(standard.title)}: <b>{told}</b></p>", svg(margins(parts))]
    for position in relay.positions:
        mine = [part for part in parts if part["position"] == position]
        body.append(f"<h2>{escape(position)}</h2>")
        known = next((part for part in mine if "margin" in part), None)
        if known:
            body.append(f"<p>At rest: {at_rest(known)}; first resonance {known['natural']:.0f} Hz.</p>")
        head = "".join(f"<th>{name}</th>" for name in HEAD)
        body.append(f'<div class="wide"><table><tr>{head}</tr>')
        for part in mine:
            row = cells(part)
            source = f"<br><small>{escape(part['clause'])}{'' if part['verified'] else ', <b>not verified</b>'}</small>"
            columns = [f"<td>{escape(row[0])}{source}</td>", f"<td>{escape(row[1])}</td>"]
            columns.append(f'<td class="verdict" style="background:{FILLS[part["verdict"]]}">{row[2]}</td>')
            columns.append(f'<td class="number">{row[3]}</td>')
            columns += [f"<td>{escape(cell)}</td>" for cell in row[4:]]
            body.append(f"<tr>{''.join(columns)}</tr>")
        body.append("</table></div>")
        body.append(svg(position_figure(mine, standard.contacts)))
        body.append(table(REASONS, map(reasons, mine)))
    body.append("<h2>How this was found</h2>")
    body.append(f"<p>{escape(limit(standard))}</p>")
    body += [f"<p>{escape(line)}</p>" for line in sentences()]
    body.append(f'<p class="note">Component {escape(component)}.</p>')
    return document(f"{relay.title}: {standard.title}", body)


def limit(standard: Standard) -> str:
    """Give what fails a contact, in words."""
    known = standard.contacts
    checked = "" if known.verified else ", not verified"
    return (
        f"A closed contact fails if it is interrupted for {time_text(known.opening)} or more, that is, if its "
        f"resistance exceeds {known.threshold:g} Ω, at which it takes half of a monitor's {known.voltage:g} V; an open "
        f"one if it conducts better than that for {time_text(known.false_make)} or more ({known.clause}{checked}). "
        f"{UNVERIFIED}."
    )


def sentences() -> list[str]:
    """Give the notes, one for each test."""
    starts = ("Margin:", "Sine:", "Random:", "Shock:", "Open contact:", "Model:")
    found: list[str] = []
    for line in NOTES.splitlines():
        if line.startswith(starts):
            found.append(line)
        else:
            found[-1] += f" {line}"
    return found


def summary(relay: Relay, standard: Standard, parts: list[Part]) -> Figure:
    """Draw the first page of the PDF: the table and the notes."""
    figure = Figure(figsize=(8.27, 11.69))
    figure.text(0.05, 0.965, relay.title, fontsize=12, weight="bold", wrap=True)
    figure.text(0.05, 0.947, standard.title, fontsize=9)
    height = min(0.8, 0.028 * (len(parts) + 1 + len(relay.positions)))
    axes = figure.add_axes((0.04, 0.93 - height, 0.92, height))
    axes.axis("off")
    rows, fills = [], []
    for position in relay.positions:
        mine = [part for part in parts if part["position"] == position]
        rows.append([position, *[""] * (len(HEAD) - 1)])
        fills.append("white")
        for part in mine:
            row = cells(part)
            row[0] += mark(part)
            rows.append([fill(cell, round(LINE * width)) for cell, width in zip(row, WIDTHS, strict=True)])
            fills.append(FILLS[part["verdict"]])
    grid = axes.table(
        rows,
        colLabels=HEAD,
        colWidths=WIDTHS,
        cellLoc="left",
        bbox=Bbox.from_bounds(0, 0, 1, 1),
    )
    grid.auto_set_font_size(False)
    grid.set_fontsize(5.5)
    for number, colour in enumerate(fills, 1):
        grid[number, 2].set_facecolor(colour)
    for cell in grid.get_celld().values():
        cell.set_linewidth(0.3)
    notes = "\n".join([f"* {UNVERIFIED}", *NOTES.splitlines()])
    figure.text(0.05, 0.9 - height, notes, fontsize=7, va="top", linespacing=1.5)
    return figure


def write(folder: Path, relay: Relay, standard: Standard, parts: list[Part], component: str) -> list[Path]:
    """Write page, PDF and tables; give their paths."""
    paths = [folder / name for name in FILES]
    settings: Any = STYLE
    with mpl.rc_context(settings):
        paths[0].write_text(html(relay, standard, parts, component), encoding="utf-8")
        with PdfPages(paths[1], metadata={"CreationDate": None, "Title": relay.title}) as pages:
            pages.savefig(summary(relay, standard, parts))
            pages.savefig(margins(parts))
            for position in relay.positions:
                figure = position_figure([part for part in parts if part["position"] == position], standard.contacts)
                if figure:
                    figure.suptitle(position, fontsize=10)
                    pages.savefig(figure)
    fields = [
        "position",
        "test",
        "clause",
        "verified",
        "level",
        "verdict",
        "margin",
        "uncertainty",
        "weakest",
        "limits",
    ]
    with paths[2].open("w", newline="", encoding="utf-8") as file:
        judged = csv.writer(file, lineterminator="\n")
        judged.writerow([*fields, "fails first", *TIMES.values(), *LEAST.values()])
        for part in parts:
            own = [part[key].get(name, "") for key in ("failed", "least") for name in TIMES] if "margin" in part else []
            judged.writerow([*(part.get(field, "") for field in fields), " and ".join(part.get("decides", [])), *own])
    with paths[3].open("w", newline="", encoding="utf-8") as file:
        lines = csv.writer(file, lineterminator="\n")
        means = [f"{text.removesuffix(' [s]')}, mean [s]" for text in TIMES.values()]
        lines.writerow(["position", "test", "frequency [Hz]", "acceleration [m/s2]", *means, *LEAST.values()])
        for part in parts:
            if part["kind"] == "sine" and "curves" in part:
                curves = part["curves"]
                none = [""] * len(curves["frequency"])
                both = [curves[key].get(name, none) for key in ("length", "least") for name in TIMES]
                for values in zip(curves["frequency"], curves["level"], *both, strict=True):
                    texts = [value if value == "" else f"{value:.9g}" for value in values]
                    lines.writerow([part["position"], part["test"], *texts])
    return paths
