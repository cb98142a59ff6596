"""The wheel, installed into an environment that knows nothing of this project, and used there.

`cargo xtask test` has built it with `cargo xtask wheel`, beside the component; otherwise it is built here.
"""

import ast
import csv
import json
import os
import subprocess
import sys
import sysconfig
import tarfile
import tomllib
import venv
import zipfile
from email.parser import Parser
from pathlib import Path
from urllib.parse import urlsplit
from urllib.request import url2pathname

import pytest
from packaging.tags import sys_tags

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


def started(*command: str | Path, folder: Path = ROOT, **further: str) -> subprocess.CompletedProcess[str]:
    """Run a program without the project's folders in its path."""
    clean = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "RELAY_CONTACT_FMU")}
    hatch = {"RELAY_CONTACT_FMU": str(FMU)} if "hatchling" in command else {}
    environment = clean | hatch | further
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)


def run(*command: str | Path, folder: Path = ROOT) -> str:
    """Run a program as `started` does; return what it printed."""
    done = started(*command, folder=folder)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the wheel, built unless `cargo xtask test` has."""
    folder = tmp_path_factory.mktemp("built")
    if "RELAY_CONTACT_FMU" in os.environ:
        built = list(FMU.parent.glob("relay_contact-*.whl"))
    else:
        run(sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", folder)
        built = list(folder.glob("*.whl"))
    return max(built, key=lambda path: path.stat().st_mtime)


@pytest.fixture(scope="module")
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Install the wheel into a new environment; give the folder of its programs.

    The packages that it needs are those of the environment of the tests: pip checks that they suffice, and downloads
    nothing. The path to this project in that environment is not followed, as it is not a site folder of the new one.
    """
    folder = tmp_path_factory.mktemp("wheel")
    venv.create(folder / "environment", with_pip=False)
    programs = folder / "environment" / SCRIPTS
    python = programs / Path(sys.executable).name
    site = Path(run(python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))").strip())
    others = [path for path in sys.path if path.endswith("site-packages")] or [sysconfig.get_path("purelib")]
    (site / "others.pth").write_text("\n".join(others))
    run(sys.executable, "-m", "pip", "--python", python, "install", "--quiet", "--no-index", wheel)
    return programs


def test_the_wheel_is_for_this_platform_alone(wheel: Path, tmp_path: Path) -> None:
    name, version, python, abi, platform = wheel.stem.split("-")
    assert (python, abi) == ("py3", "none")
    assert platform in {tag.platform for tag in sys_tags()} - {"any"}
    with zipfile.ZipFile(wheel) as archive:
        about = archive.read(f"{name}-{version}.dist-info/WHEEL").decode()
    assert "Root-Is-Purelib: false" in about
    assert f"Tag: py3-none-{platform}\n" in about
    foreign = tmp_path / wheel.name.replace(platform, "win_amd64" if os.name != "nt" else "manylinux_2_17_x86_64")
    foreign.write_bytes(wheel.read_bytes())
    refused = started(sys.executable, "-m", "pip", "install", "--no-index", "--target", tmp_path / "site", foreign)
    assert refused.returncode != 0
    assert f"{foreign.name} is not a supported wheel on this platform" in refused.stderr


def test_a_component_for_another_platform_is_not_packed(tmp_path: Path) -> None:
    platform = "win_amd64" if os.name != "nt" else "manylinux_2_17_x86_64"
    build = (sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", tmp_path)
    refused = started(*build, RELAY_CONTACT_PLATFORM=platform)
    assert refused.returncode != 0
    assert f"no library for {platform}" in refused.stderr


def test_the_wheel_tells_what_it_is_made_of(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        (bill,) = [name for name in archive.namelist() if ".dist-info/sboms/" in name]
        (about,) = [name for name in archive.namelist() if name.endswith(".dist-info/METADATA")]
        metadata = Parser().parsestr(archive.read(about).decode())
        parts = json.loads(archive.read(bill))["components"]
    with zipfile.ZipFile(FMU) as component, zipfile.ZipFile(wheel) as archive:
        assert component.read("documentation/sbom.cdx.json") == archive.read(bill)
    assert {"nalgebra", "rust-standard-library"} <= {part["name"] for part in parts}
    assert metadata["License-Expression"] == "MIT OR Apache-2.0"
    for field in ("Summary", "Author", "Project-URL", "Classifier", "Keywords", "Requires-Python", "Provides-Extra"):
        assert metadata[field], field
    assert "# relay-contact" in str(metadata.get_payload())


def test_the_source_distribution_has_what_cargo_needs(tmp_path: Path) -> None:
    run(sys.executable, "-m", "hatchling", "build", "-t", "sdist", "-d", tmp_path)
    with tarfile.open(next(tmp_path.glob("*.tar.gz"))) as archive:
        files = {name.partition("/")[2] for name in archive.getnames()}
    workspace = tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))["workspace"]
    manifests = {f"{member}/Cargo.toml" for member in workspace["members"]}
    read = {"Cargo.toml", "Cargo.lock", "build.rs", "modelDescription.xml", "src/lib.rs", "docs/model.png", "README.md"}
    assert manifests | read | {"python/component_hook.py", ".cargo/config.toml"} <= files
    assert not [name for name in files if name.startswith(("target/", "dist/", "out/", ".venv/"))]


def test_the_command_opens_the_page(installed: Path, tmp_path: Path) -> None:
    command = next(installed.glob("relay-contact*"))
    done = started(command, "explore", "--print", folder=tmp_path)
    if (ROOT / "dist/explore.html").is_file():
        path = Path(url2pathname(urlsplit(done.stdout.strip()).path))
        assert path.is_relative_to(installed.parent)
        assert path.read_bytes() == (ROOT / "dist/explore.html").read_bytes()
    else:
        assert "`cargo xtask explore` builds it" in done.stderr


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
    assert table.name in printed
    assert table.read_text(encoding="utf-8").startswith("time,contact.force,contact.resistance\n")
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
    extras = project["optional-dependencies"]
    asked = project["dependencies"] + extras["cluster"] + extras["pdf"]
    declared = {text.split(">")[0] for text in asked}
    assert foreign == declared
