"""Fixed spring, pusher and armature, by finite elements of the springs that share no code with the component."""

from collections.abc import Callable
from math import atan2, exp, pi, sin, sqrt
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import block_diag
from scipy.optimize import brentq

from component import STARTS, run
from elements import element
from relay_contact import Array, Values

ELEMENTS = 30
"""Of each spring."""
ALLOWED = 2e-4
"""Share of the largest force: the elements' error. With 20, 30 and 40 the differences are 4e-4, 7e-5, 3e-5."""


class Beam:
    """A uniform cantilever of Hermite's elements, and the degrees of freedom of its tip and of a place on it."""

    def __init__(self, length: float, width: float, thickness: float, damping: float, place: float) -> None:
        """Assemble it, with a node at the place (m)."""
        modulus, density = float(STARTS["beam.youngsModulus"]), float(STARTS["beam.density"])
        bending, per_length = modulus * width * thickness**3 / 12, density * width * thickness
        before = max(1, round(ELEMENTS * place / length))
        nodes = np.concatenate(
            [np.linspace(0, place, before + 1), np.linspace(place, length, ELEMENTS - before + 1)[1:]]
        )
        size = 2 * len(nodes)
        self.mass, rigidity = np.zeros((size, size)), np.zeros((size, size))
        for k, h in enumerate(np.diff(nodes)):
            at = np.s_[2 * k : 2 * k + 4]
            bent, moved = element(bending, per_length, h)
            rigidity[at, at] += bent
            self.mass[at, at] += moved
        rigid = np.tile([1.0, 0.0], len(nodes))
        self.load = (self.mass @ rigid)[2:]
        self.mass, self.rigidity = self.mass[2:, 2:], rigidity[2:, 2:]
        self.damping = damping * self.rigidity
        self.tip, self.place = np.zeros(size - 2), np.zeros(size - 2)
        self.tip[-2], self.place[2 * before - 2] = 1.0, 1.0


class Armature:
    """The forces of magnet, return spring and stops on an armature."""

    def __init__(self, get: Callable[[str], Any]) -> None:
        """Take its parameters."""
        names = ("mass", "stiffness", "returnForce", "holdForce", "gapConstant", "restPosition", "corePosition")
        self.mass, self.stiffness, self.back, self.hold, self.constant, self.rest, self.core = (
            float(get(f"armature.{name}")) for name in names
        )
        self.stop = float(get("armature.stopStiffness"))

        def left(ratio: float) -> float:
            swing = sqrt(1 - ratio**2)
            return exp(-ratio / swing * atan2(2 * ratio * swing, 2 * ratio**2 - 1))

        ratio = brentq(lambda ratio: left(ratio) - get("armature.stopRestitution"), 1e-9, 1 - 1e-9)
        self.damper = 2 * ratio * sqrt(self.stop * self.mass)

    def pressed(self, depth: float, rate: float) -> bool:
        """Whether a stop presses."""
        return bool(depth > 0 and self.stop * depth + self.damper * rate > 0)

    def load(self, place: float, velocity: float) -> float:
        """Force towards the contact, N, without the return spring's slope."""
        force = (
            self.hold / (1 + max(self.core - place, 0.0) / self.constant) ** 2 - self.back + self.stiffness * self.rest
        )
        for depth, rate, way in ((place - self.core, velocity, -1), (self.rest - place, -velocity, 1)):
            if self.pressed(depth, rate):
                force += way * (self.stop * depth + self.damper * rate)
        return force

    def slopes(self, place: float, velocity: float) -> tuple[float, float]:
        """Its derivatives by place and velocity."""
        gap = self.core - place
        slope = 2 * self.hold / self.constant / (1 + gap / self.constant) ** 3 if gap > 0 else 0.0
        stops = int(self.pressed(-gap, velocity)) + int(self.pressed(self.rest - place, -velocity))
        return slope - stops * self.stop, -stops * self.damper


def forces(values: Values, fixed: tuple[float, float] | None, pushed: Callable[[float], float], times: Array) -> Array:
    """Return the contact force (N) at instants (s).

    `fixed` is the width and thickness (m) of the fixed contact's spring; the pusher is where `pushed` says (m).
    """
    known: dict[str, Any] = {**STARTS, **values}
    get = known.__getitem__
    length, beta = get("beam.length"), get("beam.stiffnessDamping")
    has_pusher, moves = get("effects.pusher") != "None", get("effects.pusher") == "Armature"
    relay = Armature(get) if moves else None
    moving = Beam(
        length, get("beam.width"), get("beam.thickness"), beta, get("pusher.position") if has_pusher else length / 2
    )
    moving.mass[-2, -2] += get("tip.mass")
    moving.load[-2] += get("tip.mass")
    still = [Beam(length, *fixed, get("fixed.stiffnessDamping"), length / 2)] if fixed else []
    beams = [moving, *still]
    mass, rigidity, damping = (
        block_diag(*(getattr(beam, name) for beam in beams)) for name in ("mass", "rigidity", "damping")
    )
    load = np.concatenate([beam.load for beam in beams])
    opens = np.concatenate([moving.tip, *(-beam.tip for beam in still)])
    touched = np.concatenate([moving.place, *(0 * beam.place for beam in still)])
    compliance = sum(
        (1 - get(f"contact.{side}.poissonRatio") ** 2) / get(f"contact.{side}.youngsModulus")
        for side in ("moving", "fixed")
    )
    hertz, beta_c = 4 / 3 / compliance * get("contact.curvatureRadius") ** 0.5, get("contact.damping")
    stiff, damper = get("pusher.stiffness"), get("pusher.damping")
    amplitude, duration = get("excitation.amplitude"), np.inf
    omega = 2 * pi * get("excitation.frequency")
    if get("effects.excitation") == "HalfSine":
        duration = get("excitation.duration")
        omega = pi / duration
    elif get("effects.excitation") == "None":
        amplitude = 0.0

    def contact(w: Array, v: Array) -> tuple[float, float, float]:
        d, rate = get("contact.overtravel") - opens @ w, -opens @ v
        if d <= 0:
            return 0.0, 0.0, 0.0
        tangent = 1.5 * hertz * d**0.5
        force = hertz * d**1.5 + beta_c * tangent * rate
        return (force, tangent + 0.5 * beta_c * tangent / d * rate, beta_c * tangent) if force > 0 else (0.0, 0.0, 0.0)

    def push(time: float, w: Array, v: Array) -> tuple[float, float, float]:
        d, rate = pushed(time) + touched @ w, (pushed(time + 1e-9) - pushed(time - 1e-9)) / 2e-9 + touched @ v
        force = stiff * d + damper * rate
        return (force, stiff, damper) if has_pusher and d > 0 and force > 0 else (0.0, 0.0, 0.0)

    def loads(time: float, w: Array, v: Array) -> Array:
        both = opens * contact(w, v)[0] - touched * push(time, w, v)[0]
        if relay:
            both[-1] += relay.load(w[-1], v[-1])
        return both

    if relay:
        # The armature as one more degree of freedom.
        mass, rigidity, damping = (
            block_diag(matrix, entry)
            for matrix, entry in (
                (mass, relay.mass),
                (rigidity, get("armature.stiffness")),
                (damping, get("armature.damping")),
            )
        )
        load = np.append(load, -get("armature.unbalance") * relay.mass)
        opens, touched = np.append(opens, 0.0), np.append(touched, 1.0)
    n = len(load)
    none = np.zeros(n)
    springs = np.s_[: n - 1] if relay else np.s_[:]
    flexible = np.zeros((n, n))
    flexible[springs, springs] = np.linalg.inv(rigidity[springs, springs])
    soft = 1 / stiff + touched @ flexible @ touched

    def bent(force: float, place: float) -> Array:
        pressed = max(place + touched @ flexible @ opens * force, 0.0) / soft if has_pusher else 0.0
        return flexible @ (opens * force - touched * pressed)

    def at_rest(place: float) -> Array:
        def unbalance(force: float) -> float:
            return contact(bent(force, place), none)[0] - force

        # Of a closed contact; more than a rigid one has in no case.
        w = bent(brentq(unbalance, 0.0, 10.0, xtol=1e-16) if unbalance(0.0) > 0 else 0.0, place)
        return np.append(w[:-1], place) if relay else w

    def balance(place: float) -> float:
        w = at_rest(place)
        return float(loads(0.0, w, none)[-1] - rigidity[-1, -1] * place)

    # An armature that is held rests on its core.
    core = get("armature.corePosition")
    start = at_rest(brentq(balance, core, core + 1e-4, xtol=1e-18) if relay else pushed(0.0))
    inverse = np.linalg.inv(mass)

    def rates(time: float, state: Array) -> Array:
        w, v = state[:n], state[n:]
        shaken = load * (amplitude * sin(omega * time) if time < duration else 0.0)
        return np.concatenate([v, inverse @ (loads(time, w, v) - shaken - rigidity @ w - damping @ v)])

    def jacobian(time: float, state: Array) -> Array:
        w, v = state[:n], state[n:]
        (_, by_d, by_rate), (_, stiffness, damped) = contact(w, v), push(time, w, v)
        across, along = np.outer(opens, opens), np.outer(touched, touched)
        lower = inverse @ np.hstack(
            [-rigidity - by_d * across - stiffness * along, -damping - by_rate * across - damped * along]
        )
        if relay:
            by_place, by_velocity = relay.slopes(w[-1], v[-1])
            lower[:, n - 1] += inverse[:, -1] * by_place
            lower[:, 2 * n - 1] += inverse[:, -1] * by_velocity
        return np.vstack([np.hstack([np.zeros((n, n)), np.eye(n)]), lower])

    solution = solve_ivp(
        rates, (0.0, times[-1]), np.concatenate([start, none]), method="Radau", jac=jacobian, t_eval=times,
        rtol=1e-7, atol=np.repeat([1e-13, 1e-8], n), max_step=1e-5,
    )  # fmt: skip
    assert solution.success, solution.message
    return np.array([contact(state[:n], state[n:])[0] for state in solution.y.T])


# Shaken closed, shaken until it opens, on a fixed spring softer than the moving one; shaken until the spring leaves its
# pusher; closed by a pusher that moves in; opened by an armature that a shock takes from its core and that comes back.
SHAKEN: Values = {"effects.excitation": "Sine", "excitation.frequency": 700.0, "solver.tolerance": 1e-8}
CASES: dict[str, tuple[Values, tuple[float, float] | None, tuple[float, float]]] = {
    "closed": ({**SHAKEN, "excitation.amplitude": 300.0}, (0.02, 0.15e-3), (0.0, 0.0)),
    "opening": ({**SHAKEN, "excitation.amplitude": 3000.0}, (0.02, 0.15e-3), (0.0, 0.0)),
    "pushed": (
        {**SHAKEN, "excitation.amplitude": 3000.0, "effects.pusher": "Prescribed", "contact.overtravel": -5e-5},
        None, (7e-5, 0.0),
    ),
    "making": (
        {"solver.tolerance": 1e-8, "effects.pusher": "Prescribed", "contact.overtravel": -5e-5},
        (0.05, 0.15e-3), (-1e-5, 0.05),
    ),
    "released": (
        {
            "solver.tolerance": 1e-8, "effects.pusher": "Armature", "contact.overtravel": -5e-5,
            "effects.excitation": "HalfSine", "excitation.amplitude": -1275.0, "excitation.duration": 1.5e-3,
            "armature.unbalance": 1.0, "armature.gapConstant": 5e-4,
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
    expected = forces(values, fixed, lambda time: place + speed * max(time - step, 0.0), found["time"])
    force = found["contact.force"]
    assert (force.min() == 0.0) == (case != "closed")
    assert np.ptp(force) > 0.02
    largest = np.maximum.accumulate(np.maximum(expected, 0.05))
    assert np.abs(force - expected).max() / largest.max() < ALLOWED
