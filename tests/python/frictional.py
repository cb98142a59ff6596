"""Friction between the contacts once more, by other means: the reference for `effects.friction`.

Modes of the beam by Galerkin's method carry the contact force F and the friction force T of a contact point at a height
above the spring. The motion is integrated by SUNDIALS CVODE from one change to the next: of sticking to slipping and
back, of closed to open.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from math import copysign, sqrt
from typing import Any

import numpy as np

from one_sided import CLOSED, Law, System, shaking
from reference import Reference
from relay_contact import Array

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
class Rubbing(Law):
    """Hertz's contact with damping, and friction on Mindlin's tangential spring with the same damping time."""

    # Tangential over normal stiffness.
    ratio: float = 0.0
    coefficient: float = 0.0

    def tangential_stiffness(self, d: float) -> float:
        """k_t, N/m."""
        return 1.5 * self.ratio * self.stiffness * sqrt(max(d, 0.0))

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
            excess, against = abs(trial) - self.coefficient * self.force(d, rate), trial
        return Phase(copysign(1.0, against)) if excess > 0 else Phase.STICK


class FrictionalMotion(System):
    """Friction and slip: beside the motion are the deflection z, the distance slipped and the energy dissipated."""

    def __init__(self, relay: Reference, tolerance: float) -> None:
        """Take a relay with its excitation."""
        modes, self.relay = relay.modes(), relay
        self.law = Rubbing("contact", -modes.tip, relay.factor, relay.contact_damping, 1.5, relay.overtravel,
                           ratio=relay.tangential_ratio, coefficient=relay.coefficient)  # fmt: skip
        super().__init__(modes.omega_squared, modes.damping, modes.participation, [self.law], *shaking(relay.values))
        # Displacement along the spring by the modes.
        self.near, self.lever, omega = [relay.indentation], relay.height * modes.rotation, np.sqrt(self.squares)
        # Velocity that the force scale gives the first mode in 1 / omega, and the deflection under Coulomb's limit.
        scale = relay.force_scale * np.max(np.hypot(modes.tip, self.lever * relay.coefficient) / omega)
        self.deflection = -relay.share * relay.force / relay.tangential if relay.tangential > 0 else 0.0
        self.short = max(self.law.limit_deflection(relay.indentation, 0.0), abs(self.deflection), 1e-9)
        energy = max(relay.coefficient * relay.force_scale * self.short, 1e-15)
        others = [self.short, self.short, energy]
        self.relative, self.floor = tolerance, tolerance * np.concatenate([scale / omega, scale + 0 * omega, others])
        self.phases: list[Phase] = []
        """Phases one after another."""
        self.depths: list[float] = []
        """Indentations at closings, m."""

    def bent(self, overlaps: Array) -> Array:
        """Return the displacements under constant forces of contact and friction."""
        friction = self.relay.share * self.law.elastic(float(overlaps[0]))
        return np.asarray(super().bent(overlaps) + self.lever * friction / self.squares)

    def contact(self, state: Array) -> tuple[float, float, float, float]:
        """Give indentation (m) and its rate (m/s), deflection of the tangential spring and speed along the spring."""
        q, v, others = self.split(state)
        return self.law.overlap(0.0, q), self.law.rate(v), float(others[0]), float(self.lever @ v)

    def friction(self, state: Array) -> float:
        """Friction force, N."""
        (d, rate, z, speed), phase = self.contact(state), self.phases[-1]
        if phase is Phase.STICK:
            return self.law.trial(d, z, speed)
        return 0.0 if phase is Phase.OPEN else phase.value * self.law.coefficient * self.law.force(d, rate)

    def further(self, state: Array, time: float) -> tuple[Array | float, Sequence[float]]:  # noqa: ARG002
        """Return the friction force on the modes, and the derivatives of deflection, distance and energy."""
        d, rate, z, speed = self.contact(state)
        friction, deflects = self.friction(state), self.law.deflects(self.phases[-1], d, rate, z, speed)
        slips = abs(speed - deflects) if self.phases[-1] in (Phase.FORTH, Phase.BACK) else 0.0
        return self.lever * friction, [deflects, slips, abs(friction) * slips]

    def excess(self, state: Array) -> float:
        """Give what is positive where it slips, m: by the trial force or, without damping, by the velocity."""
        (d, rate, z, speed), phase, law = self.contact(state), self.phases[-1], self.law
        if phase is not Phase.STICK and law.damping == 0:
            return -float(phase.value) * (speed - law.deflects(phase, d, rate, z, speed)) * MILLISECOND
        trial = -(z + law.damping * speed)
        return float((abs(trial) if phase is Phase.STICK else phase.value * trial) - law.limit_deflection(d, rate))

    def integrate(self, state: Array, phases: Sequence[int], middle: float) -> Any:  # noqa: ANN401
        """Return a solver while nothing changes."""
        # A change is behind zero by what rounding leaves of the one before, so that the start is none.
        behind, rounding = self.excess(state), ROUNDING * self.short
        self.behind = max(behind, 0.0) + rounding if self.phases[-1] is Phase.STICK else min(behind, 0.0) - rounding
        return super().integrate(state, phases, middle)

    def ways(self, phases: Sequence[int]) -> list[int | None]:
        """Add that of slip."""
        slides = phases[0] == CLOSED and self.law.coefficient > 0
        return [*super().ways(phases), (1 if self.phases[-1] is Phase.STICK else -1) if slides else None]

    def watched(self, time: float, state: Array, phases: Sequence[int]) -> list[float]:
        """Add slip."""
        return [*super().watched(time, state, phases), self.excess(state) - self.behind]

    def start(self, now: float) -> tuple[Array, list[int]]:
        """Return the state at rest, held by the friction that closing left."""
        state, phases = super().start(now)
        self.along = float(self.lever @ state[: self.count])
        state[2 * self.count] = self.deflection
        self.phases = [self.law.begins(*self.contact(state)) if phases[0] == CLOSED else Phase.OPEN]
        return state, phases

    def changed(
        self, time: float, state: Array, phases: list[int], turns: Array, changes: dict[tuple[str, str], list[float]]
    ) -> list[int]:
        """Return the phases after those changes that were found; without contact the tangential spring is straight."""
        after = super().changed(time, state, phases, turns[:-1], changes)
        if CLOSED not in (phases[0], after[0]):
            return after
        if phases != after:
            state[2 * self.count] = 0.0
            self.phases.append(self.law.begins(*self.contact(state)) if after[0] == CLOSED else Phase.OPEN)
            self.depths += [self.contact(state)[0]] if after[0] == CLOSED else []
        else:
            d, _, z, speed = self.contact(state)
            slips = Phase(copysign(1.0, self.law.trial(d, z, speed)))
            self.phases.append(slips if self.phases[-1] is Phase.STICK else Phase.STICK)
        return after

    def observed(self, state: Array) -> list[float]:
        """Return friction force, slip, distance slipped and energy dissipated."""
        q, _, (z, distance, energy) = self.split(state)
        return [self.friction(state), float(self.lever @ q) - self.along - z, distance, energy]

    def outputs(self, times: Array) -> tuple[dict[str, Array], dict[tuple[str, str], list[float]]]:
        """Give the outputs of the component that depend on contact and friction, at increasing times, and changes."""
        course = self.solve(times)
        names = ["contact.tangentialForce", "contact.slip", "contact.slipDistance", "friction.energy"]
        return {"contact.force": course.forces["contact"], **dict(zip(names, course.rows, strict=True))}, course.changes
