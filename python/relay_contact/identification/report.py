"""The results of an identification as a table, a page and a figure: measured and fitted values, and what is left."""

import csv
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from relay_contact import pages
from relay_contact.component import SIGNS, Array, Component, Unit, units
from relay_contact.figures import BLACK, BLUE, GREY, RED, save
from relay_contact.files import at_once, write_at_once
from relay_contact.identification import relay_file
from relay_contact.identification.fit import Set
from relay_contact.identification.measurement import BOUNCE, COLUMNS, FORCE, FREQUENCY, RELATIVE, RINGDOWN
from relay_contact.identification.result import Found, Identification
from relay_contact.spring import PREFIX

FILES = ("identification.html", "identification.png", "identification.csv")
HEAD = ("parameter", "in the file", "identified", "95 % interval", "±")
OVER = {
    FORCE: ("travel from the working position [mm]", 1e3),
    FREQUENCY: ("overtravel [mm]", 1e3),
    RINGDOWN: ("time [ms]", 1e3),
    BOUNCE: ("speed of closing [mm/s]", 1e3),
}
OVER_FREQUENCY = ("frequency [Hz]", 1.0)
DECADE = 6.0  # ratio of largest to least value from which on there is no room for labels between powers of ten
DENSE = 300  # values from which on points are drawn smaller


def shown(component: Component, found: Found) -> tuple[str, str, str, str]:
    """Return value in the file, identified value, interval and uncertainty, in words."""
    unknown = found.unknown
    factor = Unit("", "\N{MULTIPLICATION SIGN} file")
    unit = factor if unknown.name.startswith(PREFIX) else units(component.description).get(unknown.name, Unit("", ""))
    low, high = found.interval
    digits = max(3, 2 - int(np.floor(np.log10(max(found.half, 1e-9)))))

    def told(value: float) -> str:
        return unit.text(float(f"{value:.{digits}g}")).strip()

    part = f"{100 * found.half:.2g}\N{NO-BREAK SPACE}%"
    return unit.text(unknown.start).strip(), told(found.value), f"{told(low)} to {told(high)}", part


def cells(component: Component, result: Identification) -> list[list[str]]:
    """Return the rows of the table."""
    rows = [[each.unknown.label, *shown(component, each)] for each in result.found]
    return rows + [[label, "", "not determined", "", ""] for label in result.missing]


def data(result: Identification) -> list[list[str]]:
    """Return what is to be said of each measurement."""
    rows = []
    for each in result.sets:
        relative = each.measurement.kind in RELATIVE
        scatter = f"{100 * each.sigma:.2g} % of {'the value' if relative else 'the largest'}"
        state = "open" if each.measurement.is_open else "closed"
        own = each.measurement
        rows.append([own.kind, own.path.name, own.position, state, str(len(own.values)), scatter])
    return rows


def silent(result: Identification) -> list[str]:
    """Return what the data do not tell, and other remarks."""
    told = [f"{label}: not determined: {reason}." for label, reason in result.missing.items()]
    for each in result.found:
        most = sorted(each.by_others.items(), key=lambda item: -item[1])[:2]
        words = " and ".join(f"{name} {100 * part:.2g} %" for name, part in most if part > 0.3 * each.half)
        if words:
            told.append(f"{each.unknown.label}: of its interval, {words} comes from what the file says of these.")
    return told + [f"{note}." for note in result.notes]


def matrix(result: Identification) -> pages.Table:
    """Return the correlations as a table."""
    labels = [each.unknown.label for each in result.found]
    rows = [
        [label, *(f"{result.correlation[i, j]:+.3f}" if j < i else "" for j in range(len(labels) - 1))]
        for i, label in enumerate(labels) if i
    ]  # fmt: skip
    return ["", *labels[:-1]], rows


def panels(axes: Axes, below: Axes, each: Set, model: Array, curve: tuple[Array, Array]) -> None:
    """Draw a measurement with the fitted curve, and the residuals below it."""
    measurement = each.measurement
    label, factor = OVER.get(measurement.kind, OVER_FREQUENCY)
    first = measurement.over[0] if measurement.kind == RINGDOWN else 0.0
    over = factor * (measurement.over - first)
    scale = COLUMNS[measurement.quantity][measurement.unit]
    size = 2.5 if len(over) < DENSE else 1.0
    axes.plot(over, measurement.values / scale, "o", color=BLUE, markersize=size, label="measured")
    axes.plot(factor * (curve[0] - first), curve[1] / scale, color=RED, linewidth=1.0, label="fitted")
    unit = SIGNS.get(measurement.unit, measurement.unit)
    if measurement.kind in RELATIVE:
        axes.set_yscale("log")
        axes.yaxis.set_major_formatter("{x:g}")
        axes.yaxis.set_minor_formatter("{x:g}" if np.ptp(np.log(model)) < np.log(DECADE) else NullFormatter())
    state = "spring off its contact" if measurement.is_open else measurement.position
    axes.set(ylabel=f"{measurement.quantity} [{unit}]", title=f"{measurement.kind}: {measurement.path.name}, {state}")
    axes.legend(loc="best")
    axes.tick_params(labelbottom=False)
    below.plot(over, 100 * each.differences(model), "o", color=BLACK, markersize=size)
    for line in (-2, 0, 2):
        below.axhline(100 * line * each.sigma, color=GREY, linewidth=0.6, linestyle="-" if line == 0 else ":")
    relative = "value" if measurement.kind in RELATIVE else "largest"
    below.set(xlabel=label, ylabel=f"residual\n[% of {relative}]")


def draw(result: Identification) -> Figure:
    """Draw all measurements."""
    columns = min(2, len(result.sets))
    rows = -(-len(result.sets) // columns)
    figure = Figure(figsize=(5.2 * columns, 3.5 * rows), layout="constrained")
    figure.set_layout_engine("constrained", h_pad=0.08)
    grid = figure.subplots(2 * rows, columns, squeeze=False, height_ratios=[2.2, 1] * rows)
    for number in range(rows * columns):
        row, column = divmod(number, columns)
        pair = grid[2 * row, column], grid[2 * row + 1, column]
        if number < len(result.sets):
            pair[1].sharex(pair[0])
            panels(*pair, result.sets[number], result.fitted[number], result.curves[number])
        else:
            for axes in pair:
                axes.axis("off")
    figure.align_ylabels()
    return figure


def write(folder: Path, result: Identification, component: Component) -> None:
    """Write the relay's file, page, figure and table."""
    folder.mkdir(parents=True, exist_ok=True)
    with mpl.rc_context(pages.STYLE):
        figure = draw(result)
        save(figure, folder / FILES[1])
        page = pages.render(
            "identification.html", title=f"{result.relay.title}, identified", found=(HEAD, cells(component, result)),
            remarks=silent(result), figure=pages.svg(figure), component=component.description.guid,
            data=(("measurement", "file", "position", "contact", "values", "scatter (rms)"), data(result)),
            correlations=matrix(result) if len(result.found) > 1 else None,
        )  # fmt: skip
    write_at_once(folder / FILES[0], page)
    with at_once(folder / FILES[2]) as part, part.open("w", newline="", encoding="utf-8") as file:
        lines_ = csv.writer(file, lineterminator="\n")
        lines_.writerow(["parameter", "in the file (SI)", "identified (SI)", "low", "high"])
        for each in result.found:
            numbers = (each.unknown.start, each.value, *each.interval)
            lines_.writerow([each.unknown.label, *(f"{number:.9g}" for number in numbers)])
        lines_.writerows([label, "", "not determined", "", ""] for label in result.missing)
    relay_file.write(folder, result, component)
