"""Random opening relays solved a second time, by equations that share no code with the component.

    .venv/bin/python tests/python/random_relays.py --count 50     # rewrites the table in docs/accuracy.md, some minutes

The beam has modes by Galerkin's method (reference.py), whose motion SUNDIALS CVODE integrates; openings and closings
are located, and changes between stick and slip where the contact rubs (frictional.py). The deviation is that of the
contact force at communication points, relative as the tolerance is.
"""

import argparse
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from math import pi

import numpy as np

from component import COMPONENT, ROOT
from frictional import FrictionalMotion
from reference import Reference
from relay_contact import Array, RelayContactError, Value
from relay_contact.component import sine

MARKS = "<!-- independent: written by tests/python/random_relays.py -->", "<!-- end of independent -->"
PERIODS, SAMPLES = 4, 50
"""Of the vibration, and communication steps of a period."""
COARSE, FINE = (26, 1e-11), (32, 1e-12)
"""Functions of Galerkin's method and tolerance of CVODE: what the finer ones change is the second solution's error."""
TIGHTEST = 1e-11
"""Of the component, with which it is compared too."""


@dataclass(frozen=True)
class Relay:
    """A relay and its vibration."""

    values: dict[str, Value]
    damping: float
    """Of the first mode of the spring alone, relative to critical."""

    @property
    def times(self) -> Array:
        """The communication points, s."""
        return np.arange(PERIODS * SAMPLES + 1) / SAMPLES / float(self.values["excitation.frequency"])

    @property
    def rubs(self) -> bool:
        """Whether its contact has friction."""
        return "effects.friction" in self.values

    @property
    def tolerance(self) -> float:
        """What is asked of the component."""
        return float(self.values["solver.tolerance"])


CLASSES: dict[str, Callable[[Relay], bool]] = {
    "first mode damped by 0.3 to 1 %": lambda relay: relay.damping < 0.01,
    "by 1 to 10 %": lambda relay: 0.01 <= relay.damping < 0.1,
    "by 10 to 34 %": lambda relay: relay.damping >= 0.1,
    "with friction": lambda relay: relay.rubs,
    "vibration that rises": lambda relay: relay.values["excitation.riseTime"] != 0,
    "all": lambda _: True,
}
"""Relays of the table."""


def draw(number: int) -> Relay:
    """Draw a relay whose contact opens by linear theory, or is open at rest."""
    random = np.random.default_rng(number)

    def between(low: float, high: float) -> float:
        return float(low * (high / low) ** random.uniform())

    values: dict[str, Value] = {
        "beam.length": between(8e-3, 20e-3), "beam.width": between(2e-3, 50e-3), "beam.thickness": between(8e-5, 3e-4),
        "tip.mass": between(1e-6, 5e-5), "contact.curvatureRadius": between(1e-3, 3e-2),
        "contact.damping": between(3e-7, 1e-4), "solver.tolerance": between(1e-7, 1e-3),
        "effects.axialForce": str(random.choice(["None", "FromPreload", "FromDeflection"])),
    }  # fmt: skip
    if random.uniform() < 0.3:
        stiffness, exponent = between(1e4, 1e6), float(random.uniform(0.2, 0.8))
        values |= {"effects.contactLaw": "Rough", "contact.stiffness": stiffness, "contact.stiffnessExponent": exponent}
    gap = random.uniform() < 0.25
    values["contact.overtravel"] = -between(2e-6, 2e-5) if gap else between(5e-5, 4e-4)
    bare = Reference({**values, "beam.stiffnessDamping": 0.0})
    omega = float(np.sqrt(bare.modes().omega_squared.min()))
    damping = between(0.003, 0.34)
    values["beam.stiffnessDamping"] = 2 * damping / omega
    reference = Reference(values)
    frequency = between(0.3, 1.2) * (omega / (2 * pi) if gap else reference.frequency())
    if gap:
        # So far that the contact is hit at a few times the gap.
        level = between(1.5, 4.0) * abs(float(values["contact.overtravel"])) * (2 * pi * frequency) ** 2
    else:
        level = between(1.2, 3.0) * reference.force / abs(reference.force_response(frequency))
    rise = between(0.01, 2.0) / frequency if random.uniform() < 0.5 else 0.0
    if random.uniform() < 0.4 and "effects.contactLaw" not in values:
        height, coefficient = between(1e-4, 4e-3), between(0.05, 1.5)
        values |= {
            "effects.friction": "Coulomb", "effects.axialForce": "None", "tip.contactHeight": height,
            "friction.coefficient": coefficient, "friction.initial": float(random.uniform(-1.0, 1.0)),
        }  # fmt: skip
    return Relay(values | sine(frequency, min(level, 9e4), rise), damping)


def second(relay: Relay, functions: int, tolerance: float) -> tuple[Array, int, float]:
    """Return contact forces (N) at the communication points, openings and closings, and the force scale (N)."""
    reference = Reference({**relay.values, "solver.modes": functions})
    if relay.rubs:
        course = FrictionalMotion(reference, tolerance).solve(relay.times)
    else:
        course = reference.course(relay.times, tolerance=tolerance)
    return course.forces["contact"], sum(map(len, course.changes.values())), reference.force_scale


def own(relay: Relay, tolerance: float) -> tuple[Array, float]:
    """Return the contact forces of the component (N) at the communication points, and what it says of their error."""
    with COMPONENT.started({**relay.values, "solver.tolerance": tolerance}) as contact, contact.explained():
        first = contact.get("contact.force")
        forces = np.append(first, contact.drive(relay.times, {}, ["contact.force"])["contact.force"])
        return forces, contact.get("solver.forceError")


@dataclass(frozen=True)
class Compared:
    """A relay compared: deviations and the change of the second solution, relative as the tolerance is."""

    relay: Relay
    events: int
    deviation: float
    tightest: float
    refinement: float
    told: float
    """solver.forceError."""

    @property
    def resolved(self) -> bool:
        """Whether the second solution is accurate enough to judge by it."""
        return self.refinement < 0.4 * self.relay.tolerance

    @property
    def above(self) -> bool:
        """Whether the component is above its tolerance."""
        return self.deviation > self.relay.tolerance


def compare(number: int) -> Compared | None:
    """Compare a relay; none if the component refuses it, or it does not open."""
    relay = draw(number)
    try:
        (forces, told), (tightest, _) = (own(relay, tolerance) for tolerance in (relay.tolerance, TIGHTEST))
    except RelayContactError:
        return None
    (coarse, *_), (fine, events, scale) = second(relay, *COARSE), second(relay, *FINE)
    if not events:
        return None
    scale = max(scale, float(fine.max()))
    deviation, at_best, change = (float(np.abs(each - fine).max()) / scale for each in (forces, tightest, coarse))
    return Compared(relay, events, deviation, at_best, change, told)


def table(compared: list[Compared]) -> str:
    """Return median and largest of the deviations."""
    found = [each for each in compared if each.resolved]
    above = [each for each in found if each.above]
    lines = [
        f"{len(found)} relays with {sum(each.events for each in found)} openings and closings. "
        f"{len(compared) - len(found)} more are left out: with more functions of Galerkin's method and a tighter "
        "CVODE their second solution changes by more than 0.4 of the tolerance, so it cannot judge. "
        f"Above their tolerance: {len(above)}, of these without a word from `solver.forceError`: "
        f"{sum(each.told <= each.relay.tolerance for each in above)}.",
        "",
        "| relays | number | deviation over tolerance, median | largest | at 1e-11 | largest |",
        "|---|---:|---:|---:|---:|---:|",
    ]
    for name, belongs in CLASSES.items():
        own = [each for each in found if belongs(each.relay)]
        kept = [each.deviation / each.relay.tolerance for each in own]
        tightest = [each.tightest for each in own]
        cells = [f"{value:.0e}" for values in (kept, tightest) for value in (np.median(values), max(values))]
        lines.append(f"| {name} | {len(own)} | {' | '.join(cells)} |")
    return "\n".join(lines)


def main() -> None:
    """Compare relays and write the table."""
    line = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    line.add_argument("--count", type=int, default=50)
    with ProcessPoolExecutor() as pool:
        found = [each for each in pool.map(compare, range(line.parse_args().count)) if each]
    text = table(found)
    for each in found:
        if each.resolved and each.above:
            print(each)
    page = ROOT / "docs/accuracy.md"
    before, rest = page.read_text(encoding="utf-8").split(MARKS[0])
    page.write_text(f"{before}{MARKS[0]}\n\n{text}\n\n{MARKS[1]}{rest.split(MARKS[1])[1]}", encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
