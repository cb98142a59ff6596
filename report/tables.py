"""Tables of published values beside those of the component."""

from collections.abc import Callable

import numpy as np

from report import published as paper
from report.bench import bench, specimen
from report.publication import Publication, base, deviations, resistance
from report.published import BEST, FORCE, FREQUENCIES, RATIOS
from report.spring import LINEAR, Spring
from report.text import number, percent, signed, table

COLUMNS = ("quantity", "published", "this model", "deviation", "location in the publication")
Row = list[str]


def row(quantity: str, published: float, value: float, digits: int, unit: str, place: str) -> Row:
    """Return a row with the relative deviation."""
    texts = f"{published:g} {unit}".strip(), f"{number(value, digits)} {unit}".strip()
    return [quantity, *texts, percent(value / published), place]


def difference(quantity: str, published: float, value: float, digits: int, unit: str, place: str) -> Row:
    """Return a row with the difference."""
    texts = f"{published:g} {unit}", f"{number(value, digits)} {unit}"
    return [quantity, *texts, f"{signed(value - published, digits)} {unit}", place]


def points(quantity: str, published: float, value: float, digits: int, place: str) -> Row:
    """Return a row of percentages with the difference of their magnitudes."""
    texts = f"{published:g} %", f"{signed(value, 2)} %"
    return [quantity, *texts, f"{signed(abs(value) - abs(published), digits)} points", place]


def misfit(extremes: Callable[[float], tuple[float, float]]) -> float:
    """Return the summed differences from the deviations of Table 6 where the force has extremes by ratio."""
    total = 0.0
    for ratio, least, greatest in paper.RESISTANCE_DEVIATIONS:
        found = deviations(*extremes(ratio))
        total += abs(abs(found[0]) - least) + abs(abs(found[1]) - greatest)
    return total


def statics(of: Publication) -> str:
    """Return static force, stiffness, frequencies."""
    at = "section 3.1"
    frequency = of.rest("preload.frequency")
    without = of.rest("preload.frequency", effects_axialForce="None")
    stiffness = 1e-6 * of.rest("preload.contactStiffness")
    rows = [
        row("static contact force F_0 †", FORCE, of.rest("preload.force"), 4, "N", at),
        row("contact stiffness k_j †", 1e-6 * paper.STIFFNESS, stiffness, 4, "N/µm", at),
        row("first frequency, without prestress", paper.WITHOUT_PRESTRESS, without, 1, "Hz", at),
        row("first frequency, with prestress †", paper.WITH_PRESTRESS, frequency, 1, "Hz", f"{at}, Fig. 4"),
    ]
    for length, overtravel, known in paper.SHORT:
        name = f"first frequency, L = {length:g} mm, s = {overtravel:g} mm, with prestress"
        rows.append(row(name, known, of.frequency(length, overtravel), 1, "Hz", f"{at}, Fig. 5"))
    return table(COLUMNS, rows)


def time_domain(of: Publication) -> str:
    """Return force and displacement in the time domain."""
    run, at = of.runs[BEST, 1000.0], "section 3.2, Fig. 6"
    name = "displacement amplitude of the contact, 1000 Hz, ratio 10, relative to that of the base"
    rows = [
        row("force amplitude, 1000 Hz, ratio 10 †", paper.FORCE_AMPLITUDE, run.amplitude, 3, "cN", at),
        difference("phase between force and displacement, 1000 Hz, ratio 10", paper.PHASE, run.phase, 1, "°", at),
        row(name, paper.DISPLACEMENT_RATIO, run.travel, 3, "", at),
    ]
    for ratio, place, known in paper.PEAKS:
        highest, found = of.peak(ratio)
        at, name = "section 3.2, Fig. 7", f"frequency of the maximum in the grid, ratio {ratio:g}"
        rows.append(row(f"maximum force amplitude, ratio {ratio:g}", known, highest, 2, "cN", at))
        rows.append(difference(name, place, found, 0, "Hz", at))
    return table(COLUMNS, rows)


def grid(of: Publication) -> str:
    """Return the whole excitation grid."""
    rows = []
    for frequency in FREQUENCIES:
        runs = [of.runs[ratio, frequency] for ratio in RATIOS]
        opens = [run.least <= 0 or not run.repeats for run in runs]
        cells = ["opens" if each else number(run.amplitude, 3) for run, each in zip(runs, opens, strict=True)]
        rows.append([f"{frequency:g} Hz", *cells])
    return table(["frequency", *(f"ratio {ratio:g}" for ratio in RATIOS)], rows)


def displacements(of: Publication) -> str:
    """Return displacement amplitudes over the damping ratio."""
    rows = []
    for ratio, known in zip(RATIOS, paper.DISPLACEMENTS, strict=True):
        value = 1e6 * base(1000.0) * of.runs[ratio, 1000.0].travel
        rows.append(row(f"displacement amplitude, 1000 Hz, ratio {ratio:g}", known, value, 3, "µm", "Table 4"))
    value = 1e6 * base(1000.0) * of.runs[BEST, 1000.0].travel
    name, at = "measured amplitude, compared with ratio 10", "section 4.2, Fig. 14"
    rows.append(row(name, paper.MEASURED_DISPLACEMENT, value, 3, "µm", at))
    for ratio, known in paper.DISPLACEMENT_DEVIATIONS:
        value = 100 * (of.runs[ratio, 1250.0].travel - 1)
        name = f"displacement amplitude in excess of the base, 1250 Hz, ratio {ratio:g}"
        texts = f"{known:g} %", f"{number(value, 2)} %", f"{signed(value - known, 1)} points"
        rows.append([name, *texts, "section 3.2, Fig. 8"])
    return table(COLUMNS, rows)


def frequency_domain(of: Publication) -> str:
    """Return peaks in the frequency domain."""
    rows = []
    for alpha, place, known in paper.FREQUENCY_DOMAIN_PEAKS:
        response, at = of.spring(alpha=alpha).force(LINEAR), "section 3.2, Fig. 9"
        highest = int(response.argmax())
        name = f"alpha = {alpha:g} 1/s"
        rows.append(row(f"maximum force amplitude, {name}", known, float(response[highest]), 2, "cN", at))
        rows.append(difference(f"frequency of the maximum, {name}", place, float(LINEAR[highest]), 0, "Hz", at))
    return table(COLUMNS, rows)


def domains(of: Publication) -> str:
    """Return frequency domain compared with time domain."""
    rows = []
    grid = np.array(FREQUENCIES)
    for ratio, alpha, known in paper.EQUIVALENT:
        linear, spring = of.spring(alpha=alpha).force(grid), of.spring(ratio)
        bench().contact.begin_anew(specimen(of.component, ratio) | {"contact.damping": 0.0})
        bare = Spring.of(bench().contact)
        whole = np.array([of.runs[ratio, frequency].amplitude for frequency in FREQUENCIES])
        apart = [np.abs(linear / each - 1) for each in (whole, bare.force(grid), spring.elastic(grid))]
        worst = [float(each.max()) for each in apart] + [float(apart[-1][grid <= 1500].max())]
        name = f"alpha = {alpha:g} 1/s and ratio {ratio:g}"
        rows.append([name, known, *(f"{number(100 * each, 1)} %" for each in worst)])
    columns = ["damping", "published (section 4.2, Fig. 19)", "this model", "this model, without contact damping",
               "this model, elastic part", "elastic part, up to 1500 Hz"]  # fmt: skip
    return table(columns, rows)


def resistances(of: Publication) -> str:
    """Return contact resistance."""
    run, at = of.runs[BEST, 1000.0], "section 4.2, Fig. 16"
    low, high = resistance(run.greatest), resistance(run.least)
    rows = [
        row("minimum resistance, 1000 Hz, measured", paper.LEAST_RESISTANCE, low, 2, "mΩ", at),
        row("maximum resistance, 1000 Hz, measured", paper.GREATEST_RESISTANCE, high, 2, "mΩ", at),
    ]
    for ratio, least, greatest in paper.RESISTANCE_DEVIATIONS:
        run = of.runs[ratio, 1000.0]
        found, name = deviations(run.least, run.greatest), f"resistance from measurement, ratio {ratio:g}"
        rows.append(points(f"deviation of maximum {name}", greatest, found[1], 2, "Table 6"))
        rows.append(points(f"deviation of minimum {name}", least, found[0], 2, "Table 6"))
    name = "deviation of maximum resistance from measurement, alpha = 5125 1/s, 1000 Hz"
    known, value = paper.FREQUENCY_DOMAIN_DEVIATION, of.weakest_resistance(5125.0)
    rows.append(points(name, known, value, 2, "section 4.2, Fig. 18"))
    return table(COLUMNS, rows)


def peaks(of: Publication) -> str:
    """Return greatest force amplitudes, total and elastic."""
    rows, grid = [], np.array(FREQUENCIES)
    for ratio, place, known in paper.PEAKS:
        amplitude, at = of.peak(ratio)
        found = [(amplitude, at)]
        for elastic in (of.spring(ratio).elastic(grid), of.refitted.of_ratio(ratio).elastic(grid)):
            found.append((float(elastic.max()), float(grid[elastic.argmax()])))
        cells = [f"{number(value, 2)} cN at {at:g} Hz, {percent(value / known)}" for value, at in found]
        rows.append([f"{ratio:g}", f"{known:g} cN near {place:g} Hz", *cells])
    columns = ["ratio", "published", "this model, total force", "this model, elastic part",
               "elastic part, parameters refitted"]  # fmt: skip
    return table(columns, rows)


def misfits(of: Publication) -> list[float]:
    """Return the misfits of Table 6: of the total force, of its elastic part, and of that refitted."""
    rest = of.rest("preload.force")

    def about(spring: Spring) -> tuple[float, float]:
        amplitude = float(spring.elastic(1000.0)[0]) / 100
        return rest - amplitude, rest + amplitude

    return [
        misfit(lambda ratio: (of.runs[ratio, 1000.0].least, of.runs[ratio, 1000.0].greatest)),
        misfit(lambda ratio: about(of.spring(ratio))),
        misfit(lambda ratio: about(of.refitted.of_ratio(ratio))),
    ]
