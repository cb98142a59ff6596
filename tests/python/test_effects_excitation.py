"""The generators of base acceleration, by the force on a bonded contact: that of their closed forms, exactly."""

from collections.abc import Callable
from math import exp, log, pi, sin

import numpy as np
import pytest

from component import run
from one_sided import Acceleration, risen
from reference import Reference
from relay_contact import Array, Values

BONDED: Values = {"effects.contactLaw": "Bonded", "effects.axialForce": "None", "excitation.amplitude": 98.0}
# With extremes watched the component integrates, without it takes exact steps where the generator is a sine.
EXTREMES = {"extremes": {"effects.extremes": True}, "exact": {"effects.extremes": False, "effects.chatter": False}}
TOLERANCE = 1e-9
START, STEP, STEPS = 3e-4, 2e-5, 200
AMPLITUDE, FREQUENCY, END_FREQUENCY, DURATION, PHASE = 98.0, 400.0, 2500.0, 2e-3, 0.7
RISE = 1.7e-3
# The sweep has this amplitude of acceleration at the middle of its duration, 1 kHz.
LIMIT = AMPLITUDE / (2 * pi * 1000) ** 2


def force(values: Values) -> Array:
    """Give the contact force at the communication points."""
    scene = {**BONDED, "solver.tolerance": TOLERANCE, **values}
    return run(scene, STEPS * STEP, STEP, ["contact.force"])["contact.force"]


def generated(course: Callable[[float], float]) -> Acceleration:
    """Give the course of an acceleration since its start."""
    return lambda time: course(time - START) if time >= START else 0.0


def sine(amplitude: float) -> Acceleration:
    """Give a sine."""
    return generated(lambda tau: amplitude * sin(2 * pi * FREQUENCY * tau + PHASE))


def rising(tau: float) -> float:
    """Give a sine that rises by half a period of a cosine."""
    return AMPLITUDE * risen(tau, RISE) * sin(2 * pi * FREQUENCY * tau + PHASE)


def half_sine(tau: float) -> float:
    """Give half a sine after its start."""
    return AMPLITUDE * sin(pi * tau / DURATION) if tau < DURATION else 0.0


def sweep(first: float, last: float, limit: float) -> Acceleration:
    """Give a logarithmic sweep."""

    def course(tau: float) -> float:
        if tau >= DURATION:
            return 0.0
        rate = log(last / first) / DURATION
        frequency = first * exp(rate * tau)
        phase = 2 * pi * (frequency - first) / rate + PHASE
        return min(AMPLITUDE, (2 * pi * frequency) ** 2 * limit) * sin(phase)

    return generated(course)


def mirrored(course: Acceleration) -> Acceleration:
    """Give the acceleration in the other direction."""
    return lambda time: -course(time)


SINE: Values = {"effects.excitation": "Sine", "excitation.frequency": FREQUENCY, "excitation.phase": PHASE}
UP: Values = {**SINE, "effects.excitation": "LogSweep", "excitation.endFrequency": END_FREQUENCY}
DOWN: Values = {**UP, "excitation.frequency": END_FREQUENCY, "excitation.endFrequency": FREQUENCY}
LIMITED: Values = {"excitation.displacementLimit": LIMIT}
PULLING: Values = {"excitation.amplitude": -AMPLITUDE}
GENERATORS: dict[str, tuple[Values, Acceleration]] = {
    "sine": (SINE, sine(AMPLITUDE)),
    "limited sine": ({**SINE, **LIMITED}, sine((2 * pi * FREQUENCY) ** 2 * LIMIT)),
    "rising sine": ({**SINE, "excitation.riseTime": RISE}, generated(rising)),
    "half sine": ({"effects.excitation": "HalfSine"}, generated(half_sine)),
    "sweep up": (UP, sweep(FREQUENCY, END_FREQUENCY, np.inf)),
    "sweep down": (DOWN, sweep(END_FREQUENCY, FREQUENCY, np.inf)),
    "limited sweep": ({**UP, **LIMITED}, sweep(FREQUENCY, END_FREQUENCY, LIMIT)),
    "pulling half sine": ({"effects.excitation": "HalfSine", **PULLING}, mirrored(generated(half_sine))),
    "pulling limited sine": ({**SINE, **LIMITED, **PULLING}, mirrored(sine((2 * pi * FREQUENCY) ** 2 * LIMIT))),
    "pulling limited sweep": ({**UP, **LIMITED, **PULLING}, mirrored(sweep(FREQUENCY, END_FREQUENCY, LIMIT))),
}


@pytest.mark.parametrize("name", GENERATORS)
@pytest.mark.parametrize("watching", EXTREMES)
def test_the_force_is_that_of_the_closed_form(name: str, watching: str) -> None:
    generator, course = GENERATORS[name]
    values = {**generator, **EXTREMES[watching], "excitation.startTime": START, "excitation.duration": DURATION}
    found = force(values)
    reference = Reference(BONDED)
    expected = reference.linear_force(course, STEP, STEPS)
    # Before its start nothing moves.
    assert np.ptp(found[: round(START / STEP)]) == 0.0
    assert np.ptp(expected) > 0.01
    # What the tolerance means. The reference, whose steps end where the courses break, errs by less than a tenth of it.
    assert np.max(np.abs(found - expected)) <= TOLERANCE * reference.force_scale


def test_without_a_generator_nothing_moves() -> None:
    assert np.ptp(force({})) == 0.0
    for kind, size in [
        ("Sine", "amplitude"),
        ("LogSweep", "amplitude"),
        ("HalfSine", "amplitude"),
        ("Random", "spectralDensity"),
    ]:
        assert np.ptp(force({"effects.excitation": kind, f"excitation.{size}": 0.0})) == 0.0
        assert np.ptp(force({"effects.excitation": kind})) > 1e-3


def test_a_displacement_limit_out_of_reach_limits_nothing() -> None:
    for generator in (SINE, UP):
        free, limited = force(generator), force({**generator, "excitation.displacementLimit": 1.0})
        assert (free == limited).all()
