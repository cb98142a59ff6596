"""The model of the component once more, written from its equations and solved by other means.

Static and harmonic motions are exact: solutions of the boundary value problem, by a matrix exponential along the beam.
In time the beam has modes by Galerkin's method. With a linear contact their motion is a matrix exponential too, with
any other it is integrated by SUNDIALS CVODE from one event to the next.
Names and units are those of the component.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi, sin, sqrt
from typing import Any

import numpy as np
from numpy.polynomial.legendre import Legendre, leggauss
from scipy.linalg import eig, eigh, expm
from scipy.optimize import brentq

from component import STARTS
from one_sided import Acceleration, ClosedBy, Course, Law, System, shaking
from relay_contact import Array, Values

# Functions of Galerkin's method where solver.modes is not set. Where the beam is damped, the contact force of motion
# without blows is then right to 1e-10 of its scale.
FUNCTIONS = 16


@dataclass(frozen=True)
class Modes:
    """Modes of the cantilever without contact, of modal mass 1 kg."""

    omega_squared: Array
    damping: Array
    tip: Array
    # Rotation of the tip.
    rotation: Array
    # Load per base acceleration.
    participation: Array
    # Integrals of products of their slopes.
    slopes: Array


def hertz(values: dict[str, Any], contact: str = "contact") -> float:
    """Give the force of Hertz over the indentation to the power 3/2 (N/m^1.5), of one of the contacts."""
    compliance = sum(
        (1 - values[f"contact.{side}.poissonRatio"] ** 2) / values[f"contact.{side}.youngsModulus"]
        for side in ("moving", "fixed")
    )
    return float(4 / 3 / compliance * sqrt(values[f"{contact}.curvatureRadius"]))


class Reference:
    """The contact with its spring at preload."""

    def __init__(self, values: Values) -> None:
        """Take the parameters by name; what is not given has its start value."""
        self.values: dict[str, Any] = {**STARTS, **values}
        get = self.values.__getitem__
        self.length: float = get("beam.length")
        self.stiffness: float = get("beam.youngsModulus") * get("beam.width") * get("beam.thickness") ** 3 / 12  # E I
        self.density: float = get("beam.density") * get("beam.width") * get("beam.thickness")  # rho A
        self.mass: float = get("tip.mass")
        self.inertia: float = get("tip.rotaryInertia")
        # F = factor d^power: Hertz, or dF/dd = k_r (F / F_r)^n, with the depth F_r / ((1 - n) k_r) at F_r.
        self.factor: float = hertz(self.values)
        self.power = 1.5
        if get("effects.contactLaw") == "Rough":
            reach: float = get("contact.stiffnessForce")
            self.power = 1 / (1 - get("contact.stiffnessExponent"))
            self.factor = reach * (self.power * reach / get("contact.stiffness")) ** -self.power
        self.contact_damping: float = get("contact.damping") if get("effects.contactDamping") else 0.0
        self.law, self.axial = get("effects.contactLaw"), get("effects.axialForce")
        self.gravity: float = get("environment.gravity")
        self.height: float = get("tip.contactHeight")
        # Friction force over contact force in slip, and at the preload, where closing has left it.
        rubs = get("effects.friction") != "None"
        self.coefficient: float = get("friction.coefficient") if rubs else 0.0
        self.share: float = get("friction.initial") * self.coefficient
        self.overtravel: float = get("contact.overtravel")
        # Without overtravel there is a gap, and no preload.
        self.indentation: float = min(self.overtravel, 0.0)
        if self.overtravel > 0:
            self.indentation = brentq(self._unbalance, 0.0, self.overtravel, xtol=1e-22, rtol=1e-15)
        self.deflection: float = self.overtravel - self.indentation
        self.axial_force = self.axial_force_at(self.deflection)
        pressed = max(self.indentation, 0.0)
        self.force: float = float(self.elastic(pressed))
        self.tangent: float = float(self.stiffness_at(pressed))

    def elastic(self, indentation: Array | float) -> Array:
        """Elastic force of the contact before it is linearised, N."""
        return self.factor * np.maximum(indentation, 0.0) ** self.power

    def stiffness_at(self, indentation: Array | float) -> Array:
        """Its tangent stiffness, N/m."""
        return self.power * self.factor * np.maximum(indentation, 0.0) ** (self.power - 1)

    @property
    def tangential_ratio(self) -> float:
        """Tangential over normal stiffness of the contact that sticks, k_t / k_n = 4 G* / E*, by Mindlin."""
        sides = [[self.values[f"contact.{side}.{name}"] for name in ("youngsModulus", "poissonRatio")]
                 for side in ("moving", "fixed")]  # fmt: skip
        modulus = 1 / sum((2 - nu) * 2 * (1 + nu) / e for e, nu in sides)  # G*
        return float(4 * modulus * sum((1 - nu**2) / e for e, nu in sides))

    @property
    def tangential(self) -> float:
        """Tangential stiffness at the preload, N/m."""
        return self.tangential_ratio * self.tangent

    @property
    def tip_stiffness(self) -> float:
        """3 E I / L^3, N/m."""
        return 3 * self.stiffness / self.length**3

    @property
    def force_scale(self) -> float:
        """What the tolerance is relative to, N."""
        return max(self.force, self.tip_stiffness * max(abs(self.overtravel), 1e-4))

    @property
    def carried_mass(self) -> float:
        """What the contact carries of the spring under a constant acceleration, kg."""
        return 0.375 * self.density * self.length + self.mass

    def force_of_resistance(self, resistance: float) -> float:
        """Contact force at which the contact has a resistance (Ohm) by the power law, N."""
        conductance = 1 / resistance - 1 / self.values["resistance.open"]
        return float((self.values["resistance.coefficient"] * conductance) ** (1 / self.values["resistance.exponent"]))

    def axial_force_at(self, deflection: float) -> float:
        """Axial force in the preload, N; eq. (9) where it comes from the deflection."""
        match self.axial:
            case "None":
                return 0.0
            case "Prescribed":
                return float(self.values["beam.axialForce"])
            case _:
                return self.tip_stiffness * deflection * sin(1.5 * deflection / self.length)

    def _unbalance(self, indentation: float) -> float:
        deflection = self.overtravel - indentation
        per_force, per_moment, per_acceleration = self.responses(0.0, self.axial_force_at(deflection))[0].real
        pushed = (per_force + per_moment * self.height * self.share) * self.elastic(indentation)
        return float(deflection - pushed - per_acceleration * self.gravity)

    def responses(self, omega: float, axial_force: float, damped: bool = True) -> Any:  # noqa: ANN401
        """Deflection (m) and rotation of the tip, in rows, at an angular frequency; exact.

        Per force (N) and moment (N m) on it and per base acceleration (m/s2).
        """
        alpha, beta = (damped * self.values[f"beam.{kind}Damping"] for kind in ("mass", "stiffness"))
        loss, inertial = 1 + 1j * omega * beta, -(omega**2) + 1j * omega * alpha
        bending, axial = self.stiffness * loss, axial_force * loss
        # w, w', w'', w''' and the acceleration of the base along the beam.
        along = np.diag(np.array([1, 1, 1, 0], dtype=complex), 1)
        along[3] = [-self.density * inertial / bending, 0, -axial / bending, 0, -self.density / bending]
        end = expm(along * self.length)
        moment = bending * end[2] + self.inertia * inertial * end[1]
        shear = bending * end[3] + axial * end[1] - self.mass * inertial * end[0]
        # The unknown w'' and w''' at the clamp, under unit force, unit moment and unit acceleration.
        loads = np.array([[0, 1, -moment[4]], [-1, 0, self.mass - shear[4]]])
        clamp = np.linalg.solve(np.array([moment[2:4], shear[2:4]]), loads)
        return end[:2, 2:4] @ clamp + np.outer(end[:2, 4], [0, 0, 1])

    def compliances(self, omega: float, axial_force: float) -> Any:  # noqa: ANN401
        """Tip deflection (m) per tip force (N) and per base acceleration (m/s2), at an angular frequency; exact."""
        return self.responses(omega, axial_force)[0, [0, 2]]

    def force_response(self, frequency: float) -> complex:
        """Contact force (N) per base acceleration (m/s2) of the linear contact, at a frequency (Hz); exact."""
        omega = 2 * pi * frequency
        contact = self.tangent * (1 + 1j * omega * self.contact_damping)
        per_force, per_acceleration = self.compliances(omega, self.axial_force)
        return complex(-contact * per_acceleration / (1 + contact * per_force))

    def frequency(self, sticks: bool = False) -> float:
        """Lowest natural frequency with the contact as a spring, under a constant axial force, Hz; exact.

        A contact that sticks holds the tip against rotation, too.
        """
        springs, modes = np.diag([self.tangent, sticks * self.height**2 * self.tangential]), self.modes()

        def determinant(frequency: float) -> float:
            flexible = self.responses(2 * pi * frequency, self.axial_force, False)[:, :2].real
            return float(np.linalg.det(np.eye(2) + flexible @ springs))

        # Between poles, the resonances of the spring alone; the modes say where.
        tip = np.array([modes.tip, modes.rotation])
        near = sqrt(np.linalg.eigvalsh(np.diag(modes.omega_squared) + tip.T @ springs @ tip)[0]) / (2 * pi)
        return float(brentq(determinant, (1 - 1e-4) * near, (1 + 1e-4) * near, xtol=1e-12, rtol=1e-14))

    def modes(self) -> Modes:
        """Modes by Galerkin's method, with the functions x^2 times the Legendre polynomials."""
        count = int(self.values["solver.modes"]) or FUNCTIONS
        points, weights = leggauss(count + 4)
        x, weights = (points + 1) * self.length / 2, weights * self.length / 2
        square = Legendre([1 / 3, 1 / 2, 1 / 6], domain=[0, self.length]) * self.length**2  # x^2
        functions = [square * Legendre.basis(k, domain=[0, self.length]) for k in range(count)]

        def at(where: Any, order: int) -> Array:  # noqa: ANN401
            return np.array([(f.deriv(order) if order else f)(where) for f in functions])

        value, slope, curvature = (at(x, order) for order in range(3))
        tip, tip_slope = at(self.length, 0), at(self.length, 1)
        mass = self.density * (value * weights) @ value.T + self.mass * np.outer(tip, tip)
        mass += self.inertia * np.outer(tip_slope, tip_slope)
        slopes = (slope * weights) @ slope.T
        rigidity = self.stiffness * (curvature * weights) @ curvature.T - self.axial_force * slopes
        inverse, shapes = eigh(mass, rigidity)
        omega_squared = 1 / inverse
        shapes = shapes * np.sqrt(omega_squared)
        damping = self.values["beam.massDamping"] + self.values["beam.stiffnessDamping"] * omega_squared
        load = (self.density * value @ weights + self.mass * tip) @ shapes
        return Modes(omega_squared, damping, tip @ shapes, tip_slope @ shapes, load, shapes.T @ slopes @ shapes)

    def eigenvalues(self, contact: Array) -> Any:  # noqa: ANN401
        """Eigenvalues (1/s) of small motions of the modes, between which a contact has a matrix of stiffness."""
        modes, none = self.modes(), np.zeros_like(contact)
        stiffness = np.diag(modes.omega_squared) + contact
        damping = np.diag(modes.damping) + self.contact_damping * contact
        return np.linalg.eigvals(np.block([[none, np.eye(len(none))], [-stiffness, -damping]]))

    def growth(self, force: float, sign: float) -> complex:
        """Return the eigenvalue (1/s) that grows fastest of small motions about slip, at a contact force (N)."""
        modes = self.modes()
        # Hertz: the stiffness is as the cube root of the force.
        stiffness = self.tangent * (force / self.force) ** (1 / 3)
        pushed = np.outer(modes.tip + sign * self.coefficient * self.height * modes.rotation, stiffness * modes.tip)
        return complex(max(self.eigenvalues(pushed), key=lambda value: value.real))

    def linear_force(self, step: float, steps: int) -> Array:
        """Contact force of the linear contact, which can pull, at the multiples of a step from rest, N.

        The acceleration is that of the generator, smooth within each step: its polynomial through six points is off by
        some (omega step / 2)^6 / (6! 2^5) of it, 1e-10 at 1 kHz and 30 us.
        """
        modes, (acceleration, *_) = self.modes(), shaking(self.values)
        n, omega = len(modes.tip), np.sqrt(modes.omega_squared)
        # Displacements times the angular frequency, velocities, and the acceleration with its derivatives, in steps.
        matrix = np.zeros((2 * n + 6, 2 * n + 6))
        matrix[:n, n : 2 * n] = np.diag(omega)
        matrix[n : 2 * n, :n] = -np.diag(omega) - self.tangent * np.outer(modes.tip, modes.tip / omega)
        matrix[n : 2 * n, n : 2 * n] = -np.diag(modes.damping)
        matrix[n : 2 * n, n : 2 * n] -= self.contact_damping * self.tangent * np.outer(modes.tip, modes.tip)
        matrix[n : 2 * n, 2 * n] = -modes.participation
        matrix[2 * n :, 2 * n :] = np.diag([1 / step] * 5, 1)
        over_step = expm(matrix * step)[: 2 * n]
        points = 0.5 - 0.5 * np.cos(pi * (np.arange(6) + 0.5) / 6)
        # Derivatives at the start from values at the points.
        taylor = np.linalg.inv(np.vander(points, 6, increasing=True)) * np.array([[1], [1], [2], [6], [24], [120]])
        to_force = -self.tangent * np.concatenate([modes.tip / omega, self.contact_damping * modes.tip])
        motion, force = np.zeros(2 * n), [self.force]
        for k in range(steps):
            accelerations = np.array([acceleration((k + point) * step) for point in points])
            motion = over_step @ np.concatenate([motion, taylor @ accelerations])
            force.append(self.force + to_force @ motion)
        return np.array(force)

    def course(
        self, times: Array, base: Acceleration | None = None, tolerance: float = 1e-12, *, speed: float = 0.0,
        limit: float = 0.0,
    ) -> Course:  # fmt: skip
        """Solve the motion at increasing times, at rest at the first, for any contact law and axial force.

        The acceleration is that of the generator, unless another one is given. The fixed contact may come at a constant
        speed, m/s; `limit` is a force (N) whose instants are noted.
        """
        factor, power, offset, near = self.factor, self.power, self.overtravel, self.indentation
        if self.law not in ("Hertz", "Rough"):
            factor, power, near = self.tangent, 1.0, self.force / self.tangent
            offset += near - self.indentation
        by: dict[str, ClosedBy] = {"Bonded": "nothing", "Linearised": "force"}
        row, closed_by = -self.modes().tip, by.get(self.law, "overlap")
        contact = Law("contact", row, factor, self.contact_damping, power, offset, speed, limit, closed_by)
        spring = Spring(self, contact, near, base or shaking(self.values)[0])
        spring.relative, spring.floor = tolerance, 1e9 * tolerance * spring.floor
        return spring.solve(times)

    def frequency_following(self) -> float:
        """Lowest natural frequency with the contact as a spring and the axial force following the deflection, Hz."""
        modes = self.modes()
        preload = (modes.tip * self.force - modes.participation * self.gravity) / modes.omega_squared
        step = 1e-4 * self.deflection
        slope = (self.axial_force_at(self.deflection + step) - self.axial_force_at(self.deflection - step)) / (2 * step)
        matrix = np.diag(modes.omega_squared)
        matrix = matrix + np.outer(self.tangent * modes.tip - slope * modes.slopes @ preload, modes.tip)
        return float(sqrt(np.min(eig(matrix, right=False).real))) / (2 * pi)


class Spring(System):
    """Modes of a spring with its contact, for any contact law and axial force."""

    def __init__(self, relay: Reference, contact: Law, near: float, base: Acceleration) -> None:
        """Take the contact with its overlap at rest (m)."""
        self.relay, self.modes = relay, relay.modes()
        super().__init__(self.modes.omega_squared, self.modes.damping, self.modes.participation, [contact], base)
        self.pull, self.near = -relay.gravity * self.load, [near]

    def further(self, state: Array, time: float) -> tuple[Array | float, Sequence[float]]:
        """Return what the axial force adds that follows the deflection."""
        if self.relay.axial != "FromDeflection":
            return super().further(state, time)
        q = state[: self.count]
        change = self.relay.axial_force_at(float(self.modes.tip @ q)) - self.relay.axial_force
        return change * self.modes.slopes @ q, [0.0]
