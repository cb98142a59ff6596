"""Modes under one-sided laws, such as contacts, pushers and stops, from one change of a law to the next.

Each law is open, closed, or loose: overlapping with a force that its damper has taken to zero. SUNDIALS' CVODE
integrates between the instants at which one of them changes, which it finds as roots.
"""

from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import copysign, cos, exp, inf, log, pi, sin
from typing import Any, Literal

import numpy as np
from scipy.optimize import root
from sksundae.cvode import CVODE

from relay_contact import Array

FASTEST = 1e4
"""Angular frequency (1/s) by which the absolute tolerance of velocities follows from that of displacements."""
OPEN, CLOSED, LOOSE = range(3)

Acceleration = Callable[[float], float]
ClosedBy = Literal["overlap", "force", "nothing"]
"""What has to be above zero in a law that is closed: overlap and force, the force alone, or nothing, of power 1."""


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
    """Of the offset."""
    limit: float = 0.0
    """Force whose instants are noted too, N; 0: none."""
    closed_by: ClosedBy = "overlap"

    def overlap(self, time: float, q: Array) -> float:
        """Return the overlap, m."""
        return float(self.offset + self.speed * time + self.row @ q)

    def rate(self, v: Array) -> float:
        """Return its derivative, m/s."""
        return float(self.speed + self.row @ v)

    def sign(self, d: float, rate: float) -> float:
        """Return a length with the sign of the force of the closed law."""
        return d + self.damping * self.power * rate

    def force(self, d: float, rate: float) -> float:
        """Return the force of the closed law, N."""
        return float(self.stiffness * max(d, 0.0) ** (self.power - 1) * self.sign(d, rate))

    def elastic(self, d: float) -> float:
        """Return the force without damping, N."""
        return float(self.stiffness * max(d, 0.0) ** self.power)


@dataclass
class Course:
    """What a system did at the instants asked for, by law, and the instants of changes."""

    overlaps: dict[str, Array]
    forces: dict[str, Array]
    changes: dict[tuple[str, str], list[float]]
    """When a law closes and leaves, and its force rises above its limit and falls below, by its name."""
    rows: Array
    """What else is observed, by column."""


def risen(time: float, rise: float) -> float:
    """Return the part of its amplitude that a sine has reached which rises by half a period of a cosine."""
    return (1 - cos(pi * time / rise)) / 2 if time < rise else 1.0


def shaking(known: dict[str, Any]) -> tuple[Acceleration, float, float]:
    """Return the acceleration of the base by the parameters of a component, and instants (s) at which it bends."""
    names = "amplitude", "frequency", "endFrequency", "phase", "startTime", "duration", "riseTime", "displacementLimit"
    amplitude, first, last, phase, start, duration, rise, limit = (known[f"excitation.{name}"] for name in names)
    kind = known["effects.excitation"]

    def size(omega: float) -> float:
        return copysign(min(abs(amplitude), omega**2 * (limit or inf)), amplitude)

    def since(time: float) -> float:
        if kind == "Sine":
            omega = 2 * pi * first
            return size(omega) * risen(time, rise) * sin(omega * time + phase)
        if kind == "HalfSine" and time < duration:
            return float(amplitude * sin(pi * time / duration))
        if kind == "LogSweep" and time < duration:
            rate = log(last / first) / duration
            omega = 2 * pi * first * exp(rate * time)
            return size(omega) * sin((omega - 2 * pi * first) / rate + phase)
        return 0.0

    end = start + ((rise or inf) if kind == "Sine" else duration)
    return lambda time: since(time - start) if time >= start else 0.0, start, end


class System:
    """Modes of unit mass under their springs, dampers and laws, on a shaken base."""

    def __init__(
        self, squares: Array, damping: Array, load: Array, laws: Sequence[Law], base: Acceleration, *kinks: float
    ) -> None:
        """Take squares of angular frequencies, damping, load per base acceleration, and instants where this breaks."""
        self.squares, self.damping, self.load, self.laws, self.base = squares, damping, load, list(laws), base
        self.count, self.kinks = len(squares), kinks
        self.pull = np.zeros(self.count)
        """Constant forces on the modes."""
        self.relative = 1e-9
        """Tolerance: with 1e-11, and a floor of 1e-17, forces of a whole relay change by 8e-6 of the largest."""
        self.floor = 1e-16 * np.repeat([1.0, FASTEST, FASTEST], [self.count, self.count, 1])
        """Absolute tolerances of modal displacements (m sqrt(kg)), velocities and the flux linkage."""
        self.near = [1e-7] * len(self.laws)
        """Overlaps (m) beside those at rest."""

    def bent(self, overlaps: Array) -> Array:
        """Return the displacements under constant forces of these overlaps."""
        force = sum(law.row * law.elastic(d) for law, d in zip(self.laws, overlaps.tolist(), strict=True))
        return np.asarray((self.pull - force) / self.squares)

    def at_rest(self) -> Array:
        """Return the displacements in equilibrium."""

        def left(overlaps: Array) -> Array:
            q = self.bent(overlaps)
            return np.array([law.overlap(0.0, q) for law in self.laws]) - overlaps

        found = root(left, self.near, tol=1e-15)
        assert np.abs(found.fun).max() < 1e-14
        return self.bent(found.x)

    def split(self, state: Array) -> tuple[Array, Array, Array]:
        """Return displacements, velocities, and what is beside them."""
        return state[: self.count], state[self.count : 2 * self.count], state[2 * self.count :]

    def forces(self, time: float, state: Array, phases: Sequence[int]) -> list[float]:
        """Return the force of each law, N."""
        q, v, _ = self.split(state)
        pairs = zip(self.laws, phases, strict=True)
        return [law.force(law.overlap(time, q), law.rate(v)) if phase == CLOSED else 0.0 for law, phase in pairs]

    def further(self, state: Array, time: float) -> tuple[Array | float, Sequence[float]]:  # noqa: ARG002
        """Return further forces on the modes, and the derivatives of what is beside the motion, such as flux (V)."""
        return 0.0, [0.0]

    def rates(self, time: float, state: Array, phases: Sequence[int], middle: float) -> Array:
        """Return the derivatives; `middle` is a time on the same side of a kink."""
        q, v, _ = self.split(state)
        pushed = sum(law.row * force for law, force in zip(self.laws, self.forces(time, state, phases), strict=True))
        force, others = self.further(state, middle)
        turns = self.pull + force - pushed - self.squares * q - self.damping * v - self.load * self.base(time)
        return np.concatenate([v, turns, others])

    def ways(self, phases: Sequence[int]) -> list[int | None]:
        """Return the directions in which what is watched changes a phase: 0 in both, none in no direction."""
        watched: dict[str, dict[int, list[int | None]]] = {
            "overlap": {OPEN: [1, None], CLOSED: [None, -1], LOOSE: [-1, 1]},
            "force": {CLOSED: [None, -1], LOOSE: [None, 1]}, "nothing": {CLOSED: [None, None]},
        }  # fmt: skip
        pairs = zip(self.laws, phases, strict=True)
        own = [each for law, phase in pairs for each in watched[law.closed_by][phase]]
        return [*own, *(0 if law.limit else None for law in self.laws)]

    def watched(self, time: float, state: Array, phases: Sequence[int]) -> list[float]:
        """Return what is watched: overlap and sign of the force of each law, then the forces above their limits."""
        q, v, _ = self.split(state)
        own = [(d := law.overlap(time, q), law.sign(d, law.rate(v))) for law in self.laws]
        forces = zip(self.laws, self.forces(time, state, phases), strict=True)
        return [*(each for pair in own for each in pair), *(force - law.limit for law, force in forces)]

    def integrate(self, state: Array, phases: Sequence[int], middle: float) -> Any:  # noqa: ANN401, ARG002
        """Return a solver of the motion from a state while no law changes."""
        ways = self.ways(phases)
        ignored = np.array([way is None for way in ways])

        def into(time: float, state: Array, found: Array) -> None:
            found[:] = self.rates(time, state, phases, middle)

        def located(time: float, state: Array, found: Array) -> None:
            found[:] = np.where(ignored, 1.0, self.watched(time, state, phases))

        located.direction, located.terminal = [way or 0 for way in ways], [True] * len(ways)  # type: ignore[attr-defined]
        return CVODE(into, eventsfn=located, num_events=len(ways), rtol=self.relative, atol=self.floor,
                     max_num_steps=500_000)  # fmt: skip

    def start(self, now: float) -> tuple[Array, list[int]]:
        """Return the state at rest with its phases."""
        state = np.concatenate([self.at_rest(), np.zeros(len(self.floor) - self.count)])
        return state, [self.phase(law, now, state) for law in self.laws]

    def observed(self, state: Array) -> list[float]:  # noqa: ARG002
        """Return what else is to be known of a state."""
        return []

    def solve(self, times: Array) -> Course:
        """Return the course at instants (s) from the first, where it is at rest, on."""
        now, solver = float(times[0]), None
        state, phases = self.start(now)
        changes: dict[tuple[str, str], list[float]] = defaultdict(list)
        overlaps, forces, rows = [], [], []
        for time in times.tolist():
            while now < time:
                kink = min([np.inf, *(each for each in self.kinks if each > now)])
                stop = min(time, kink)
                if solver is None:
                    solver = self.integrate(state, phases, (now + stop) / 2)
                    solver.init_step(now, state)
                found = solver.step(stop, tstop=kink)
                assert found.success, found.message
                now, state = float(found.t), np.array(found.y)
                if found.i_events is not None:
                    phases = self.changed(now, state, phases, np.atleast_2d(found.i_events)[-1], changes)
                    solver = None
                elif now == kink:
                    solver = None
            overlaps.append([law.overlap(time, state[: self.count]) for law in self.laws])
            forces.append(self.forces(time, state, phases))
            rows.append(self.observed(state))

        def by_law(rows: list[list[float]]) -> dict[str, Array]:
            return dict(zip((law.name for law in self.laws), np.transpose(rows), strict=True))

        return Course(by_law(overlaps), by_law(forces), changes, np.transpose(rows))

    def phase(self, law: Law, time: float, state: Array) -> int:
        """Return the phase of a law at the begin."""
        q, v, _ = self.split(state)
        d, rate = law.overlap(time, q), law.rate(v)
        if law.closed_by == "overlap" and (d < 0 or d == 0 >= rate):
            return OPEN
        return CLOSED if law.closed_by == "nothing" or law.sign(d, rate) > 0 else LOOSE

    def changed(
        self, time: float, state: Array, phases: list[int], turns: Array, changes: dict[tuple[str, str], list[float]]
    ) -> list[int]:
        """Return the phases of the laws after those changes that were found, and note them."""
        after, (q, v, _) = list(phases), self.split(state)
        for at in np.flatnonzero(turns).tolist():
            number, by_force = divmod(at, 2)
            if number >= len(self.laws):
                name = self.laws[at - 2 * len(self.laws)].name
                changes[name, "rises" if turns[at] > 0 else "falls"].append(time)
                continue
            law, old = self.laws[number], phases[number]
            d, rate = law.overlap(time, q), law.rate(v)
            loose = law.closed_by == "force" or (d > 0 and law.damping > 0)
            closes = old == (LOOSE if by_force else OPEN)
            after[number] = CLOSED if closes else LOOSE if by_force and loose else OPEN
            if CLOSED in (old, after[number]):
                changes[law.name, "closes" if closes else "leaves"].append(time)
            # A damped force is above its limit as soon as there is an overlap.
            if closes and 0 < law.limit < law.force(d, rate):
                changes[law.name, "rises"].append(time)
        return after
