"""Every scene from its parameter set under FMPy: the set follows the schema of SSP, the force is that of our own run.

`cargo xtask test` writes the sets and the runs before this test.
"""

import csv
import math
import tomllib
from itertools import pairwise
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest
from component import FMU, ROOT, Array, Instance
from fmpy import read_model_description
from fmpy.ssp.ssd import read_ssv
from results import FOLDER, record
from test_derivatives import set_derivative

SETS = ROOT / "out" / "ssv"
SCENES = {path.stem: tomllib.loads(path.read_text(encoding="utf-8")) for path in (ROOT / "scenes").glob("*.toml")}


def apply(instance: Instance, name: str) -> None:
    """Set every value of the parameter set, checked against the schema first."""
    variables = {variable.name: variable for variable in read_model_description(str(FMU)).modelVariables}
    for parameter in read_ssv(str(SETS / f"{name}.ssv"), validate=True).parameters:
        variable, value = variables[parameter.name], parameter.value
        assert parameter.type == variable.type
        reference = [variable.valueReference]
        match parameter.type:
            case "Real":
                instance.slave.setReal(reference, [float(value)])
            case "Boolean":
                instance.slave.setBoolean(reference, [value == "true"])
            case "Enumeration":
                items = {item.name: int(item.value) for item in variable.declaredType.items}
                instance.slave.setInteger(reference, [items[value]])
            case _:
                instance.slave.setInteger(reference, [int(value)])


def points(scene: dict[str, Any]) -> list[float]:
    """Give the communication points; the last is the stop."""
    step, stop = scene["communicationStep"], scene["stop"]
    return [min(n * step, stop) for n in range(math.ceil(stop / step - 1e-9) + 1)]


def courses(scene: dict[str, Any], time: list[float]) -> dict[str, Array]:
    """Give the inputs that the scene takes from a table, at the communication points."""
    file = scene.get("inputs", {}).get("file")
    if file is None:
        return {}
    with (ROOT / "scenes" / file).open() as table:
        rows = list(csv.DictReader(table))
    instants = [float(row["time"]) for row in rows]
    names = [name for name in rows[0] if name != "time"]
    return {name: np.interp(time, instants, [float(row[name]) for row in rows]) for name in names}


def difference(name: str, folder: Path) -> float:
    """Give the largest difference in the contact force between a run and our own, N."""
    scene = SCENES[name]
    with (FOLDER / "scenes" / f"{name}.csv").open() as table:
        expected = [float(row["contact.force"]) for row in csv.DictReader(table)]
    time = points(scene)
    inputs = courses(scene, time)
    with Instance(folder) as instance:
        apply(instance, name)
        instance.initialise()
        forces = [instance.get("contact.force")]
        for n, (start, end) in enumerate(pairwise(time)):
            for variable, values in inputs.items():
                instance.set(variable, values[n])
                set_derivative(instance, variable, (values[n + 1] - values[n]) / (end - start))
            instance.step(start, end - start)
            forces.append(instance.get("contact.force"))
    return max(abs(force - own) for force, own in zip(forces, expected, strict=True))


DIFFERENCES: dict[str, float] = {}


@pytest.mark.parametrize("name", sorted(SCENES))
def test_a_scene_from_its_parameter_set_gives_our_own_force(name: str, tmp_path: Path) -> None:
    DIFFERENCES[name] = difference(name, tmp_path)
    # The same numbers in the same order.
    assert DIFFERENCES[name] == 0.0


def test_all_scenes_ran() -> None:
    assert sorted(DIFFERENCES) == sorted(SCENES) == sorted(path.stem for path in SETS.glob("*.ssv"))
    record("FMPy", fmpy.__version__, "scenes", max(DIFFERENCES.values()))
