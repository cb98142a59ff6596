"""Figures of the fit to the published numbers."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from relay_contact import Values
from relay_contact.figures import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, RED, SKY
from report.bench import Bench, damped
from report.files import DOCS
from report.fit import ALONE, Fit
from report.published import ACCELERATION, EXPONENT, FORCE, LENGTHS, RESISTANCE, ROUGHNESS, Number

FORCES = np.geomspace(0.02, 3, 50)  # N
STYLES = {"Hertz": "--", "support": ":", "Rough": "-"}
LABELS = {"Hertz": "smooth spheres (Hertz)", "support": "support that yields", "Rough": "rough contact"}
COLOURS = {250: GREEN, 750: ORANGE, 1000: BLUE, 1250: PURPLE}  # by frequency, Hz

Contacts = Mapping[str, Values]
"""Values of the component by the name of the contact."""


def panels(count: int, title: str) -> tuple[Figure, list[Axes]]:
    """Return a figure with panels side by side."""
    figure = Figure(figsize=(5.5 * count if count > 1 else 7, 4.6), layout="constrained")
    figure.suptitle(title, fontsize="medium")
    axes = list(np.atleast_1d(figure.subplots(1, count)))
    for each in axes:
        each.grid(alpha=0.3)
    return figure, axes


def frequencies(bench: Bench, contacts: Contacts, numbers: list[Number]) -> Figure:
    """Draw the first frequency over overtravel for three lengths."""
    figure, (axes,) = panels(1, "First natural frequency of three springs")
    overtravels = np.linspace(0.05, 0.5, 30)
    colours = {"Hertz": GREY, "support": ORANGE, "Rough": BLUE}
    for name, stroke in STYLES.items():
        for length in LENGTHS:
            springs = [{"beam.length": 1e-3 * length, "contact.overtravel": 1e-3 * each} for each in overtravels]
            found = [bench.rest({**ALONE, **contacts[name], **each}, "preload.frequency") for each in springs]
            label = LABELS[name] if length == LENGTHS[0] else None
            axes.plot(overtravels, found, stroke, color=colours[name], label=label)
            if name == "Rough":
                axes.annotate(
                    f"{length:g} mm", (float(overtravels[0]), found[0]), (-4, 0), textcoords="offset points",
                    ha="right", va="center", fontsize="small",
                )  # fmt: skip
    for kind, fill, label in (("natural", "full", "published, prestressed"),
                              ("stiff", "none", "published, not prestressed")):  # fmt: skip
        own = [each for each in numbers if each.kind == kind]
        places, values = [each.overtravel for each in own], [each.published for each in own]
        axes.plot(places, values, "o", color=RED, fillstyle=fill, label=label)
    axes.set(xlabel="overtravel [mm]", ylabel="first natural frequency [Hz]", xlim=(-0.03, 0.52), ylim=(0, 7800))
    axes.legend(fontsize="small", frameon=False, ncols=2, loc="upper left")
    return figure


def amplitudes(bench: Bench, contacts: Contacts, numbers: list[Number]) -> Figure:
    """Draw amplitudes of force and displacement over the damping ratio; what opens is left out."""
    figure, (left, right) = panels(2, "98 m/s², steady")
    ratios = np.geomspace(0.1, 40, 25)
    base = 1e6 * ACCELERATION / (2 * np.pi * 1000) ** 2
    for frequency, colour in COLOURS.items():
        for name in ("Hertz", "Rough"):
            curve = np.full((2, len(ratios)), np.nan)
            for at in range(len(ratios))[::-1]:
                period = bench.vibrate(damped({**ALONE, **contacts[name]}, float(ratios[at])), float(frequency))
                if period.least <= 0:
                    break
                curve[:, at] = period.elastic_amplitude, period.travel
            label = f"{frequency} Hz" if name == "Rough" else None
            left.plot(ratios, curve[0], STYLES[name], color=colour, label=label)
            if frequency >= 1000:
                right.plot(ratios, curve[1], STYLES[name], color=colour, label=label)
        for axes, kind in ((left, "force"), (right, "displacement")):
            own = [each for each in numbers if each.kind == kind and each.frequency == frequency
                   and "measured" not in each.quantity]  # fmt: skip
            scaled = [each.published / (base if kind == "displacement" and each.unit else 1) for each in own]
            axes.plot([each.ratio for each in own], scaled, "o", color=colour, markeredgecolor=BLACK)
    measured = next(each.published for each in numbers if each.kind == "displacement" and "measured" in each.quantity)
    right.axhline(measured / base, color=GREY, linestyle="-.", linewidth=1, label="measured, 1000 Hz")
    right.plot([], [], "o", color="white", markeredgecolor=BLACK, label="published")
    right.plot([], [], "-", color=BLACK, label=LABELS["Rough"])
    right.plot([], [], "--", color=BLACK, label=LABELS["Hertz"])
    left.set(ylabel="amplitude of the elastic force [cN]", ylim=(0, 12))
    right.set(ylabel="amplitude of the contact's displacement\nover that of the base", ylim=(0.9, 2.8))
    for axes in (left, right):
        axes.set(xlabel="damping ratio", xscale="log")
        axes.xaxis.set_major_formatter("{x:g}")
    left.legend(fontsize="small", frameon=False)
    right.legend(fontsize="small", frameon=False, loc="upper center", bbox_to_anchor=(0.4, 1.0))
    return figure


def stiffness(bench: Bench, contacts: Contacts, rough: Fit) -> Figure:
    """Draw the tangent stiffness over the force."""
    figure, (axes,) = panels(1, "Stiffness of the contact")

    def rest(contact: str, output: str, more: Values) -> float:
        return bench.rest({**ALONE, **contacts[contact], **more}, output)

    at, exponent = rough.free[-2:]
    logarithm = np.log(FORCES / FORCE)
    own = rough.covariance[-2:, -2:]
    # Of the exponent the covariance is that of its logarithm.
    slopes = np.array([np.ones_like(logarithm), exponent * logarithm])
    half = rough.half(np.sqrt(np.einsum("if,ij,jf->f", slopes, own, slopes)))
    curve = at * (FORCES / FORCE) ** exponent
    axes.plot(FORCES, curve, color=BLUE, label="fitted: rough contact, 95 %")
    axes.fill_between(FORCES, curve * np.exp(-half), curve * np.exp(half), color=BLUE, alpha=0.15, lw=0)
    hertz = rest("Hertz", "preload.contactStiffness", {})
    axes.plot(FORCES, hertz * (FORCES / FORCE) ** (1 / 3), "--", color=GREY, label="smooth spheres (Hertz)")
    support = rest("support", "preload.contactStiffness", {})
    axes.axhline(support, color=ORANGE, linestyle=":", label="fitted: support that yields")
    # Barber: resistance times stiffness is the same for all contacts of these materials.
    barber: Values = {"effects.resistance": "Barber"}
    product = rest("Rough", "contact.resistance", barber) * rest("Rough", "preload.contactStiffness", barber)
    published = 1e-3 * RESISTANCE * FORCES**-EXPONENT
    axes.plot(FORCES, product / published, "-.", color=RED, label="published resistance, by Barber")
    axes.fill_between(
        FORCES, FORCES / ROUGHNESS, FORCES / (0.4 * ROUGHNESS), color=GREEN, alpha=0.25, lw=0,
        label="published roughness h: F/h to F/0.4h",
    )  # fmt: skip
    for length, overtravel in ((15.5, 0.2), (11.5, 0.5), (7.5, 0.25)):
        spring: Values = {"beam.length": 1e-3 * length, "contact.overtravel": 1e-3 * overtravel}
        force = rest("Rough", "preload.force", spring)
        axes.axvline(force, color=SKY, linewidth=0.8)
        place = force, 1.1e3
        axes.annotate(f"{length:g} mm ", place, rotation=90, ha="right", va="bottom", fontsize="small", color=GREY)
    axes.set(xscale="log", yscale="log", xlabel="contact force [N]", ylabel="tangent stiffness [N/m]", ylim=(1e3, 3e7))
    axes.xaxis.set_major_formatter("{x:g}")
    axes.legend(fontsize="small", frameon=False, loc="upper left", ncols=2)
    return figure


def draw(bench: Bench, contacts: Contacts, fits: list[Fit], numbers: list[Number]) -> list[Path]:
    """Draw all figures; return their files."""
    rough = next(each for each in fits if each.law.name == "Rough")
    drawn = {
        "frequency": frequencies(bench, contacts, numbers),
        "amplitude": amplitudes(bench, contacts, numbers),
        "stiffness": stiffness(bench, contacts, rough),
    }
    paths = []
    for name, figure in drawn.items():
        paths.append(DOCS / f"published-contact-{name}.png")
        figure.savefig(paths[-1], dpi=110)
    return paths
