"""Outputs that do not influence the motion: resistance, heat, interruptions, extremes, energy."""

from math import pi

import numpy as np
import pytest

from component import COMPONENT, run
from one_sided import Course
from reference import Reference
from relay_contact import Array, Scene, Values, run_many
from relay_contact import run as run_scene

SHAKEN: Values = {"effects.excitation": "Sine", "excitation.frequency": 1000.0, "effects.axialForce": "None"}
# Pressed all the time, and open for a part of every period.
PRESSED: Values = {**SHAKEN, "excitation.amplitude": 98.0}
OPENING: Values = {**SHAKEN, "excitation.amplitude": 400.0}
FORCE_SCALE = Reference(SHAKEN).force_scale
# The formulas are evaluated once, from the force that is read too: a few roundings.
ROUNDING = 1e-13

OPEN = 1e9


def constriction(kind: str, force: Array) -> Array:
    """Give the resistance of a closed contact without a film, Ohm."""
    if kind == "PowerLaw":
        return np.asarray(7.4118e-3 * force**-0.9515)
    if kind == "Barber":
        # rho E* / k, with the tangent stiffness of Hertz: k^3 = 6 E*^2 R F.
        modulus = 1 / ((1 - 0.33**2) / 86e9 + (1 - 0.34**2) / 81.92e9)
        return np.asarray(2.2e-8 * modulus / np.cbrt(6 * modulus**2 * 0.02177 * force))
    return 2.2e-8 / 2 * np.sqrt(pi * 0.785e9 / force)


def conductance(kind: str, force: Array, film: float, open_: float) -> Array:
    """Give the conductance, S."""
    closed = force > 0
    return np.where(closed, 1 / (constriction(kind, np.where(closed, force, 1.0)) + film), 0.0) + 1 / open_


@pytest.mark.parametrize("kind", ["PowerLaw", "Holm", "Barber"])
@pytest.mark.parametrize(("film", "open_"), [(0.0, OPEN), (0.02, OPEN), (0.0, 10.0)])
@pytest.mark.parametrize(("law", "source"), [("Hertz", 1e21), ("Bonded", 1e3)])
def test_resistance_and_voltage_follow_from_the_force(
    kind: str, film: float, open_: float, law: str, source: float
) -> None:
    values: Values = {
        "effects.resistance": kind, "resistance.film": film, "resistance.open": open_, "effects.contactLaw": law,
        "contact.openVoltage": source, "contact.current": -0.1,
    }  # fmt: skip
    output = ["contact.force", "contact.resistance", "contact.conductance", "contact.voltage", "contact.closed"]
    result = run({**OPENING, **values}, 2e-3, 1e-5, output)
    force = result["contact.force"]
    # The bonded contact pulls where the other is open.
    assert np.min(force) < 0 if law == "Bonded" else np.min(force) == 0
    assert (result["contact.closed"].astype(bool) == (force > 0)).all()
    # The stiffness of a linear contact, and with it the resistance by Barber, does not depend on the force.
    linear = kind == "Barber" and law == "Bonded"
    expected = conductance(kind, np.where(force > 0, Reference({}).force, 0.0) if linear else force, film, open_)
    assert result["contact.conductance"] == pytest.approx(expected, rel=ROUNDING, abs=0)
    assert result["contact.resistance"] == pytest.approx(1 / expected, rel=ROUNDING, abs=0)
    assert result["contact.voltage"] == pytest.approx(np.maximum(-0.1 / expected, -source), rel=ROUNDING, abs=0)


def test_voltage_is_resistance_times_the_current_of_the_same_row() -> None:
    """Of an input over time, too, which the component itself has as it was at the begin of the step."""
    time = np.linspace(0.0, 1e-3, 101)
    table = {"time": time, "contact.current": 0.1 + 50.0 * time}
    output = ["contact.current", "contact.resistance", "contact.voltage"]
    scene = Scene("", 1e-3, 1e-5, output, dict(PRESSED), table)
    result = run_scene(scene, component=COMPONENT)
    current = result["contact.current"]
    assert current == pytest.approx(table["contact.current"], rel=ROUNDING)
    assert result["contact.voltage"] == pytest.approx(current * result["contact.resistance"], rel=ROUNDING, abs=0)
    assert run_many([scene], component=COMPONENT)["contact.current"][0] == current[-1]


@pytest.mark.parametrize(("current", "melts"), [(-0.05, "never"), (3.0, "sometimes"), (30.0, "always")])
@pytest.mark.parametrize("source", [1e3, 0.1])
def test_current_heats_the_closed_contact(current: float, melts: str, source: float) -> None:
    surroundings, melting, film = 350.0, 0.3, 0.01
    values: Values = {
        "contact.current": current, "contact.openVoltage": source, "contact.meltingVoltage": melting,
        "resistance.film": film, "environment.temperature": surroundings,
    }  # fmt: skip
    output = ["contact.force", "contact.temperature"]
    cold = run({**OPENING, **values}, 2e-3, 1e-5, output)
    hot = run({**OPENING, **values, "effects.heating": True}, 2e-3, 1e-5, output)
    assert (cold["contact.temperature"] == surroundings).all()
    force = hot["contact.force"]
    assert (force == cold["contact.force"]).all()
    closed = force > 0
    assert 0 < np.count_nonzero(closed) < len(force)
    voltage = abs(current) * (constriction("PowerLaw", force[closed]) + film)
    capped = np.minimum(voltage, min(melting, source))
    assert bool(np.min(voltage) > melting) == (melts == "always")
    assert bool(np.max(voltage) > melting) == (melts != "never")
    expected = np.full(len(force), surroundings)
    expected[closed] = np.sqrt(surroundings**2 + capped**2 / (4 * 2.45e-8))
    assert hot["contact.temperature"] == pytest.approx(expected, rel=ROUNDING, abs=0)


@pytest.mark.parametrize("law", ["Hertz", "Rough", "Linearised", "Bonded"])
def test_the_elastic_force_is_the_contact_force_without_what_damping_adds(law: str) -> None:
    values: Values = {**OPENING, "effects.contactLaw": law}
    output = ["contact.force", "contact.elasticForce", "contact.indentation", "tip.velocity"]
    result = run(values, 2e-3, 1e-5, output)
    force, elastic, indentation, rate = (result[name] for name in output)
    reference = Reference(values)
    linear = reference.force + reference.tangent * (indentation - reference.indentation)
    expected = reference.elastic(indentation) if law in ("Hertz", "Rough") else linear
    closed = (force > 0) | (law == "Bonded")
    largest = np.max(np.abs(force))
    assert elastic == pytest.approx(np.where(closed, expected, 0.0), rel=0, abs=ROUNDING * largest)
    stiffness = reference.stiffness_at(indentation[closed]) if law in ("Hertz", "Rough") else reference.tangent
    damped = reference.contact_damping * stiffness * -rate[closed]
    # Force and motion are each right to the tolerance.
    allowed = 2 * 1e-6 * max(FORCE_SCALE, largest)
    assert np.max(np.abs(damped)) > 1e4 * allowed
    assert np.max(np.abs((force - elastic)[closed] - damped)) <= allowed


def test_the_elastic_force_has_the_published_amplitude_in_the_scene_that_is_fitted_to_it() -> None:
    scene = Scene.read("paper-elastic")
    elastic = run_scene(scene)["contact.elasticForce"][-100:]
    reference = Reference(scene.values)
    linear = 98 * abs(reference.force_response(1000.0) / (1 + 2j * pi * 1000 * reference.contact_damping))
    # The contact is 4655 times as stiff as the spring: what its nonlinearity can change.
    assert np.ptp(elastic) / 2 == pytest.approx(linear, rel=1 / 4655)
    # What the fit to the six published amplitudes leaves of this one.
    assert linear == pytest.approx(4.812e-2, rel=3e-3)


CHATTER = ["chatter.count", "chatter.longestInterruption", "chatter.totalInterruption"]


def test_the_first_interruption_is_that_of_the_reference() -> None:
    tolerance, threshold, stop = 1e-8, 60.0, 1.1e-3
    values: Values = {**OPENING, "solver.tolerance": tolerance, "chatter.resistanceThreshold": threshold}
    reference = Reference(values)
    limit = reference.force_of_resistance(threshold)

    def course(*times: float) -> Course:
        return reference.course(np.array([0.0, *times]), limit=limit)

    changes = course(stop).changes
    (opening,), (closing,) = (changes["contact", way] for way in ("falls", "rises"))
    # Long communication steps do not matter.
    count, longest, total = (run(values, stop, stop, CHATTER)[name][-1] for name in CHATTER)
    assert count == 1
    assert longest == total
    # Instants are located to 1 ns; the error of the force over its slope is less.
    forces = course(opening - 1e-8, opening, closing, closing + 1e-8).forces["contact"]
    assert tolerance * FORCE_SCALE / (np.abs(np.diff(forces[1:])[::2]).min() / 1e-8) < 1e-9
    assert longest == pytest.approx(closing - opening, rel=0, abs=1e-9)


EXTREMES = ["step.minimumForce", "step.maximumForce", "step.maximumResistance"]
ELECTRICAL = ["contact.resistance", "contact.conductance", "contact.voltage", "step.maximumResistance"]
LOADED: Values = {"contact.current": 0.1, "effects.chatter": False}


WITHIN = 2e-6 * FORCE_SCALE
"""Two runs, each wrong by the tolerance."""


# Extremes want steps that are right inside too, and steps end where an interruption begins or ends. The others look on.
@pytest.mark.parametrize(
    ("on", "off", "outputs", "pressed", "opening"),
    [
        ({"effects.extremes": True}, {"effects.extremes": False}, EXTREMES, WITHIN, WITHIN),
        ({"effects.chatter": True}, {"effects.chatter": False}, CHATTER, 0.0, WITHIN),
        ({"effects.energy": True}, {"effects.energy": False}, ["energy.balance"], 0.0, 0.0),
        *(
            ({**LOADED, "effects.resistance": kind, "effects.heating": True},
             {**LOADED, "effects.resistance": "None"}, ELECTRICAL, 0.0, 0.0)
            for kind in ("PowerLaw", "Holm", "Barber")
        ),
    ],
)  # fmt: skip
def test_without_an_effect_its_outputs_are_zero_and_the_motion_is_the_same(
    on: Values, off: Values, outputs: list[str], pressed: float, opening: float
) -> None:
    names = ["contact.force", *outputs]
    for scene, allowed in ((PRESSED, pressed), (OPENING, opening)):
        seen, without = (run({**scene, **effect}, 3e-3, 1e-5, names) for effect in (on, off))
        assert np.abs(seen["contact.force"] - without["contact.force"]).max() <= allowed
        for name in outputs:
            # A balance may be of either sign.
            found = np.abs(seen[name]) if name == "energy.balance" else seen[name]
            assert (found > 0).any() or (outputs is CHATTER and scene is PRESSED)
            assert (without[name] == 0).all()
