"""Friction between the contacts once more, by other means: the reference for `effects.friction`.

Modes of the beam by Galerkin's method carry the contact force F and the friction force T of a contact point at a height
above the spring. The motion is integrated by scipy's implicit Runge-Kutta method from one change to the next: of
sticking to slipping and back, of closed to open. Every change is located, so that no step goes over one.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from enum import Enum
from math import copysign, pi, sqrt
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from component import STARTS
from one_sided import Acceleration
from reference import Reference
from relay_contact import Array, Values

MILLISECOND = 1e-3
# By which a change of phase is later than it is, of the deflection under Coulomb's limit.
ROUNDING = 1e-10


class Phase(Enum):
    """What the contact does."""

    OPEN = 2.0
    STICK = 0.0
    # Slips away from the clamp, and to it: the sign of the friction force.
    FORTH = -1.0
    BACK = 1.0


@dataclass(frozen=True)
class Law:
    """Hertz's contact with damping, and friction on Mindlin's tangential spring with the same damping time."""

    hertz: float
    damping: float
    # Tangential over normal stiffness.
    ratio: float
    coefficient: float

    def normal(self, d: float, rate: float) -> float:
        """Contact force (N) of a closed contact, by indentation (m) and rate (m/s)."""
        return self.hertz * sqrt(max(d, 0.0)) * (d + 1.5 * self.damping * rate)

    def engagement(self, d: float, rate: float) -> float:
        """Give what is positive while the contact is closed, m."""
        return min(d, d + 1.5 * self.damping * rate)

    def tangential_stiffness(self, d: float) -> float:
        """k_t, N/m."""
        return 1.5 * self.ratio * self.hertz * sqrt(max(d, 0.0))

    def trial(self, d: float, z: float, speed: float) -> float:
        """Friction force (N) if the contact sticks and moves along the spring at a speed (m/s)."""
        return -self.tangential_stiffness(d) * (z + self.damping * speed)

    def limit_deflection(self, d: float, rate: float) -> float:
        """Deflection of the tangential spring under Coulomb's limit, mu F / k_t, m; smooth where the contact opens."""
        return self.coefficient / self.ratio * (2 / 3 * d + self.damping * rate)

    def deflects(self, phase: Phase, d: float, rate: float, z: float, speed: float) -> float:
        """Rate of the deflection z of the tangential spring, m/s."""
        if phase is Phase.OPEN:
            return 0.0
        if phase is Phase.STICK:
            return speed
        if self.damping == 0:
            return -float(phase.value) * self.limit_deflection(rate, 0.0)
        return (-float(phase.value) * self.limit_deflection(d, rate) - z) / self.damping

    def begins(self, d: float, rate: float, z: float, speed: float) -> Phase:
        """Phase of a closed contact."""
        if self.coefficient == 0:
            return Phase.BACK
        if abs(d) <= 1e-9 * abs(self.damping * rate) or self.damping == 0 >= d:
            # Both forces grow from zero as the square root of time, or as its power of 3/2 without damping.
            grows = self.limit_deflection(rate, 0.0) if self.damping == 0 else self.limit_deflection(0.0, rate)
            moves = speed if self.damping == 0 else self.damping * speed
            excess, against = abs(moves) - grows, -speed
        else:
            trial = self.trial(d, z, speed)
            excess, against = abs(trial) - self.coefficient * self.normal(d, rate), trial
        return Phase(copysign(1.0, against)) if excess > 0 else Phase.STICK


class Frictional(Reference):
    """The contact with its spring at preload, closed by sliding."""

    def __init__(self, values: Values) -> None:
        """Take the parameters by name; what is not given has its start value."""
        known: dict[str, Any] = {**STARTS, **values}
        self.height: float = known["tip.contactHeight"]
        # Friction force over contact force at the preload.
        self.share: float = known["friction.initial"] * known["friction.coefficient"]
        super().__init__(values)
        sides: list[tuple[float, float]] = [
            (known[f"contact.{side}.youngsModulus"], known[f"contact.{side}.poissonRatio"])
            for side in ("moving", "fixed")
        ]
        modulus = 1 / sum((2 - nu) * 2 * (1 + nu) / e for e, nu in sides)  # G*
        self.tangential: float = 8 * modulus * sqrt(known["contact.curvatureRadius"] * max(self.indentation, 0.0))
        normal = 1 / sum((1 - nu**2) / e for e, nu in sides)  # E*
        self.friction = Law(self.factor, self.contact_damping, 4 * modulus / normal, known["friction.coefficient"])

    def _unbalance(self, indentation: float) -> float:
        deflection = self.overtravel - indentation
        per_force, per_moment, per_acceleration = self.responses(0.0, self.axial_force_at(deflection))[0].real
        pushed = (per_force + per_moment * self.height * self.share) * self.elastic(indentation)
        return float(deflection - pushed - per_acceleration * self.gravity)

    def sticking_by_modes(self) -> float:
        """Lowest natural frequency of the contact that sticks, under a constant axial force, by the modes, Hz."""
        modes = self.modes()
        matrix = np.diag(modes.omega_squared) + self.tangent * np.outer(modes.tip, modes.tip)
        matrix += self.height**2 * self.tangential * np.outer(modes.rotation, modes.rotation)
        return sqrt(np.linalg.eigvalsh(matrix)[0]) / (2 * pi)

    def sticking_frequency(self) -> float:
        """Give the same from the characteristic equation: springs against deflection and rotation of the tip, Hz."""
        springs = np.diag([self.tangent, self.height**2 * self.tangential])

        def determinant(frequency: float) -> float:
            flexible = self.responses(2 * pi * frequency, self.axial_force, False)[:, :2].real
            return float(np.linalg.det(np.eye(2) + flexible @ springs))

        # Between poles, the resonances of the spring alone; the modes say where.
        near = self.sticking_by_modes()
        return float(brentq(determinant, (1 - 1e-6) * near, (1 + 1e-6) * near, xtol=1e-12, rtol=1e-14))

    def growth(self, force: float, sign: float) -> complex:
        """Give the eigenvalue (1/s) that grows fastest of small motions about slip, at a contact force (N)."""
        modes = self.modes()
        # Hertz: the stiffness is as the cube root of the force.
        stiffness = self.tangent * (force / self.force) ** (1 / 3)
        pushed = np.outer(
            modes.tip + sign * self.friction.coefficient * self.height * modes.rotation, stiffness * modes.tip
        )
        matrix = np.block(
            [
                [np.zeros_like(pushed), np.eye(len(modes.tip))],
                [-np.diag(modes.omega_squared) - pushed, -np.diag(modes.damping) - self.contact_damping * pushed],
            ]
        )
        return complex(max(np.linalg.eigvals(matrix), key=lambda value: value.real))


@dataclass
class Piece:
    """Motion in one phase."""

    begin: float
    end: float
    phase: Phase
    at: Callable[[Any], Any] = field(repr=False)


class FrictionalMotion:
    """Contact force, friction force and slip over time."""

    def __init__(self, relay: Frictional, acceleration: Acceleration, stop: float, tolerance: float) -> None:
        """Integrate; the motion is `omega q` and `q'` of the modes, then z, distance slipped, energy dissipated."""
        self.relay, self.law, self.modes, self.acceleration = relay, relay.friction, relay.modes(), acceleration
        law, modes = self.law, self.modes
        # Displacement along the spring by the modes, and the friction force at rest.
        self.lever, self.held = relay.height * modes.rotation, relay.share * relay.force
        self.n, self.omega = len(modes.tip), np.sqrt(modes.omega_squared)
        n = self.n
        # Velocity that the force scale gives the first mode in 1 / omega, and the deflection under Coulomb's limit.
        loads = np.hypot(modes.tip, self.lever * law.coefficient)
        scale = relay.force_scale * np.max(loads / self.omega)
        deflection = -self.held / relay.tangential if relay.tangential > 0 else 0.0
        short = max(law.limit_deflection(relay.indentation, 0.0), abs(deflection), 1e-9)
        energy = max(law.coefficient * relay.force_scale * short, 1e-15)
        self.short = short
        self.floor = tolerance * np.concatenate([np.full(2 * n, scale), [short, short, energy]])
        self.tolerance = tolerance
        motion = np.concatenate([np.zeros(2 * n), [deflection, 0.0, 0.0]])
        self.pieces: list[Piece] = []
        time, phase = 0.0, self._closed(motion) if relay.force > 0 else Phase.OPEN
        while time < stop:
            piece, motion, change = self._piece(time, stop, phase, motion)
            self.pieces.append(piece)
            time = piece.end
            if change == "slip":
                d, _, _, speed = self.contact(motion)
                trial = self.law.trial(d, motion[2 * n], speed)
                phase = Phase(copysign(1.0, trial)) if phase is Phase.STICK else Phase.STICK
            elif change == "contact":
                motion[2 * n] = 0.0
                phase = self._closed(motion) if phase is Phase.OPEN else Phase.OPEN

    def contact(self, motion: Array) -> tuple[Any, Any, Any, Any]:
        """Give indentation (m) and its rate (m/s), displacement along the spring and its rate."""
        n, tip = self.n, self.modes.tip
        q, v = (motion[:n].T / self.omega).T, motion[n : 2 * n]
        return self.relay.indentation - tip @ q, -tip @ v, self.lever @ q, self.lever @ v

    def _closed(self, motion: Array) -> Phase:
        d, rate, _, speed = self.contact(motion)
        return self.law.begins(d, rate, motion[2 * self.n], speed)

    def forces(self, phase: Phase, motion: Array) -> tuple[float, float]:
        """Contact force and friction force, N."""
        if phase is Phase.OPEN:
            return 0.0, 0.0
        d, rate, _, speed = self.contact(motion)
        force = self.law.normal(d, rate)
        if phase is Phase.STICK:
            return force, self.law.trial(d, motion[2 * self.n], speed)
        return force, phase.value * self.law.coefficient * force

    def _rates(self, phase: Phase, time: float, motion: Array) -> Array:
        n, modes = self.n, self.modes
        d, rate, _, speed = self.contact(motion)
        force, friction = self.forces(phase, motion)
        load = modes.tip * (force - self.relay.force) + self.lever * (friction - self.held)
        load = load - modes.participation * self.acceleration(time)
        deflects = self.law.deflects(phase, d, rate, motion[2 * n], speed)
        slips = abs(speed - deflects) if phase in (Phase.FORTH, Phase.BACK) else 0.0
        turns = load - self.omega * motion[:n] - modes.damping * motion[n : 2 * n]
        return np.concatenate([self.omega * motion[n : 2 * n], turns, [deflects, slips, abs(friction) * slips]])

    def _piece(self, begin: float, stop: float, phase: Phase, motion: Array) -> tuple[Piece, Array, str]:
        """Go on to the next change, and say of what."""
        law, z = self.law, 2 * self.n

        def engaged(_time: float, motion: Array) -> float:
            d, rate, _, _ = self.contact(motion)
            return law.engagement(d, rate)

        def excess(motion: Array) -> Any:  # noqa: ANN401
            """Give what is positive where it slips, m: by the trial force or, without damping, by the velocity."""
            d, rate, _, speed = self.contact(motion)
            if phase is not Phase.STICK and law.damping == 0:
                return -phase.value * (speed - law.deflects(phase, d, rate, motion[z], speed)) * MILLISECOND
            trial = -(motion[z] + law.damping * speed)
            return (abs(trial) if phase is Phase.STICK else phase.value * trial) - law.limit_deflection(d, rate)

        # A change is behind zero by what rounding leaves of the one before, so that the start is none.
        behind, rounding = excess(motion), ROUNDING * self.short
        behind = max(behind, 0.0) + rounding if phase is Phase.STICK else min(behind, 0.0) - rounding

        def slips(_time: float, motion: Array) -> float:
            return float(excess(motion) - behind)

        changes: list[Any] = [engaged] if phase is Phase.OPEN or law.coefficient == 0 else [engaged, slips]
        engaged.terminal = slips.terminal = True  # type: ignore[attr-defined]
        engaged.direction = 1 if phase is Phase.OPEN else -1  # type: ignore[attr-defined]
        slips.direction = 1 if phase is Phase.STICK else -1  # type: ignore[attr-defined]
        solution = solve_ivp(
            lambda time, motion: self._rates(phase, time, motion),
            (begin, stop),
            motion,
            method="Radau",
            rtol=self.tolerance,
            atol=self.floor,
            dense_output=True,
            events=changes,
        )
        assert solution.success, solution.message
        events = zip(("contact", "slip"), solution.t_events, strict=False)
        change = next((name for name, times in events if len(times)), "")
        return Piece(begin, float(solution.t[-1]), phase, solution.sol), solution.y[:, -1].copy(), change

    def instants(self, before: set[Phase], after: set[Phase]) -> Array:
        """Give the instants at which a phase among these changes to one among those."""
        pairs = zip(self.pieces, self.pieces[1:], strict=False)
        return np.array([late.begin for early, late in pairs if early.phase in before and late.phase in after])

    def outputs(self, times: Array) -> dict[str, Array]:
        """Give the outputs of the component that depend on contact and friction, at increasing times."""
        rows = []
        ends = np.array([piece.end for piece in self.pieces])
        for time in times:
            piece = self.pieces[min(int(np.searchsorted(ends, time)), len(ends) - 1)]
            motion = piece.at(time)
            z = 0.0 if piece.phase is Phase.OPEN else motion[2 * self.n]
            d, _, along, _ = self.contact(motion)
            rows.append([*self.forces(piece.phase, motion), along - z, *motion[2 * self.n + 1 :], d])
        names = ["contact.force", "contact.tangentialForce", "contact.slip", "contact.slipDistance", "friction.energy"]
        return dict(zip([*names, "contact.indentation"], np.array(rows).T, strict=True))
