"""The fit to the published numbers: its tables, its scene, and that it is a minimum."""

import csv
from pathlib import Path

import numpy as np
import pytest

import published_contact as fit
from conftest import FMU, Run, is_picture, table
from relay_contact import Array, Component, Scene, Values

DOCS = Path(fit.__file__).resolve().parents[2] / "docs"
FITTED = np.array([number.fitted for number in fit.published()])
KNOWN = np.array([number.published for number in fit.published()])
ROUGH = fit.LAWS[1]


@pytest.fixture(scope="module")
def bench() -> fit.Bench:
    return fit.Bench(Component(FMU))


def parameters(path: Path) -> dict[str, float]:
    """Return the parameters of the rough contact, and its residual (%)."""
    return {row["parameter"]: float(row["value"]) for row in table(path) if row["contact"] == "Rough"}


def residual(bench: fit.Bench, values: Values) -> float:
    """Return the rms of the numbers that were fitted, %."""
    asked = [number for number in fit.published() if number.fitted]
    left = np.log(bench.numbers(values, asked) / KNOWN[FITTED])
    return float(100 * np.sqrt(np.mean(left**2)))


def test_the_scene_has_the_numbers_of_the_table(bench: fit.Bench) -> None:
    values = Scene.read("paper-rough").values
    found: Array = bench.numbers(values, fit.published())
    written = np.array([float(row["Rough"]) for row in table(DOCS / "published-contact.csv")])
    # Its parameters have four digits, of which every number takes on a few times the rounding.
    assert np.allclose(found, written, rtol=1e-3)
    assert residual(bench, values) < 6.0
    # Each is within what the page says of it.
    assert np.abs(found / KNOWN - 1)[FITTED].max() < 0.13
    short = [abs(value / known - 1) for value, known in zip(found[:4], KNOWN[:4], strict=True)]
    assert max(short) < 0.1


def test_it_is_a_minimum(bench: fit.Bench) -> None:
    free = np.array([parameters(DOCS / "published-contact-parameters.csv")[name] for name, _, _ in ROUGH.parameters])
    least = residual(bench, ROUGH.values(bench.component, free))
    for place in range(len(free)):
        for factor in (0.97, 1.03):
            moved = free.copy()
            moved[place] *= factor
            assert residual(bench, ROUGH.values(bench.component, moved)) > least, (place, factor)


def test_the_program_finds_what_is_written(run: Run, tmp_path: Path) -> None:
    run("published_contact")
    for name in ("frequency", "amplitude", "stiffness"):
        assert is_picture(tmp_path / f"published-contact-{name}.png")
    now, then = (parameters(folder / "published-contact-parameters.csv") for folder in (tmp_path, DOCS))
    # A sum of squares to 1e-9 has parameters to the root of that, 3e-5, of their uncertainty; four digits are written.
    assert list(now) == list(then)
    assert np.allclose(list(now.values()), list(then.values()), rtol=1e-3)
    with (tmp_path / "published-contact.csv").open(encoding="utf-8") as file:
        assert [row["quantity"] for row in csv.DictReader(file)] == [number.quantity for number in fit.published()]
