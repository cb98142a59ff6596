"""What is read off the motion and leaves it as it is: resistance, heat, interruptions, extremes, energy."""

from math import pi

import numpy as np
import pytest
from fmpy.fmi1 import FMICallException

from component import Instance, run
from reference import Reference, crossings
from relay_contact import Array, Values

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
    return 2.2e-8 / 2 * np.sqrt(pi * 0.785e9 / force)


def conductance(kind: str, force: Array, film: float, open_: float) -> Array:
    """Give the conductance, S."""
    closed = force > 0
    return np.where(closed, 1 / (constriction(kind, np.where(closed, force, 1.0)) + film), 0.0) + 1 / open_


@pytest.mark.parametrize("kind", ["PowerLaw", "Holm"])
@pytest.mark.parametrize(("film", "open_"), [(0.0, OPEN), (0.02, OPEN), (0.0, 10.0)])
@pytest.mark.parametrize(("law", "source"), [("Hertz", 1e21), ("Bonded", 1e3)])
def test_resistance_and_voltage_follow_from_the_force(
    kind: str, film: float, open_: float, law: str, source: float
) -> None:
    values: Values = {
        "contact.openVoltage": source,
        "effects.resistance": kind,
        "effects.contactLaw": law,
        "resistance.film": film,
        "resistance.open": open_,
        "contact.current": -0.1,
    }
    output = ["contact.force", "contact.resistance", "contact.conductance", "contact.voltage", "contact.closed"]
    result = run({**OPENING, **values}, 2e-3, 1e-5, output)
    force = result["contact.force"]
    # The bonded contact pulls where the other is open.
    assert np.min(force) < 0 if law == "Bonded" else np.min(force) == 0
    assert (result["contact.closed"].astype(bool) == (force > 0)).all()
    expected = conductance(kind, force, film, open_)
    assert result["contact.conductance"] == pytest.approx(expected, rel=ROUNDING, abs=0)
    assert result["contact.resistance"] == pytest.approx(1 / expected, rel=ROUNDING, abs=0)
    assert result["contact.voltage"] == pytest.approx(np.maximum(-0.1 / expected, -source), rel=ROUNDING, abs=0)


def test_without_resistance_its_outputs_are_zero_and_the_motion_is_the_same() -> None:
    without: Values = {"effects.resistance": "None", "effects.chatter": False, "contact.current": 0.1}
    output = ["contact.force", "contact.resistance", "contact.conductance", "contact.voltage", "step.maximumResistance"]
    force, *zeros = (run({**PRESSED, **without}, 2e-3, 1e-5, output)[name] for name in output)
    for zero in zeros:
        assert (zero == 0).all()
    for kind in ("PowerLaw", "Holm"):
        values: Values = {"effects.resistance": kind, "effects.heating": True, "contact.current": 0.1}
        assert (run({**PRESSED, **values}, 2e-3, 1e-5, output)["contact.force"] == force).all()


def test_interruptions_need_a_resistance() -> None:
    with Instance() as instance:
        instance.set("effects.resistance", "None")
        with pytest.raises(FMICallException):
            instance.initialise()
        assert any("effects.chatter" in message for message in instance.messages)


@pytest.mark.parametrize(("current", "melts"), [(-0.05, "never"), (3.0, "sometimes"), (30.0, "always")])
@pytest.mark.parametrize("source", [1e3, 0.1])
def test_current_heats_the_closed_contact(current: float, melts: str, source: float) -> None:
    surroundings, melting, film = 350.0, 0.3, 0.01
    values: Values = {
        "contact.current": current,
        "contact.meltingVoltage": melting,
        "contact.openVoltage": source,
        "resistance.film": film,
        "environment.temperature": surroundings,
    }
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


CHATTER = ["chatter.count", "chatter.longestInterruption", "chatter.totalInterruption"]


def interruptions(time: Array, resistance: Array, threshold: float) -> list[tuple[float, float]]:
    """Give beginnings and ends of the stretches above a threshold in a trace, the last of which may not have ended."""
    above = (resistance > threshold).astype(int)
    turns = np.flatnonzero(np.diff(above, prepend=0, append=0))
    instants = np.append(time, time[-1])[turns]
    return list(zip(instants[::2], instants[1::2], strict=True))


@pytest.mark.parametrize("minimum", [0.0, 1e-5, 1e-4])
def test_interruptions_are_those_of_a_fine_trace(minimum: float) -> None:
    step, threshold = 1e-7, 0.5
    # Little damping, so that there are bounces of many lengths.
    values: Values = {
        **SHAKEN,
        "excitation.amplitude": 600.0,
        "contact.damping": 1e-7,
        "chatter.resistanceThreshold": threshold,
        "chatter.minimumDuration": minimum,
    }
    result = run(values, 5e-3, step, ["contact.resistance", *CHATTER])
    found = interruptions(result["time"], result["contact.resistance"], threshold)
    lengths = np.array([end - begin for begin, end in found])
    # The trace tells each duration to a step, which leaves no doubt about which of them count.
    assert np.min(np.abs(lengths - minimum)) > step
    counting = lengths[lengths >= minimum]
    count, longest, total = (result[name] for name in CHATTER)
    assert (len(counting) < len(lengths)) == (minimum > 0)
    assert count[-1] == len(counting) > 2
    assert longest[-1] == pytest.approx(np.max(lengths), rel=0, abs=step)
    assert total[-1] == pytest.approx(np.sum(counting), rel=0, abs=len(counting) * step)
    # The first of them as it goes on.
    begin, end = found[0]
    during = (result["time"] > begin + step) & (result["time"] < end - step)
    assert longest[during] == pytest.approx(result["time"][during] - begin, rel=0, abs=step * (1 + 1e-6))
    # While they are off they are not there.
    for name, output in run({**values, "effects.chatter": False}, 5e-3, 1e-3, CHATTER).items():
        assert name == "time" or (output == 0).all()


def test_the_first_interruption_is_that_of_the_reference() -> None:
    tolerance, threshold, stop = 1e-8, 60.0, 1.1e-3
    values: Values = {**OPENING, "solver.tolerance": tolerance, "chatter.resistanceThreshold": threshold}
    reference = Reference(values)
    motion = reference.motion(lambda time: 400 * np.sin(2 * pi * 1000 * time), stop, 1e-11)
    limit = reference.force_of_resistance(threshold)
    (opening,), (closing,) = crossings(motion, limit, np.linspace(0, stop, 1101))
    # Long communication steps do not matter.
    count, longest, total = (run(values, stop, stop, CHATTER)[name][-1] for name in CHATTER)
    assert count == 1
    assert longest == total
    # Instants are located to 1 ns; the error of the force over its slope is less.
    slopes = [abs(motion(at + h) - motion(at)) / 1e-8 for at, h in ((opening, -1e-8), (closing, 1e-8))]
    assert tolerance * FORCE_SCALE / min(slopes) < 1e-9
    assert longest == pytest.approx(closing - opening, rel=0, abs=1e-9)


def test_watching_interruptions_leaves_the_motion_as_it_is() -> None:
    tolerance = 1e-6
    watched, unwatched = (
        [
            run({**scene, "effects.chatter": on}, 3e-3, 1e-5, ["contact.force"])["contact.force"]
            for scene in (PRESSED, OPENING)
        ]
        for on in (True, False)
    )
    assert (watched[0] == unwatched[0]).all()
    # Steps end where an interruption begins or ends. Each run may be wrong by the tolerance.
    assert np.max(np.abs(watched[1] - unwatched[1])) <= 2 * tolerance * FORCE_SCALE


EXTREMES = ["step.minimumForce", "step.maximumForce", "step.maximumResistance"]


@pytest.mark.parametrize("amplitude", [98.0, 300.0, 400.0])
def test_extremes_within_a_step_are_those_of_a_fine_trace(amplitude: float) -> None:
    tolerance, fine, many, stop = 1e-8, 1e-7, 1300, 3.9e-3
    values: Values = {**SHAKEN, "excitation.amplitude": amplitude, "solver.tolerance": tolerance}
    trace = run(values, stop, fine, ["contact.force", "contact.resistance"])
    result = run(values, stop, fine * many, EXTREMES)
    steps = [slice(n * many, (n + 1) * many + 1) for n in range(round(stop / fine / many))]
    force = trace["contact.force"]
    least, greatest = (np.array([extreme(force[step]) for step in steps]) for extreme in (np.min, np.max))
    # Once a period the greatest is inside a step, not at its ends.
    assert np.count_nonzero(greatest > np.maximum(force[:-1:many], force[many::many])) > 3
    # Both runs may be wrong by the tolerance. Between points of the trace the force goes beyond them by an eighth of
    # its second difference.
    bend = np.abs(np.diff(force, 2))
    bends = np.array([np.max(bend[step], initial=0.0) / 8 for step in steps])
    minimum, maximum, resistance = (result[name][1:] for name in EXTREMES)
    for found, expected in ((minimum, least), (maximum, greatest)):
        assert (np.abs(found - expected) <= 2 * tolerance * FORCE_SCALE + bends).all()
    assert resistance == pytest.approx(1 / conductance("PowerLaw", minimum, 0.0, OPEN), rel=ROUNDING, abs=0)
    assert (np.min(minimum) == 0) == (amplitude > 300)


def test_without_extremes_they_are_zero_and_the_motion_is_the_same() -> None:
    for scene in (PRESSED, OPENING):
        on, off = (
            run({**scene, "effects.extremes": on}, 3e-3, 1e-5, ["contact.force", *EXTREMES]) for on in (True, False)
        )
        assert (on["contact.force"] == off["contact.force"]).all()
        for name in EXTREMES:
            assert (on[name] > 0).any()
            assert (off[name] == 0).all()


@pytest.mark.parametrize("scene", [PRESSED, OPENING], ids=["pressed", "opening"])
def test_the_balance_of_energy_is_within_what_the_tolerance_is_worth(scene: Values) -> None:
    output = ["contact.force", "tip.velocity", "energy.balance"]
    step, balances = 1e-6, []
    for tolerance in (1e-2, 1e-4, 1e-6):
        values: Values = {**scene, "solver.tolerance": tolerance}
        on, off = (run({**values, "effects.energy": on}, 5e-3, step, output) for on in (True, False))
        assert (off["energy.balance"] == 0).all()
        assert (on["contact.force"] == off["contact.force"]).all()
        # A force wrong by the tolerance does this work along the way of the tip.
        way = float(np.sum(np.abs(on["tip.velocity"])) * step)
        balances.append(np.max(np.abs(on["energy.balance"])))
        assert 0 < balances[-1] <= tolerance * FORCE_SCALE * way
    # It tells of the integration: the tighter the less.
    assert balances[-1] < 0.01 * balances[0]
