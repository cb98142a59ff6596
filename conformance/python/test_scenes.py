"""Every scene from its parameter set under FMPy: the set follows the schema of SSP, the force is that of our own run.

`cargo xtask test` writes the sets and the runs before this test.
"""

from dataclasses import replace

import fmpy
import numpy as np
import pytest
from fmpy.ssp.ssd import read_ssv

from component import COMPONENT, ROOT
from relay_contact import Scene, Value, read_table, run, scenes
from results import FOLDER, record

SETS = ROOT / "out" / "ssv"
SCENES = {name: Scene.read(path) for name, path in scenes().items()}


def parameter_set(name: str) -> dict[str, Value]:
    """Read a parameter set, checked against the schema first."""
    values: dict[str, Value] = {}
    for parameter in read_ssv(str(SETS / f"{name}.ssv"), validate=True).parameters:
        assert parameter.type == COMPONENT.variables[parameter.name].type
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
def test_a_scene_file_says_what_its_parameter_set_says(name: str) -> None:
    values, scene = parameter_set(name), SCENES[name]
    assert values == values | scene.values | {each: course[0] for each, course in scene.inputs([0.0]).items()}


def test_all_scenes_ran() -> None:
    assert sorted(DIFFERENCES) == sorted(SCENES) == sorted(path.stem for path in SETS.glob("*.ssv"))
    record("FMPy", fmpy.__version__, "scenes", max(DIFFERENCES.values()))
