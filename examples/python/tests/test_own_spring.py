"""The spring in finite elements against beam theory, and the example that compares it with segments."""

import math
import tomllib
from pathlib import Path

import numpy as np
import pytest

from conftest import FMU, Run, is_picture, run_inside, table
from own_spring_elements import CUBE, Drawing, Elements, missing, segments
from relay_contact import Component, RelayContactError

LACKING = missing()
needs_programs = pytest.mark.skipif(bool(LACKING), reason=LACKING or "nothing")
# A narrow strip, 100 times as long as thick, without hole; its rivet is nearly nothing and at the very end.
STRIP = Drawing(
    length=20.2e-3, width=0.8e-3, taper_start=10e-3, end_width=0.8e-3, thickness=0.2e-3,
    hole=(5e-3, 0.0), rivet=(20e-3, 0.2e-3), head=1e-5, tail=1e-5, rivet_material=CUBE,
)  # fmt: skip
ROOTS = [1.8751041, 4.6940911, 7.8547574]  # of the cantilever's characteristic equation


@pytest.fixture(scope="module")
def strip(tmp_path_factory: pytest.TempPathFactory) -> Elements:
    """Give the strip in finite elements."""
    return Elements(STRIP, tmp_path_factory.mktemp("strip"), 0.4e-3)


def bending_stiffness() -> float:
    """Give that of the strip as a beam, N m2."""
    return STRIP.spring_material.youngs_modulus * STRIP.width * STRIP.thickness**3 / 12


# A plate bends less than a beam, by 1 - nu^2. The strip is one near its clamp alone, over less than half of its width.
PLATE = CUBE.poissons_ratio**2
CLAMP = STRIP.width / 2 / STRIP.length


@needs_programs
def test_a_strip_deflects_as_a_beam_does(strip: Elements) -> None:
    theory = STRIP.rivet[0] ** 3 / (3 * bending_stiffness())
    # Of the compliance, the clamp's vicinity makes three times its share of the length.
    # Shear makes 3 E / (kappa G) r^2 / l^2 of it, with the radius of gyration r.
    shear = 3 * 1.2 * 2.6 / 12 * (STRIP.thickness / STRIP.rivet[0]) ** 2
    assert 1 - 3 * PLATE * CLAMP * STRIP.length / STRIP.rivet[0] < strip.compliance / theory < 1 + shear


@needs_programs
def test_a_strip_vibrates_as_a_beam_does(strip: Elements) -> None:
    basis, whole = strip.basis(20), strip.frequencies(12)
    mass = CUBE.density * STRIP.width * STRIP.thickness
    for number, root in enumerate(ROOTS):
        theory = (root / STRIP.length) ** 2 / (2 * math.pi) * math.sqrt(bending_stiffness() / mass)
        found = float(whole[np.argmin(np.abs(whole - basis.frequencies[number]))])
        # Of the strain energy, the clamp's vicinity holds four times its share of the length, in every mode; half of
        # it in the frequency. Shear and rotary inertia (Timoshenko), and the rivet: the end moves twice the mean.
        above = 0.5 * PLATE / (1 - PLATE) * 4 * CLAMP
        below = (root * STRIP.thickness / STRIP.length) ** 2 * (1 + 1.2 * 2.6) / 24
        below += 2 * STRIP.rivet_load[0] / (mass * STRIP.length)
        assert -below < found / theory - 1 < above, (number, found / theory)
        # CalculiX seeks its eigenvalues to a tolerance of its own, which leaves some 1e-6.
        assert basis.frequencies[number] == pytest.approx(found, rel=1e-5)
    assert basis.compliance == pytest.approx(strip.compliance, rel=1e-5)
    held = np.sum((basis.contact / (2 * np.pi * basis.frequencies)) ** 2)
    assert held == pytest.approx(basis.compliance, rel=1e-6)


def test_segments_have_the_area_of_the_drawing(tmp_path: Path) -> None:
    drawing = Drawing(20e-3, 4e-3, 10e-3, 2.4e-3, 0.2e-3, (9.7e-3, 1.5e-3), (18e-3, 1.6e-3), 0.6e-3, 0.3e-3)
    path = tmp_path / "segments.toml"
    path.write_text(segments(drawing, "test"), encoding="utf-8")
    parts = tomllib.loads(path.read_text(encoding="utf-8"))["segment"]
    area = sum(part["length"] * (part["width_start"] + part["width_end"]) / 2 for part in parts)
    exact = 4e-3 * 10e-3 + 3.2e-3 * 10e-3 - math.pi * 1.5e-3**2 / 4
    assert area == pytest.approx(exact, rel=1e-8)
    assert sum(part["length"] for part in parts) == pytest.approx(20e-3, rel=1e-8)


@needs_programs
def test_modes_in_the_component_are_the_whole_mesh(run: Run, tmp_path: Path) -> None:
    printed = run("own_spring")
    assert "opening at resonance [g]" in printed
    assert is_picture(tmp_path / "own-spring.png")
    rows = {row["quantity"]: row for row in table(tmp_path / "own-spring.csv")}
    assert len(rows) == 8
    for name, row in rows.items():
        whole, modes, parts = (float(row[each]) for each in ("finite_elements", "modes", "segments"))
        # The same structure: what differs is the peak between the samples of a spectrum (5 Hz), the Hertz contact
        # instead of a linear one, and the frequencies at which the program prints its response.
        assert modes == pytest.approx(whole, rel=5e-3 if "opening" in name else 2e-4), name
        # A plate bends less by nu^2, 9 %; hole and rivet, half as much in frequency.
        assert parts == pytest.approx(whole, rel=0.05), name


def test_a_wrong_spring_file_is_refused_with_its_line(tmp_path: Path) -> None:
    path = tmp_path / "wrong.toml"
    path.write_text(segments(STRIP, "wrong").replace("thickness = 0.0002", "thickness = 0.02", 1), encoding="utf-8")
    with pytest.raises(RelayContactError, match=r"wrong.toml:\d+: segment 1: thickness = 0.02 m: not allowed"):
        Component(FMU).started({"beam.file": str(path)})


def test_missing_programs_are_named(tmp_path: Path) -> None:
    result = run_inside("import os\nos.environ['PATH'] = ''\nrun()", "own_spring", "--out", str(tmp_path))
    assert result.returncode == 1
    assert result.stderr.strip() == (
        "gmsh and ccx not found: apt-get install --no-install-recommends gmsh calculix-ccx"
    )
