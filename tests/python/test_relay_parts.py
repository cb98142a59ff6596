"""Fixed spring, pusher and armature, by finite elements of the springs that share no code with the component."""

from pathlib import Path

import numpy as np
import pytest

from component import STARTS, run
from relay_contact import Values
from relay_contact.component import half_sine, sine
from whole_relay import Relay

ALLOWED = 5e-5
"""Share of the largest force: the elements' error. With 20, 30, 40 and 60 the differences are at most 4.4e-4, 7.9e-5,
3.4e-5 and 1.2e-5; 40 are taken."""
GAP = 1e-7
"""The same of the armature's largest gap, on which blows of the spring hardly act: 3.8e-7, 7.7e-8, 3e-8."""
LOCATED = 1e-9
"""Accuracy of an instant in the component, s."""

# Shaken closed, shaken until it opens, on a fixed spring softer than the moving one; shaken until the spring leaves its
# pusher; closed by a pusher that moves in; opened by an armature that a shock takes from its core and that comes back.
FINE: Values = {"solver.tolerance": 1e-8}
PUSHED: Values = {**FINE, "contact.overtravel": -5e-5}
CASES: dict[str, tuple[Values, tuple[float, float] | None, tuple[float, float]]] = {
    "closed": ({**FINE, **sine(700.0, 300.0)}, (0.02, 0.15e-3), (0.0, 0.0)),
    "opening": ({**FINE, **sine(700.0, 3000.0)}, (0.02, 0.15e-3), (0.0, 0.0)),
    "pushed": ({**PUSHED, **sine(700.0, 3000.0), "effects.pusher": "Prescribed"}, None, (7e-5, 0.0)),
    "making": ({**PUSHED, "effects.pusher": "Prescribed"}, (0.05, 0.15e-3), (-1e-5, 0.05)),
    "released": (
        {
            **PUSHED, **half_sine(-1275.0, 1.5e-3), "effects.pusher": "Armature", "armature.unbalance": 1.0,
            "armature.gapConstant": 5e-4,
        },
        None, (0.0, 0.0),
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", CASES)
def test_springs_of_finite_elements_give_the_same_forces(case: str, tmp_path: Path) -> None:
    """Beside a share of the largest force so far."""
    values, fixed, (place, speed) = CASES[case]
    stop, given = 0.004, dict(values)
    if fixed:
        length = float(STARTS["beam.length"])
        text = f"[[segment]]\nlength = {length}\nwidth = {fixed[0]}\nthickness = {fixed[1]}\n"
        (tmp_path / "fixed.toml").write_text(text, encoding="utf-8")
        given["fixed.file"] = str(tmp_path / "fixed.toml")
    ends = np.array([0.0, stop])
    moved = {"time": ends, "pusher.displacement": place + speed * ends} if place or speed else None
    found = run(given, stop, 1e-5, ["contact.force"], moved)
    expected = Relay(values, fixed, (place, speed)).solve(found["time"]).forces["contact"]
    force = found["contact.force"]
    assert (force.min() == 0.0) == (case != "closed")
    assert np.ptp(force) > 0.02
    largest = np.maximum.accumulate(np.maximum(expected, 0.05))
    assert np.abs(force - expected).max() / largest.max() < ALLOWED


# A shock that takes the armature from its core, after which it bounces there; and one that throws it to its rest stop.
RELEASED = CASES["released"][0]
SHOCKS: dict[str, tuple[Values, int, int]] = {
    "released": (RELEASED, 2, 0),
    "thrown to rest": ({**RELEASED, "excitation.amplitude": -2500.0}, 2, 2),
}


@pytest.mark.parametrize("shock", SHOCKS)
def test_a_released_armature_bounces_as_in_a_second_solution(shock: str) -> None:
    """Forces, position and each release from the core, until it is back."""
    values, releases, rests = SHOCKS[shock]
    relay = Relay(values)
    names = ["contact.force", "pusher.force", "armature.displacement", "armature.gap", "armature.lastRelease"]
    found = run(values, 0.012, 1e-5, names)
    course = relay.solve(found["time"])
    for part in ("contact", "pusher"):
        force = course.forces[part]
        assert np.abs(found[f"{part}.force"] - force).max() / force.max() < ALLOWED
    gap = -course.overlaps["core"]
    assert np.abs(found["armature.gap"] - gap).max() / gap.max() < GAP
    assert found["armature.gap"] == pytest.approx(relay.get("armature.corePosition") - found["armature.displacement"])
    left = course.changes["core", "leaves"]
    assert len(left) == releases
    assert len(course.changes.get(("rest", "closes"), [])) == rests
    assert np.unique(found["armature.lastRelease"])[1:] == pytest.approx(left, abs=LOCATED)
