"""The component inside an FMU container of FMU Manipulation Toolbox, alone and two of them connected."""

import json
import shutil
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import pytest
from fmpy import read_model_description, simulate_fmu
from fmpy.validation import validate_fmu

from component import FMU
from results import JUMP, STEP, TOLERANCE, compare, staircase


def simulate(folder: Path, instances: list[str], fmi: str = "2", **description: list[list[object]]) -> list[float]:
    """Pack instances of the component as a container, with links, start values, inputs and outputs; give its force.

    The container is one of this version of FMI.
    """
    for name in instances:
        shutil.copy(FMU, folder / f"{name}.fmu")
    content = {"name": "container.fmu", "fmu": [f"{name}.fmu" for name in instances], "step_size": STEP, **description}
    automatic = {f"auto_{kind}": False for kind in ("input", "output", "link")}
    (folder / "container.json").write_text(json.dumps(content | automatic))
    program = [sys.executable, "-m", "fmu_manipulation_toolbox.cli.fmucontainer"]
    arguments = ["-fmu-directory", str(folder), "-container", "container.json", "-fmi", fmi]
    subprocess.run([*program, *arguments], check=True)
    container = str(folder / "container.fmu")
    assert read_model_description(container).fmiVersion.startswith(fmi)
    assert validate_fmu(container) == []
    signals = staircase(["acceleration"])
    stop = float(signals["time"][-1])
    result = simulate_fmu(container, stop_time=stop, output_interval=STEP, input=signals, output=["force"])
    forces: list[float] = result["force"].tolist()
    return forces


@pytest.mark.parametrize(("fmi", "task"), [("2", "run"), ("3", "run as FMI 3")])
def test_a_sine_given_at_the_communication_points(tmp_path: Path, fmi: str, task: str) -> None:
    fmu = "contact.fmu"
    forces = simulate(
        tmp_path,
        ["contact"],
        fmi,
        start=[[fmu, "solver.tolerance", TOLERANCE]],
        input=[["acceleration", fmu, "base.acceleration"]],
        output=[[fmu, "contact.force", "force"]],
    )
    compare("FMU container", version("fmu_manipulation_toolbox"), task, forces)


def test_two_instances_wired_together(tmp_path: Path) -> None:
    first, second = "first.fmu", "second.fmu"
    starts = {"solver.tolerance": TOLERANCE, "base.acceleration": JUMP}
    forces = simulate(
        tmp_path,
        ["first", "second"],
        start=[[fmu, name, value] for fmu in (first, second) for name, value in starts.items()],
        link=[[first, "tip.displacement", second, "support.displacement"]],
        output=[[second, "contact.force", "force"]],
    )
    compare("FMU container", version("fmu_manipulation_toolbox"), "two coupled", forces)
