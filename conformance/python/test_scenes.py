"""Every scene from its parameter set under FMPy: the set follows SSP's schema, the force is that of the Rust library.

`cargo xtask importers` writes the runs of the library before this test.
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
from relay_contact.ssp import parameter_set
from results import FOLDER, record

SCENES = {name: Scene.read(path) for name, path in scenes().items()}


# Where a parameter set has its spring files.
shutil.copytree(ROOT / "scenes" / "springs", COMPONENT.folder / "resources", dirs_exist_ok=True)


def read_set(folder: Path, name: str, plain: bool = False) -> dict[str, Value]:
    """Write a parameter set and read it, checked against the schema first."""
    path = folder / "set.ssv"
    path.write_bytes(parameter_set(name, SCENES[name], COMPONENT, plain))
    component = Component(PLAIN) if plain else COMPONENT
    values: dict[str, Value] = {}
    for parameter in read_ssv(str(path), validate=True).parameters:
        assert parameter.type == component.variables[parameter.name].type
        match parameter.type:
            case "Boolean":
                values[parameter.name] = parameter.value == "true"
            case "Enumeration" | "String":
                values[parameter.name] = parameter.value
            case _:
                values[parameter.name] = float(parameter.value)
    return values


DIFFERENCES: dict[str, float] = {}


@pytest.mark.parametrize("name", sorted(SCENES))
def test_a_scene_from_its_parameter_set_has_the_force_of_the_library(tmp_path: Path, name: str) -> None:
    expected = read_table(FOLDER / "scenes" / f"{name}.csv")["contact.force"]
    scene = replace(SCENES[name], values=read_set(tmp_path, name), outputs=["contact.force"])
    found = run(scene, component=COMPONENT)["contact.force"]
    DIFFERENCES[name] = float(np.max(np.abs(found - expected)))
    # The same numbers in the same order.
    assert DIFFERENCES[name] == 0.0


@pytest.mark.parametrize("name", sorted(SCENES))
def test_a_parameter_set_says_what_the_scene_file_changes(tmp_path: Path, name: str) -> None:
    values, scene = read_set(tmp_path, name), SCENES[name]
    wanted = scene.values | {each: course[0] for each, course in scene.inputs(np.zeros(1)).items()}
    for file in {"beam.file", "fixed.file"} & wanted.keys():
        wanted[file] = Path(str(wanted[file])).name
    assert values == {each: value for each, value in wanted.items() if value != COMPONENT.start(each)}
    # For the plain component it says the same in numbers.
    texts = {each for each, variable in COMPONENT.variables.items() if variable.type == "String"}
    numbers = {each: value if each in texts else COMPONENT.number(each, value) for each, value in values.items()}
    assert read_set(tmp_path, name, plain=True) == numbers


def test_every_scene_was_compared() -> None:
    assert sorted(DIFFERENCES) == sorted(SCENES)
    record("FMPy", fmpy.__version__, "scenes", max(DIFFERENCES.values()))
