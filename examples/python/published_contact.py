"""What contact the published numbers belong to: the component fitted to seventeen of them at once, with three contacts.

docs/published-numbers.csv has the numbers, with their place in Zhang, Zhang, Meng, Ren, "Machines" 2025, 13(1), 52. The
contacts are smooth spheres of the published stiffness (Hertz), a rough contact (Rough), and a support that yields under
a contact so stiff that it does not matter (a linear spring that can open: Rough with the exponent 0). Free are mass per
length, rivet, damping and the stiffness of the contact; the bending stiffness follows from the published static force.

- Frequencies: preload.frequency.
- Time domain: half peak-to-peak of contact.elasticForce and of the contact's displacement with the base, once steady.
- Frequency domain: the same of a vibration so weak that the contact is linear, with mass damping alone.

The chapter on it is in docs/validation.md, which `cargo xtask report --docs` writes from the tables written here.
"""

import csv
import math
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares
from scipy.special import stdtrit

import published_contact_figures as figures
from common import ROOT, parser, read_arguments
from relay_contact import Array, Component, Contact, Value, Values

NUMBERS = ROOT / "docs/published-numbers.csv"
LENGTH, OVERTRAVEL, FORCE = 15.5e-3, 0.2e-3, 0.152  # m, m, N: the specimen, and its published static force
HERTZ = 3.54e6, 1 / 3  # N/m at that force, and exponent: the published contact
RATIO, ACCELERATION = 10.0, 98.0  # the damping of the values is that of this published ratio; m/s2
WEAK = 1.0  # m/s2: force amplitude 0.3 % of the static force, so that its square is below 1e-5
GRID = np.arange(700.0, 1701.0, 100.0)  # Hz, among which the largest amplitude is sought
BESIDE = 50.0  # Hz: a parabola through the amplitudes there and so far beside has the peak to 1e-4
RISE, SETTLE, SAMPLES = 20, 5, 32  # periods of the gentle start and after it; samples of the period that is read
SOON = 10  # periods after a sudden start
PIECES = 16  # of a period of the gentle start
STEP = 1e-3  # of logarithms and exponent, for derivatives
PROBABLE = 0.975  # quantile: intervals of 95 %
ALONE: Values = {
    "effects.axialForce": "FromPreload", "effects.chatter": False, "effects.extremes": False,
    "effects.resistance": "None",
}  # fmt: skip


@dataclass(frozen=True)
class Number:
    """A published number: what it is of, in SI units but for the damping ratio and its own value."""

    quantity: str
    kind: str
    place: dict[str, float]
    published: float
    unit: str
    location: str
    fitted: bool

    @property
    def spring(self) -> Values:
        """Return the parameters of its length and overtravel."""
        return {"beam.length": self.place["length"] * 1e-3, "contact.overtravel": self.place["overtravel"] * 1e-3}


def published() -> list[Number]:
    """Return the published numbers."""
    with NUMBERS.open(newline="", encoding="utf-8") as file:
        return [
            Number(
                row["quantity"], row["kind"],
                {name: float(row[name] or "nan") for name in ("length", "overtravel", "ratio", "alpha", "frequency")},
                float(row["published"]), row["unit"], row["location"], row["fitted"] == "1",
            )
            for row in csv.DictReader(file)
        ]  # fmt: skip


@dataclass(frozen=True)
class Period:
    """A period of steady vibration: its samples, and the amplitude of the base, m."""

    force: Array
    """Elastic, N."""
    displacement: Array
    """Of the contact with the base, m."""
    resistance: Array
    base: float

    @property
    def amplitude(self) -> float:
        """Return half the range of the force, N."""
        return half_range(self.force)

    @property
    def travel(self) -> float:
        """Return half the range of the displacement over that of the base."""
        return half_range(self.displacement) / self.base

    @property
    def phase(self) -> float:
        """Return the phase between force and displacement, from 0 to 180 degrees."""
        force, displacement = (np.fft.rfft(each)[1] for each in (self.force, self.displacement))
        return float(abs(np.degrees(np.angle(force / displacement))))


def half_range(samples: Array) -> float:
    """Return half the difference of maximum and minimum of a period, between its samples too, by its Fourier series."""
    fine = 16 * np.fft.irfft(np.fft.rfft(samples), 16 * len(samples))
    return float(np.ptp(fine) / 2)


class Bench:
    """The component in place of the published specimen."""

    def __init__(self, component: Component) -> None:
        """Instantiate it, once for all."""
        self.component = component
        self.contact = Contact(component)
        self.known: tuple[Values, dict[tuple[float, float], Period]] = {}, {}

    def rest(self, values: Values, output: str) -> float:
        """Return an output of the contact at rest."""
        self.contact.begin_anew({**ALONE, **values})
        return self.contact.get(output)

    def shaken(self, values: Values, frequency: float, level: float) -> float:
        """Begin a vibration from rest; return the deflection there, m."""
        sine: Values = {
            "effects.excitation": "Sine", "excitation.frequency": frequency, "excitation.amplitude": level,
        }  # fmt: skip
        self.contact.begin_anew({**ALONE, **values, **sine})
        return self.contact.get("tip.displacement")

    def period(self, frequency: float, level: float, deflection: float, number: int) -> Period:
        """Return the period with this number, which comes next."""
        contact = self.contact
        outputs = contact.references("contact.elasticForce", "tip.displacement", "contact.resistance")
        rows = []
        for sample in range(SAMPLES):
            contact.step((number + sample / SAMPLES) / frequency, 1 / SAMPLES / frequency)
            rows.append(contact.fmu.getReal(outputs))
        force, tip, resistance = np.array(rows).T
        base = level / (2 * np.pi * frequency) ** 2
        phase = 2 * np.pi * np.arange(1, SAMPLES + 1) / SAMPLES
        return Period(force, tip - deflection - base * np.sin(phase), resistance, base)

    def vibrate(self, values: Values, frequency: float, level: float = ACCELERATION) -> Period:
        """Return a period of the vibration, started gently so that it is steady soon."""
        deflection = self.shaken(values, frequency, level)
        self.contact.rise(frequency, level, RISE, PIECES)
        self.contact.step(RISE / frequency, SETTLE / frequency)
        return self.period(frequency, level, deflection, RISE + SETTLE)

    def sudden(self, values: Values, ratio: float, frequency: float) -> float:
        """Return the largest displacement amplitude (m) in a period soon after a sudden start."""
        deflection = self.shaken(damped(values, ratio), frequency, ACCELERATION)
        periods = [self.period(frequency, ACCELERATION, deflection, number) for number in range(SOON)]
        return max(float(np.ptp(each.displacement)) / 2 for each in periods)

    def steady(self, values: Values, ratio: float, frequency: float) -> Period:
        """Return a period of the published vibration with the damping of a published ratio."""
        if self.known[0] != values:
            self.known = values, {}
        periods = self.known[1]
        if (ratio, frequency) not in periods:
            periods[ratio, frequency] = self.vibrate(damped(values, ratio), frequency)
        return periods[ratio, frequency]

    def peak(self, values: Values, alpha: float) -> float:
        """Return the largest force amplitude (N) over frequency, linear, with mass damping (1/s) alone."""
        linear = damped(values, 0.0) | {"beam.massDamping": alpha}

        def amplitude(frequency: float) -> float:
            return self.vibrate(linear, frequency, WEAK).amplitude * ACCELERATION / WEAK

        here, at = max((amplitude(float(each)), float(each)) for each in GRID)
        below, above = amplitude(at - BESIDE), amplitude(at + BESIDE)
        slope, curvature = (above - below) / 2, above - 2 * here + below
        return here - slope**2 / (2 * curvature) if curvature < 0 else here

    def number(self, values: Values, number: Number) -> float:
        """Return the component's value of a published number, in its unit."""
        values, place = {**values, **number.spring}, number.place
        barber: Values = {**values, "effects.resistance": "Barber"}
        at = place["ratio"], place["frequency"]
        match number.kind:
            case "natural":
                return self.rest(values, "preload.frequency")
            case "stiff":
                return self.rest({**values, "effects.contactLaw": "Hertz"}, "preload.frequency")
            case "force":
                return 100 * self.steady(values, *at).amplitude
            case "peak":
                return 100 * self.peak(values, place["alpha"])
            case "displacement":
                period = self.steady(values, *at)
                return period.travel * (1e6 * period.base if number.unit else 1)
            case "sudden":
                return 1e6 * self.sudden(values, *at)
            case "phase":
                return self.steady(values, *at).phase
            case "resting":
                return 1e3 * self.rest(barber, "contact.resistance")
            case "least":
                return 1e3 * float(self.steady(barber, *at).resistance.min())
            case "greatest":
                return 1e3 * float(self.steady(barber, *at).resistance.max())
        raise ValueError(number.kind)

    def numbers(self, values: Values, asked: list[Number]) -> Array:
        """Return the component's values of published numbers, in their units."""
        return np.array([self.number(values, each) for each in asked])


def damped(values: Values, ratio: float) -> dict[str, Value]:
    """Return the values with the damping of another published ratio."""
    names = ("beam.stiffnessDamping", "contact.damping")
    return {**values, **{name: float(values[name]) * ratio / RATIO for name in names}}


@dataclass(frozen=True)
class Law:
    """A contact and what is free in its fit: names with units, and starts in these."""

    name: str
    starts: tuple[tuple[float, ...], ...]

    @property
    def parameters(self) -> list[tuple[str, str, float]]:
        """Return name, unit, and unit in SI units of what is free."""
        known = [("mass per length", "g/m", 1e-3), ("rivet mass", "mg", 1e-6), ("damping times, ratio 10", "µs", 1e-6),
                 ("contact stiffness at 0.152 N", "N/m", 1.0), ("exponent of the stiffness", "", 1.0)]  # fmt: skip
        return known[: len(self.starts[0])]

    def values(self, component: Component, free: Array) -> dict[str, Value]:
        """Return the parameters of the component; the section bends as much as the published force asks."""
        scaled = [value * scale for value, (_, _, scale) in zip(free, self.parameters, strict=True)]
        mass, rivet, damping, *contact = scaled
        stiffness, exponent = HERTZ if not contact else (contact[0], contact[1] if len(contact) > 1 else 0.0)
        indentation = FORCE / ((1 - exponent) * stiffness)
        bending = FORCE * LENGTH**3 / 3 / (OVERTRAVEL - indentation)
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
    covariance: Array
    """Of the logarithms of the parameters."""
    freedom: int

    def half(self, deviation: Array) -> Array:
        """Return half of a 95 % interval by its standard deviation, which the scatter of the residuals gives."""
        return np.asarray(stdtrit(self.freedom, PROBABLE) * deviation)

    @property
    def intervals(self) -> tuple[Array, Array]:
        """Return the ends of the 95 % intervals of the parameters."""
        half = self.half(np.sqrt(np.diag(self.covariance)))
        return self.free * np.exp(-half), self.free * np.exp(half)


def fit(fmu: Path, law: Law, start: tuple[float, ...]) -> Fit:
    """Fit a law from a start."""
    bench, asked = Bench(Component(fmu)), [each for each in published() if each.fitted]
    known = np.array([each.published for each in asked])

    def residuals(logarithms: Array) -> Array:
        return np.asarray(np.log(bench.numbers(law.values(bench.component, np.exp(logarithms)), asked) / known))

    def jacobian(at: Array) -> Array:
        here = residuals(at)
        return np.column_stack([(residuals(at + step) - here) / STEP for step in STEP * np.eye(len(at))])

    bounds = np.log(BOUNDS[: len(start)]).T
    found = least_squares(residuals, np.log(start), jacobian, bounds, xtol=1e-6, ftol=1e-9)
    left, slopes = found.fun, found.jac
    freedom = len(left) - len(start)
    covariance = np.linalg.inv(slopes.T @ slopes) * (left @ left) / freedom
    return Fit(law, np.exp(found.x), float(np.sqrt(np.mean(left**2))), covariance, freedom)


def best(fmu: Path, starts: int) -> list[Fit]:
    """Return the best fit of each law, by so many starts each."""
    tasks = [(law, start) for law in LAWS for start in law.starts[-starts:]]
    with ProcessPoolExecutor(max_workers=2) as pool:
        found = list(pool.map(fit, [fmu] * len(tasks), *zip(*tasks, strict=True)))
    for each in found:
        print(f"{each.law.name:8} rms {100 * each.rms:6.3f} %:", *(f"{value:.5g}" for value in each.free))
    return [min((each for each in found if each.law == law), key=lambda each: each.rms) for law in LAWS]


def write(folder: Path, fits: list[Fit], asked: list[Number], values: Array) -> list[Path]:
    """Write the tables of what the component has of each number, and of the parameters."""
    table, parameters = folder / "published-contact.csv", folder / "published-contact-parameters.csv"
    with table.open("w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["quantity", "location", "unit", "published", "fitted", *(each.law.name for each in fits)])
        for number, own in zip(asked, values.T, strict=True):
            shown = [f"{value:.5g}" for value in own]
            rows.writerow(
                [number.quantity, number.location, number.unit, f"{number.published:g}", int(number.fitted), *shown]
            )
    with parameters.open("w", newline="", encoding="utf-8") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["contact", "parameter", "unit", "value", "low", "high"])
        for each in fits:
            rows.writerow([each.law.name, "rms", "%", f"{100 * each.rms:.4g}", "", ""])
            for (name, unit, _), *ends in zip(each.law.parameters, each.free, *each.intervals, strict=True):
                rows.writerow([each.law.name, name, unit, *(f"{value:.4g}" for value in ends)])
    return [table, parameters]


def main() -> None:
    """Fit, write the tables and draw."""
    line = parser(str(__doc__).splitlines()[0], epilog="Takes about two minutes on two cores.")
    line.set_defaults(out=ROOT / "docs")
    line.add_argument("--quick", action="store_true", help="from one start each, and few points in the figures")
    given = read_arguments(line)
    fits = best(given.fmu, 1 if given.quick else 3)
    bench, asked = Bench(Component(given.fmu)), published()
    found = {each.law.name: each.law.values(bench.component, each.free) for each in fits}
    paths = write(given.out, fits, asked, np.array([bench.numbers(each, asked) for each in found.values()]))
    paths += figures.draw(given.out, bench, found, fits, asked, given.quick)
    print(*paths, sep="\n")


if __name__ == "__main__":
    main()
