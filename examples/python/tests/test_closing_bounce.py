"""Make and break against a second solution and closed forms."""

from pathlib import Path

import numpy as np
import pytest

from conftest import Run, is_picture, table
from reference import Reference, crossings
from relay_contact import Values, read_table

GAP, OVERTRAVEL = 20e-6, 200e-6


def test_bounce_is_that_of_a_second_solution(run: Run, tmp_path: Path) -> None:
    speed, damping = 0.06, 1e-6
    run("closing_bounce")
    shown = {name: float(value) for name, value in table(tmp_path / "closing-bounce.csv")[0].items()}
    assert (shown["speed [m/s]"], shown["contact.damping [s]"]) == (speed, damping)
    course = np.column_stack(list(read_table(tmp_path / "closing-bounce-course.csv").values()))
    # The spring is at rest before: it is touched when the gap is travelled. Instants are located to 1 ns.
    assert abs(shown["first touch [s]"] - GAP / speed) < 1e-9
    after = course[:, 0] - GAP / speed
    near = (after > 0) & (after < 300e-6)
    # From the touch on, so with a gap of nothing.
    values: Values = {"contact.overtravel": 0.0, "contact.damping": damping, "effects.axialForce": "None"}
    reference = Reference(values)
    motion = reference.motion(lambda _: 0.0, 300e-6, 1e-8, support_speed=speed, max_step=0.5e-6)
    force = np.array([motion(time) for time in after[near]])
    opened, closed = crossings(motion, reference.force_of_resistance(60.0), np.linspace(0, 300e-6, 3001))
    # The blow is of the high modes, of which both have a limited number: 1e-3 of it.
    assert np.max(np.abs(course[near, 1] - force)) < 2e-3 * force.max()
    assert len(opened) == shown["bounces on make"] == 1
    assert np.isclose(shown["bounce time [s]"], closed[-1], rtol=1e-3)
    assert np.isclose(shown["open while bouncing [s]"], np.sum(closed[-1:] - opened), rtol=1e-3)
    assert is_picture(tmp_path / "closing-bounce.png")


def test_slow_and_fast_ones_are_those_of_closed_forms(run: Run, tmp_path: Path) -> None:
    printed = run("closing_bounce", "--speed", "5", "--damping", "10")
    rows = [{name: float(value) for name, value in row.items()} for row in table(tmp_path / "closing-bounce.csv")]
    shown, grid = rows[0], rows[1:]
    # The monitor does not depend on the communication step: the course is sampled every 2 us, the map is not. The
    # solver's steps are others and so are its errors, 1e-6 of the force: 1 us of a slow separation.
    same = next(row for row in grid if row["speed [m/s]"] == 0.005 and np.isclose(row["contact.damping [s]"], 1e-5))
    assert all(np.isclose(shown[name], same[name], rtol=1e-4, atol=1e-9) for name in shown if "force" not in name)
    assert "bounces 0" in printed
    # A damped spring that follows at v exerts k (y - beta v): it is left beta before its rest, at the earliest.
    spring = Reference({"contact.overtravel": -GAP, "effects.axialForce": "None"})
    lag = spring.values["beam.stiffnessDamping"]
    early = 1.5 * OVERTRAVEL / same["speed [m/s]"] - same["break time [s]"]
    assert 0.5 * lag < early < 1.01 * lag
    # Left at a speed v, the spring swings through, and reaches the actuator where that stopped too near: first mode.
    omega = np.sqrt(spring.modes().omega_squared.min())
    ratio = lag * omega / 2
    time = np.linspace(0, np.pi / omega, 1000)
    damped = omega * np.sqrt(1 - ratio**2)
    # Position for a unit speed, from y = beta, y' = -1.
    start = (ratio * omega * lag - 1) / damped
    swing = np.exp(-ratio * omega * time) * (lag * np.cos(damped * time) + start * np.sin(damped * time))
    critical = GAP / -swing.min()
    assert 0.03 < critical < 0.06, critical
    for row in grid:
        speed, damping = row["speed [m/s]"], row["contact.damping [s]"]
        # The other modes change the swing by some per cent.
        if not 0.8 < speed / critical < 1.25:
            assert (row["bounces on break"] > 0) == (speed > critical), row
        # A stop at v2/s opens where it exceeds what the preload can slow down; a sudden one shakes twice as much.
        stop = speed**2 / OVERTRAVEL * spring.carried_mass / 0.152
        if damping > 5e-6 and not 0.5 < stop < 1:
            assert (row["bounces on make"] > 0) == (stop > 1), row
        assert row["open while bouncing [s]"] <= row["bounce time [s]"]
        assert abs(row["first touch [s]"] - GAP / speed) < 1e-9


def test_wrong_speed_is_refused(run: Run) -> None:
    with pytest.raises(AssertionError, match="--speed: 0: must be from 1 to 500 mm/s"):
        run("closing_bounce", "--speed", "0")
