"""The second contact of a changeover relay, by the motion of the spring between both, solved by other means."""

from functools import cache
from math import pi, sin
from typing import Any

import numpy as np
import pytest

from reference import Reference, cvode
from relay_contact import Array, Values
from relay_contact.scene import Scene, run

TOLERANCE, STEP = 1e-6, 5e-6
# Instants are located to 1 ns.
LOCATED = 1e-9
# Contacts that differ in radius and damping, with so little damping that they bounce.
CHANGEOVER: Values = {
    "effects.axialForce": "None",
    "effects.secondContact": True,
    "effects.excitation": "Sine",
    "excitation.frequency": 1000.0,
    "contact.damping": 1e-6,
    "second.damping": 3e-6,
    "second.curvatureRadius": 5e-3,
    "solver.tolerance": TOLERANCE,
}
SIDES = ("contact", "second")
MONITORS = ("chatter", "second")
OUTPUTS = [
    *(f"{side}.{name}" for side in SIDES for name in ("force", "closed", "lastOpening", "lastClosing")),
    *(f"{side}.{name}" for side in MONITORS for name in ("falseMakes", "longestFalseMake", "totalFalseMake")),
    "step.minimumGap",
]


class Between:
    """The spring between two contacts, by the equations of motion with both forces and SUNDIALS CVODE."""

    def __init__(self, values: Values, speeds: tuple[float, float], times: Array, tolerance: float) -> None:
        """Solve them; both fixed contacts come at these constant speeds (m/s), the second relative to the first."""
        self.first = Reference(values)
        known = self.first.values
        of_second = {f"contact.{name}": known[f"second.{name}"] for name in ("curvatureRadius", "damping")}
        self.laws = self.first, Reference({**values, **of_second})
        self.gap: float = known["second.gap"]
        self.limit = self.first.force_of_resistance(known["chatter.resistanceThreshold"])
        self.speeds = speeds
        amplitude, omega = known["excitation.amplitude"], 2 * pi * known["excitation.frequency"]
        equations = self.first.equations(lambda time: amplitude * sin(omega * time), self._load)

        def events(time: float, motion: Array) -> list[float]:
            tip = time, *equations.tip(motion)
            return [self._overlap(side, *tip) for side in (0, 1)] + self._margins(*tip)

        solver = cvode(equations.rates, events, [0] * 4, False, tolerance, tolerance * equations.scale)
        solution = solver.solve(times, np.zeros(equations.size))
        assert solution.success, solution.message
        # The instants of events are among its times.
        asked = np.searchsorted(solution.t, times)
        self.times, self.tip = times, equations.tip(solution.y[asked].T)
        self.event_times, self.events = solution.t_events, solution.i_events

    def _indentations(self, time: Any, deflection: Any, rate: Any) -> list[Any]:  # noqa: ANN401
        """Give indentation and its rate for each contact."""
        first, second = self.speeds
        change, change_rate = first * time - deflection, first - rate
        return [
            (self.first.indentation + change, change_rate),
            (second * time - self.gap - change, second - change_rate),
        ]

    def _laws(self, *tip: float) -> list[float]:
        return [law.law_force(*at) for law, at in zip(self.laws, self._indentations(*tip), strict=True)]

    def _load(self, *tip: float) -> float:
        first, second = self._laws(*tip)
        return first - second

    def _margins(self, *tip: float) -> list[float]:
        """Force of each contact above that of the threshold resistance, N."""
        return [force - self.limit for force in self._laws(*tip)]

    def _overlap(self, side: int, *tip: Any) -> Any:  # noqa: ANN401
        """Give what is positive where a contact has a force: its indentation, or what damping leaves of it (m)."""
        indentation, rate = self._indentations(*tip)[side]
        return np.minimum(indentation, indentation + 1.5 * self.laws[side].contact_damping * rate)

    def forces(self, side: int, every: int) -> Array:
        """Force of a contact at so many times each but the first, N."""
        tips = zip(*(course[every::every] for course in (self.times, *self.tip)), strict=True)
        return np.array([self._laws(*tip)[side] for tip in tips])

    def closed(self, side: int) -> Any:  # noqa: ANN401
        """Whether a contact has a force, at all times."""
        return self._overlap(side, self.times, *self.tip) > 0

    def gaps(self) -> Array:
        """Gap at the second contact at all times, m."""
        indentation: Array = self._indentations(self.times, *self.tip)[1][0]
        return -indentation

    def instants(self, event: int) -> tuple[Array, Array]:
        """Give the instants at which an event's value falls through zero and those at which it rises."""
        return tuple(self.event_times[self.events[:, event] == turn] for turn in (-1, 1))


# Vibration between fixed contacts at rest; and vibration while both move past the spring, as the armature of a relay
# moves them, and the second comes closer to the first.
MOTIONS: dict[str, tuple[Values, tuple[float, float], float]] = {
    "shaken": ({**CHANGEOVER, "excitation.amplitude": 600.0, "second.gap": 2e-5}, (0.0, 0.0), 3e-3),
    "moved": ({**CHANGEOVER, "excitation.amplitude": 300.0, "second.gap": 1e-4}, (-0.1, 0.01), 4e-3),
}


# Places at which each step is looked at for its smallest gap.
PLACES = 100


def solved(name: str, places: int, tolerance: float) -> Between:
    """Solve the equations of motion at as many times in each step."""
    values, speeds, stop = MOTIONS[name]
    return Between(values, speeds, np.linspace(0.0, stop, round(stop / STEP) * places + 1), tolerance)


@cache
def results(name: str) -> tuple[dict[str, Array], Between, float]:
    """Run the component and the reference; give the error allowed in a force too, N."""
    values, speeds, stop = MOTIONS[name]
    ends = np.array([0.0, stop])
    moved = {"support.displacement": speeds[0] * ends, "second.displacement": speeds[1] * ends}
    found = run(Scene("", stop, STEP, OUTPUTS, dict(values), {"time": ends, **moved})).columns
    between = solved(name, PLACES, 1e-12)
    # Relative to the largest force of the run; here that of a blow.
    largest = max(found[f"{side}.force"].max() for side in SIDES)
    assert largest > 10 * between.first.force_scale
    return found, between, TOLERANCE * largest


@pytest.mark.parametrize("name", MOTIONS)
def test_the_forces_of_both_contacts(name: str) -> None:
    found, between, allowed = results(name)
    coarser = solved(name, 1, 1e-11)
    # At time 0 the fixed contacts have not moved yet, and the forces are those of the preload.
    for side, contact in enumerate(SIDES):
        force = found[f"{contact}.force"][1:]
        expected, coarse = between.forces(side, PLACES), coarser.forces(side, 1)
        # The reference's own error is some tenth of this difference; 24 modes in place of 16 change its forces by less
        # than 0.1 of what is allowed.
        assert np.max(np.abs(coarse - expected)) <= 0.5 * allowed
        assert np.max(np.abs(force - expected)) <= allowed
        assert (found[f"{contact}.closed"][1:].astype(bool) == (force > 0)).all()
    assert (np.minimum(found["contact.force"], found["second.force"]) == 0).all()


@pytest.mark.parametrize("name", MOTIONS)
def test_the_instants_at_which_both_contacts_open_and_close(name: str) -> None:
    found, between, _ = results(name)
    for side, contact in enumerate(SIDES):
        openings, closings = between.instants(side)
        assert len(closings) >= 2
        for output, expected in (("lastOpening", openings), ("lastClosing", closings)):
            instants = np.unique(found[f"{contact}.{output}"])
            # -1: not yet; 0: the fixed contact leaves at the start, so fast that the contact opens at once.
            assert instants[instants > 0] == pytest.approx(expected, rel=0, abs=LOCATED)


@pytest.mark.parametrize("name", MOTIONS)
def test_the_smallest_gap_of_each_step(name: str) -> None:
    found, between, allowed = results(name)
    # Those of each step with both of its ends.
    steps = np.arange(len(found["time"]) - 1)
    inside = PLACES * steps + np.arange(PLACES + 1)[:, None]
    gaps = between.gaps()[inside]
    places = np.argmin(gaps, axis=0)
    expected = np.min(gaps, axis=0)
    closed = between.closed(1)[inside[places, steps]]
    assert np.any(closed)
    # The gap is as wrong as the force over the stiffness, of the second contact or, where it is open, of the spring.
    stiffness = np.full(len(places), between.first.tip_stiffness)
    stiffness[closed] = between.laws[1].stiffness_at(-expected[closed])
    # Between the places it is smaller by an eighth of their second difference at most.
    between_places = np.max(np.diff(gaps, 2, axis=0), axis=0).clip(0) / 8
    assert (np.abs(found["step.minimumGap"][1:] - expected) <= allowed / stiffness + between_places).all()


@pytest.mark.parametrize("name", MOTIONS)
def test_false_makes_of_both_contacts(name: str) -> None:
    found, between, _ = results(name)
    for side, monitor in enumerate(MONITORS):
        ends, starts = between.instants(2 + side)
        # What is closed at the start is no make; what is closed at the end is one that lasts.
        ends = np.append(ends[ends > starts[0]], found["time"][-1])[: len(starts)]
        lasting = ends - starts
        assert (lasting > between.first.values["second.minimumDuration"]).all()
        count, longest, total = (
            found[f"{monitor}.{name}"][-1] for name in ("falseMakes", "longestFalseMake", "totalFalseMake")
        )
        assert count == len(starts) >= 2
        assert longest == pytest.approx(np.max(lasting), rel=0, abs=2 * LOCATED)
        assert total == pytest.approx(np.sum(lasting), rel=0, abs=2 * len(starts) * LOCATED)
