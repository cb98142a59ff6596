"""The whole relay once more: springs, contact, pusher, armature and coil, from the equations, by other means.

The springs are finite elements in their own modes. Each one-sided law is open, closed, or loose: overlapping with a
force that its damper has taken to zero. SUNDIALS' CVODE integrates between the instants at which one of them changes,
which it finds as roots. Nothing is shared with the component but names and units.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import atan2, exp, pi, sin, sqrt
from typing import Any

import numpy as np
from scipy.linalg import block_diag, eigh
from scipy.optimize import brentq, root

from component import STARTS
from elements import assembled
from reference import cvode, hertz
from relay_contact import Array, Values

ELEMENTS = 40
"""Of each spring."""
RELATIVE, ABSOLUTE = 1e-9, 1e-16
"""Of CVODE, the absolute one of modal displacements, m sqrt(kg): with 1e-11 and 1e-17 forces
change by 8e-6 of the largest."""
FASTEST = 1e4
"""Angular frequency (1/s) by which the absolute tolerance of velocities follows from that of displacements."""


class Beam:
    """A uniform cantilever of Hermite's elements, and the degrees of freedom of its tip and of a place on it."""

    def __init__(self, length: float, width: float, thickness: float, damping: float, place: float) -> None:
        """Assemble it, with a node at the place (m)."""
        modulus, density = float(STARTS["beam.youngsModulus"]), float(STARTS["beam.density"])
        bending, per_length = modulus * width * thickness**3 / 12, density * width * thickness
        before = max(1, round(ELEMENTS * place / length))
        nodes = np.concatenate(
            [np.linspace(0, place, before + 1), np.linspace(place, length, ELEMENTS - before + 1)[1:]]
        )
        parts = [(k, k + 1, bending, per_length, h) for k, h in enumerate(np.diff(nodes).tolist())]
        rigidity, mass = assembled(len(nodes), parts)
        # The load is that of all nodes moving alike; the first is clamped.
        self.load, self.mass, self.rigidity = mass[2:, ::2].sum(axis=1), mass[2:, 2:], rigidity[2:, 2:]
        self.damping = damping
        self.tip, self.place = np.zeros((2, len(self.load)))
        self.tip[-2], self.place[2 * before - 2] = 1.0, 1.0


@dataclass(frozen=True)
class Law:
    """A one-sided force k d^n + b n k d^(n-1) d' of the overlap d, which is an offset with a row of the motion."""

    name: str
    row: Array
    stiffness: float
    damping: float
    power: float = 1.0
    offset: float = 0.0
    speed: float = 0.0
    """Of the offset, from `start` on."""
    start: float = 0.0

    def overlap(self, time: float, q: Array) -> float:
        """Return the overlap, m."""
        return float(self.offset + self.speed * max(time - self.start, 0.0) + self.row @ q)

    def rate(self, time: float, v: Array) -> float:
        """Return its derivative, m/s."""
        return float((self.speed if time >= self.start else 0.0) + self.row @ v)

    def sign(self, d: float, rate: float) -> float:
        """Return a length with the sign of the force of the closed law."""
        return d + self.damping * self.power * rate

    def force(self, d: float, rate: float) -> float:
        """Return the force of the closed law, N."""
        return float(self.stiffness * max(d, 0.0) ** (self.power - 1) * self.sign(d, rate))

    def elastic(self, d: float) -> float:
        """Return the force without damping, N."""
        return float(self.stiffness * max(d, 0.0) ** self.power)


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


@dataclass
class Course:
    """What a relay did."""

    force: Array
    """Contact force at the instants asked for, N."""
    place: Array
    """Position of the armature, m."""
    changes: dict[tuple[str, str], list[float]] = field(default_factory=dict)
    """Instants at which a law closes and leaves, by its name."""


OPEN, CLOSED, LOOSE = range(3)


class Relay:
    """Springs, contact, pusher, and if there is one the armature."""

    def __init__(
        self,
        values: Values,
        fixed: tuple[float, float] | None = None,
        pushed: tuple[float, float, float] = (0.0, 0.0, 0.0),
        coil: Coil | None = None,
    ) -> None:
        """Build it from parameters of the component.

        `fixed` is the width and thickness (m) of the fixed contact's spring; `pushed` where a prescribed pusher is
        (m), its speed (m/s) and from when on (s); without a coil the current is that of the hold force.
        """
        self.known: dict[str, Any] = {**STARTS, **values}
        self.get, self.coil = self.known.__getitem__, coil
        get = self.get
        length, beta = get("beam.length"), get("beam.stiffnessDamping")
        self.has_pusher, self.moves = get("effects.pusher") != "None", get("effects.pusher") == "Armature"
        place = get("pusher.position") if self.has_pusher else length / 2
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
        self.squares, self.damping, self.load, self.count = squares, damping, load, len(squares)
        self.laws = [self.contact(-opens)]
        if self.has_pusher:
            at, speed, start = pushed
            stiffness = get("pusher.stiffness")
            self.laws.append(
                Law("pusher", touched, stiffness, get("pusher.damping") / stiffness, 1.0, at, speed, start)
            )
        if self.moves:
            self.laws += self.stops()
        self.frequency = 2 * pi * get("excitation.frequency")
        self.amplitude, self.duration = get("excitation.amplitude"), np.inf
        if get("effects.excitation") == "HalfSine":
            self.duration = get("excitation.duration")
            self.frequency = pi / self.duration
        elif get("effects.excitation") == "None":
            self.amplitude = 0.0

    def contact(self, row: Array) -> Law:
        """Return the law of the contact."""
        get = self.get
        return Law("contact", row, hertz(self.known), get("contact.damping"), 1.5, get("contact.overtravel"))

    def stops(self) -> list[Law]:
        """Return the laws of both stops."""
        get, wanted = self.get, self.get("armature.stopRestitution")

        def left(ratio: float) -> float:
            swing = sqrt(1 - ratio**2)
            return exp(-ratio / swing * atan2(2 * ratio * swing, 2 * ratio**2 - 1))

        ratio = brentq(lambda ratio: left(ratio) - wanted, 1e-9, 1 - 1e-9) if wanted < 1 else 0.0
        stiffness, row = get("armature.stopStiffness"), np.zeros(self.count)
        row[-1] = 1 / sqrt(self.mass)
        damping = 2 * ratio * sqrt(self.mass / stiffness)
        core, rest = get("armature.corePosition"), get("armature.restPosition")
        return [
            Law("core", row, stiffness, damping, offset=-core),
            Law("rest", -row, stiffness, damping, offset=rest),
        ]

    def place(self, q: Array) -> float:
        """Return the position of the armature, m."""
        return float(q[-1]) / sqrt(self.mass) if self.moves else 0.0

    def magnet(self, place: float, flux: float) -> float:
        """Return the force towards the core (N), without a coil that of a held current."""
        if self.coil:
            return flux**2 / (2 * self.coil.inductance * self.coil.constant)
        hold, constant = self.get("armature.holdForce"), self.get("armature.gapConstant")
        gap = max(self.get("armature.corePosition") - place, 0.0)
        return float(hold / (1 + gap / constant) ** 2)

    def held(self, place: float, flux: float) -> float:
        """Return the force on the armature (N) but those of its stops, of the pusher and in proportion to its place."""
        get = self.get
        back = get("armature.returnForce") - get("armature.stiffness") * get("armature.restPosition")
        return self.magnet(place, flux) - float(back)

    def at_rest(self) -> Array:
        """Return the equilibrium: of an armature that is held, or of one without current."""
        core = self.get("armature.corePosition")

        def bent(overlaps: Array) -> Array:
            total = -sum(law.row * law.elastic(d) for law, d in zip(self.laws, overlaps.tolist(), strict=True))
            if self.moves:
                total[-1] += self.held(overlaps[2] + core, 0.0) / sqrt(self.mass)
            return np.asarray(total / self.squares)

        def left(overlaps: Array) -> list[float]:
            q = bent(overlaps)
            return [law.overlap(0.0, q) - d for law, d in zip(self.laws, overlaps.tolist(), strict=True)]

        stop = self.get("armature.restPosition" if self.coil else "armature.corePosition")
        start = [1e-7, 1e-6, stop - core, self.get("armature.restPosition") - stop][: len(self.laws)]
        found = root(left, start, tol=1e-15)
        assert np.abs(found.fun).max() < 1e-14
        return bent(found.x)

    def states(self, time: float, q: Array) -> list[int]:
        """Return the states of the laws at rest."""
        return [CLOSED if law.overlap(time, q) > 0 else OPEN for law in self.laws]

    def forces(self, time: float, q: Array, v: Array, states: Sequence[int], flux: float) -> Array:
        """Return the forces on the modes but those of springs, dampers and base."""
        total = np.zeros(self.count)
        for law, state in zip(self.laws, states, strict=True):
            if state == CLOSED:
                total -= law.row * law.force(law.overlap(time, q), law.rate(time, v))
        if self.moves:
            total[-1] += self.held(self.place(q), flux) / sqrt(self.mass)
        return total

    def base(self, time: float) -> float:
        """Return the acceleration of the base, m/s2."""
        return self.amplitude * sin(self.frequency * time) if time < self.duration else 0.0

    def rates(self, time: float, state: Array, states: Sequence[int], voltage: float) -> Array:
        """Return the derivatives of displacements, velocities and flux linkage."""
        n = self.count
        q, v, flux = state[:n], state[n : 2 * n], state[-1]
        turns = self.forces(time, q, v, states, flux) - self.squares * q - self.damping * v
        gap = self.get("armature.corePosition") - self.place(q)
        flows = self.coil.slope(flux, gap, voltage) if self.coil else 0.0
        return np.concatenate([v, turns - self.load * self.base(time), [flows]])

    def integrate(self, states: list[int], voltage: float) -> Any:  # noqa: ANN401
        """Return a solver of the motion while no law changes and the voltage stays."""
        n = self.count
        # What does not matter in a state is watched in no direction: by a constant.
        watched = {OPEN: (1, 0), CLOSED: (0, -1), LOOSE: (-1, 1)}
        directions = np.array([each for state in states for each in watched[state]])

        def events(time: float, state: Array) -> Array:
            found = []
            for law in self.laws:
                d, rate = law.overlap(time, state[:n]), law.rate(time, state[n : 2 * n])
                found += [d, law.sign(d, rate)]
            return np.where(directions == 0, 1.0, found)

        absolute = np.concatenate([np.full(n, ABSOLUTE), np.full(n, FASTEST * ABSOLUTE), [1e-12]])
        return cvode(
            lambda time, state: self.rates(time, state, states, voltage), events, directions.tolist(), True, RELATIVE,
            absolute,
        )  # fmt: skip

    def solve(self, times: Array) -> Course:
        """Return the course at instants (s) from the first, where it is at rest, on."""
        n, coil = self.count, self.coil
        start = self.at_rest()
        states = self.states(float(times[0]), start)
        state = np.concatenate([start, np.zeros(n + 1)])
        kinks = [self.duration] + [law.start for law in self.laws] + ([coil.on, coil.off] if coil else [])
        course = Course(np.zeros(0), np.zeros(0))
        now, solver, force, place = float(times[0]), None, [], []
        for time in times.tolist():
            while now < time:
                stop = min([time, *(kink for kink in kinks if now < kink < time)])
                if solver is None:
                    voltage = coil.voltage if coil and coil.on <= now < coil.off else 0.0
                    solver = self.integrate(states, voltage)
                    solver.init_step(now, state)
                found = solver.step(stop, tstop=min([np.inf, *(kink for kink in kinks if kink > now)]))
                assert found.success, found.message
                now, state = float(found.t), np.array(found.y)
                if now < stop or found.i_events is not None:
                    states = self.changed(now, state, states, found, course)
                    solver = None
                elif stop in kinks:
                    solver = None
            place.append(self.place(state[:n]))
            contact = self.laws[0]
            closed = states[0] == CLOSED
            force.append(
                contact.force(contact.overlap(time, state[:n]), contact.rate(time, state[n : 2 * n])) if closed else 0.0
            )
        course.force, course.place = np.array(force), np.array(place)
        return course

    def changed(self, time: float, state: Array, states: list[int], found: Any, course: Course) -> list[int]:  # noqa: ANN401
        """Return the states of the laws after those changes that were found, and note them."""
        n, after = self.count, list(states)
        for k in np.flatnonzero(np.atleast_2d(found.i_events)[-1]):
            law, old, by_force = self.laws[k // 2], states[k // 2], k % 2 == 1
            loose = law.overlap(time, state[:n]) > 0 and law.damping > 0
            new = (
                (CLOSED if old == LOOSE else LOOSE if loose else OPEN)
                if by_force
                else (CLOSED if old == OPEN else OPEN)
            )
            after[k // 2] = new
            if CLOSED in (old, new):
                course.changes.setdefault((law.name, "closes" if new == CLOSED else "leaves"), []).append(time)
        return after
