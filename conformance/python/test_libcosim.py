"""The component in libcosim, which reckons time in whole nanoseconds and knows no enumerations."""

import re
import zipfile
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from component import FMU, PLAIN, SPRUNG
from relay_contact import Component
from results import JUMP, PUBLISHED, STEP, SYSTEM, TOLERANCE, column, compare, missing, published

try:
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimManipulator import CosimManipulator
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    VERSION = version("libcosimpy")
except (ImportError, OSError, PackageNotFoundError) as error:
    missing("libcosim", ["run", "published run", "two coupled", "SSP"], error)

NANOSECONDS = round(1e9 * STEP)
# It warns of every variable that is an enumeration.
log_output_level(CosimLogLevel.ERROR)


class Execution:
    """An execution, its instances known by name."""

    def __init__(self, execution: CosimExecution) -> None:
        """Take over an execution."""
        self.execution = execution
        self.observer = CosimObserver.create_last_value()
        assert execution.add_observer(self.observer)

    def add(self, name: str, fmu: Path, start: dict[str, float]) -> None:
        """Add an instance of the component with the start values of real variables."""
        assert self.execution.add_local_slave(CosimLocalSlave(str(fmu), name)) >= 0
        for variable, value in start.items():
            assert self.execution.real_initial_value(*self.find(name, variable), value)

    def find(self, name: str, variable: str) -> tuple[int, int]:
        """Give the index of an instance and the value reference of its variable."""
        index = self.execution.slave_index_from_instance_name(name)
        variables = self.execution.slave_variables(index)
        return index, next(each.reference for each in variables if each.name == variable.encode())

    def value(self, name: str, variable: str) -> float:
        """Give a real variable of an instance."""
        index, reference = self.find(name, variable)
        return float(self.observer.last_real_values(index, [reference])[0])

    def forces(self, name: str, steps: int) -> list[float]:
        """Step; give the contact force of an instance after each step, before which it cannot be read."""
        result = []
        for _ in range(steps):
            assert self.execution.step()
            result.append(self.value(name, "contact.force"))
        return result


def test_a_sine_given_at_the_communication_points() -> None:
    run = Execution(CosimExecution.from_step_size(NANOSECONDS))
    run.add("contact", FMU, {"solver.tolerance": TOLERANCE})
    sine = CosimManipulator.create_override()
    assert run.execution.add_manipulator(sine)
    index, reference = run.find("contact", "base.acceleration")
    forces = []
    for acceleration in column("base.acceleration")[:-1]:
        assert sine.slave_real_values(index, [reference], [acceleration])
        forces += run.forces("contact", 1)
    compare("libcosim", VERSION, "run", forces, start=1)


def test_the_published_run_by_a_choice_that_is_a_number() -> None:
    run = Execution(CosimExecution.from_step_size(NANOSECONDS))
    run.add("contact", PLAIN, PUBLISHED)
    times = [n * NANOSECONDS / 1e9 for n in range(2001)]
    compare("libcosim", VERSION, "published run", run.forces("contact", 2000), start=1, expected=published(times))


def coupled(run: Execution, task: str) -> None:
    """Step two contacts that are wired together and compare the second."""
    steps = len(column("coupled")) - 1
    compare("libcosim", VERSION, task, run.forces("second", steps), start=1)


def test_two_instances_wired_together() -> None:
    run = Execution(CosimExecution.from_step_size(NANOSECONDS))
    for name in ["first", "second"]:
        run.add(name, FMU, {"solver.tolerance": TOLERANCE, "base.acceleration": JUMP})
    carried = *run.find("first", "tip.displacement"), *run.find("second", "support.displacement")
    assert run.execution.connect_real_variables(*carried) == 0
    coupled(run, "two coupled")


def test_a_system_of_two_instances() -> None:
    coupled(Execution(CosimExecution.from_ssp_file(str(SYSTEM), NANOSECONDS)), "SSP")


def test_two_springs_in_one_system_are_not_taken_for_each_other(tmp_path: Path) -> None:
    """Libcosim takes two components of the same GUID for one."""
    system = tmp_path / "springs.ssp"
    with zipfile.ZipFile(SYSTEM) as given, zipfile.ZipFile(system, "w") as changed:
        text = given.read("SystemStructure.ssd").decode()
        second = r'(name="second".*?)RelayContact'
        text = re.sub("<ssd:Connections>.*</ssd:Connections>", "", text, flags=re.DOTALL)
        text = re.sub(second, r"\1RelayContact-tapered-cube", text, count=1, flags=re.DOTALL)
        changed.writestr("SystemStructure.ssd", text)
        for fmu in [FMU, SPRUNG]:
            changed.write(fmu, f"resources/{fmu.name}")
    run = Execution(CosimExecution.from_ssp_file(str(system), NANOSECONDS))
    assert run.execution.step()
    found = [run.value(name, "preload.frequency") for name in ("first", "second")]
    with Component(FMU).started() as uniform, Component(SPRUNG).started() as tapered:
        expected = [each.get("preload.frequency") for each in (uniform, tapered)]
    assert found == expected
    assert abs(found[0] - found[1]) > 100.0
