"""A spring that forks into two tongues, by finite elements that share no code with the component."""

from math import pi, sin
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.optimize import root

from component import STARTS, run
from elements import assembled
from reference import cvode, hertz
from relay_contact import Array, Values

ELEMENTS = 16
"""Of trunk and of each tongue."""
ALLOWED = 2e-4
"""Share of the largest force: the error of the elements. With 8, 16, 32 the differences are 1.2e-3, 7.7e-5, 2.8e-6."""
FORK = 8e-3
"""m from the clamp."""
NAMES = ("contact.force", "parallel.force")


class Forked:
    """Trunk and two tongues of half its width, clamped at the start of the trunk."""

    def __init__(self) -> None:
        """Assemble the uniform spring of the start values, forked."""
        start = {name: float(STARTS[name]) for name in STARTS if isinstance(STARTS[name], int | float)}
        bending = start["beam.youngsModulus"] * start["beam.width"] * start["beam.thickness"] ** 3 / 12
        per_length = start["beam.density"] * start["beam.width"] * start["beam.thickness"]
        n = ELEMENTS
        trunk = [(k, k + 1, FORK / n, 1.0) for k in range(n)]
        tongue = (start["beam.length"] - FORK) / n
        first = [(n + k, n + k + 1, tongue, 0.5) for k in range(n)]
        other = [(n if k == 0 else 2 * n + k, 2 * n + k + 1, tongue, 0.5) for k in range(n)]
        parts = [(a, b, share * bending, share * per_length, h) for a, b, h, share in trunk + first + other]
        rigidity, mass = assembled(3 * n + 1, parts)
        tips = [2 * 2 * n, 2 * 3 * n]
        for tip in tips:
            mass[tip, tip] += start["tip.mass"] / 2
        self.load, self.mass, self.rigidity = mass[2:, ::2].sum(axis=1), mass[2:, 2:], rigidity[2:, 2:]
        self.damping = start["beam.stiffnessDamping"] * self.rigidity
        self.opens = np.zeros((2, len(self.load)))
        for row, tip in enumerate(tips):
            self.opens[row, tip - 2] = 1.0


def forces(values: Values, times: Array) -> Array:
    """Return the forces of both contacts (N) at instants (s), a row each."""
    known: dict[str, Any] = {**STARTS, **values}
    spring = Forked()
    n = len(spring.load)
    factor = np.array([hertz(known, name) for name in ("contact", "parallel")])
    damper = np.array([known["contact.damping"], known["parallel.damping"]])
    reach = known["contact.overtravel"] - np.array([0.0, known["parallel.offset"]])

    def contacts(w: Array, v: Array) -> Array:
        """Return the forces."""
        d, rate = np.maximum(reach - spring.opens @ w, 0.0), -spring.opens @ v
        return np.asarray(np.maximum(factor * d**0.5 * (d + 1.5 * damper * rate), 0.0))

    none = np.zeros(n)
    flexible = np.linalg.inv(spring.rigidity)

    def unbalance(force: Array) -> Array:
        return contacts(flexible @ (spring.opens.T @ force), none) - force

    at_rest = root(unbalance, [0.05, 0.05], tol=1e-14)
    start = flexible @ (spring.opens.T @ at_rest.x)
    inverse = np.linalg.inv(spring.mass)
    omega = 2 * pi * known["excitation.frequency"]

    def rates(time: float, state: Array) -> Array:
        w, v = state[:n], state[n:]
        shaken = spring.load * known["excitation.amplitude"] * sin(omega * time)
        pressed = spring.opens.T @ contacts(w, v)
        return np.concatenate([v, inverse @ (pressed - shaken - spring.rigidity @ w - spring.damping @ v)])

    def engaged(_time: float, state: Array) -> Array:
        d, rate = reach - spring.opens @ state[:n], -spring.opens @ state[n:]
        return np.asarray(np.minimum(d, d + 1.5 * damper * rate))

    solver = cvode(rates, engaged, [0, 0], False, 1e-9, np.repeat([1e-15, 1e-10], n))
    solution = solver.solve(times, np.concatenate([start, none]))
    assert solution.success, solution.message
    rows = [contacts(state[:n], state[n:]) for state in solution.y[np.searchsorted(solution.t, times)]]
    return np.asarray(np.transpose(rows))


@pytest.mark.parametrize(("amplitude", "offset"), [(150.0, 0.0), (150.0, 2e-5), (700.0, 4e-5)])
def test_trunk_and_tongues_of_finite_elements_give_the_same_forces(
    amplitude: float, offset: float, tmp_path: Path
) -> None:
    """Both closed, and opening one after the other."""
    length, width, thickness = (STARTS[f"beam.{name}"] for name in ("length", "width", "thickness"))
    text = f"fork_position = {FORK}\n[[segment]]\nlength = {length}\nwidth = {width}\nthickness = {thickness}\n"
    (tmp_path / "forked.toml").write_text(text, encoding="utf-8")
    values: Values = {
        "effects.excitation": "Sine", "excitation.frequency": 800.0, "excitation.amplitude": amplitude,
        "effects.axialForce": "None", "solver.tolerance": 1e-8, "effects.parallelContact": True,
        "parallel.offset": offset, "parallel.curvatureRadius": 5e-3, "parallel.damping": 4e-5,
    }  # fmt: skip
    found = run({**values, "beam.file": str(tmp_path / "forked.toml")}, 0.003, 1e-5, list(NAMES))
    expected = forces(values, found["time"])
    largest = expected.max()
    for name, force in zip(NAMES, expected, strict=True):
        assert np.abs(found[name] - force).max() < ALLOWED * largest, name
        assert (force.min() == 0.0) == (amplitude > 500), name
    assert (np.abs(expected[0] - expected[1]).max() > 0.02 * largest) == (offset > 0)
