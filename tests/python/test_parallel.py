"""A spring that forks into two tongues, by finite elements that share no code with the component."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.linalg import eigh

from component import COMPONENT, STARTS, run
from elements import assembled
from one_sided import Law, System, shaking
from reference import hertz
from relay_contact import Values
from relay_contact import run as run_scene
from relay_contact.component import sine
from relay_contact.plot import open_times

ELEMENTS = 16
"""Of trunk and of each tongue."""
ALLOWED = 2e-4
"""Share of the largest force: the error of the elements. With 8, 16, 32 the differences are 1.2e-3, 7.7e-5, 2.8e-6."""
FORK = 8e-3
"""m from the clamp."""
NAMES = ("contact", "parallel")


def forked(values: Values) -> System:
    """Return trunk and two tongues of half its width, clamped at the start of the trunk, with both contacts."""
    known: dict[str, Any] = {**STARTS, **values}
    bending = known["beam.youngsModulus"] * known["beam.width"] * known["beam.thickness"] ** 3 / 12
    per_length = known["beam.density"] * known["beam.width"] * known["beam.thickness"]
    n = ELEMENTS
    trunk = [(k, k + 1, FORK / n, 1.0) for k in range(n)]
    tongue = (known["beam.length"] - FORK) / n
    first = [(n + k, n + k + 1, tongue, 0.5) for k in range(n)]
    other = [(n if k == 0 else 2 * n + k, 2 * n + k + 1, tongue, 0.5) for k in range(n)]
    parts = [(a, b, share * bending, share * per_length, h) for a, b, h, share in trunk + first + other]
    rigidity, mass = assembled(3 * n + 1, parts)
    tips = [2 * 2 * n, 2 * 3 * n]
    mass[tips, tips] += known["tip.mass"] / 2
    squares, shapes = eigh(rigidity[2:, 2:], mass[2:, 2:])
    reach = known["contact.overtravel"]
    laws = [
        Law(name, -shapes[tip - 2], hertz(known, name), known[f"{name}.damping"], 1.5, offset)
        for name, tip, offset in zip(NAMES, tips, (reach, reach - known["parallel.offset"]), strict=True)
    ]
    damping, load = known["beam.stiffnessDamping"] * squares, mass[2:, ::2].sum(axis=1) @ shapes
    return System(squares, damping, load, laws, *shaking(known))


@pytest.mark.parametrize(("amplitude", "offset"), [(150.0, 0.0), (150.0, 2e-5), (700.0, 4e-5)])
def test_trunk_and_tongues_of_finite_elements_give_the_same_forces(
    amplitude: float, offset: float, tmp_path: Path
) -> None:
    """Both closed, and opening one after the other."""
    length, width, thickness = (STARTS[f"beam.{name}"] for name in ("length", "width", "thickness"))
    text = f"fork_position = {FORK}\n[[segment]]\nlength = {length}\nwidth = {width}\nthickness = {thickness}\n"
    (tmp_path / "forked.toml").write_text(text, encoding="utf-8")
    values: Values = {
        **sine(800.0, amplitude), "effects.axialForce": "None", "solver.tolerance": 1e-8,
        "effects.parallelContact": True, "parallel.offset": offset, "parallel.curvatureRadius": 5e-3,
        "parallel.damping": 4e-5,
    }  # fmt: skip
    outputs = [f"{name}.force" for name in NAMES]
    found = run({**values, "beam.file": str(tmp_path / "forked.toml")}, 0.003, 1e-5, outputs)
    expected = forked(values).solve(found["time"]).forces
    largest = max(force.max() for force in expected.values())
    for name, force in expected.items():
        assert np.abs(found[f"{name}.force"] - force).max() < ALLOWED * largest, name
        assert (force.min() == 0.0) == (amplitude > 500), name
    assert (np.abs(expected["contact"] - expected["parallel"]).max() > 0.02 * largest) == (offset > 0)


def test_twin_contacts_are_open_in_a_figure_while_neither_is_closed() -> None:
    # Here the first stays back by a micrometre.
    result = run_scene("twin-contact", component=COMPONENT, parallel_offset=-1e-6)
    first, parallel = (result[f"{name}.force"] > 0 for name in NAMES)
    assert (parallel & ~first).any()
    assert not (first | parallel).all()
    shaded = open_times(result.columns)
    assert shaded is not None
    assert np.array_equal(shaded, ~(first | parallel))
    assert np.array_equal(shaded, result["contact.resistance"] > 1e6)
