"""The results of an assessment as figures, one HTML page and tables."""

import csv
from collections.abc import Iterable
from html import escape
from pathlib import Path
from textwrap import fill
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from relay_contact.component import Array, Component, Values, units
from relay_contact.figures import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, RED, SKY, three
from relay_contact.figures import GRAVITY as G
from relay_contact.html import STYLE, document, svg, table
from relay_contact.qualification.assessment import CHANCE, DRAWS, MODEL, WORN, Part, spring_of
from relay_contact.qualification.relay import Relay
from relay_contact.qualification.standards import Contacts, Standard
from relay_contact.qualification.trials import CLOSED, OPEN

LINE_COLOURS = (BLUE, RED, PURPLE, ORANGE, GREEN, SKY, BLACK, GREY)
COLOURS = (BLUE, RED, PURPLE, ORANGE, GREEN)
FILLS = {"pass": "#BFE5D8", "FAIL": "#F5CDB8", "undecided": "#FBE8B0", "not judged": "#E4E4E4"}
LINES = {"pass": GREEN, "FAIL": RED, "undecided": ORANGE}
HEAD = (
    "test",
    "level",
    "verdict",
    "margin",
    "95 % interval of the parameters",
    "weakest at",
    "fails first",
    "in the test",
    "left at least",
)
QUANTITIES = {CLOSED: "force", OPEN: "gap"}
FAILURES = {CLOSED: "interrupted", OPEN: "makes"}
DASHES = {CLOSED: "-", OPEN: "--"}
TIMES = {CLOSED: "closed contact interrupted [s]", OPEN: "open contact makes [s]"}
LEAST = {CLOSED: "closed contact least force [N]", OPEN: "open contact least gap [m]"}
FILES = ("qualification.html", "qualification.csv", "sweeps.csv")
FIELDS = (
    "position", "test", "model", "clause", "verified", "level", "verdict", "margin", "low", "high", "chance", "weakest",
    "limits",
)  # fmt: skip
"""Of the table of results."""
REASONS = ("test", "what limits", "what the interval comes from", "chance of failing", "passes from")
UNVERIFIED = "Not verified: not, or not all, read in the standard's text"
JUDGED = """The contact springs are judged as in a rigid relay: base vibration moves the clamp of the spring and the
fixed contacts alike. Armature, actuator, coil and case are not in the model: what they do to the contact is not in
any verdict here."""
ALONE = """An interval is that of the uncertain parameters alone, and of the allowance that the relay's file makes for
what the model leaves out. How far another form of the model would move a margin"""
LAWS = {
    "Hertz": "Hertzian contact of smooth bodies",
    "Rough": "contact of rough surfaces, its stiffness the power {:g} of the force,",
    "Linearised": "contact of smooth bodies, linear about the preload,",
    "Bonded": "contact of smooth bodies, linear and unable to open,",
}
"""By effects.contactLaw."""
NOTES = """Margin: the level that interrupts the closed contact, or closes the open one, for the time that the
standard allows, relative to that of the test. Its interval has 95 % confidence: the component answers a pulse with
each of {draws} draws of the uncertain parameters, the margins follow from the answers, and at both ends of the
interval the component seeks the level itself. If the interval includes 1, the verdict is undecided; if there are
several models, a test is passed only by all, and failed only by all. Fails first: the contact that fails at the
margin. In the test: which contacts fail at its level, and the longest failure. Left at least: of the force of the
closed contact and the gap of the open one, in parts of those at rest. Chance of failing: the part of the draws whose
margin is below 1. Passes from: the overtravel of the closed contact, or the gap of one that is open alone, from which
on the whole interval is above 1, if that is as wide as here.
Open contact: that of a changeover relay is reached only after the closed one has opened, so that an interruption
comes first, unless the gap is crossed within the time allowed for one.
Sine: steady vibration, its level raised gently; the slow sweep of a test is close to it. A contact at rest that is
vibrated suddenly may fail at a lower level.
Random: the level at which the largest dip of force or gap in the time of the test fails with a chance of one half, by
Rice's rate of crossings; the response is that of the component, and the largest dips in a record of one minute were
simulated in full. What fails in the test is told of such a dip, raised to the size of the largest in the time of the
test. Gaussian, without clipping at three times the rms.
Shock: half sine in both directions along the motion of the contact; the worse one is shown.
Model: along the motion of the contact only, without resonances of the case."""
SETTINGS = ("excitation.", "chatter.", "solver.")
"""Parameters that are not the relay's."""
UNUSED = {
    "beam.file": ("beam.length", "beam.width", "beam.thickness"),
    "effects.secondContact": ("second.",),
    "effects.friction": ("friction.", "effects.friction"),
    "effects.contactLaw": ("contact.stiffness",),
}
"""Parameters without effect where this one has a value, or where it has its start value."""


def mark(part: Part) -> str:
    """Return the mark of a test whose numbers were not all read in the standard's text."""
    return "" if part["verified"] else " *"


def time_text(seconds: float) -> str:
    """Return a short time in words."""
    return f"{three(1e3 * seconds)} ms" if seconds >= 1e-3 else f"{three(1e6 * seconds)} µs"


def shares(part: Part) -> dict[str, float]:
    """Return what a test left at least of the force of the closed contact and of the gap of the open one, of 1."""
    return {name: max(least, 0.0) / part["rest"][name] for name, least in part["least"].items()}


def failures(part: Part) -> str:
    """Return which contacts fail at the level of the test, and the longest failure, in words."""
    told = [
        f"{name} {FAILURES[name]} for {time_text(length)} {part['where'][name]}".rstrip()
        for name, length in part["failed"].items()
    ]
    if not told and part["margin"] <= 1:
        return f"none fails at this level itself, but at {three(part['margin'])} of it"
    return ", ".join(told) or "none fails"


def at_rest(part: Part) -> str:
    """Return force and gap at rest, in words."""
    texts = {CLOSED: ("force of the closed contact {} cN", 100), OPEN: ("gap of the open contact {} mm", 1e3)}
    return ", ".join(texts[name][0].format(three(texts[name][1] * value)) for name, value in part["rest"].items())


def is_open(part: Part) -> bool:
    """Tell whether the first contact was open, so that its gap was observed."""
    return CLOSED not in part["rest"]


def own_cells(part: Part) -> list[str]:
    """Return what the table has of a test by one model, from the verdict on."""
    if "margin" not in part:
        return [part["verdict"], "", "", part["limits"], "", "", ""]
    left = [f"{QUANTITIES[name]} {100 * share:.0f} %" for name, share in shares(part).items()]
    interval = f"{three(part['low'])} to {three(part['high'])}"
    first = " and ".join(part["decides"]) or "none"
    return [
        part["verdict"], three(part["margin"]), interval, part["weakest"], first, failures(part), ", ".join(left)
    ]  # fmt: skip


def rows(part: Part) -> list[list[str]]:
    """Return the rows of a test in the table: one, or the verdict of all models and a row for each of them."""
    if len(part["models"]) == 1:
        return [[part["test"], part["level"], *own_cells(part)]]
    known = [each["margin"] for each in part["models"] if "margin" in each]
    spread = f"{three(min(known))} to {three(max(known))}" if known else ""
    whole = [part["test"], part["level"], part["verdict"], spread, "by model", *[""] * 4]
    return [whole, *([f"- {each['model']}", "", *own_cells(each)] for each in part["models"])]


def names(effects: dict[str, float]) -> str:
    """Return what contributes most to an interval, in words."""
    found = sorted(effects.items(), key=lambda item: -item[1])[:3]
    words = {MODEL: "allowance for the model", CHANCE: CHANCE}
    told = [f"{words.get(name, name)} ± {three(100 * effect)} %" for name, effect in found if effect > 1e-4]
    return ", ".join(told) or "nothing: the relay's file names no uncertainty"


def chance_text(chance: float) -> str:
    """Return a chance of failing in words, as far as the draws tell it."""
    if chance in (0, 1):
        return f"< {100 / DRAWS:.1f} %" if chance == 0 else f"> {100 - 100 / DRAWS:.1f} %"
    return f"{three(100 * chance)} %"


def passes_text(part: Part) -> str:
    """Return from which overtravel or gap on a test is passed, in words."""
    what, over = "gap" if is_open(part) else "overtravel", part["wear"]["overtravel"]
    if part["passes"] is None:
        return f"nothing up to {WORN[-1]:g} times the {what}"
    below = "< " if part["passes"] <= over[0] else ""
    return f"{below}{three(1e3 * part['passes'])} mm {what}"


def reasons(part: Part) -> list[list[str]]:
    """Return the rows of a test in the table of reasons."""
    found = []
    for each in part["models"]:
        test = part["test"] + (f": {each['model']}" if len(part["models"]) > 1 else "")
        if "margin" in each:
            told = [names(each["effects"]), chance_text(each["chance"]), passes_text(each)]
        else:
            told = [""] * 3
        found.append([test, each["limits"], *told])
    return found


def margins(parts: list[Part]) -> Figure:
    """Draw all margins on one scale, of each model."""
    judged = [(part, each) for part in parts for each in part["models"] if "margin" in each]
    figure = Figure(figsize=(8.27, 1.0 + 0.24 * len(judged)), layout="constrained")
    axes = figure.subplots()
    several = len({part["position"] for part in parts}) > 1
    labels = []
    for row, (part, each) in enumerate(judged):
        colour = LINES[each["verdict"]]
        axes.plot([max(each["low"], 1e-3), each["high"]], [row, row], color=colour, linewidth=4,
                  solid_capstyle="butt", alpha=0.5)  # fmt: skip
        axes.plot(each["margin"], row, "o", color=colour, markersize=4)
        place = f", {part['position']}" if several else ""
        model = f", {each['model']}" if len(part["models"]) > 1 else ""
        labels.append(f"{part['test']}{place}{model}: {each['verdict']}")
    axes.set(yticks=range(len(judged)), yticklabels=labels, xscale="log", xlabel="level that fails / level of the test")
    axes.set_ylim(len(judged) - 0.4, -0.6)
    axes.axvline(1.0, color=GREY, linewidth=1)
    low, high = axes.get_xlim()
    axes.set_xlim(min(low, 0.5), max(high, 2.0))
    ticks = [tick for tick in (0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50) if axes.get_xlim()[0] < tick < axes.get_xlim()[1]]
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.set_xticks([], minor=True)
    return figure


def above(axes: Axes, title: str, *, legend: bool = True) -> None:
    """Write the title at the left above a panel, and its legend beside it, off the data."""
    axes.set_title(title, loc="left")
    if legend:
        axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.99), ncols=4, borderaxespad=0.2, handlelength=1.5)


def beside(axes: Axes) -> None:
    """Put the legend to the right of a panel, off the data."""
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), borderaxespad=0.0)


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
                note = f"{three(failing.min())} to {three(failing.max())} Hz, longest {time_text(1e-6 * lengths[at])}"
                length.plot(frequency[at], lengths[at], "o", color=colour, markersize=3)
                left_half = frequency[at] ** 2 < frequency[0] * frequency[-1]
                length.annotate(
                    note, (frequency[at], lengths[at]), (8 if left_half else -8, -3), textcoords="offset points",
                    ha="left" if left_half else "right", color=colour,
                )  # fmt: skip
                most = max(most, lengths[at])
    above(level, "Sine: amplitude of the base acceleration")
    level.set(ylabel="acceleration [g]", ylim=(0, None))
    limits = {CLOSED: contacts.opening, OPEN: contacts.false_make}
    for name in parts[0]["rest"]:
        left.plot([], [], DASHES[name], color=GREY, label=f"{QUANTITIES[name]} of the {name}")
        told = f"{name} {FAILURES[name]}, limit {1e6 * limits[name]:g} µs"
        length.plot([], [], DASHES[name], color=GREY, label=told)
        length.axhline(1e6 * limits[name], color=GREY, linestyle=DASHES[name], linewidth=0.6)
    above(left, "What is left at least in steady vibration")
    left.set(ylabel="part of rest [%]", ylim=(-5, 105))
    above(length, "Longest failure")
    length.set(ylim=(0, max(1.5e6 * limits[next(iter(parts[0]["rest"]))], 1.25 * most)))
    length.set(ylabel="duration [µs]", xlabel="frequency [Hz]")
    for axes in panels:
        axes.set_xscale("log")
        axes.xaxis.set_major_formatter("{x:g}")
        axes.tick_params(labelbottom=axes is length)


def courses(axes: Axes, parts: list[Part], title: str) -> None:
    """Draw force or gap over time: of shocks in the worse direction, or around the largest dip in random vibration.

    The blows of closing are many times the force at rest: what is beyond the panel is marked, and its largest value at
    the points of the curve written.
    """
    name, rest = next(iter(parts[0]["rest"].items()))
    scale, unit = (1e3, "mm") if name == OPEN else (100, "cN")
    both = any(OPEN in part["failed"] for part in parts) and name == CLOSED
    ends = np.array((-3.0 if both else -0.2, 3.0)) * scale * rest
    for part, colour in zip(parts, LINE_COLOURS, strict=False):
        time, course = (np.array(part["curves"][each]) for each in ("time", "course"))
        label = fill(f"{part['test']}: {failures(part)}", 34)
        axes.plot(1e3 * time, scale * course, color=colour, label=label, linewidth=1)
        clipped(axes, 1e3 * time, scale * course, ends, unit, colour)
    axes.axhline(scale * rest, color=GREY, linestyle=":", label="at rest")
    axes.axhline(0.0, color=GREY, linewidth=0.6)
    if both:
        title += "; below 0: force of the open contact"
    axes.set(xlabel="time [ms]", ylabel=f"{'gap' if name == OPEN else 'force'} [{unit}]", ylim=ends)
    axes.set_title(title, loc="left")
    beside(axes)


def clipped(axes: Axes, time: Array, course: Array, ends: Array, unit: str, colour: str) -> None:
    """Mark the peaks of a course that are beyond the ends of a panel, and write the largest at each end."""
    for end, sign, marker in zip(ends, (-1, 1), ("v", "^"), strict=True):
        beyond = sign * course > sign * end
        if not beyond.any():
            continue
        runs = np.split(np.flatnonzero(beyond), np.flatnonzero(np.diff(np.flatnonzero(beyond)) > 1) + 1)
        peaks = [int(run[np.argmax(sign * course[run])]) for run in runs]
        axes.plot(time[peaks], np.full(len(peaks), end), marker, color=colour, markersize=5, clip_on=False)
        most = max(peaks, key=lambda at: sign * course[at])
        value = f"≥ {three(abs(float(course[most])))} {unit}"
        axes.annotate(value, (time[most], end), (6, -9 * sign), textcoords="offset points", color=colour, fontsize=7)


def wear(axes: Axes, parts: list[Part]) -> None:
    """Draw the margins over the overtravel, or the gap of a contact that is open alone."""
    for part, colour in zip(parts, LINE_COLOURS, strict=False):
        axes.plot(1e3 * np.array(part["wear"]["overtravel"]), part["wear"]["margin"], color=colour, label=part["test"])
    axes.axhline(1.0, color=GREY, linewidth=1)
    axes.axvline(1e3 * parts[0]["overtravel"], color=GREY, linestyle=":", label="as it is")
    over = "gap" if is_open(parts[0]) else "overtravel"
    why = "" if is_open(parts[0]) else ", which wear takes away"
    axes.set(xlabel=f"{over} [mm]", ylabel="margin", ylim=(0, None))
    axes.set_title(f"Margins over the {over}{why}", loc="left")
    beside(axes)


def position_figures(parts: list[Part], contacts: Contacts) -> list[Figure]:
    """Draw what the tests showed in a position of the coil, by the first model."""
    kinds = {
        kind: [part for part in parts if part["kind"] == kind and "margin" in part]
        for kind in ("sine", "random", "shock")
    }
    judged = [part for part in parts if "margin" in part]
    figures: list[Figure] = []

    def added(panels: int, height: float) -> list[Axes]:
        figures.append(Figure(figsize=(8.27, height), layout="constrained"))
        found = list(figures[-1].subplots(panels, 1, squeeze=False)[:, 0])
        figures[-1].align_ylabels()
        return found

    if kinds["sine"]:
        sweeps(added(3, 5.6), kinds["sine"], contacts)
    if kinds["random"]:
        courses(added(1, 2.1)[0], kinds["random"], "Random: around the largest dip expected in the time of the test")
    if kinds["shock"]:
        way = "closes the contact" if is_open(judged[0]) else "opens the contact"
        courses(added(1, 2.3)[0], kinds["shock"], f"Shock in the direction that {way}")
    if judged:
        wear(added(1, 2.3)[0], judged)
    return figures


def form(component: Component, values: Values) -> str:
    """Return the form of the model in words."""

    def has(name: str, group: str = "effects") -> Any:  # noqa: ANN401
        return values.get(f"{group}.{name}", component.start(f"{group}.{name}"))

    law = LAWS[has("contactLaw")].format(has("stiffnessExponent", "contact"))
    axial = {"None": "no axial force", "Prescribed": "a given axial force"}
    parts = [
        "slender spring with Rayleigh damping",
        f"{law} {'with' if has('contactDamping') else 'without'} viscoelastic damping",
        axial.get(str(has("axialForce")), "the axial force of the preload"),
        "no friction" if has("friction") == "None" else f"friction of {has('coefficient', 'friction'):g}",
    ]
    return ", ".join(parts)


def inputs(component: Component, relay: Relay) -> str:
    """Return a table of all parameters of the relay by position and model, with their uncertainties."""
    columns = {
        ", ".join([position] * (len(relay.positions) > 1) + [model.name] * (len(relay.models) > 1)) or "value": (
            {**relay.positions[position], **model.parameters}
        )
        for position in relay.positions
        for model in relay.models
    }
    described = units(component.description)
    own = {name for values in columns.values() for name in values}
    hidden: list[tuple[str, ...]] = [SETTINGS]
    for name, prefixes in UNUSED.items():
        used = any(values.get(name, component.start(name)) != component.start(name) for values in columns.values())
        hidden += [prefixes] if used == (name == "beam.file") else []
    rows = []
    for name, variable in component.variables.items():
        if variable.causality != "parameter" or name == "beam.file":
            continue
        if name not in own and any(name.startswith(prefixes) for prefixes in hidden):
            continue

        def text(value: Any, name: str = name) -> str:  # noqa: ANN401
            if isinstance(value, str):
                return value
            if component.variables[name].type == "Boolean":
                return str(bool(value)).lower()
            return described[name].text(float(value)).strip() if name in described else f"{float(value):g}"

        part = relay.uncertainty.get(name)
        cells = [text(values.get(name, component.start(name))) for values in columns.values()]
        told = f"± {100 * part:.3g} %" if part else ""
        rows.append([name, *cells, told, "file" if name in own else "start"])
    for name, part in relay.uncertainty.items():
        if name not in component.variables:
            rows.append([name, *["as in the spring file"] * len(columns), f"± {100 * part:.3g} %", "file"])
    for model in relay.models:
        named = f"margin, by {model.name}" if len(relay.models) > 1 else "margin, by what the model leaves out"
        rows.append([named, *[""] * len(columns), f"± {100 * model.uncertainty:.3g} %", "file"])
    files = {
        Path(str(values["beam.file"])).name: spring_of(values) for values in columns.values() if "beam.file" in values
    }
    told = "".join(
        f"<h3>Spring file {escape(name)}</h3><pre>{escape(content.decode())}</pre>" for name, content in files.items()
    )
    return table(("parameter", *columns, "uncertainty, 95 %", "by"), rows) + told


def verdict_rows(part: Part) -> Iterable[str]:
    """Return the rows of a test in the page's table."""
    for number, row in enumerate(rows(part)):
        source = ""
        if number == 0:
            unverified = "" if part["verified"] else ", <b>not verified</b>"
            source = f"<br><small>{escape(part['clause'])}{unverified}</small>"
        columns = [f"<td>{escape(row[0])}{source}</td>", f"<td>{escape(row[1])}</td>"]
        columns.append(f'<td class="verdict" style="background:{FILLS[row[2]]}">{row[2]}</td>')
        columns.append(f'<td class="number">{row[3]}</td>')
        columns += [f"<td>{escape(cell)}</td>" for cell in row[4:]]
        yield f"<tr{' class=of' if number else ''}>{''.join(columns)}</tr>"


def html(relay: Relay, standard: Standard, parts: list[Part], component: Component, date: str) -> str:
    """Return the page."""
    counts = {verdict: sum(part["verdict"] == verdict for part in parts) for verdict in FILLS}
    told = ", ".join(f"{count} {verdict}" for verdict, count in counts.items() if count)
    when = f" <small>{escape(date)}</small>" if date else ""
    body = [f"<h1>{escape(relay.title)}</h1>", f"<p>{escape(standard.title)}: <b>{told}</b>{when}</p>"]
    warned = list(dict.fromkeys(text for part in parts for each in part["models"] for text in each["warnings"]))
    if warned:
        body.append(
            f"<p><b>Warnings of the component:</b></p><ul>{''.join(f'<li>{escape(w)}</li>' for w in warned)}</ul>"
        )
    body += [f'<p class="judged">{escape(JUDGED)}</p>', svg(margins(parts))]
    for position, values in relay.positions.items():
        mine = [part for part in parts if part["position"] == position]
        body.append(f"<h2>{escape(position)}</h2>")
        known = next((part for part in mine if "margin" in part), None)
        if known:
            body.append(f"<p>At rest: {at_rest(known)}; first resonance {three(known['natural'])} Hz.</p>")
        forms = {form(component, {**values, **model.parameters}): None for model in relay.models}
        count = len(relay.models)
        told = f", the margins of {count} models show" if count > 1 else " it does not say; one model is judged"
        body.append(f'<p class="judged">{escape(ALONE + told)}. Form of the model: {escape("; ".join(forms))}.</p>')
        head = "".join(f"<th>{name}</th>" for name in HEAD)
        lines = "".join(line for part in mine for line in verdict_rows(part))
        body.append(f'<div class="wide"><table><tr>{head}</tr>{lines}</table></div>')
        body.append(table(REASONS, [row for part in mine for row in reasons(part)]))
        if len(relay.models) > 1:
            body.append(f'<p class="note">Figures: {escape(relay.models[0].name)}.</p>')
        body += map(svg, position_figures(mine, standard.contacts))
    body += ["<h2>Inputs</h2>", inputs(component, relay), "<h2>How this was found</h2>"]
    body.append(f"<p>{escape(limit(standard))}</p>")
    body += [f"<p>{escape(line)}</p>" for line in sentences()]
    described = component.description
    version = f"{described.modelName} {described.version}, {described.guid}"
    body.append(f'<p class="note">Component {escape(version)}.</p>')
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
    for line in NOTES.format(draws=DRAWS).splitlines():
        if line.startswith(starts):
            found.append(line)
        else:
            found[-1] += f" {line}"
    return found


def write(
    folder: Path, relay: Relay, standard: Standard, parts: list[Part], component: Component, date: str = ""
) -> list[Path]:
    """Write page and tables; return their paths."""
    paths = [folder / name for name in FILES]
    settings: Any = STYLE
    with mpl.rc_context(settings):
        paths[0].write_text(html(relay, standard, parts, component, date), encoding="utf-8")
    with paths[1].open("w", newline="", encoding="utf-8") as file:
        judged = csv.writer(file, lineterminator="\n")
        judged.writerow([*FIELDS, "verdict of all models", "fails first", *TIMES.values(), *LEAST.values()])
        for part in parts:
            for each in part["models"]:
                keys = ("failed", "least")
                own = [each[key].get(name, "") for key in keys for name in TIMES] if "margin" in each else []
                fields = [each.get(field, "") for field in FIELDS]
                judged.writerow([*fields, part["verdict"], " and ".join(each.get("decides", [])), *own])
    with paths[2].open("w", newline="", encoding="utf-8") as file:
        lines = csv.writer(file, lineterminator="\n")
        lines.writerow(
            ["position", "test", "model", "frequency [Hz]", "acceleration [m/s2]", *TIMES.values(), *LEAST.values()]
        )
        for part in (each for tested in parts for each in tested["models"]):
            if part["kind"] == "sine" and "curves" in part:
                curves = part["curves"]
                none = [""] * len(curves["frequency"])
                both = [curves[key].get(name, none) for key in ("length", "least") for name in TIMES]
                for values in zip(curves["frequency"], curves["level"], *both, strict=True):
                    texts = [value if value == "" else f"{value:.9g}" for value in values]
                    lines.writerow([part["position"], part["test"], part["model"], *texts])
    return paths
