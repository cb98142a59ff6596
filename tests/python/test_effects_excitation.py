"""The generators of base acceleration, by the force on a bonded contact: that of their closed forms, exactly."""

from collections.abc import Callable
from math import exp, log, pi, sin, sqrt

import numpy as np
import pytest

from component import run
from reference import Acceleration, Reference
from relay_contact import Array, Values

BONDED: Values = {"effects.contactLaw": "Bonded", "effects.axialForce": "None", "excitation.amplitude": 98.0}
# With extremes watched the component integrates, without it takes exact steps where the generator is a sine.
EXTREMES = {"extremes": {"effects.extremes": True}, "exact": {"effects.extremes": False, "effects.chatter": False}}
TOLERANCE = 1e-9
START, STEP, STEPS = 3e-4, 2e-5, 200
AMPLITUDE, FREQUENCY, END_FREQUENCY, DURATION, PHASE = 98.0, 400.0, 2500.0, 2e-3, 0.7
# The sweep has this amplitude of acceleration at the middle of its duration, 1 kHz.
LIMIT = AMPLITUDE / (2 * pi * 1000) ** 2


def force(values: Values, steps: int = STEPS, step: float = STEP) -> Array:
    """Give the contact force at the communication points."""
    scene = {**BONDED, "solver.tolerance": TOLERANCE, **values}
    return run(scene, steps * step, step, ["contact.force"])["contact.force"]


def generated(course: Callable[[float], float]) -> Acceleration:
    """Give the course of an acceleration since its start."""
    return lambda time: course(time - START) if time >= START else 0.0


def sine(amplitude: float) -> Acceleration:
    """Give a sine."""
    return generated(lambda tau: amplitude * sin(2 * pi * FREQUENCY * tau + PHASE))


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


RANDOM: Values = {"effects.excitation": "Random", "excitation.frequency": 50.0}


@pytest.mark.parametrize(("band", "seed"), [((50.0, 2000.0), 1), ((1200.0, 1500.0), 2)])
def test_random_force_has_the_mean_square_of_its_spectral_density(band: tuple[float, float], seed: int) -> None:
    density, step, settled, stop = 0.5, 2.0**-12, 0.125, 8.0
    values: Values = {
        **RANDOM,
        "excitation.frequency": band[0],
        "excitation.endFrequency": band[1],
        "excitation.spectralDensity": density,
        "excitation.seed": seed,
        "solver.tolerance": 1e-5,
    }
    reference = Reference(BONDED)
    found = force(values, round(stop / step), step)[round(settled / step) :] - reference.force
    frequencies, width = np.linspace(*band, 201, retstep=True)
    spectrum = density * np.array([abs(reference.force_response(frequency)) ** 2 for frequency in frequencies])
    expected = np.trapezoid(spectrum, dx=width)
    # With one of at least 200 sines in each equal part of the band, the sum of their powers is a Riemann sum.
    quadrature = np.sum(np.abs(np.diff(spectrum))) * (band[1] - band[0]) / 200
    # The mean square of Gaussian noise over a time scatters by this; that of sines apart from each other by less.
    scatter = sqrt(np.trapezoid(spectrum**2, dx=width) / (stop - settled))
    assert 4 * scatter + quadrature < 0.2 * expected
    assert np.mean(found**2) == pytest.approx(expected, rel=0, abs=4 * scatter + quadrature)


def test_a_displacement_limit_out_of_reach_limits_nothing() -> None:
    for generator in (SINE, UP):
        free, limited = force(generator), force({**generator, "excitation.displacementLimit": 1.0})
        assert (free == limited).all()
