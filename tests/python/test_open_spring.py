"""The open spring after a blow: its motion read at any communication point, against its modes in closed form."""

import tomllib

import numpy as np
import pytest

from component import ROOT
from relay_contact import Array, Component, Values
from relay_contact.component import half_sine

SPRING = ROOT / "scenes" / "springs" / "tapered-cube-modes.toml"
AMPLITUDE, DURATION = 1e3, 2e-3  # m/s2, s


def displacement(time: Array) -> Array:
    """Give that of the contact point (m) after the half sine has ended, without damping."""
    modes = tomllib.loads(SPRING.read_text(encoding="utf-8"))["mode"]
    pulse, since = np.pi / DURATION, time - DURATION
    total = np.zeros(len(time))
    for mode in modes:
        omega = 2 * np.pi * mode["frequency"]
        forced = -mode["participation"] * AMPLITUDE / (omega**2 - pulse**2)
        # At the end of the pulse, where its sine is 0 and its cosine -1.
        place = -forced * pulse / omega * np.sin(omega * DURATION)
        velocity = forced * pulse * (-1 - np.cos(omega * DURATION))
        total += mode["contact"] * (place * np.cos(omega * since) + velocity / omega * np.sin(omega * since))
    return total


@pytest.mark.parametrize("step", [1e-5, 1e-4, 2e-4, 1e-3, 1e-2])
def test_the_motion_read_does_not_depend_on_the_communication_step(step: float) -> None:
    values: Values = {"contact.overtravel": -3e-3, "beam.stiffnessDamping": 0.0, "beam.file": str(SPRING)}
    time: Array = step * np.arange(round(1e-2 / step) + 1.0)
    with Component().started({**values, **half_sine(AMPLITUDE, DURATION)}) as contact:
        read = contact.drive(time, {}, ["tip.displacement"])["tip.displacement"]
    free = time[1:] > DURATION
    # The tolerance is 1e-6 of the force that bends the spring by the overtravel, 3 mm.
    assert np.max(np.abs(read - displacement(time[1:]))[free]) < 1e-6 * 3e-3
