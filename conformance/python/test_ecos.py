"""The component in Ecos, which adds up its steps, knows no enumerations and does not look at what the calls return."""

import ctypes
import itertools
from importlib.metadata import PackageNotFoundError, files, version
from pathlib import Path

import pytest

from component import FMU, PLAIN
from results import JUMP, PUBLISHED, STEP, SYSTEM, TOLERANCE, column, compare, missing, published

try:
    # Ecos needs this library of the package tbb, and finds it where it is loaded already.
    for file in files("tbb") or []:
        if file.name == "libtbb.so.12":
            ctypes.CDLL(str(file.locate()), mode=ctypes.RTLD_GLOBAL)
    from ecospy import EcosSimulation, EcosSimulationStructure

    VERSION = version("ecospy")
except (ImportError, OSError, PackageNotFoundError) as error:
    missing("Ecos", ["run", "published run", "two coupled", "SSP"], error)


def forces(simulation: EcosSimulation, name: str, steps: int) -> list[float]:
    """Step; give the contact force of an instance at every communication point from the present one on."""
    result = [simulation.get_real(f"{name}::contact.force")]
    for _ in range(steps):
        simulation.step()
        result.append(simulation.get_real(f"{name}::contact.force"))
    return result


def coupled(simulation: EcosSimulation, parameters: str, task: str) -> None:
    """Step two contacts that are wired together and compare the second."""
    assert simulation.init(parameter_set=parameters)
    steps = len(column("coupled")) - 1
    compare("Ecos", VERSION, task, forces(simulation, "second", steps))
    simulation.terminate()


def test_a_sine_given_at_the_communication_points() -> None:
    with EcosSimulationStructure() as structure:
        structure.add_model("contact", str(FMU))
        structure.add_parameter_set("run", {"contact::solver.tolerance": TOLERANCE})
        with EcosSimulation(structure=structure, step_size=STEP) as simulation:
            assert simulation.init(parameter_set="run")
            result = forces(simulation, "contact", 0)
            for acceleration in column("base.acceleration")[:-1]:
                simulation.set_real("contact::base.acceleration", acceleration)
                result += forces(simulation, "contact", 1)[1:]
            compare("Ecos", VERSION, "run", result)
            simulation.terminate()


def test_the_published_run_by_a_choice_that_is_a_number() -> None:
    with EcosSimulationStructure() as structure:
        structure.add_model("contact", str(PLAIN))
        structure.add_parameter_set("sine", {f"contact::{name}": float(number) for name, number in PUBLISHED.items()})
        with EcosSimulation(structure=structure, step_size=STEP) as simulation:
            assert simulation.init(parameter_set="sine")
            times = list(itertools.accumulate(itertools.repeat(STEP, 2000), initial=0.0))
            compare("Ecos", VERSION, "published run", forces(simulation, "contact", 2000), expected=published(times))
            simulation.terminate()


def test_two_instances_wired_together() -> None:
    with EcosSimulationStructure() as structure:
        parameters: dict[str, float] = {}
        for name in ["first", "second"]:
            structure.add_model(name, str(FMU))
            parameters |= {f"{name}::solver.tolerance": TOLERANCE, f"{name}::base.acceleration": JUMP}
        structure.add_parameter_set("jump", parameters)
        structure.make_real_connection("first::tip.displacement", "second::support.displacement")
        with EcosSimulation(structure=structure, step_size=STEP) as simulation:
            coupled(simulation, "jump", "two coupled")


def test_a_system_of_two_instances(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # Ecos leaves what it unpacks from a system.
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    with EcosSimulation(ssp_path=str(SYSTEM), step_size=STEP) as simulation:
        coupled(simulation, "jump", "SSP")
