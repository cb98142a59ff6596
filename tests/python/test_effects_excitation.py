"""The generators of base acceleration, by the force on a bonded contact: that of their closed forms, exactly."""

from math import pi

import numpy as np
import pytest

from component import run
from reference import Reference
from relay_contact import Array, Values

BONDED: Values = {"effects.contactLaw": "Bonded", "effects.axialForce": "None", "excitation.amplitude": 98.0}
# With extremes watched the component integrates, without it takes exact steps where the generator is a sine.
EXTREMES = {"extremes": {"effects.extremes": True}, "exact": {"effects.extremes": False, "effects.chatter": False}}
TOLERANCE = 1e-9
START, STEP, STEPS = 3e-4, 2e-5, 200
AMPLITUDE, FREQUENCY, END_FREQUENCY, DURATION, PHASE = 98.0, 400.0, 2500.0, 2e-3, 0.7
# The sweep has this amplitude of acceleration at the middle of its duration, 1 kHz.
LIMIT = AMPLITUDE / (2 * pi * 1000) ** 2


def force(values: Values) -> Array:
    """Give the contact force at the communication points."""
    scene = {**BONDED, "solver.tolerance": TOLERANCE, **values}
    return run(scene, STEPS * STEP, STEP, ["contact.force"])["contact.force"]


SINE: Values = {"effects.excitation": "Sine", "excitation.frequency": FREQUENCY, "excitation.phase": PHASE}
UP: Values = {**SINE, "effects.excitation": "LogSweep", "excitation.endFrequency": END_FREQUENCY}
DOWN: Values = {**UP, "excitation.frequency": END_FREQUENCY, "excitation.endFrequency": FREQUENCY}
LIMITED: Values = {"excitation.displacementLimit": LIMIT}
PULLING: Values = {"excitation.amplitude": -AMPLITUDE}
GENERATORS: dict[str, Values] = {
    "sine": SINE,
    "limited sine": {**SINE, **LIMITED},
    "rising sine": {**SINE, "excitation.riseTime": 1.7e-3},
    "half sine": {"effects.excitation": "HalfSine"},
    "sweep up": UP,
    "sweep down": DOWN,
    "limited sweep": {**UP, **LIMITED},
    "pulling half sine": {"effects.excitation": "HalfSine", **PULLING},
    "pulling limited sine": {**SINE, **LIMITED, **PULLING},
    "pulling limited sweep": {**UP, **LIMITED, **PULLING},
}


@pytest.mark.parametrize("name", GENERATORS)
@pytest.mark.parametrize("watching", EXTREMES)
def test_the_force_is_that_of_the_closed_form(name: str, watching: str) -> None:
    values: Values = {**BONDED, **GENERATORS[name], "excitation.startTime": START, "excitation.duration": DURATION}
    found, reference = force({**values, **EXTREMES[watching]}), Reference(values)
    expected = reference.linear_force(STEP, STEPS)
    # Before its start nothing moves.
    assert np.ptp(found[: round(START / STEP)]) == 0.0
    assert np.ptp(expected) > 0.01
    # What the tolerance means. The reference, whose steps end where the courses break, errs by less than a tenth of it.
    assert np.max(np.abs(found - expected)) <= TOLERANCE * reference.force_scale


def test_without_a_generator_nothing_moves() -> None:
    assert np.ptp(force({})) == 0.0
    kinds = {"Sine": "amplitude", "LogSweep": "amplitude", "HalfSine": "amplitude", "Random": "spectralDensity"}
    for kind, size in kinds.items():
        assert np.ptp(force({"effects.excitation": kind, f"excitation.{size}": 0.0})) == 0.0
        assert np.ptp(force({"effects.excitation": kind})) > 1e-3


def test_a_displacement_limit_out_of_reach_limits_nothing() -> None:
    for generator in (SINE, UP):
        free, limited = force(generator), force({**generator, "excitation.displacementLimit": 1.0})
        assert (free == limited).all()
