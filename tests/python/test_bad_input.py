"""Bad input: the message names the variable, its value and what is allowed; what was there before is kept."""

import math
from collections.abc import Iterator

import pytest
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import fmi2Discard, fmi2Error

from component import Instance


@pytest.fixture
def instance() -> Iterator[Instance]:
    """Give a fresh instance."""
    with Instance() as instance:
        yield instance


def assert_told(instance: Instance, *parts: str) -> None:
    """Assert that the last message has all these parts."""
    assert instance.messages, "nothing was logged"
    for part in parts:
        assert part in instance.messages[-1], instance.messages


@pytest.mark.parametrize(
    ("name", "value", "parts"),
    [
        ("beam.length", -0.0155, ["-0.0155 m", "0.001 to 0.2"]),
        ("contact.fixed.poissonRatio", 0.6, ["0.6", "more than -1 and less than 0.5"]),
        ("contact.moving.poissonRatio", 0.5, ["0.5", "more than -1 and less than 0.5"]),
        ("resistance.open", 0.0, ["0 Ohm", "1 to 1000000000000000"]),
        ("beam.density", math.nan, ["NaN kg/m3", "1 to 100000"]),
        ("tip.mass", math.inf, ["inf kg", "0 to 0.1"]),
        ("base.acceleration", math.nan, ["NaN m/s2", "-1000000000 to 1000000000"]),
    ],
)
def test_value_out_of_range_is_discarded_and_the_instance_goes_on(
    instance: Instance, name: str, value: float, parts: list[str]
) -> None:
    before = instance.get(name)
    with pytest.raises(FMICallException) as raised:
        instance.set(name, value)
    assert raised.value.status == fmi2Discard
    assert_told(instance, name, *parts)
    assert instance.get(name) == before
    instance.initialise()
    instance.step(0.0, 1e-5)
    assert instance.get("contact.force") == pytest.approx(0.152, rel=5e-3)


def test_one_bad_value_discards_the_whole_call(instance: Instance) -> None:
    names = ["beam.length", "beam.thickness"]
    references = instance.references(*names)
    before = instance.fmu.getReal(references)
    with pytest.raises(FMICallException) as raised:
        instance.fmu.setReal(references, [0.02, -1.0])
    assert raised.value.status == fmi2Discard
    assert_told(instance, "beam.thickness", "-1 m", "1e-5 to 0.005")
    assert instance.fmu.getReal(references) == before


def test_unknown_choice_is_discarded(instance: Instance) -> None:
    with pytest.raises(FMICallException) as raised:
        instance.set("effects.excitation", 9)
    assert raised.value.status == fmi2Discard
    assert_told(instance, "effects.excitation", "9", "1 (None)", "2 (Sine)")
    instance.initialise()
    instance.step(0.0, 1e-5)


def test_bad_input_between_steps_keeps_the_motion(instance: Instance) -> None:
    instance.initialise()
    instance.set("base.acceleration", 50.0)
    instance.step(0.0, 1e-4)
    force = instance.get("contact.force")
    with pytest.raises(FMICallException) as raised:
        instance.set("base.acceleration", math.nan)
    assert raised.value.status == fmi2Discard
    assert_told(instance, "base.acceleration", "NaN m/s2")
    assert instance.get("base.acceleration") == 50.0
    assert instance.get("contact.force") == force
    instance.step(1e-4, 1e-4)
    # Pressed by a constant acceleration, the force goes on rising.
    assert instance.get("contact.force") > force


def test_axial_force_above_buckling_ends_initialisation_with_an_error(instance: Instance) -> None:
    instance.set("effects.axialForce", "Prescribed")
    instance.set("beam.axialForce", 10.0)
    with pytest.raises(FMICallException) as raised:
        instance.initialise()
    assert raised.value.status == fmi2Error
    # The buckling load of the cantilever, pi^2 E I / (4 L^2), is 9.69 N.
    assert_told(instance, "beam.axialForce", "10 N", "9.69")


def test_axial_force_below_buckling_is_simulated(instance: Instance) -> None:
    instance.set("effects.axialForce", "Prescribed")
    instance.set("beam.axialForce", 9.6)
    instance.initialise()
    instance.step(0.0, 1e-5)
    # Close to buckling the spring has next to no stiffness of its own, so next to nothing presses the contact.
    assert 0 < instance.get("contact.force") < 0.1 * 0.152
