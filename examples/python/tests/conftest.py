"""Runs an example as its user does."""

import csv
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from relay_contact import fmu_path

FOLDER = Path(__file__).resolve().parents[1]
FMU = fmu_path()

Run = Callable[..., str]
"""Runs an example by its name with arguments; gives what it printed."""


@pytest.fixture
def run(tmp_path: Path) -> Run:
    """Run an example in its short form, its files in the test's folder; fail where it fails."""

    def example(name: str, *arguments: str) -> str:
        quick = [] if name == "paper_1khz" else ["--quick"]
        command = [sys.executable, str(FOLDER / f"{name}.py"), *quick, "--fmu", str(FMU), "--out", str(tmp_path)]
        result = subprocess.run([*command, *arguments], capture_output=True, text=True, check=False)
        assert result.returncode == 0, result.stdout + result.stderr
        return result.stdout

    return example


def table(path: Path) -> list[dict[str, str]]:
    """Read a table with a head."""
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def is_picture(path: Path) -> bool:
    """Tell whether a file is a PNG that holds something."""
    return path.read_bytes().startswith(b"\x89PNG") and path.stat().st_size > 10_000
