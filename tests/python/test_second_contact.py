"""The second contact of a changeover relay, by the motion of the spring between both, solved by other means."""

from functools import cache

import numpy as np
import pytest

from component import run
from one_sided import Course, Law, System, shaking
from reference import Reference, hertz
from relay_contact import Array, Values
from relay_contact.component import sine

TOLERANCE, STEP = 1e-6, 5e-6
# Instants are located to 1 ns.
LOCATED = 1e-9
# Contacts that differ in radius and damping, with so little damping that they bounce.
CHANGEOVER: Values = {
    "effects.axialForce": "None", "effects.secondContact": True, "solver.tolerance": TOLERANCE,
    "contact.damping": 1e-6, "second.damping": 3e-6, "second.curvatureRadius": 5e-3,
}  # fmt: skip
SIDES = ("contact", "second")
MONITORS = ("chatter", "second")
OUTPUTS = [
    *(f"{side}.{name}" for side in SIDES for name in ("force", "closed", "lastOpening", "lastClosing")),
    *(f"{side}.{name}" for side in MONITORS for name in ("falseMakes", "longestFalseMake", "totalFalseMake")),
    "step.minimumGap",
]


# Vibration between fixed contacts at rest; and vibration while both move past the spring, as the armature of a relay
# moves them, and the second comes closer to the first.
MOTIONS: dict[str, tuple[Values, tuple[float, float], float]] = {
    "shaken": ({**CHANGEOVER, **sine(1000.0, 600.0), "second.gap": 2e-5}, (0.0, 0.0), 3e-3),
    "moved": ({**CHANGEOVER, **sine(1000.0, 300.0), "second.gap": 1e-4}, (-0.1, 0.01), 4e-3),
}


# Places at which each step is looked at for its smallest gap.
PLACES = 100


def solved(name: str, places: int, tolerance: float) -> tuple[Course, Reference]:
    """Solve the equations of motion at as many times in each step; give the contact at preload, too."""
    values, (first, second), stop = MOTIONS[name]
    relay = Reference(values)
    known, modes = relay.values, relay.modes()
    limit = relay.force_of_resistance(known["chatter.resistanceThreshold"])
    laws = [
        Law(side, way * modes.tip, hertz(known, side), known[f"{side}.damping"], 1.5, at, speed, limit=limit)
        for side, way, at, speed in (
            ("contact", -1, relay.overtravel, first),
            # Its fixed contact moves relative to the first.
            ("second", 1, -known["second.gap"] - relay.deflection, second - first),
        )
    ]
    spring = System(modes.omega_squared, modes.damping, modes.participation, laws, *shaking(known))
    spring.relative, spring.floor = tolerance, 1e9 * tolerance * spring.floor
    spring.near = [1e-7, -known["second.gap"]]
    return spring.solve(np.linspace(0.0, stop, round(stop / STEP) * places + 1)), relay


@cache
def results(name: str) -> tuple[dict[str, Array], Course, Reference, float]:
    """Run the component and the reference; give the error allowed in a force too, N."""
    values, speeds, stop = MOTIONS[name]
    ends = np.array([0.0, stop])
    moved = {"support.displacement": speeds[0] * ends, "second.displacement": speeds[1] * ends}
    found = run(values, stop, STEP, OUTPUTS, {"time": ends, **moved})
    course, relay = solved(name, PLACES, 1e-12)
    # Relative to the largest force of the run; here that of a blow.
    largest = max(found[f"{side}.force"].max() for side in SIDES)
    assert largest > 10 * relay.force_scale
    return found, course, relay, TOLERANCE * largest


@pytest.mark.parametrize("name", MOTIONS)
def test_the_forces_of_both_contacts(name: str) -> None:
    found, course, _, allowed = results(name)
    coarser, _ = solved(name, 1, 1e-11)
    # At time 0 the fixed contacts have not moved yet, and the forces are those of the preload.
    for side in SIDES:
        force = found[f"{side}.force"][1:]
        expected, coarse = course.forces[side][PLACES::PLACES], coarser.forces[side][1:]
        # The reference's own error is some tenth of this difference; 24 modes in place of 16 change its forces by less
        # than 0.1 of what is allowed.
        assert np.max(np.abs(coarse - expected)) <= 0.5 * allowed
        assert np.max(np.abs(force - expected)) <= allowed
        assert (found[f"{side}.closed"][1:].astype(bool) == (force > 0)).all()
    assert (np.minimum(found["contact.force"], found["second.force"]) == 0).all()


@pytest.mark.parametrize("name", MOTIONS)
def test_the_instants_at_which_both_contacts_open_and_close(name: str) -> None:
    found, course, *_ = results(name)
    for side in SIDES:
        assert len(course.changes[side, "closes"]) >= 2
        for output, what in (("lastOpening", "leaves"), ("lastClosing", "closes")):
            expected = course.changes[side, what]
            instants = np.unique(found[f"{side}.{output}"])
            # -1: not yet; 0: the fixed contact leaves at the start, so fast that the contact opens at once.
            assert instants[instants > 0] == pytest.approx(expected, rel=0, abs=LOCATED)


@pytest.mark.parametrize("name", MOTIONS)
def test_the_smallest_gap_of_each_step(name: str) -> None:
    found, course, relay, allowed = results(name)
    # Those of each step with both of its ends.
    steps = np.arange(len(found["time"]) - 1)
    inside = PLACES * steps + np.arange(PLACES + 1)[:, None]
    gaps = -course.overlaps["second"][inside]
    places = np.argmin(gaps, axis=0)
    expected = np.min(gaps, axis=0)
    closed = course.forces["second"][inside[places, steps]] > 0
    assert np.any(closed)
    # The gap is as wrong as the force over the stiffness, of the second contact or, where it is open, of the spring.
    stiffness = np.full(len(places), relay.tip_stiffness)
    stiffness[closed] = 1.5 * hertz(relay.values, "second") * np.sqrt(-expected[closed])
    # Between the places it is smaller by an eighth of their second difference at most.
    between_places = np.max(np.diff(gaps, 2, axis=0), axis=0).clip(0) / 8
    assert (np.abs(found["step.minimumGap"][1:] - expected) <= allowed / stiffness + between_places).all()


@pytest.mark.parametrize("name", MOTIONS)
def test_false_makes_of_both_contacts(name: str) -> None:
    found, course, relay, _ = results(name)
    for side, monitor in zip(SIDES, MONITORS, strict=True):
        ends, starts = (np.array(course.changes[side, way]) for way in ("falls", "rises"))
        # What is closed at the start is no make; what is closed at the end is one that lasts.
        ends = np.append(ends[ends > starts[0]], found["time"][-1])[: len(starts)]
        lasting = ends - starts
        assert (lasting > relay.values["second.minimumDuration"]).all()
        names = "falseMakes", "longestFalseMake", "totalFalseMake"
        count, longest, total = (found[f"{monitor}.{name}"][-1] for name in names)
        assert count == len(starts) >= 2
        assert longest == pytest.approx(np.max(lasting), rel=0, abs=2 * LOCATED)
        assert total == pytest.approx(np.sum(lasting), rel=0, abs=2 * len(starts) * LOCATED)
