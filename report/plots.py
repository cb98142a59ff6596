"""The figures of the publication, drawn with the component."""

from collections.abc import Iterable

import numpy as np

from report import published as paper
from report.bench import bench
from report.figure import Curve, Figure
from report.publication import DRAWN, Publication
from report.published import BEST, FREQUENCIES
from report.spring import LINEAR

FREQUENCY, AMPLITUDE = "frequency / Hz", "amplitude of the contact force / cN"


def published(name: str, pairs: Iterable[tuple[float, float]], colour: int) -> list[Curve]:
    """Return published points, if there are any."""
    pairs = list(pairs)
    x, y = [pair[0] for pair in pairs], [pair[1] for pair in pairs]
    return [Curve(f"published, {name}", x, y, "points", colour)] if pairs else []


def figures(of: Publication) -> list[Figure]:
    """Return all figures."""
    return [
        fig5(of), *fig6(of), fig7(of), fig8(of), fig9(of), fig19(of), fig11(), fig16(of), fig18(of),
        elastic_figure(of), literal_figure(of),
    ]  # fmt: skip


def fig5(of: Publication) -> Figure:
    """Draw first frequency over overtravel."""
    curves = []
    for colour, length in enumerate(paper.LENGTHS):
        found = [of.frequency(length, overtravel) for overtravel in of.overtravels]
        curves.append(Curve(f"L = {length:g} mm", of.overtravels, found, "line", colour))
        known = [*paper.SHORT, (15.5, 0.2, paper.WITH_PRESTRESS)]
        own = [(each[1], each[2]) for each in known if each[0] == length]
        curves += published(f"{length:g} mm, with prestress", own, colour)
    curves += published("15.5 mm, without prestress", [(0.2, paper.WITHOUT_PRESTRESS)], 3)
    title = "First frequency over overtravel (Fig. 5)"
    return Figure("paper-fig5", title, "overtravel / mm", "first frequency / Hz", curves)


def fig6(of: Publication) -> list[Figure]:
    """Draw force and displacement over time at 1000 Hz."""
    run, rest = of.runs[BEST, 1000.0], 100 * of.rest("preload.force")
    time = np.arange(1, 3 * len(run.force) + 1) / len(run.force)
    found = []
    for name, label, values, middle, amplitude, known, own in (
        ("force", "contact force / cN", 100 * run.force, rest, paper.FORCE_AMPLITUDE,
         "amplitude, to which the rivet is fitted", "this model"),
        ("displacement", "displacement / µm", 1e6 * run.displacement, 0.0, paper.DISPLACEMENT, "amplitude",
         "this model, contact and base"),
    ):  # fmt: skip
        turning = [float(time[values.argmax()]), float(time[values.argmin()])]
        points = zip(turning, (middle + amplitude, middle - amplitude), strict=True)
        curves = [Curve(own, time, np.tile(values, 3)), *published(known, points, 0)]
        what = "Contact force" if name == "force" else "Displacement of the contact"
        title = f"{what} at 1000 Hz, 98 m/s² (Fig. 6)"
        found.append(Figure(f"paper-fig6-{name}", title, "time / ms", label, curves))
    return found


def fig7(of: Publication) -> Figure:
    """Draw force amplitude in the time domain."""
    curves = []
    for colour, ratio in enumerate(DRAWN):
        curves.append(of.curve(f"ratio {ratio:g}", ratio, colour))
        own = [(1000.0, paper.FORCE_AMPLITUDE)] if ratio == BEST else []
        own += [(at, peak) for known, at, peak in paper.PEAKS if known == ratio]
        curves += published(f"ratio {ratio:g}", own, colour)
    title = "Force amplitude over frequency, time domain, 98 m/s² (Fig. 7)"
    return Figure("paper-fig7", title, FREQUENCY, AMPLITUDE, curves)


def fig8(of: Publication) -> Figure:
    """Draw displacement amplitude in excess of the base."""
    curves = [Curve(f"this model, ratio {DRAWN[0]:g}", of.frequencies, of.excess(), "line", 6)]
    base = 1e6 * of.runs[BEST, 1000.0].base
    known = [(ratio, 1000.0, 100 * (value / base - 1)) for ratio, value in paper.DISPLACEMENTS.items()]
    known += [(ratio, 1250.0, excess) for ratio, excess in paper.DISPLACEMENT_DEVIATIONS]
    for colour, ratio in enumerate(DRAWN):
        own = [(frequency, excess) for each, frequency, excess in known if each == ratio]
        curves += published(f"ratio {ratio:g}", own, colour)
    title = "Displacement amplitude of the contact in excess of the base (Fig. 8)"
    return Figure("paper-fig8", title, FREQUENCY, "excess over the base / %", curves)


def fig9(of: Publication) -> Figure:
    """Draw force amplitude in the frequency domain."""
    curves = []
    for colour, alpha in enumerate(paper.ALPHAS):
        name = f"alpha = {alpha:g} 1/s"
        curves.append(Curve(name, LINEAR, of.spring(alpha=alpha).force(LINEAR), "line", colour))
        own = [(at, peak) for known, at, peak in paper.FREQUENCY_DOMAIN_PEAKS if known == alpha]
        curves += published(name, own, colour)
    title = "Force amplitude over frequency, frequency domain, 98 m/s² (Fig. 9)"
    return Figure("paper-fig9", title, FREQUENCY, AMPLITUDE, curves)


def fig19(of: Publication) -> Figure:
    """Draw time and frequency domain."""
    curves = []
    for colour, (ratio, alpha, _) in enumerate(paper.EQUIVALENT):
        curves.append(of.curve(f"time domain, ratio {ratio:g}", ratio, colour))
        name, response = f"frequency domain, alpha = {alpha:g} 1/s", of.spring(alpha=alpha).force(LINEAR)
        curves.append(Curve(name, LINEAR, response, "dashed", colour))
    title = "Force amplitude, time and frequency domain, 98 m/s² (Fig. 19)"
    return Figure("paper-fig19", title, FREQUENCY, AMPLITUDE, curves)


def fig11() -> Figure:
    """Draw resistance over force, by the component at rest with other overtravels."""
    overtravels = np.geomspace(1.4e-5, 1.4e-3, 41)
    curves: list[Curve] = []
    for name, kind, style in (("power law", "PowerLaw", "line"), ("Holm", "Holm", "dashed")):
        found = []
        for overtravel in overtravels:
            bench().contact.begin_anew({"effects.resistance": kind, "contact.overtravel": overtravel})
            found.append(bench().contact.real("contact.force", "contact.resistance"))
        forces, resistances = np.array(found).T
        curves.append(Curve(name, forces, 1e3 * resistances, style, len(curves)))  # type: ignore[arg-type]
    own = [(at, paper.resistance(at)) for at in (0.02, 0.05, 0.1, 0.152, 0.2, 0.5, 1.0)]
    curves += published("eq. 29, which the power law is", own, 0)
    title, y = "Contact resistance over contact force (Fig. 11)", "contact resistance / mΩ"
    return Figure("paper-fig11", title, "contact force / N", y, curves, log="xy")


def fig16(of: Publication) -> Figure:
    """Draw resistance over time at 1000 Hz."""
    run = of.runs[BEST, 1000.0]
    time = np.arange(1, 10 * len(run.resistance) + 1) / len(run.resistance)
    curves = [
        Curve("this model", time, np.tile(1e3 * run.resistance, 10)),
        Curve("measured, maximum", [0, 10], [paper.GREATEST_RESISTANCE] * 2, "dashed", 1),
        Curve("measured, minimum", [0, 10], [paper.LEAST_RESISTANCE] * 2, "dashed", 2),
    ]
    title = "Contact resistance at 1000 Hz, 98 m/s² (Fig. 16)"
    return Figure("paper-fig16", title, "time / ms", "contact resistance / mΩ", curves)


def fig18(of: Publication) -> Figure:
    """Draw deviation of the greatest resistance in the frequency domain."""
    known = [(5125.0, paper.FREQUENCY_DOMAIN_DEVIATION)]
    curves = [Curve("this model", *of.by_alpha), *published("5125 1/s", known, 0)]
    title = "Deviation of the maximum resistance from the measurement, frequency domain, 1000 Hz (Fig. 18)"
    return Figure("paper-fig18", title, "mass coefficient / (1/s)", "magnitude of the deviation / %", curves)


def elastic_figure(of: Publication) -> Figure:
    """Draw total force as fitted, and the elastic part fitted to the same amplitudes."""
    curves = []
    for colour, (ratio, at, highest) in enumerate(paper.PEAKS):
        name, refitted = f"elastic part, parameters refitted, ratio {ratio:g}", of.refitted.of_ratio(ratio)
        curves.append(Curve(name, LINEAR, refitted.elastic(LINEAR), "line", colour))
        whole = of.spring(ratio).force(LINEAR)
        curves.append(Curve(f"total force, ratio {ratio:g}", LINEAR, whole, "dashed", colour))
        own = [(1000.0, paper.FORCE_AMPLITUDE)] if ratio == BEST else []
        curves += published(f"ratio {ratio:g}", [*own, (at, highest)], colour)
    title = "Force amplitude, if the publication shows the elastic part"
    return Figure("not-reproduced-elastic", title, FREQUENCY, AMPLITUDE, curves)


def literal_figure(of: Publication) -> Figure:
    """Draw the published stiffness coefficient as printed."""
    printed = [run.amplitude for run in of.literal]
    own = [(1000.0, paper.FORCE_AMPLITUDE), paper.PEAKS[0][1:]]
    curves = [
        Curve("beta as printed", FREQUENCIES, printed, "dashed", 1),
        of.curve("beta / 4 π²", BEST, 0),
        *published("ratio 10", own, 0),
    ]
    title = "The published beta as printed, and divided by 4 π²"
    return Figure("finding-beta", title, FREQUENCY, AMPLITUDE, curves)
