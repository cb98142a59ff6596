"""The reference for friction against closed forms: it needs no component but for start values."""

from math import asin, cos, pi, sin, sqrt

import numpy as np
import pytest

from frictional import Carrier, Frictional, FrictionalMotion, Law, Phase, Start
from relay_contact import Array

SPECIMEN = Frictional({})
# Of a contact that nothing presses or lifts.
PRESSED, DEFLECTED = SPECIMEN.force, SPECIMEN.indentation
TOLERANCE = 1e-7


def rigid(
    omega: float, mass: float, amplitude: float, cosine: tuple[float, float, float], stop: float
) -> FrictionalMotion:
    """Let a mass (kg) on a spring of this natural frequency (rad/s) slide under a constant contact force.

    It starts at rest at an amplitude (m), with a relaxed tangential spring, under a force of this amplitude (N),
    frequency (rad/s) and phase.
    """
    force, frequency, phase = cosine
    law = Law(SPECIMEN.factor, 0.0, SPECIMEN.friction.ratio, 0.2)
    lever = np.array([1 / sqrt(mass)])
    carrier = Carrier(np.array([omega**2]), np.zeros(1), np.zeros(1), lever, -lever)
    start = Start(DEFLECTED, PRESSED, 0.0, 0.0, np.array([omega * amplitude / lever[0], 0.0]))
    return FrictionalMotion(
        law, carrier, start, lambda time: force * cos(frequency * time + phase), stop, TOLERANCE, PRESSED
    )


LIMIT = 0.2 * PRESSED
# How far the tangential spring yields before the contact slips, m.
YIELDS = LIMIT / SPECIMEN.tangential


def turns(motion: FrictionalMotion) -> Array:
    """Give the displacement along the spring at which it comes to rest each time, m."""
    begins = motion.instants({Phase.BACK, Phase.FORTH}, {Phase.STICK})
    pieces = [piece for piece in motion.pieces if piece.begin in begins]
    return np.array([motion.contact(piece.at(piece.begin))[2] for piece in pieces])


def test_a_contact_moved_to_and_fro_has_the_hysteresis_of_its_spring_and_its_limit() -> None:
    # A mass of a gigaton is moved by nothing.
    amplitude, omega = 10 * YIELDS, 100.0
    period = 2 * pi / omega
    motion = rigid(omega, 1e12, amplitude, (0.0, 1.0, 0.0), 3 * period)
    distance, energy = (
        np.diff(motion.outputs(period * np.array([1.0, 2.0, 3.0]))[name])
        for name in ("contact.slipDistance", "friction.energy")
    )
    assert distance == pytest.approx(4 * (amplitude - YIELDS), rel=1e-6)
    assert energy == pytest.approx(4 * LIMIT * (amplitude - YIELDS), rel=1e-6)


def test_a_mass_that_slides_loses_the_same_amplitude_in_every_swing() -> None:
    omega, mass, amplitude = 100.0, 1e-4, 1.0
    motion = rigid(omega, mass, amplitude, (0.0, 1.0, 0.0), 8 * pi / omega)
    # Twice the limit over the stiffness in half a period, but for the way of the tangential spring.
    loses = np.diff(np.abs(turns(motion)[:6]))
    assert loses == pytest.approx(-2 * LIMIT / (mass * omega**2), abs=20 * YIELDS)


@pytest.mark.parametrize("ratio", [0.6, 0.8, 1.3])
def test_a_mass_that_slides_under_a_sine_has_the_amplitude_of_den_hartog(ratio: float) -> None:
    # J. P. Den Hartog, Trans. ASME 53 (1931) APM-107: motion without stops.
    omega, mass, force = 100.0, 1e-5, 5 * LIMIT
    bends = 1 / (1 - ratio**2)
    shifts = sin(pi / ratio) / (ratio * (1 + cos(pi / ratio)))
    expected = force / (mass * omega**2) * sqrt(bends**2 - (shifts * LIMIT / force) ** 2)
    # The periodic motion begins at rest at the amplitude, with this phase of the force.
    ahead = asin(-LIMIT / force * shifts / bends)
    phase = ahead if bends > 0 else pi - ahead
    motion = rigid(omega, mass, expected, (force, ratio * omega, phase), 6 * pi / (ratio * omega))
    found = np.abs(turns(motion))
    assert len(found) >= 5
    # At every turn the tangential spring yields both ways before the mass slides on: that takes this part of a radian.
    assert found == pytest.approx(expected, rel=sqrt(4 * YIELDS / expected))


@pytest.mark.parametrize("height", [1e-4, 1e-3, 1e-2])
def test_a_contact_that_sticks_is_a_rotational_spring_at_the_tip(height: float) -> None:
    specimen = Frictional({"tip.contactHeight": height})
    # Modes are as right as the functions they are made of; 16 and 24 of them differ by less.
    assert specimen.sticking_by_modes() == pytest.approx(specimen.sticking_frequency(), rel=1e-10)
    # Between a tip that is pinned and one that is clamped.
    assert specimen.frequency() < specimen.sticking_frequency() < 1.46 * specimen.frequency()
