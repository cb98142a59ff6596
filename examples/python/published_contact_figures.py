"""Figures of published_contact.py."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from common import save
from relay_contact import Array, Values
from relay_contact.figures import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, RED, SKY

if TYPE_CHECKING:
    from published_contact import Bench, Fit, Number

LENGTHS = (7.5, 11.5, 15.5)  # mm
ROUGHNESS = 12.84e-6  # m, published (section 3.3)
FORCES = np.geomspace(0.02, 3, 50)  # N
STYLES = {"Hertz": "--", "support": ":", "Rough": "-"}
LABELS = {"Hertz": "smooth spheres (Hertz)", "support": "support that yields", "Rough": "rough contact"}
COLOURS = {250: GREEN, 750: ORANGE, 1000: BLUE, 1250: PURPLE}  # by frequency, Hz

Contacts = Mapping[str, Values]
"""Values of the component by the name of the contact."""
Points = dict[int, list[tuple[float, float]]]
"""Damping ratio and value, by frequency (Hz)."""


def panels(count: int, title: str) -> tuple[Figure, list[Axes]]:
    """Return a figure with panels side by side."""
    figure, axes = plt.subplots(1, count, figsize=(5.5 * count if count > 1 else 7, 4.6), layout="constrained")
    figure.suptitle(title, fontsize="medium")
    return figure, list(np.atleast_1d(axes))


def finish(axes: Axes) -> None:
    """Give a panel its grid and legend."""
    axes.grid(alpha=0.3)
    axes.legend(fontsize="small", frameon=False)


def frequencies(bench: "Bench", contacts: Contacts, numbers: "list[Number]", quick: bool) -> Figure:
    """Draw the first frequency over overtravel for three lengths."""
    figure, (axes,) = panels(1, "First natural frequency of three springs")
    overtravels = np.linspace(0.05, 0.5, 4 if quick else 30)
    colours = {"Hertz": GREY, "support": ORANGE, "Rough": BLUE}
    for name, stroke in STYLES.items():
        for length in LENGTHS:
            found = [
                bench.rest(
                    {**contacts[name], "beam.length": 1e-3 * length, "contact.overtravel": 1e-3 * each},
                    "preload.frequency",
                )
                for each in overtravels
            ]
            label = LABELS[name] if length == LENGTHS[0] else None
            axes.plot(overtravels, found, stroke, color=colours[name], label=label)
            if name == "Rough":
                at = (float(overtravels[0]), found[0])
                axes.annotate(
                    f"{length:g} mm", at, (-4, 0), textcoords="offset points", ha="right", va="center", fontsize="small"
                )
    for kind, fill, label in (
        ("natural", "full", "published, prestressed"),
        ("stiff", "none", "published, not prestressed"),
    ):
        own = [each for each in numbers if each.kind == kind]
        places, values = [each.place["overtravel"] for each in own], [each.published for each in own]
        axes.plot(places, values, "o", color=RED, fillstyle=fill, label=label)
    axes.set(xlabel="overtravel [mm]", ylabel="first natural frequency [Hz]", xlim=(-0.03, 0.52), ylim=(0, 7800))
    finish(axes)
    axes.legend(fontsize="small", frameon=False, ncols=2, loc="upper left")
    return figure


def curves(axes: Axes, responses: Mapping[tuple[str, int], Array], ratios: Array, row: int, points: Points) -> None:
    """Draw a row of the responses over the damping ratio, and published points, by frequency."""
    for frequency, own in points.items():
        for name in ("Hertz", "Rough"):
            label = f"{frequency} Hz" if name == "Rough" else None
            axes.plot(ratios, responses[name, frequency][row], STYLES[name], color=COLOURS[frequency], label=label)
        axes.plot(*zip(*own, strict=True), "o", color=COLOURS[frequency], markeredgecolor=BLACK)
    axes.set_xscale("log")
    axes.xaxis.set_major_formatter("{x:g}")


def force_panel(axes: Axes, responses: Mapping[tuple[str, int], Array], ratios: Array, numbers: "list[Number]") -> None:
    """Draw the force amplitude over the damping ratio at four frequencies."""
    points: Points = {frequency: [] for frequency in COLOURS}
    for each in numbers:
        if each.kind == "force":
            points[int(each.place["frequency"])].append((each.place["ratio"], each.published))
    curves(axes, responses, ratios, 0, points)
    axes.set(xlabel="damping ratio", ylabel="amplitude of the elastic force [cN]", ylim=(0, 12))
    finish(axes)


def travel_panel(
    axes: Axes, responses: Mapping[tuple[str, int], Array], ratios: Array, numbers: "list[Number]"
) -> None:
    """Draw the displacement amplitude over that of the base."""
    base = 1e6 * 98 / (2 * np.pi * 1000) ** 2
    points: Points = {1000: [], 1250: []}
    for each in numbers:
        if each.kind == "displacement" and "measured" not in each.quantity:
            value = each.published / (base if each.unit else 1)
            points[int(each.place["frequency"])].append((each.place["ratio"], value))
    curves(axes, responses, ratios, 1, points)
    measured = next(each.published for each in numbers if each.kind == "displacement" and "measured" in each.quantity)
    axes.axhline(measured / base, color=GREY, linestyle="-.", linewidth=1, label="measured, 1000 Hz")
    axes.plot([], [], "o", color="white", markeredgecolor=BLACK, label="published")
    axes.plot([], [], "-", color=BLACK, label=LABELS["Rough"])
    axes.plot([], [], "--", color=BLACK, label=LABELS["Hertz"])
    axes.set(xlabel="damping ratio", ylabel="amplitude of the contact's displacement\nover that of the base")
    axes.set_ylim(0.9, 2.8)
    finish(axes)
    axes.legend(fontsize="small", frameon=False, loc="upper center", bbox_to_anchor=(0.4, 1.0))


def amplitudes(bench: "Bench", contacts: Contacts, numbers: "list[Number]", quick: bool) -> Figure:
    """Draw amplitudes over the damping ratio; what opens is left out."""
    figure, (left, right) = panels(2, "98 m/s², steady")
    ratios = np.geomspace(0.1, 40, 4 if quick else 25)
    responses = {}
    for name in ("Hertz", "Rough"):
        for frequency in COLOURS:
            curve = np.full((2, len(ratios)), np.nan)
            for at in range(len(ratios))[::-1]:
                period = bench.steady(contacts[name], float(ratios[at]), float(frequency))
                if period.force.min() <= 0:
                    break
                curve[:, at] = 100 * period.amplitude, period.travel
            responses[name, frequency] = curve
    force_panel(left, responses, ratios, numbers)
    travel_panel(right, responses, ratios, numbers)
    return figure


def stiffness(bench: "Bench", contacts: Contacts, rough: "Fit") -> Figure:
    """Draw the tangent stiffness over the force."""
    figure, (axes,) = panels(1, "Stiffness of the contact")
    at, exponent = rough.free[-2:]
    logarithm = np.log(FORCES / 0.152)
    own = rough.covariance[-2:, -2:]
    # Of the exponent the covariance is that of its logarithm.
    slopes = np.array([np.ones_like(logarithm), exponent * logarithm])
    half = rough.half(np.sqrt(np.einsum("if,ij,jf->f", slopes, own, slopes)))
    curve = at * (FORCES / 0.152) ** exponent
    axes.plot(FORCES, curve, color=BLUE, label="fitted: rough contact, 95 %")
    axes.fill_between(FORCES, curve * np.exp(-half), curve * np.exp(half), color=BLUE, alpha=0.15, lw=0)
    hertz = bench.rest(contacts["Hertz"], "preload.contactStiffness")
    axes.plot(FORCES, hertz * (FORCES / 0.152) ** (1 / 3), "--", color=GREY, label="smooth spheres (Hertz)")
    support = bench.rest(contacts["support"], "preload.contactStiffness")
    axes.axhline(support, color=ORANGE, linestyle=":", label="fitted: support that yields")
    # Barber: resistance times stiffness is the same for all contacts of these materials.
    barber = {**contacts["Rough"], "effects.resistance": "Barber"}
    product = bench.rest(barber, "contact.resistance") * bench.rest(barber, "preload.contactStiffness")
    axes.plot(FORCES, product / (7.4118e-3 * FORCES**-0.9515), "-.", color=RED, label="published resistance, by Barber")
    axes.fill_between(
        FORCES, FORCES / ROUGHNESS, FORCES / (0.4 * ROUGHNESS), color=GREEN, alpha=0.25, lw=0,
        label="published roughness h: F/h to F/0.4h",
    )  # fmt: skip
    for length, overtravel in ((15.5, 0.2), (11.5, 0.5), (7.5, 0.25)):
        spring: Values = {"beam.length": 1e-3 * length, "contact.overtravel": 1e-3 * overtravel}
        force = bench.rest({**contacts["Rough"], **spring}, "preload.force")
        axes.axvline(force, color=SKY, linewidth=0.8)
        axes.annotate(
            f"{length:g} mm ", (force, 1.1e3), rotation=90, ha="right", va="bottom", fontsize="small", color=GREY
        )
    axes.set(xscale="log", yscale="log", xlabel="contact force [N]", ylabel="tangent stiffness [N/m]", ylim=(1e3, 3e7))
    axes.xaxis.set_major_formatter("{x:g}")
    finish(axes)
    axes.legend(fontsize="small", frameon=False, loc="upper left", ncols=2)
    return figure


def draw(
    folder: Path, bench: "Bench", contacts: Contacts, fits: "list[Fit]", numbers: "list[Number]", quick: bool
) -> list[Path]:
    """Draw all figures; return their files."""
    rough = next(each for each in fits if each.law.name == "Rough")
    drawn = {
        "frequency": frequencies(bench, contacts, numbers, quick),
        "amplitude": amplitudes(bench, contacts, numbers, quick),
        "stiffness": stiffness(bench, contacts, rough),
    }
    paths = []
    for name, figure in drawn.items():
        paths.append(folder / f"published-contact-{name}.png")
        save(figure, paths[-1], 110)
    return paths
