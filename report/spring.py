"""The specimen as a linear system in closed form, and the parameters that follow from published results.

The deflection `w` relative to the base obeys, with bending stiffness EI, axial compression N, mass per length mu, mass
damping alpha and stiffness damping beta,

    (1 + i omega beta) (EI w'''' + N w'') - (omega^2 - i omega alpha) mu w = -mu a,

`w = w' = 0` at the clamp, and at the tip `w'' = 0` and `(1 + i omega beta) (EI w''' + N w') = k (1 + i omega tau) w
- (omega^2 - i omega alpha) m w + m a` with the contact's stiffness k and damping time tau, and the rivet m. No code of
the component is in here: what agrees with it was found twice.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from relay_contact import Contact
from report.published import ACCELERATION, BEST, BETA, FORCE, FORCE_AMPLITUDE, LENGTH, OVERTRAVEL, STIFFNESS
from report.published import WITH_PRESTRESS as FREQUENCY

Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class Spring:
    """The spring with its rivet and the contact as a linear spring, SI units."""

    length: float
    bending: float
    mass: float
    """Per length."""
    rivet: float
    stiffness: float
    """Of the contact."""
    contact_damping: float
    beam_damping: float
    """Both are times."""
    mass_damping: float = 0.0
    axial: float = 0.0

    @classmethod
    def of(cls, contact: Contact) -> Self:
        """Return the spring of an instance of the component."""
        get = contact.get
        width, thickness = get("beam.width"), get("beam.thickness")
        return cls(
            get("beam.length"), get("beam.youngsModulus") * width * thickness**3 / 12,
            get("beam.density") * width * thickness, get("tip.mass"), get("preload.contactStiffness"),
            get("contact.damping"), get("beam.stiffnessDamping"), get("beam.massDamping"), get("preload.axialForce"),
        )  # fmt: skip

    def deflection(self, frequency: ArrayLike, part: float = 1.0) -> Complex:
        """Return the deflection at a part of the length, per base acceleration (m per m/s2)."""
        omega = 2 * np.pi * np.atleast_1d(np.asarray(frequency, dtype=float))
        inertia = omega**2 - 1j * omega * self.mass_damping
        damped = 1 + 1j * omega * self.beam_damping
        root = np.sqrt(self.axial**2 + 4 * self.bending * self.mass * inertia / damped)
        s = np.sqrt(np.array([root - self.axial, -root - self.axial]) / (2 * self.bending) + 0j)
        tip = self.stiffness * (1 + 1j * omega * self.contact_damping) - inertia * self.rivet
        free = 1 / inertia  # of a mass that nothing holds: a solution, but for the conditions at the ends

        def shapes(x: float, order: int) -> Complex:
            """Return the derivatives of the four solutions, by frequency."""
            even, odd = (np.cosh, np.sinh) if order % 2 == 0 else (np.sinh, np.cosh)
            return np.array([f(z * x) * z**order for z in s for f in (even, odd)])

        end = self.length
        shear = damped * (self.bending * shapes(end, 3) + self.axial * shapes(end, 1)) - tip * shapes(end, 0)
        matrix = np.array([shapes(0, 0), shapes(0, 1), shapes(end, 2), shear])
        zero = np.zeros_like(free)
        sides = np.array([-free, zero, zero, tip * free + self.rivet])
        factors = np.linalg.solve(np.moveaxis(matrix, -1, 0), sides.T[..., None])[..., 0].T
        return np.asarray(np.sum(factors * shapes(part * end, 0), axis=0) + free)

    def elastic(self, frequency: ArrayLike) -> NDArray[np.float64]:
        """Return the amplitude of the elastic part of the contact force under the published vibration, cN."""
        return 100 * ACCELERATION * self.stiffness * np.abs(self.deflection(frequency))

    def force(self, frequency: ArrayLike) -> NDArray[np.float64]:
        """Return the amplitude of the contact force under the published vibration, cN."""
        return self.elastic(frequency) * np.hypot(1, 2 * np.pi * np.asarray(frequency) * self.contact_damping)

    @property
    def buckling(self) -> float:
        """The axial force at which the spring buckles off its contact, N."""
        return np.pi**2 * self.bending / (4 * self.length**2)

    def of_ratio(self, ratio: float) -> Self:
        """Return the spring, whose damping is that of the published ratio 10, with that of another one."""
        factor = ratio / BEST
        return replace(self, beam_damping=factor * self.beam_damping, contact_damping=factor * self.contact_damping)


@dataclass(frozen=True)
class Source:
    """A published result, as it is shown, and a unit of its last printed digit."""

    name: str
    value: float
    digit: float
    shown: str
    place: str

    @property
    def rounding(self) -> float:
        """Half a unit of its last digit, relative."""
        return 0.5 * self.digit / self.value


SOURCES = (
    Source("static force F_0", FORCE, 1e-3, "0.152 N", "section 3.1"),
    Source("contact stiffness k_j", STIFFNESS, 1e4, "3.54e6 N/m", "section 3.1"),
    Source("first frequency f_1", FREQUENCY, 0.1, "1354.5 Hz", "section 3.1, Fig. 4"),
    Source("force amplitude at 1000 Hz", FORCE_AMPLITUDE, 1e-3, "4.812 cN", "section 3.2, Fig. 6"),
    Source("stiffness coefficient beta", BETA, 1e-7, "3.1831e-3 s", "Table 3"),
)


@dataclass(frozen=True)
class Materials:
    """Start values of the component that are published, SI units."""

    youngs_modulus: float
    density: float
    contact_modulus: float
    """Of both bodies in the Hertz law."""

    @classmethod
    def of(cls, contact: Contact) -> Self:
        """Return those of an instance of the component."""
        get = contact.get
        compliances = ((1 - get(f"contact.{body}.poissonRatio") ** 2) / get(f"contact.{body}.youngsModulus")
                       for body in ("moving", "fixed"))  # fmt: skip
        return cls(get("beam.youngsModulus"), get("beam.density"), 1 / sum(compliances))


@dataclass(frozen=True)
class Specimen:
    """What was not published: a spring with its contact, and the camber radius (m) of that."""

    spring: Spring
    radius: float
    materials: Materials

    @classmethod
    def of(cls, contact: Contact) -> Self:
        """Return that of an instance of the component."""
        return cls(Spring.of(contact), contact.get("contact.curvatureRadius"), Materials.of(contact))

    @property
    def thickness(self) -> float:
        """Of a uniform section with the bending stiffness and the mass, m."""
        of = self.materials
        return float(np.sqrt(12 * self.spring.bending * of.density / (of.youngs_modulus * self.spring.mass)))

    @cached_property
    def values(self) -> NDArray[np.float64]:
        """In the order and the units of PARAMETERS."""
        spring, width = self.spring, self.spring.mass / (self.materials.density * self.thickness)
        return np.array([
            1e3 * self.radius, 1e6 * spring.bending, 1e3 * spring.mass, 1e3 * width, 1e3 * self.thickness,
            1e6 * spring.rivet, 1e6 * spring.beam_damping,
        ])  # fmt: skip


SECTION = "EI and mass per length, with E = 124 GPa and 8300 kg/m³"
PARAMETERS = (
    ("camber radius R", "mm", "F_0 and k_j, by the Hertz law"),
    ("bending stiffness EI", "N mm²", "F_0 at the overtravel of 0.2 mm"),
    ("mass per length rhoA", "g/m", "f_1, with the rivet mass"),
    ("width b", "mm", SECTION),
    ("thickness h", "mm", SECTION),
    ("rivet mass m", "mg", "force amplitude at 1000 Hz, with the mass per length"),
    ("damping times beta", "µs", "beta over 4 π²"),
)
"""Name with symbol, unit, and what determines it."""
RIVET = 5
"""Place of the rivet's mass among them."""
LINEAR = np.arange(250.0, 2001.0, 5.0)
"""Frequencies of linear responses, Hz."""
HEAVIEST = 200e-6  # kg, of a rivet
SUPPORTED = 3.926602
"""Just below the first root of tan z = tanh z, of a beam clamped at one end and supported at the other."""


def bending_stiffness(force: float, stiffness: float, exponent: float = 1 / 3) -> float:
    """Return the bending stiffness that gives the published static force, N m2.

    The contact has the stiffness (N/m) at that force, and is as stiff as a power of the force.
    """
    indentation = force / ((1 - exponent) * stiffness)
    return force * LENGTH**3 / 3 / (OVERTRAVEL - indentation)


def identified(materials: Materials, changes: dict[int, float] | None = None, elastic: bool = False) -> Specimen:
    """Return the specimen that has the published results, some of them changed by a factor; without axial force.

    `elastic`: the published force amplitude is that of the elastic part of the contact force.
    """
    published = [source.value * (changes or {}).get(place, 1.0) for place, source in enumerate(SOURCES)]
    force, stiffness, frequency, amplitude, beta = published
    # By Hertz, k^3 = 6 E*^2 R F.
    radius = stiffness**3 / (6 * materials.contact_modulus**2 * force)
    bending, damping, omega = bending_stiffness(force, stiffness), beta / (4 * np.pi**2), 2 * np.pi * frequency

    def rivet(mass: float) -> float:
        """Return the rivet's mass with which a mass per length gives the first frequency."""
        wave = (mass * omega**2 / bending) ** 0.25
        z = wave * LENGTH
        free = 1 + np.cos(z) * np.cosh(z)
        held = np.sin(z) * np.cosh(z) - np.cos(z) * np.sinh(z)
        return float((stiffness + bending * wave**3 * free / held) / omega**2)

    def spring(mass: float) -> Spring:
        return Spring(LENGTH, bending, mass, rivet(mass), stiffness, damping, damping)

    def excess(mass: float) -> float:
        found = spring(mass)
        own = found.elastic(1000.0) if elastic else found.force(1000.0)
        return float(own[0] - amplitude)

    # A spring a little heavier than that without a rivet has this frequency on a rigid support, whatever the rivet.
    supported = bending * (SUPPORTED / LENGTH) ** 4 / omega**2
    heaviest = brentq(rivet, 1e-2, supported)
    lightest = brentq(lambda mass: rivet(mass) - HEAVIEST, 1e-2, heaviest)
    return Specimen(spring(brentq(excess, lightest, heaviest, xtol=1e-16)), radius, materials)


def sensitivities(materials: Materials, parts: list[float]) -> list[NDArray[np.float64]]:
    """Return the relative changes of the parameters per relative change of each published result, of such a size."""
    found = []
    for place, part in enumerate(parts):
        above, below = (identified(materials, {place: 1 + sign * part}).values for sign in (1, -1))
        found.append(np.log(above / below) / (2 * part))
    return found


def elastic_reading(materials: Materials, frequency: float, amplitude: float) -> Specimen:
    """Return the specimen whose elastic force has the published amplitude at 1000 Hz and another one (Hz, cN).

    The damping is free, too.
    """

    def found(factor: float) -> Specimen:
        return identified(materials, {4: factor}, elastic=True)

    factor = brentq(lambda factor: float(found(factor).spring.elastic(frequency)[0] - amplitude), 0.72, 1.0)
    return found(factor)
