"""The whole relay once more: springs, contact, pusher, armature and coil, from the equations, by other means.

The springs are finite elements in their own modes, under the one-sided laws of contact, pusher and stops. Nothing is
shared with the component but names and units.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import atan2, exp, sqrt
from typing import Any

import numpy as np
from scipy.linalg import block_diag, eigh
from scipy.optimize import brentq

from component import STARTS
from elements import assembled
from one_sided import Law, System, shaking
from reference import hertz
from relay_contact import Array, Values

ELEMENTS = 40
"""Of each spring."""


class Beam:
    """A uniform cantilever of Hermite's elements, and the degrees of freedom of its tip and of a place on it."""

    def __init__(self, length: float, width: float, thickness: float, damping: float, place: float) -> None:
        """Assemble it, with a node at the place (m)."""
        modulus, density = float(STARTS["beam.youngsModulus"]), float(STARTS["beam.density"])
        bending, per_length = modulus * width * thickness**3 / 12, density * width * thickness
        before = max(1, round(ELEMENTS * place / length))
        before_it = np.linspace(0, place, before, endpoint=False)
        nodes = np.append(before_it, np.linspace(place, length, ELEMENTS - before + 1))
        parts = [(k, k + 1, bending, per_length, h) for k, h in enumerate(np.diff(nodes).tolist())]
        rigidity, mass = assembled(len(nodes), parts)
        # The load is that of all nodes moving alike; the first is clamped.
        self.load, self.mass, self.rigidity = mass[2:, ::2].sum(axis=1), mass[2:, 2:], rigidity[2:, 2:]
        self.damping = damping
        self.tip, self.place = np.zeros((2, len(self.load)))
        self.tip[-2], self.place[2 * before - 2] = 1.0, 1.0


@dataclass(frozen=True)
class Coil:
    """A coil under a voltage (V) from an instant to another (s), without current before."""

    voltage: float
    on: float
    off: float
    resistance: float
    inductance: float
    constant: float

    def slope(self, flux: float, gap: float, voltage: float) -> float:
        """Return the derivative of the flux linkage, V."""
        return voltage - self.resistance * flux * (1 + max(gap, 0.0) / self.constant) / self.inductance


class Relay(System):
    """Springs, contact, pusher, and if there is one the armature."""

    def __init__(
        self,
        values: Values,
        fixed: tuple[float, float] | None = None,
        pushed: tuple[float, float] = (0.0, 0.0),
        coil: Coil | None = None,
    ) -> None:
        """Build it from parameters of the component.

        `fixed` is the width and thickness (m) of the fixed contact's spring; `pushed` where a prescribed pusher is
        (m) and its speed (m/s); without a coil the current is that of the hold force.
        """
        known: dict[str, Any] = {**STARTS, **values}
        get = self.get = known.__getitem__
        self.coil, self.moves = coil, get("effects.pusher") == "Armature"
        length, beta = get("beam.length"), get("beam.stiffnessDamping")
        place = get("pusher.position") if get("effects.pusher") != "None" else length / 2
        moving = Beam(length, get("beam.width"), get("beam.thickness"), beta, place)
        moving.mass[-2, -2] += get("tip.mass")
        moving.load[-2] += get("tip.mass")
        beams = [moving] + ([Beam(length, *fixed, get("fixed.stiffnessDamping"), length / 2)] if fixed else [])
        parts = [eigh(beam.rigidity, beam.mass) for beam in beams]
        squares = np.concatenate([each for each, _ in parts])
        damping = np.concatenate([beam.damping * each for beam, (each, _) in zip(beams, parts, strict=True)])
        shapes = block_diag(*(shape for _, shape in parts))
        sides = (1.0, -1.0)[: len(beams)]
        opens = np.concatenate([side * beam.tip for side, beam in zip(sides, beams, strict=True)]) @ shapes
        touched = np.concatenate([moving.place, *(0 * beam.place for beam in beams[1:])]) @ shapes
        load = np.concatenate([beam.load for beam in beams]) @ shapes
        if self.moves:
            mass = self.mass = get("armature.mass")
            squares = np.append(squares, get("armature.stiffness") / mass)
            damping = np.append(damping, get("armature.damping") / mass)
            load = np.append(load, -get("armature.unbalance") * sqrt(mass))
            opens, touched = np.append(opens, 0.0), np.append(touched, 1 / sqrt(mass))
        laws = [Law("contact", -opens, hertz(known), get("contact.damping"), 1.5, get("contact.overtravel"))]
        if get("effects.pusher") != "None":
            stiffness = get("pusher.stiffness")
            laws.append(Law("pusher", touched, stiffness, get("pusher.damping") / stiffness, 1.0, *pushed))
        laws += self.stops(len(squares)) if self.moves else []
        super().__init__(squares, damping, load, laws, *shaking(known), *((coil.on, coil.off) if coil else ()))
        if self.moves:
            core, rest = get("armature.corePosition"), get("armature.restPosition")
            # Of the return spring.
            self.pull[-1] = (get("armature.stiffness") * rest - get("armature.returnForce")) / sqrt(mass)
            self.near = [1e-7, 1e-6, *((rest - core, 0.0) if coil else (0.0, rest - core))]

    def stops(self, count: int) -> list[Law]:
        """Return the laws of both stops."""
        get, wanted = self.get, self.get("armature.stopRestitution")

        def left(ratio: float) -> float:
            swing = sqrt(1 - ratio**2)
            return exp(-ratio / swing * atan2(2 * ratio * swing, 2 * ratio**2 - 1))

        ratio = brentq(lambda ratio: left(ratio) - wanted, 1e-9, 1 - 1e-9) if wanted < 1 else 0.0
        stiffness, row = get("armature.stopStiffness"), np.zeros(count)
        row[-1] = 1 / sqrt(self.mass)
        damping = 2 * ratio * sqrt(self.mass / stiffness)
        core, rest = get("armature.corePosition"), get("armature.restPosition")
        return [Law("core", row, stiffness, damping, offset=-core), Law("rest", -row, stiffness, damping, offset=rest)]

    def magnet(self, gap: float, flux: float) -> float:
        """Return the force towards the core (N), without a coil that of a held current."""
        if self.coil:
            return flux**2 / (2 * self.coil.inductance * self.coil.constant)
        hold, constant = self.get("armature.holdForce"), self.get("armature.gapConstant")
        return float(hold / (1 + max(gap, 0.0) / constant) ** 2)

    def bent(self, overlaps: Array) -> Array:
        """Return the displacements under constant forces of these overlaps, without current in a coil."""
        q = super().bent(overlaps)
        if self.moves:
            q[-1] += self.magnet(-overlaps[2], 0.0) / sqrt(self.mass) / self.squares[-1]
        return q

    def further(self, state: Array, time: float) -> tuple[Array | float, Sequence[float]]:
        """Return the force of the magnet on the modes, and the derivative of the flux linkage (V)."""
        if not self.moves:
            return 0.0, [0.0]
        q, _, (flux,) = self.split(state)
        force, gap, coil = np.zeros(self.count), -self.laws[2].overlap(time, q), self.coil
        force[-1] = self.magnet(gap, flux) / sqrt(self.mass)
        voltage = coil.voltage if coil and coil.on <= time < coil.off else 0.0
        return force, [coil.slope(flux, gap, voltage) if coil else 0.0]
