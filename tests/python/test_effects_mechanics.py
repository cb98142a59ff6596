"""Contact law, damping, axial force, gravity and rivet, each by what it does to the contact force."""

from math import sqrt, tan, tanh

import numpy as np
import pytest
from scipy.optimize import brentq

from component import run
from reference import Reference
from relay_contact import Array, Values
from relay_contact.component import sine

NO_AXIAL: Values = {"effects.axialForce": "None"}
POWERS = ("Hertz", "Rough")
LAWS = (*POWERS, "Linearised", "Bonded")
FREQUENCY = 1000.0


def shaken(values: Values, amplitude: float, tolerance: float) -> Values:
    """Give a scene vibrating at 1 kHz."""
    return {**values, **sine(FREQUENCY, amplitude), "solver.tolerance": tolerance}


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("acceleration", [300.0, -1000.0])
def test_a_constant_acceleration_ends_in_the_equilibrium_of_the_law(law: str, acceleration: float) -> None:
    tolerance = 1e-8
    values: Values = {**NO_AXIAL, "effects.contactLaw": law, "base.acceleration": acceleration}
    # The slowest motion is that of the cantilever alone, 294 Hz: it falls as exp(-137 t), to 1e-12 in the end.
    output = ["contact.force", "contact.indentation"]
    result = run({**values, "solver.tolerance": tolerance}, 0.2, 1e-2, output)
    force, indentation = (result[name][-1] for name in output)
    reference = Reference(values)
    inertia = reference.carried_mass * acceleration

    def spring(d: float) -> float:
        return reference.tip_stiffness * (reference.overtravel - d) + inertia

    def elastic(d: float) -> float:
        if law in POWERS:
            return float(reference.elastic(d))
        linear = reference.force + reference.tangent * (d - reference.indentation)
        return linear if law == "Bonded" else max(linear, 0.0)

    expected = brentq(lambda d: elastic(d) - spring(d), -1e-3, 1e-3, xtol=1e-20)
    assert (elastic(expected) < 0) == (law == "Bonded" and acceleration < 0)
    assert (elastic(expected) == 0) == (law != "Bonded" and acceleration < 0)
    allowed = tolerance * reference.force_scale
    assert force == pytest.approx(elastic(expected), rel=0, abs=allowed)
    # The indentation is as wrong as the force over the stiffness, of the contact or, where it is open, of the spring.
    if elastic(expected) == 0:
        stiffness = reference.tip_stiffness
    else:
        stiffness = float(reference.stiffness_at(expected)) if law in POWERS else reference.tangent
    assert indentation == pytest.approx(expected, rel=0, abs=allowed / stiffness)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("damping", [True, False])
def test_the_force_of_a_law_under_vibration_until_the_contact_closes_again(law: str, damping: bool) -> None:
    tolerance, amplitude, stop = 1e-7, 400.0, 1.06e-3
    own: Values = {**NO_AXIAL, "effects.contactLaw": law, "effects.contactDamping": damping}
    values = shaken(own, amplitude, tolerance)
    result, reference = run(values, stop, 1e-5, ["contact.force"]), Reference(values)
    # Its own error is a tenth of the tolerance at most.
    expected = reference.course(result["time"]).forces["contact"]
    assert (np.min(expected) < 0) == (law == "Bonded")
    assert np.max(np.abs(result["contact.force"] - expected)) <= tolerance * reference.force_scale


@pytest.mark.parametrize(
    ("off", "neutral"),
    [
        ({"effects.contactDamping": False}, {"contact.damping": 0.0}),
        ({"effects.axialForce": "None"}, {"effects.axialForce": "Prescribed", "beam.axialForce": 0.0}),
    ],
)
def test_off_is_the_same_as_a_neutral_parameter(off: Values, neutral: Values) -> None:
    forces = [run(shaken(each, 98.0, 1e-6), 2e-3, 1e-5, ["contact.force"])["contact.force"] for each in (off, neutral)]
    assert (forces[0] == forces[1]).all()


LOADS: dict[str, Values] = {
    "none": {"effects.axialForce": "None", "beam.axialForce": 5.0},
    "compression": {"effects.axialForce": "Prescribed", "beam.axialForce": 5.0},
    "tension": {"effects.axialForce": "Prescribed", "beam.axialForce": -20.0},
    "from preload": {"effects.axialForce": "FromPreload", "contact.overtravel": 4e-3},
    "from deflection": {"effects.axialForce": "FromDeflection", "contact.overtravel": 4e-3},
    "under gravity": {"effects.axialForce": "FromDeflection", "contact.overtravel": 4e-3, "environment.gravity": 300.0},
    "gravity alone": {**NO_AXIAL, "environment.gravity": -200.0},
}


@pytest.mark.parametrize("name", LOADS)
def test_axial_force_and_gravity_change_preload_and_frequency(name: str) -> None:
    values = {**LOADS[name], "tip.rotaryInertia": 1e-10}
    reference = Reference(values)
    output = ["preload.force", "preload.indentation", "preload.axialForce", "preload.frequency"]
    result = run(values, 1e-5, 1e-5, output)
    force, indentation, axial, frequency = (result[name][-1] for name in output)
    # What is computed once is right to rounding, of which the roots for a frequency have some more.
    assert axial == pytest.approx(reference.axial_force, rel=1e-12, abs=0)
    assert force == pytest.approx(reference.force, rel=1e-12)
    follows = values["effects.axialForce"] == "FromDeflection"
    assert frequency == pytest.approx(reference.frequency_following() if follows else reference.frequency(), rel=1e-10)
    # The stiffness of the tip in closed form.
    stiffness = reference.tip_stiffness
    if axial != 0:
        root = sqrt(abs(axial) / reference.stiffness)
        turn = root * reference.length
        stiffness = axial / ((tan(turn) if axial > 0 else tanh(turn)) / root - reference.length)
    if axial == 0 or reference.gravity == 0:
        # Gravity is a constant acceleration.
        weight = reference.carried_mass * reference.gravity
        assert force == pytest.approx(stiffness * (reference.overtravel - indentation) + weight, rel=1e-11)
    if follows:
        # That it follows the deflection is worth more than what is allowed above.
        assert abs(reference.frequency() / frequency - 1) > 1e-6


@pytest.mark.parametrize("name", LOADS)
def test_axial_force_and_gravity_change_the_force_under_vibration(name: str) -> None:
    tolerance, amplitude, stop = 1e-8, 4000.0 if "contact.overtravel" in LOADS[name] else 98.0, 2e-3
    values = shaken(LOADS[name], amplitude, tolerance)
    result, reference = run(values, stop, 1e-5, ["contact.force"]), Reference(values)
    others = [Reference({**values, "effects.axialForce": kind}) for kind in ("None", "FromPreload")]

    def solved(model: Reference, own: float) -> Array:
        return model.course(result["time"], tolerance=own).forces["contact"]

    expected = solved(reference, 1e-12)
    allowed = tolerance * reference.force_scale
    assert np.max(np.abs(result["contact.force"] - expected)) <= allowed
    for other in others:
        # Its own error is as small as what is allowed.
        assert (other.axial == reference.axial) or np.max(np.abs(solved(other, 1e-10) - expected)) > 20 * allowed


# Without damping the sum over the modes of the beam converges slowly, and the number chosen is for a damped one:
# here few, but the same in both.
UNDAMPED: Values = {"beam.stiffnessDamping": 0.0, "solver.modes": 8}
TERMS: dict[str, Values] = {
    "mass damping": {"beam.massDamping": 3000.0},
    "no rivet": {"tip.mass": 0.0},
    "rotary inertia": {"tip.rotaryInertia": 2e-10},
    "no damping of the beam": UNDAMPED,
    "mass damping alone": {**UNDAMPED, "beam.massDamping": 3000.0, "effects.contactDamping": False},
    "no damping": {**UNDAMPED, "effects.contactDamping": False},
}


@pytest.mark.parametrize("name", TERMS)
def test_a_term_of_the_beam_does_what_the_equations_say(name: str) -> None:
    tolerance, step, steps = 1e-9, 2e-5, 150
    bonded = shaken({**NO_AXIAL, "effects.contactLaw": "Bonded"}, 98.0, tolerance)
    values = {**bonded, **TERMS[name]}
    found = run(values, steps * step, step, ["contact.force"])["contact.force"]
    expected, without = (Reference(scene).linear_force(step, steps) for scene in (values, bonded))
    assert np.max(np.abs(found - expected)) <= tolerance * Reference(values).force_scale
    assert np.max(np.abs(expected - without)) > 1e-4
