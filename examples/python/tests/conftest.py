"""Runs an example as its user does."""

import csv
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import expm

from relay_contact import Array, fmu_path

FOLDER = Path(__file__).resolve().parents[1]
FMU = fmu_path()

Run = Callable[..., str]
"""Runs an example by its name with arguments; gives what it printed."""


def run_example(folder: Path, name: str, *arguments: str) -> str:
    """Run an example in its short form, its files in a folder; give what it printed, fail where it fails."""
    quick = [] if name == "paper_1khz" else ["--quick"]
    command = [sys.executable, str(FOLDER / f"{name}.py"), *quick, "--fmu", str(FMU), "--out", str(folder)]
    result = subprocess.run([*command, *arguments], capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


@pytest.fixture
def run(tmp_path: Path) -> Run:
    """Run examples with their files in the test's folder."""
    return partial(run_example, tmp_path)


def table(path: Path) -> list[dict[str, str]]:
    """Read a table with a head."""
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def run_inside(code: str, name: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run an example in its short form within code that calls it by `run()`."""
    path = (FOLDER / f"{name}.py").as_posix()
    arguments = (path, "--quick", "--fmu", str(FMU), *arguments)
    start = f"""import runpy, sys
def run():
    sys.argv = {list(arguments)!r}
    sys.path.insert(0, {FOLDER.as_posix()!r})
    runpy.run_path({path!r}, run_name="__main__")
"""
    return subprocess.run([sys.executable, "-c", start + code], capture_output=True, text=True, check=False)


# The circuit of the examples once more: V, Ohm, H, Ohm, F.
SOURCE, LOAD, COIL, QUENCH, CAPACITOR = 6.0, 60.0, 1e-3, 47.0, 220e-9


def contact_voltage(state: Array, conductance: float) -> float:
    """Give the voltage of the contact: Kirchhoff's law at its node."""
    return float((state[0] + state[1] / QUENCH) / (conductance + 1 / QUENCH))


def advanced(state: Array, conductance: float, length: float) -> Array:
    """Step the circuit by SciPy's matrix exponential, the source as a third state."""
    drop = 1 / (conductance + 1 / QUENCH)
    matrix = np.zeros((3, 3))
    matrix[0] = [-(LOAD + drop) / COIL, -drop / QUENCH / COIL, SOURCE / COIL]
    matrix[1] = [(1 - conductance * drop) / CAPACITOR, -conductance * drop / QUENCH / CAPACITOR, 0]
    after: Array = (expm(matrix * length) @ np.append(state, 1.0))[:2]
    return after


def is_picture(path: Path) -> bool:
    """Tell whether a file is a PNG that holds something."""
    return path.read_bytes().startswith(b"\x89PNG") and path.stat().st_size > 10_000
