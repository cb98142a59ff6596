"""Every scene from its parameter set under FMPy: the set follows the schema of SSP, the force is that of our own run.

`cargo xtask test` writes the sets and the runs before this test.
"""

import shutil
from dataclasses import replace
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy.ssp.ssd import read_ssv

from component import COMPONENT, PLAIN, ROOT
from relay_contact import Component, Scene, Value, read_table, run, scenes
from results import FOLDER, record

SETS = ROOT / "out" / "ssv"
SCENES = {name: Scene.read(path) for name, path in scenes().items()}


# Where a parameter set has its spring files.
shutil.copytree(ROOT / "scenes" / "springs", Path(COMPONENT.folder) / "resources", dirs_exist_ok=True)


def parameter_set(name: str, component: Component = COMPONENT) -> dict[str, Value]:
    """Read a parameter set, checked against the schema first."""
    values: dict[str, Value] = {}
    for parameter in read_ssv(str(SETS / f"{name}.ssv"), validate=True).parameters:
        assert parameter.type == component.variables[parameter.name].type
        match parameter.type:
            case "Boolean":
                values[parameter.name] = parameter.value == "true"
            case "Enumeration" | "String":
                values[parameter.name] = parameter.value
            case _:
                values[parameter.name] = float(parameter.value)
    return values


def difference(name: str) -> float:
    """Give the largest difference in the contact force between a run and our own, N."""
    expected = read_table(FOLDER / "scenes" / f"{name}.csv")["contact.force"]
    scene = replace(SCENES[name], values=parameter_set(name), outputs=["contact.force"])
    return float(np.max(np.abs(run(scene, component=COMPONENT)["contact.force"] - expected)))


DIFFERENCES: dict[str, float] = {}


@pytest.mark.parametrize("name", sorted(SCENES))
def test_a_scene_from_its_parameter_set_gives_our_own_force(name: str) -> None:
    DIFFERENCES[name] = difference(name)
    # The same numbers in the same order.
    assert DIFFERENCES[name] == 0.0


@pytest.mark.parametrize("name", sorted(SCENES))
def test_a_parameter_set_says_what_the_scene_file_changes(name: str) -> None:
    values, scene = parameter_set(name), SCENES[name]
    wanted = scene.values | {each: course[0] for each, course in scene.inputs([0.0]).items()}
    if "beam.file" in wanted:
        wanted["beam.file"] = Path(str(wanted["beam.file"])).name
    assert values == {each: value for each, value in wanted.items() if value != COMPONENT.start(each)}


@pytest.mark.parametrize("name", sorted(SCENES))
def test_a_plain_parameter_set_says_the_same_in_numbers(name: str) -> None:
    texts = {each for each, variable in COMPONENT.variables.items() if variable.type == "String"}
    numbers = {
        each: value if each in texts else COMPONENT.number(each, value) for each, value in parameter_set(name).items()
    }
    assert parameter_set(f"{name}-plain", Component(PLAIN)) == numbers


def test_all_scenes_ran() -> None:
    assert sorted(DIFFERENCES) == sorted(SCENES)
    assert {path.stem for path in SETS.glob("*.ssv")} == {f"{name}{end}" for name in SCENES for end in ("", "-plain")}
    record("FMPy", fmpy.__version__, "scenes", max(DIFFERENCES.values()))
