"""Reference values of the specimen, each to all the digits given.

The digits were computed by two independent implementations of the model. A value passes when it rounds to them.
"""

import numpy as np
import pytest

from component import extremes, run
from relay_contact import Array, Values

TOLERANCE = 1e-8
NO_AXIAL: Values = {"effects.axialForce": "None", "solver.tolerance": TOLERANCE}
PRELOAD = ["preload.force", "preload.indentation", "preload.contactStiffness", "preload.frequency"]


def half_unit(digits: str) -> float:
    """Give half a unit of the last digit of a number, with a little for the rounding of the comparison itself."""
    mantissa, _, exponent = digits.partition("e")
    decimals = len(mantissa.partition(".")[2])
    return 0.5 * 10.0 ** (int(exponent or "0") - decimals) * (1 + 1e-6)


def check(value: float, digits: str) -> None:
    """Assert that a value rounds to the digits."""
    assert value == pytest.approx(float(digits), rel=0, abs=half_unit(digits))


def test_half_unit_of_the_last_digit() -> None:
    assert half_unit("0.1520261") == pytest.approx(5e-8, rel=1e-5)
    assert half_unit("64.418e-9") == pytest.approx(5e-13, rel=1e-5)


def test_preload_without_axial_force() -> None:
    result = run(NO_AXIAL, 1e-5, 1e-5, PRELOAD)
    digits = ["0.1520261", "64.418e-9", "3.539968e6", "1354.5397"]
    for name, expected in zip(PRELOAD, digits, strict=True):
        check(result[name][-1], expected)


def test_preload_with_axial_force_from_the_preload() -> None:
    result = run({"solver.tolerance": TOLERANCE}, 1e-5, 1e-5, PRELOAD)
    check(result["preload.force"][-1], "0.1519806")
    check(result["preload.frequency"][-1], "1354.5151")


def periodic(values: Values, frequency: float, samples: int, output: list[str]) -> dict[str, Array]:
    """Give outputs over the last of enough periods that the transient, which falls as exp(-2900 t), is gone."""
    period = 1 / frequency
    scene: Values = {**NO_AXIAL, "effects.excitation": "Sine", "excitation.frequency": frequency, **values}
    periods = int(np.ceil(0.015 / period)) + 1
    result = run(scene, periods * period, period / samples, output)
    return {name: values[-samples - 1 :] for name, values in result.items()}


@pytest.mark.parametrize(("frequency", "digits"), [(500.0, "3.6295e-2"), (1000.0, "4.8122e-2")])
def test_force_amplitude_of_the_linearised_contact(frequency: float, digits: str) -> None:
    # At a thousandth of the amplitude the contact is linear: the force departs from its preload by r = 3e-4, and the
    # fundamental of the force departs from linear by some r^2 = 1e-7, less than the digits show. The digits are 1e-5
    # of the amplitude, 5e-10 N here, so the run needs a tolerance well below 3e-9 of the preload.
    scale = 1e-3
    values = {"excitation.amplitude": 98 * scale, "solver.tolerance": 1e-10}
    force = periodic(values, frequency, 100, ["contact.force"])["contact.force"][:-1]
    fundamental = 2 * np.abs(np.mean(force * np.exp(-2j * np.pi * np.arange(100) / 100)))
    check(fundamental / scale, digits)


def test_periodic_state_of_the_nonlinear_contact() -> None:
    # The parabola through samples 1/1000 of a period apart misses an extreme by less than 1e-9 N.
    result = periodic({"excitation.amplitude": 98}, 1000, 1000, ["contact.force", "contact.resistance"])
    least, greatest = extremes(result["contact.force"])
    check(least, "0.103905")
    check(greatest, "0.200149")
    # The resistance is least where the force is greatest: H F^-n, as exact as half a unit of the force's digits.
    coefficient, exponent = 7.4118e-3, 0.9515
    for resistance, force in zip(extremes(result["contact.resistance"]), (0.200149, 0.103905), strict=True):
        assert resistance == pytest.approx(coefficient * force**-exponent, rel=exponent * 5e-7 / force)


def test_first_opening_and_closing_under_hard_vibration() -> None:
    values: Values = {
        **NO_AXIAL,
        "effects.excitation": "Sine",
        "excitation.amplitude": 400,
        "excitation.frequency": 1000,
    }
    output = ["contact.lastOpening", "contact.lastClosing", "contact.closed"]
    result = run(values, 1.2e-3, 1e-6, output)
    opening, closing = result["contact.lastOpening"], result["contact.lastClosing"]
    check(1e6 * opening[opening >= 0][0], "708.827593")
    check(1e6 * closing[closing >= 0][0], "1089.427605")
    # The Boolean output and the instants tell the same story.
    time, closed = result["time"], result["contact.closed"].astype(bool)
    assert closed[time < 708e-6].all()
    assert not closed[(time > 709.5e-6) & (time < 1088.5e-6)].any()
