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
    stop, step = 0.004, 1e-5
    given = dict(values)
    if fixed:
        length = float(STARTS["beam.length"])
        text = f"[[segment]]\nlength = {length}\nwidth = {fixed[0]}\nthickness = {fixed[1]}\n"
        (tmp_path / "fixed.toml").write_text(text, encoding="utf-8")
        given["fixed.file"] = str(tmp_path / "fixed.toml")
    signals = None
    if place or speed:
        signals = np.array(
            [(0.0, place), (stop, place + speed * stop)], dtype=[("time", float), ("pusher.displacement", float)]
        )
    found = run(given, stop, step, ["contact.force"], signals)
    # FMPy sets no derivatives of inputs: the pusher lags by a step.
    expected = Relay(values, fixed, (place, speed, step)).solve(found["time"]).forces["contact"]
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
    """Force, position and each release from the core, until it is back."""
    values, releases, rests = SHOCKS[shock]
    relay = Relay(values)
    names = ["contact.force", "armature.displacement", "armature.gap", "armature.lastRelease"]
    found = run(values, 0.012, 1e-5, names)
    course = relay.solve(found["time"])
    force, gap = course.forces["contact"], -course.overlaps["core"]
    assert np.abs(found["contact.force"] - force).max() / force.max() < ALLOWED
    assert np.abs(found["armature.gap"] - gap).max() / gap.max() < GAP
    assert found["armature.gap"] == pytest.approx(relay.get("armature.corePosition") - found["armature.displacement"])
    left = course.changes["core", "leaves"]
    assert len(left) == releases
    assert len(course.changes.get(("rest", "closes"), [])) == rests
    assert np.unique(found["armature.lastRelease"])[1:] == pytest.approx(left, abs=LOCATED)


@pytest.mark.parametrize("shock", SHOCKS)
def test_the_energy_of_a_flying_armature_is_what_magnet_springs_and_base_give_it(shock: str) -> None:
    """From the outputs of the component, while no stop touches it."""
    values = SHOCKS[shock][0]
    step = 1e-6
    get = Relay(values).get
    names = ["armature.displacement", "armature.velocity", "armature.gap", "pusher.force"]
    time, place, velocity, gap, pushed = run(values, 0.005, step, names).values()
    mass, hold, constant, rest = (
        get(f"armature.{name}") for name in ("mass", "holdForce", "gapConstant", "restPosition")
    )
    duration = get("excitation.duration")
    base = np.where(time < duration, get("excitation.amplitude") * np.sin(np.pi * time / duration), 0.0)
    energy = 0.5 * mass * velocity**2 + 0.5 * get("armature.stiffness") * (place - rest) ** 2
    energy += get("armature.returnForce") * place - hold * constant / (1 + gap / constant)
    power = (get("armature.unbalance") * mass * base - pushed - get("armature.damping") * velocity) * velocity
    given = np.concatenate([[0.0], np.cumsum(power[1:] + power[:-1]) * step / 2])
    flying = np.flatnonzero((gap > 0) & (place > rest))
    flights = np.split(flying, np.flatnonzero(np.diff(flying) > 1) + 1)
    longest = max(flights, key=len)
    assert len(longest) > 500
    for flight in flights:
        # The trapezoidal rule misses up to half a step of the power that the pusher's damper has at once at a touch.
        jump = get("pusher.damping") * np.abs(velocity[flight]).max() ** 2
        allowed = jump * step / 2 + 1e-4 * np.ptp(given[flight]) * (step / 1e-5) ** 2
        assert np.ptp(energy[flight] - given[flight]) < allowed
