"""Figures of the fit to the published numbers, with the stored parameters."""

import numpy as np
import pandas as pd

from relay_contact import Values
from report.bench import bench, damped
from report.figure import Curve, Figure, Style
from report.fit import ALONE, LAWS, PARAMETERS
from report.plots import published
from report.published import ACCELERATION, EXPONENT, FORCE, LENGTHS, RESISTANCE, ROUGHNESS, SHORT, numbers

FORCES = np.geomspace(0.02, 3, 50)  # N
LOOKS: dict[str, tuple[str, Style, int]] = {
    "Hertz": ("smooth spheres", "dashed", 6), "support": ("support that yields", "dashed", 4),
    "Rough": ("rough contact", "line", 0),
}  # fmt: skip
"""Name, style and colour of each contact."""


def figures() -> list[Figure]:
    """Return all figures."""
    stored = pd.read_csv(PARAMETERS, index_col=["contact", "parameter"]).value
    found = {law.name: stored[law.name].drop("rms").to_numpy() for law in LAWS}
    contacts: dict[str, Values] = {law.name: {**ALONE, **law.values(bench().component, found[law.name])}
                                   for law in LAWS}  # fmt: skip
    return [frequencies(contacts), *amplitudes(contacts), stiffness(contacts, *found["Rough"][-2:].tolist())]


def frequencies(contacts: dict[str, Values]) -> Figure:
    """Draw the first frequency over overtravel for three lengths."""
    overtravels = np.linspace(0.05, 0.5, 30)
    curves = []
    for name, (label, style, colour) in LOOKS.items():
        for length in LENGTHS:
            springs = [{"beam.length": 1e-3 * length, "contact.overtravel": 1e-3 * each} for each in overtravels]
            found = [bench().rest({**contacts[name], **each}, "preload.frequency") for each in springs]
            curves.append(Curve(label if length == LENGTHS[0] else "", overtravels, found, style, colour))
    for kind, label, colour in (("natural", "prestressed", 1), ("stiff", "not prestressed", 2)):
        own = [(each.overtravel, each.published) for each in numbers() if each.kind == kind]
        curves += published(label, own, colour)
    title = "First frequency over overtravel, three contacts"
    return Figure("fit-frequency", title, "overtravel / mm", "first frequency / Hz", curves)


def amplitudes(contacts: dict[str, Values]) -> list[Figure]:
    """Draw amplitudes of force and displacement over the damping ratio; what opens is left out."""
    ratios = np.geomspace(40, 0.1, 25)
    base = 1e6 * ACCELERATION / (2 * np.pi * 1000) ** 2
    known = [each for each in numbers() if each.kind in ("force", "displacement")]
    force, travel = list[Curve](), list[Curve]()
    for colour, frequency in enumerate((250.0, 750.0, 1000.0, 1250.0)):
        for name in ("Hertz", "Rough"):
            closed = []
            for ratio in ratios.tolist():
                period = bench().vibrate(damped(contacts[name], ratio), frequency)
                if period.least <= 0:
                    break
                closed.append((period.elastic_amplitude, period.travel))
            label, style, _ = LOOKS[name]
            for curves, found in zip((force, travel), np.transpose(closed), strict=True):
                if curves is force or frequency >= 1000:
                    curves.append(Curve(f"{label}, {frequency:g} Hz", ratios[: len(closed)], found, style, colour))
        for curves, kind in ((force, "force"), (travel, "displacement")):
            own = [(each.ratio, each.published / (base if kind == "displacement" and each.unit else 1))
                   for each in known if each.kind == kind and each.frequency == frequency
                   and "measured" not in each.quantity]  # fmt: skip
            curves += published(f"{frequency:g} Hz", own, colour)
    measured = next(each.published for each in known if "measured" in each.quantity) / base
    travel.append(Curve("measured, 1000 Hz", ratios, np.full(len(ratios), measured), "dashed", 6))
    x, over = "damping ratio", "amplitude of the contact's displacement over that of the base"
    title = "over the damping ratio, 98 m/s²"
    return [
        Figure("fit-force", f"Elastic force {title}", x, "amplitude of the elastic force / cN", force, "xy"),
        Figure("fit-displacement", f"Displacement of the contact {title}", x, over, travel, "xy"),
    ]


def stiffness(contacts: dict[str, Values], at: float, exponent: float) -> Figure:
    """Draw the tangent stiffness over the force, of the rough contact by its stiffness at FORCE and its exponent."""
    hertz, support, own = (bench().rest(contacts[name], "preload.contactStiffness") for name in LOOKS)
    # Barber: resistance times stiffness is the same for all contacts of these materials.
    product = own * bench().rest({**contacts["Rough"], "effects.resistance": "Barber"}, "contact.resistance")
    springs = [(15.5, 0.2), *((length, overtravel) for length, overtravel, _ in SHORT[1:])]
    forces = np.array([
        bench().rest({**contacts["Rough"], "beam.length": 1e-3 * length, "contact.overtravel": 1e-3 * overtravel},
                     "preload.force")
        for length, overtravel in springs
    ])  # fmt: skip
    lengths = ", ".join(f"{length:g} mm" for length, _ in springs)
    curves = [
        Curve("fitted: rough contact", FORCES, at * (FORCES / FORCE) ** exponent, "line", 0),
        Curve("smooth spheres", FORCES, hertz * (FORCES / FORCE) ** (1 / 3), "dashed", 6),
        Curve("fitted: support that yields", FORCES, np.full(len(FORCES), support), "dashed", 4),
        Curve("published resistance, by Barber", FORCES, product / (1e-3 * RESISTANCE * FORCES**-EXPONENT), "line", 1),
        Curve("published roughness h: F/h to F/0.4h", FORCES, FORCES / ROUGHNESS, "line", 2),
        Curve("", FORCES, FORCES / (0.4 * ROUGHNESS), "line", 2),
        Curve(f"static forces, {lengths}", forces, at * (forces / FORCE) ** exponent, "points", 0),
    ]
    title, x, y = "Stiffness of the contact over its force", "contact force / N", "tangent stiffness / (N/m)"
    return Figure("fit-stiffness", title, x, y, curves, "xy")
