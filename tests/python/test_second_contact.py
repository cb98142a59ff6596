"""The second contact of a changeover relay, by the motion of the spring between both, solved by other means."""

from functools import cache, partial
from math import pi, sin
from typing import Any

import numpy as np
import pytest

from reference import Reference, crossings
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
    """The spring between two contacts, by the equations of motion with both forces."""

    def __init__(self, values: Values, speeds: tuple[float, float], stop: float, tolerance: float) -> None:
        """Solve them; both fixed contacts come at these constant speeds (m/s), the second relative to the first."""
        self.first = Reference(values)
        known = self.first.values
        of_second = {f"contact.{name}": known[f"second.{name}"] for name in ("curvatureRadius", "damping")}
        self.laws = self.first, Reference({**values, **of_second})
        self.gap: float = known["second.gap"]
        self.speeds = speeds
        amplitude, omega = known["excitation.amplitude"], 2 * pi * known["excitation.frequency"]
        self.tip = self.first.tip(lambda time: amplitude * sin(omega * time), stop, tolerance, self._load)

    def _indentations(self, time: Any, deflection: Any, rate: Any) -> list[Any]:  # noqa: ANN401
        """Give indentation and its rate for each contact."""
        first, second = self.speeds
        change, change_rate = first * time - deflection, first - rate
        return [
            (self.first.indentation + change, change_rate),
            (second * time - self.gap - change, second - change_rate),
        ]

    def _load(self, time: float, deflection: float, rate: float) -> tuple[float, float, float]:
        first, second = (
            law.law_force(*indentation)
            for law, indentation in zip(self.laws, self._indentations(time, deflection, rate), strict=True)
        )
        return first[0] - second[0], first[1] + second[1], first[2] + second[2]

    def force(self, side: int, time: float) -> float:
        """Force of a contact, N."""
        return self.laws[side].law_force(*self._indentations(time, *self.tip(time))[side])[0]

    def overlap(self, side: int, time: Any) -> Any:  # noqa: ANN401
        """Give what is positive where a contact has a force: its indentation, or what damping leaves of it (m)."""
        indentation, rate = self._indentations(time, *self.tip(time))[side]
        return np.minimum(indentation, indentation + 1.5 * self.laws[side].contact_damping * rate)

    def gaps(self, times: Array) -> Array:
        """Gap at the second contact, m."""
        indentation: Array = self._indentations(times, *self.tip(times))[1][0]
        return -indentation


# Vibration between fixed contacts at rest; and vibration while both move past the spring, as the armature of a relay
# moves them, and the second comes closer to the first.
MOTIONS: dict[str, tuple[Values, tuple[float, float], float]] = {
    "shaken": ({**CHANGEOVER, "excitation.amplitude": 600.0, "second.gap": 2e-5}, (0.0, 0.0), 3e-3),
    "moved": ({**CHANGEOVER, "excitation.amplitude": 300.0, "second.gap": 1e-4}, (-0.1, 0.01), 4e-3),
}


@cache
def results(name: str) -> tuple[dict[str, Array], Between, float]:
    """Run the component and the reference; give the error allowed in a force too, N."""
    values, speeds, stop = MOTIONS[name]
    ends = np.array([0.0, stop])
    moved = {"support.displacement": speeds[0] * ends, "second.displacement": speeds[1] * ends}
    found = run(Scene("", stop, STEP, OUTPUTS, dict(values), {"time": ends, **moved})).columns
    between = Between(values, speeds, stop, 1e-10)
    # Relative to the largest force of the run; here that of a blow.
    largest = max(found[f"{side}.force"].max() for side in SIDES)
    assert largest > 10 * between.first.force_scale
    return found, between, TOLERANCE * largest


@pytest.mark.parametrize("name", MOTIONS)
def test_the_forces_of_both_contacts(name: str) -> None:
    found, between, allowed = results(name)
    values, speeds, stop = MOTIONS[name]
    coarser = Between(values, speeds, stop, 1e-9)
    # At time 0 the fixed contacts have not moved yet, and the forces are those of the preload.
    times = found["time"][1:]
    for side, contact in enumerate(SIDES):
        force = found[f"{contact}.force"][1:]
        expected, coarse = (np.array([each.force(side, time) for time in times]) for each in (between, coarser))
        # The reference's own error is some tenth of this difference, which is up to 0.2 of what is allowed, by how sums
        # are rounded; 24 modes in place of 16 change its forces by less than 0.1 of that.
        assert np.max(np.abs(coarse - expected)) <= 0.5 * allowed
        assert np.max(np.abs(force - expected)) <= allowed
        assert (found[f"{contact}.closed"][1:].astype(bool) == (force > 0)).all()
    assert (np.minimum(found["contact.force"], found["second.force"]) == 0).all()


@pytest.mark.parametrize("name", MOTIONS)
def test_the_instants_at_which_both_contacts_open_and_close(name: str) -> None:
    found, between, _ = results(name)
    # No contact is open or closed for less than 10 us.
    times = np.arange(0.0, found["time"][-1], 1e-6)
    for side, contact in enumerate(SIDES):
        openings, closings = crossings(partial(between.overlap, side), 0.0, times)
        assert len(closings) >= 2
        for output, expected in (("lastOpening", openings), ("lastClosing", closings)):
            instants = np.unique(found[f"{contact}.{output}"])
            # -1: not yet; 0: the fixed contact leaves at the start, so fast that the contact opens at once.
            assert instants[instants > 0] == pytest.approx(expected, rel=0, abs=LOCATED)


@pytest.mark.parametrize("name", MOTIONS)
def test_the_smallest_gap_of_each_step(name: str) -> None:
    found, between, allowed = results(name)
    times = np.linspace(found["time"][:-1], found["time"][1:], 401)
    gaps = between.gaps(times.ravel()).reshape(times.shape)
    places = np.argmin(gaps, axis=0)
    expected = np.min(gaps, axis=0)
    closed = between.overlap(1, times[places, np.arange(len(places))]) > 0
    assert np.any(closed)
    # The gap is as wrong as the force over the stiffness, of the second contact or, where it is open, of the spring.
    stiffness = np.full(len(places), between.first.tip_stiffness)
    stiffness[closed] = 1.5 * between.laws[1].hertz * np.sqrt(-expected[closed])
    # Between the samples it is smaller by an eighth of their second difference at most.
    between_samples = np.max(np.diff(gaps, 2, axis=0), axis=0) / 8
    assert (np.abs(found["step.minimumGap"][1:] - expected) <= allowed / stiffness + between_samples).all()


@pytest.mark.parametrize("name", MOTIONS)
def test_false_makes_of_both_contacts(name: str) -> None:
    found, between, _ = results(name)
    known = between.first.values
    limit = between.first.force_of_resistance(known["chatter.resistanceThreshold"])
    times = np.arange(0.0, found["time"][-1], 1e-6)
    for side, monitor in enumerate(MONITORS):
        ends, starts = crossings(partial(between.force, side), limit, times)
        # What is closed at the start is no make; what is closed at the end is one that lasts.
        ends = np.append(ends[ends > starts[0]], found["time"][-1])[: len(starts)]
        lasting = ends - starts
        assert (lasting > known["second.minimumDuration"]).all()
        count, longest, total = (
            found[f"{monitor}.{name}"][-1] for name in ("falseMakes", "longestFalseMake", "totalFalseMake")
        )
        assert count == len(starts) >= 2
        assert longest == pytest.approx(np.max(lasting), rel=0, abs=2 * LOCATED)
        assert total == pytest.approx(np.sum(lasting), rel=0, abs=2 * len(starts) * LOCATED)
