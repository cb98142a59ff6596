"""The wheel, installed into an environment that knows nothing of this project, and used there.

`cargo xtask test` has built it with `cargo xtask wheel`, beside the component; otherwise it is built here.
"""

import ast
import csv
import os
import subprocess
import sys
import sysconfig
import tomllib
import venv
from pathlib import Path

import pytest

from component import FMU, ROOT

SCRIPTS = "Scripts" if os.name == "nt" else "bin"
USE = """
import numpy, relay_contact
assert set(relay_contact.scenes()) >= {"paper-1khz", "sweep"}
result = relay_contact.run("closing-bounce", stop=1e-3, outputs=["contact.force"])
assert {"paper", "cube-changeover", "finite-elements"} <= set(relay_contact.relays())
assert "MIL-PRF-28776" in relay_contact.standards()
assert result.units["contact.force"] == "N" and result["contact.force"].max() > 0
print(relay_contact.fmu_path())
"""


def run(*command: str | Path, folder: Path = ROOT) -> str:
    """Run a program without the project's folders in its path; give what it printed."""
    clean = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "RELAY_CONTACT_FMU")}
    hatch = {"RELAY_CONTACT_FMU": str(FMU)} if "hatchling" in command else {}
    done = subprocess.run(command, cwd=folder, env=clean | hatch, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Install the wheel into a new environment; give the folder of its programs.

    The packages that it needs are those of the environment of the tests: pip checks that they suffice, and downloads
    nothing. The path to this project in that environment is not followed, as it is not a site folder of the new one.
    """
    folder = tmp_path_factory.mktemp("wheel")
    if "RELAY_CONTACT_FMU" in os.environ:
        built = list(FMU.parent.glob("relay_contact-*.whl"))
    else:
        run(sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", folder)
        built = list(folder.glob("*.whl"))
    wheel = max(built, key=lambda path: path.stat().st_mtime)
    venv.create(folder / "environment", with_pip=False)
    programs = folder / "environment" / SCRIPTS
    python = programs / Path(sys.executable).name
    site = Path(run(python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))").strip())
    others = [path for path in sys.path if path.endswith("site-packages")] or [sysconfig.get_path("purelib")]
    (site / "others.pth").write_text("\n".join(others))
    run(sys.executable, "-m", "pip", "--python", python, "install", "--quiet", "--no-index", wheel)
    return programs


def test_the_package_is_used_from_its_own_folder(installed: Path, tmp_path: Path) -> None:
    python = next(installed.glob("python*"))
    used = Path(run(python, "-c", USE, folder=tmp_path).strip())
    assert used.is_relative_to(installed.parent)
    assert used.read_bytes() == FMU.read_bytes()


def test_the_command_lists_and_runs_scenes(installed: Path, tmp_path: Path) -> None:
    command = next(installed.glob("relay-contact*"))
    assert "paper-1khz" in run(command, "list", folder=tmp_path)
    printed = run(command, "run", "paper-1khz", "--stop", "0.002", "--set", "excitation.frequency=500", folder=tmp_path)
    table = tmp_path / "paper-1khz,excitation.frequency=500.csv"
    assert str(table.name) in printed
    with table.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 201
    assert list(rows[0]) == ["time", "contact.force", "contact.resistance"]
    assert table.with_suffix(".png").read_bytes().startswith(b"\x89PNG")


def test_the_command_tests_a_relay_with_a_spring_of_its_own(installed: Path, tmp_path: Path) -> None:
    command = next(installed.glob("relay-contact*"))
    asked = ("finite-elements", "--standard", "MIL-STD-202", "--test", "213 C", "--out", "verdicts")
    # By both models, and so together.
    assert run(command, "qualify", *asked, folder=tmp_path).count(" pass ") == 3
    assert (tmp_path / "verdicts/qualification.html").is_file()


def test_the_command_identifies(installed: Path, tmp_path: Path) -> None:
    """The stiffness by a straight line: the force is in proportion to it."""
    command = next(installed.glob("relay-contact*"))
    rows = [f"{travel},{0.1672 * (0.2 + travel) / 0.22}" for travel in (-0.1, -0.05, 0.0, 0.02, 0.05, 0.1)]
    (tmp_path / "force.csv").write_text("\n".join(["travel [mm],force [N]", *rows]) + "\n")
    asked = ("paper", "--data", "force.csv", "--parameter", "beam.youngsModulus", "--out", "found")
    assert "beam.youngsModulus" in run(command, "identify", *asked, folder=tmp_path)
    assert (tmp_path / "found/identification.html").is_file()
    with (tmp_path / "found/identification.csv").open(encoding="utf-8") as file:
        (row,) = csv.DictReader(file)
    # Without axial force, 0.1520261 N at 0.2 mm are those of 124 GPa; it takes 3e-4 of them.
    assert float(row["identified (SI)"]) == pytest.approx(124e9 * 0.152 / 0.1520261, rel=1e-3)


def test_every_package_that_is_imported_is_declared() -> None:
    imported = set()
    for path in (ROOT / "python/relay_contact").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                imported |= {alias.name.split(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom):
                imported.add(str(node.module).split(".")[0])
    foreign = imported - sys.stdlib_module_names - {"relay_contact"}
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    asked = project["dependencies"] + project["optional-dependencies"]["cluster"]
    declared = {text.split(">")[0] for text in asked}
    assert foreign == declared
