"""`qualify` of a relay with pusher and armature: which part fails first, by closed forms, statics and brute force."""

from dataclasses import replace

import numpy as np
import pytest

from component import COMPONENT, resting
from qualified import CONTACTS, described, judged, placed
from relay_contact import Values
from relay_contact.component import half_sine, sine
from relay_contact.qualification import FEW, Assessment, Standard, judgement
from relay_contact.qualification import position as positions
from relay_contact.qualification.distributions import Distribution
from relay_contact.qualification.excitation import Random, Shock, Sine
from relay_contact.qualification.excitation import Test as Asked
from relay_contact.qualification.judgement import transient
from relay_contact.qualification.page import write
from relay_contact.qualification.parts import CLOSED, CONTACT, CORE, PUSHER, STOP, Rest, all_parts
from relay_contact.qualification.position import Position
from relay_contact.qualification.relay import Relay
from relay_contact.qualification.words import part_rows, reasons

G = 9.80665
ARMATURE: dict[str, float] = {
    "mass": 0.02, "stiffness": 300.0, "returnForce": 0.5, "damping": 0.05, "unbalance": 1.0, "holdForce": 3.0,
    "gapConstant": 3e-4, "restPosition": -3e-4, "corePosition": 1e-4, "stopStiffness": 1e6, "stopRestitution": 0.4,
}  # fmt: skip
SPRING: Values = {"contact.overtravel": -5e-5, "contact.damping": 1e-6, "pusher.position": 10e-3}
WEAK: Values = {**SPRING, "effects.pusher": "Armature", **{f"armature.{name}": own for name, own in ARMATURE.items()}}
"""A heavy armature that is barely held: it is shaken off before anything else fails."""
SLOW = Sine("slow", "", "from memory", acceleration=1.0, steps=(20.0,))
LONG = Shock("long", "", "from memory", acceleration=30.0, duration=11e-3)


def position(values: Values, *tests: Asked, current: float = 1.0) -> Position:
    """Return a position of a relay of these parameters."""
    return placed(described({**values, "coil.relativeCurrent": current}), *tests)


def least_level(each: Position, test: Sine) -> float:
    """Return the least level (m/s2) that fails a part in a sine of steps."""
    frequency, factor, *_ = each.weakest[test.name]
    return factor * float(test.amplitude(np.array(frequency)))


def test_a_weakly_held_armature_leaves_its_core_at_the_level_of_the_closed_form() -> None:
    levels = {each.part: least_level(each, SLOW) for each in position(WEAK, SLOW).parts}
    # Once it leaves it falls back for good: what it carried fails at the same level, known to 1e-4.
    assert levels[CORE] <= min(levels.values()) * (1 + 2e-4)
    push, gap, held = resting(WEAK, "pusher.force", "armature.gap", "step.minimumStopForce")
    back = 0.5 + 300.0 * (4e-4 - gap)
    # The spring takes part with at most its mass and its rivet's; 1e-4 by the bisection.
    taking_part = 7.85e3 * 15e-3 * 5e-3 * 0.2e-3 + 1e-4
    level = (3.0 - back - push) / ARMATURE["mass"]
    assert levels[CORE] == pytest.approx(level, rel=taking_part / ARMATURE["mass"])
    # By statics alone: gravity of 1 m/s2 is the same load. Linear to the compliance of contact and stop.
    (eased,) = resting({**WEAK, "environment.gravity": -1.0}, "step.minimumStopForce")
    assert levels[CORE] == pytest.approx(held / (held - eased), rel=1e-3)


def test_a_strongly_held_armature_is_a_fixed_pusher() -> None:
    """It fails by the contact, where the relay with a pusher that does not move does."""
    strong = {**WEAK, "armature.holdForce": 500.0, "armature.unbalance": 0.0, "armature.stopStiffness": 1e8}
    (place,) = resting(strong, "armature.displacement")
    still = {**SPRING, "effects.pusher": "Prescribed", "pusher.displacement": place}
    for test in (SLOW, Sine("sine", "", "from memory", acceleration=1.0, frequencies=(10.0, 2500.0), sweep_rate=1.0)):
        moved, fixed = ({each.part: least_level(each, test) for each in position(values, test).parts}
                        for values in (strong, still))  # fmt: skip
        assert set(moved) == {CONTACT, PUSHER, CORE}
        assert set(fixed) == {CONTACT, PUSHER}
        assert min(moved, key=lambda name: moved[name]) in (CONTACT, PUSHER)
        for name, level in fixed.items():
            # The stop gives way by 1e5/1e8 of what the pusher does; each level is known to 1e-4.
            assert moved[name] == pytest.approx(level, rel=1.2e-3)


def test_what_holds_the_armature_makes_no_other_part_weaker() -> None:
    """The armature's margin grows with the hold force, and no margin falls; the contact fails at last by itself."""
    before: dict[str, float] = {}
    for hold in (2.8, 4.0, 60.0, 400.0):
        own = position({**WEAK, "armature.holdForce": hold}, LONG)
        levels = {name: level.factor for name, level in transient(own, LONG)[0].items()}
        # Each is known to 1e-4.
        assert all(level > before.get(name, 0.0) * (1 - 2e-4) for name, level in levels.items())
        if before:
            assert levels[CORE] > before[CORE]
        before = levels
    assert min(before, key=lambda name: before[name]) == CONTACT


def test_a_part_that_a_shock_hardly_shakes_fails_where_another_takes_it_along() -> None:
    weak = replace(LONG, acceleration=0.04)
    own = position(WEAK, weak)
    assert own.parts[0].is_endless(weak)
    levels, _ = transient(own, weak)
    found, first = levels[CONTACT].factor, levels[CORE].factor

    def opens(factor: float) -> bool:
        shock = half_sine(-factor * weak.acceleration * G, weak.duration)
        with COMPONENT.started({**WEAK, **shock, "chatter.resistanceThreshold": CONTACTS.threshold}) as contact:
            contact.step(0.0, 0.1)
            return contact.get("chatter.count") > 0

    assert opens(1.002 * found)
    assert not any(map(opens, np.linspace(first, 0.998 * found, 30)))


def leaves(values: Values, frequency: float, level: float, step: float) -> bool:
    """Return whether a steady vibration, gently raised, takes the armature from its core, by small steps."""
    with COMPONENT.started({**values, **sine(frequency, level, 12 / frequency)}) as contact, contact.explained():
        contact.step(0.0, 12 / frequency)
        count = round(6 / frequency / step)
        rows = contact.drive(12 / frequency + step * np.arange(count + 1.0), {}, ["step.minimumStopForce"])
        return bool(rows["step.minimumStopForce"].min() <= 0)


def test_the_weakest_frequency_is_that_of_brute_force() -> None:
    soft = {**WEAK, "armature.stopStiffness": 2e4, "armature.mass": 2e-3, "armature.stopRestitution": 0.7}
    test = Sine("sine", "", "from memory", acceleration=1.0, frequencies=(200.0, 1200.0), sweep_rate=1.0)
    core = next(each for each in position(soft, test).parts if each.part == CORE)
    frequency, factor, *_ = core.weakest[test.name]

    def brute(tried: float) -> float:
        low, high = 0.5 * factor, 8 * factor
        while high > 1.001 * low:
            middle = (low * high) ** 0.5
            low, high = (low, middle) if leaves(soft, tried, G * middle, 1e-4) else (middle, high)
        return high

    grid = np.geomspace(200.0, 1200.0, 22)
    levels = [brute(float(each)) for each in grid]
    at = int(np.argmin(levels))
    assert 0 < at < len(grid) - 1
    assert grid[at - 1] < frequency < grid[at + 1]
    assert factor <= min(levels) * 1.002
    assert factor == pytest.approx(brute(frequency), rel=2e-3)


@pytest.mark.parametrize("restitution", [0.1, 0.4, 1.0])
def test_the_forces_of_the_stops_are_those_of_the_component(restitution: float) -> None:
    """That of the core in small steps, and that of the rest stop by the motion of the armature."""
    shaken: Values = {**WEAK, "armature.stopRestitution": restitution, **sine(700.0, 10.0)}
    core, stop = (all_parts(COMPONENT, shaken)[name] for name in (CORE, STOP))
    step = 1e-6
    with COMPONENT.started(shaken) as contact:
        rows = contact.drive(step * np.arange(2001.0), {}, [*core.outputs, core.least])
    force = core.force(rows)
    both = np.minimum(force[1:], force[:-1])
    # Within a step of a thousandth of a period a minimum is missed by (0.0022)^2 of what changes.
    assert rows[core.least][1:] == pytest.approx(both, abs=1e-5 * np.ptp(force) + 1e-9)
    level = 10.0
    with COMPONENT.started({**shaken, "coil.relativeCurrent": 0.0, "excitation.amplitude": level}) as contact:
        for number in range(300):
            contact.step(number * 1e-5, 1e-5)
            place, speed = contact.real("armature.displacement", "armature.velocity")
            (change,) = contact.rates("armature.velocity")
            base = level * np.sin(2 * np.pi * 700.0 * (number + 1) * 1e-5)
            pressed = 0.5 + 300 * (place + 3e-4) - 0.02 * base
            expected = 0.02 * change + 0.05 * speed + pressed
            # The derivative of an output is that of a step's polynomial.
            assert stop.now(contact) == pytest.approx(expected, abs=2e-3)


@pytest.mark.parametrize("duration", [11e-3, 0.3e-3])
def test_a_shock_takes_an_armature_from_its_stop_where_small_steps_do(duration: float) -> None:
    """Nothing counts how it leaves: what lasts for less than a communication step might be missed."""
    pulse = Shock("shock", "", "from memory", acceleration=10.0, duration=duration)
    values = {**WEAK, "contact.overtravel": -2e-4, "armature.unbalance": 0.8}
    own = position(values, pulse, current=0.0)
    assert STOP in own.rest.held
    assert CORE not in own.rest.held
    found = transient(own, pulse)[0][STOP].factor
    stop = all_parts(COMPONENT, values)[STOP]

    def left(factor: float) -> bool:
        shock = half_sine(factor * 10.0 * G, duration)
        with COMPONENT.started({**values, **shock, "coil.relativeCurrent": 0.0}) as contact:
            rows = contact.drive(2e-6 * np.arange(2 * duration / 2e-6), {}, stop.outputs)
        return bool(stop.force(rows).min() <= 0)

    assert left(1.002 * found)
    assert not left(0.998 * found)
    if duration > 5e-3:
        # A slow one by its closed form: return force over mass and unbalance.
        assert found * 10 * G == pytest.approx(0.5 / (0.02 * 0.8), rel=5e-3)


UNSURE = {"armature.holdForce": Distribution(part=0.1), "armature.unbalance": Distribution(part=0.05)}
TESTS = (
    Sine("sine", "1", "from memory", acceleration=4.0, steps=(20.0, 100.0)),
    Random("random", "2", "from memory", density=((20.0, 0.01), (1000.0, 0.01)), rms=3.13, duration=60.0),
    Shock("shock", "3", "from memory", acceleration=8.0, duration=11e-3),
)


@pytest.fixture(scope="module")
def assessed(tmp_path_factory: pytest.TempPathFactory) -> Assessment:
    """Judge the weakly held relay."""
    relay, out = described({**WEAK, "coil.relativeCurrent": 1.0}, UNSURE), tmp_path_factory.mktemp("judged")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(positions, "DRAWS", 32)
        found = Assessment(relay, Standard("own", CONTACTS, TESTS), judged(relay, out, *TESTS), out)
    write(found, COMPONENT)
    return found


def test_the_verdict_is_that_of_the_part_that_fails_first(assessed: Assessment) -> None:
    assert [tested.first.kind for tested in assessed] == ["sine", "random", "shock"]
    for tested in assessed:
        own = tested.margin
        assert set(own.parts) == {CONTACT, PUSHER, CORE}
        assert own.margin == min(part.margin for part in own.parts.values())
        assert own.parts[CORE].margin == pytest.approx(own.margin, rel=4e-4)
        assert own.decides == [CORE]
        assert own.low <= min(part.low for part in own.parts.values()) * (1 + 1e-9)
        assert tested.verdict == ("pass" if own.low > 1 else "FAIL" if own.high < 1 else "undecided")
        if own.margin < 1:
            assert CORE in own.failed
            assert own.least[CORE] == 0
        assert np.interp(own.overtravel, own.wear["overtravel"], own.wear["margin"]) == pytest.approx(own.margin)
        assert own.chance
        effects = own.chance.effects
        assert max(effects, key=effects.__getitem__) in ("armature.holdForce", "chance of the largest dip")
    slow = assessed["sine"].margin
    # Of the overtravel, that of the pusher included, half leaves half of the force.
    force, held = resting(WEAK, "contact.force", "step.minimumStopForce")
    half = resting({**WEAK, "contact.overtravel": -5e-5 - slow.overtravel / 2}, "contact.force")
    assert half == pytest.approx([force / 2], rel=0.02)
    # The hold force, less what it has to carry, is what the level follows: the interval in closed form.
    assert slow.high / slow.margin - 1 == pytest.approx(np.hypot(0.1 * 3.0 / held, 0.05), rel=0.08)


def test_page_and_tables_name_the_parts(assessed: Assessment) -> None:
    page = (assessed.folder / "qualification.html").read_text(encoding="utf-8")
    texts = ("The relay with its contacts, its armature and the pusher", "the part that fails first", f"· {PUSHER}",
             "armature leaves its core", "cN at its core", "armature that moves a pusher")  # fmt: skip
    for text in texts:
        assert text in page, text
    assert "as in a rigid relay" not in page
    for tested in assessed:
        (told,) = [row[7] for row in part_rows(tested.first) if row[0] == f"· {CORE}"]
        assert (told == "holds") == (CORE not in tested.margin.failed)
        # Parts have limits of their own.
        assert {f"· {CONTACT}", f"· {PUSHER}"} <= {row[0] for row in reasons(tested)}
    table = assessed.table
    assert (table[f"{CORE} margin"] < table["margin"] * (1 + 4e-4)).all()
    assert (table["fails first"] == CORE).all()
    assert (table["closed contact least force"] > 0).any()
    assert f"{CLOSED} interrupted" in table


def test_reading_a_relay_tells_no_error_of_a_force(recwarn: pytest.WarningsRecorder) -> None:
    """What is found out by a blow harder than any test is not a warning of a test."""
    COMPONENT.told.clear()
    Relay.read("power-changeover", COMPONENT)
    assert not [str(each.message) for each in recwarn]


def test_a_draw_that_does_not_hold_the_armature_fails() -> None:
    own = position(WEAK, SLOW)
    released = own.responses({"armature.holdForce": 0.5})
    margins = {each.part: each.linear(released[each.part], SLOW) for each in own.parts}
    assert margins[CORE] == 0
    assert margins[CONTACT] == 0


def test_what_fails_at_rest_is_said() -> None:
    loose = position(WEAK, LONG)
    loose.rest = Rest(is_open=False)
    worn, sagging, lifted = (
        placed(described({"contact.overtravel": overtravel, "environment.gravity": gravity}), LONG)
        for overtravel, gravity in ((1e-9, 0.0), (-1e-6, 9.8), (1e-6, -9.8))
    )
    for own, told in (
        (loose, "the armature rests at neither of its stops"),
        (worn, "interrupted at rest: more than 600 Ω of contact resistance"),
        (lifted, "interrupted at rest: more than 600 Ω of contact resistance"),
        (sagging, "makes at rest: gravity closes the gap"),
    ):
        found = judgement.judged(own, LONG, FEW)
        assert (found.verdict, found.limits) == ("FAIL", told)


def test_a_part_that_is_not_shaken_is_said_to_hold() -> None:
    balanced = {**WEAK, "armature.unbalance": 0.0, "armature.restPosition": -2e-3, "armature.corePosition": -1.6e-3,
                "contact.overtravel": 2e-4}  # fmt: skip
    own = position(balanced, LONG, current=0.0)
    assert own.rest.held == (STOP,)
    levels, seen = transient(own, LONG)
    assert levels[STOP].factor > 100
    assert levels[CONTACT].factor < levels[STOP].factor
    assert STOP not in seen.failed


@pytest.mark.parametrize("unbalance", [0.2, 0.3, 0.5])
def test_a_pulse_calms_down_beside_an_open_contact_and_a_stiff_core(unbalance: float) -> None:
    """At a tolerance of 1e-11 one communication step had taken too many integration steps."""
    values: Values = {
        "beam.length": 16.2e-3, "beam.width": 2.2e-3, "beam.thickness": 0.31e-3, "beam.youngsModulus": 1.2e11,
        "beam.density": 8800.0, "beam.stiffnessDamping": 1.2e-5, "tip.mass": 6.8e-5, "contact.overtravel": -0.26e-3,
        "pusher.position": 13.5e-3, "pusher.stiffness": 5.6e4, "pusher.damping": 2.26, "effects.pusher": "Armature",
        "armature.mass": 1.23e-3, "armature.stiffness": 190.0, "armature.damping": 0.115,
        "armature.unbalance": unbalance, "armature.gapConstant": 0.13e-3, "armature.stopStiffness": 1.28e6,
        "armature.stopRestitution": 0.53, "armature.returnForce": 0.1, "armature.holdForce": 15.2,
        "armature.corePosition": 0.04e-3, "armature.restPosition": -0.52e-3,
    }  # fmt: skip
    own = position(values, LONG)
    assert own.rest.is_open
    assert all(each.specimen.response.reserve > 0 for each in own.parts)
