"""What contact the published numbers belong to: the component fitted to seventeen of them at once, with three contacts.

docs/published-numbers.csv has the numbers. The contacts are smooth spheres of the published stiffness (Hertz), a rough
contact (Rough), and a support that yields under a contact so stiff that it does not matter (a linear spring that can
open: Rough with the exponent 0). Free are mass per length, rivet, damping and the stiffness of the contact; the bending
stiffness follows from the published static force.

- Frequencies: preload.frequency.
- Time domain: half peak-to-peak of contact.elasticForce and of the contact's displacement with the base, once steady.
- Frequency domain: the same of a vibration so weak that the contact is linear, with mass damping alone.
"""

import math
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.optimize import least_squares
from scipy.special import stdtrit

from relay_contact import Array, Component, Value, Values
from report.bench import Bench, damped
from report.files import DOCS
from report.published import ACCELERATION, FORCE, STIFFNESS, Number, numbers
from report.spring import bending_stiffness

HERTZ = STIFFNESS, 1 / 3
"""Stiffness at the published force, N/m, and exponent: the published contact."""
WEAK = 1.0  # m/s2: force amplitude 0.3 % of the static force, so that its square is below 1e-5
GRID = np.arange(700.0, 1701.0, 100.0)  # Hz, among which the largest amplitude is sought
BESIDE = 50.0  # Hz: a parabola through the amplitudes there and so far beside has the peak to 1e-4
STEP = 1e-3  # of logarithms and exponent, for derivatives
PROBABLE = 0.975  # quantile: intervals of 95 %
ALONE: Values = {"effects.axialForce": "FromPreload", "effects.chatter": False}
TABLE, PARAMETERS = DOCS / "published-contact.csv", DOCS / "published-contact-parameters.csv"


def peak(bench: Bench, values: Values, alpha: float) -> float:
    """Return the largest force amplitude (cN) over frequency, linear, with mass damping (1/s) alone."""
    linear = damped(values, 0.0) | {"beam.massDamping": alpha}

    def amplitude(frequency: float) -> float:
        return bench.vibrate(linear, frequency, WEAK).elastic_amplitude * ACCELERATION / WEAK

    here, at = max((amplitude(float(each)), float(each)) for each in GRID)
    below, above = amplitude(at - BESIDE), amplitude(at + BESIDE)
    slope, curvature = (above - below) / 2, above - 2 * here + below
    return here - slope**2 / (2 * curvature) if curvature < 0 else here


def number(bench: Bench, values: Values, asked: Number) -> float:
    """Return the component's value of a published number, in its unit."""
    values, barber = {**ALONE, **values, **asked.spring}, {"effects.resistance": "Barber"}
    ratio, frequency = asked.ratio, asked.frequency
    match asked.kind:
        case "natural":
            return bench.rest(values, "preload.frequency")
        case "stiff":
            return bench.rest({**values, "effects.contactLaw": "Hertz"}, "preload.frequency")
        case "peak":
            return peak(bench, values, asked.alpha)
        case "sudden":
            return 1e6 * bench.sudden(damped(values, ratio), frequency)
        case "resting":
            return 1e3 * bench.rest({**values, **barber}, "contact.resistance")
    period = bench.vibrate(damped({**values, **barber}, ratio), frequency)
    match asked.kind:
        case "force":
            return period.elastic_amplitude
        case "displacement":
            return period.travel * (1e6 * period.base if asked.unit else 1)
        case "phase":
            return period.phase
        case "least":
            return 1e3 * float(period.resistance.min())
        case "greatest":
            return 1e3 * float(period.resistance.max())
    raise ValueError(asked.kind)


def values_of(bench: Bench, values: Values, asked: Iterable[Number]) -> Array:
    """Return the component's values of published numbers, in their units."""
    bench.known.clear()
    return np.array([number(bench, values, each) for each in asked])


@dataclass(frozen=True)
class Law:
    """A contact and what is free in its fit: names with units, and starts in these."""

    name: str
    starts: tuple[tuple[float, ...], ...]

    @property
    def parameters(self) -> list[tuple[str, str, float]]:
        """Name, unit, and unit in SI units of what is free."""
        known = [("mass per length", "g/m", 1e-3), ("rivet mass", "mg", 1e-6), ("damping times, ratio 10", "µs", 1e-6),
                 ("contact stiffness at 0.152 N", "N/m", 1.0), ("exponent of the stiffness", "", 1.0)]  # fmt: skip
        return known[: len(self.starts[0])]

    def values(self, component: Component, free: Array) -> dict[str, Value]:
        """Return the parameters of the component; the section bends as much as the published force asks."""
        scaled = [value * scale for value, (_, _, scale) in zip(free, self.parameters, strict=True)]
        mass, rivet, damping, *contact = scaled
        stiffness, exponent = HERTZ if not contact else (contact[0], contact[1] if len(contact) > 1 else 0.0)
        bending = bending_stiffness(FORCE, stiffness, exponent)
        modulus, density = (float(component.start(f"beam.{name}")) for name in ("youngsModulus", "density"))
        thickness = math.sqrt(12 * bending * density / (modulus * mass))
        found: dict[str, Value] = {
            "beam.width": mass / (density * thickness), "beam.thickness": thickness, "tip.mass": rivet,
            "beam.stiffnessDamping": damping, "contact.damping": damping,
        }  # fmt: skip
        rough: dict[str, Value] = {
            "effects.contactLaw": "Rough", "contact.stiffness": stiffness, "contact.stiffnessForce": FORCE,
            "contact.stiffnessExponent": exponent,
        }  # fmt: skip
        return found | (rough if contact else {})


# The start values of the component and points far to either side of the results.
LAWS = (
    Law("Hertz", ((53.6, 22.6, 80.6), (40.0, 90.0, 60.0), (65.0, 5.0, 120.0))),
    Law("Rough", ((53.6, 22.6, 80.6, 2e5, 0.33), (41.0, 93.0, 67.0, 4.3e4, 0.54), (30.0, 60.0, 50.0, 2e4, 0.75))),
    Law("support", ((53.6, 22.6, 80.6, 2e5), (41.0, 93.0, 67.0, 4.3e4), (45.0, 50.0, 120.0, 1e5))),
)
BOUNDS = ((10.0, 200.0), (0.1, 300.0), (20.0, 300.0), (1e4, 1e7), (0.01, 0.89))


@dataclass(frozen=True)
class Fit:
    """A law fitted."""

    law: Law
    free: Array
    """Its parameters, in their units."""
    rms: float
    """Of the logarithms of what the component has over what is published."""
    half: Array
    """Of the 95 % intervals of the logarithms of the parameters, by the scatter of the residuals."""


def fit(law: Law, start: tuple[float, ...]) -> Fit:
    """Fit a law from a start."""
    bench, asked = Bench(Component()), [each for each in numbers() if each.fitted]
    known = np.array([each.published for each in asked])

    def residuals(logarithms: Array) -> Array:
        return np.asarray(np.log(values_of(bench, law.values(bench.component, np.exp(logarithms)), asked) / known))

    def jacobian(at: Array) -> Array:
        here = residuals(at)
        return np.column_stack([(residuals(at + step) - here) / STEP for step in STEP * np.eye(len(at))])

    bounds = np.log(BOUNDS[: len(start)]).T
    found = least_squares(residuals, np.log(start), jacobian, bounds, xtol=1e-6, ftol=1e-9)
    left, slopes = found.fun, found.jac
    freedom = len(left) - len(start)
    deviation = np.sqrt(np.diag(np.linalg.inv(slopes.T @ slopes)) * (left @ left) / freedom)
    return Fit(law, np.exp(found.x), float(np.sqrt(np.mean(left**2))), stdtrit(freedom, PROBABLE) * deviation)


def best() -> list[Fit]:
    """Return the best fit of each law, by three starts each."""
    tasks = [(law, start) for law in LAWS for start in law.starts]
    with ProcessPoolExecutor(max_workers=2) as pool:
        found = list(pool.map(fit, *zip(*tasks, strict=True)))
    for each in found:
        print(f"{each.law.name:8} rms {100 * each.rms:6.3f} %:", *(f"{value:.5g}" for value in each.free))
    return [min((each for each in found if each.law == law), key=lambda each: each.rms) for law in LAWS]


def write(fits: list[Fit], asked: list[Number], values: Array) -> None:
    """Write the tables of what the component has of each number, and of the parameters."""
    numbers = [[each.quantity, each.location, each.unit, f"{each.published:g}", each.fitted] for each in asked]
    head = ["quantity", "location", "unit", "published", "fitted"]
    names = [each.law.name for each in fits]
    table = pd.DataFrame(numbers, columns=head).join(pd.DataFrame(values.T, columns=names).map("{:.5g}".format))
    table.to_csv(TABLE, index=False, lineterminator="\n")
    rows = []
    for found in fits:
        rows.append([found.law.name, "rms", "%", f"{100 * found.rms:.4g}", "", ""])
        for (name, unit, _), value, half in zip(found.law.parameters, found.free, found.half, strict=True):
            ends = value, value * np.exp(-half), value * np.exp(half)
            rows.append([found.law.name, name, unit, *(f"{each:.4g}" for each in ends)])
    head = ["contact", "parameter", "unit", "value", "low", "high"]
    pd.DataFrame(rows, columns=head).to_csv(PARAMETERS, index=False, lineterminator="\n")


def run() -> list[Path]:
    """Fit, and write the tables."""
    fits = best()
    bench, asked = Bench(Component()), numbers()
    found = [each.law.values(bench.component, each.free) for each in fits]
    write(fits, asked, np.array([values_of(bench, each, asked) for each in found]))
    return [TABLE, PARAMETERS]
