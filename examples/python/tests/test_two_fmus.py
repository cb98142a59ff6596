"""The contact and its test bench: two ways of running them, the circuit, the coupling, and the system as a file."""

import json
import platform
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from fmpy.ssp.ssd import read_ssd
from fmpy.validation import validate_fmu
from numpy.typing import NDArray

from conftest import LOAD, SOURCE, Run, advanced, contact_voltage, is_picture, run_example
from relay_contact import Array, read_table

if platform.machine() not in ("x86_64", "AMD64") or sys.platform == "darwin":
    pytest.skip("PythonFMU has no binary for this machine", allow_module_level=True)

NANOSECONDS = 2000
"""Communication step of the short form."""

# Runs a system with what is in the file alone, in a process and a folder of its own.
ALONE = """
import json, os, sys
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
from libcosimpy.CosimObserver import CosimObserver

log_output_level(CosimLogLevel.ERROR)
execution = CosimExecution.from_ssp_file("system.ssp", int(sys.argv[1]))
observer = CosimObserver.create_last_value()
execution.add_observer(observer)
result = {}
for name, variable in (("contact", "contact.force"), ("bench", "contact.voltage")):
    index = execution.slave_index_from_instance_name(name)
    variables = execution.slave_variables(index)
    result[variable] = index, [each.reference for each in variables if each.name.decode() == variable], []
for _ in range(int(sys.argv[2])):
    assert execution.step()
    for index, reference, values in result.values():
        values += observer.last_real_values(index, reference)
print(json.dumps({variable: values for variable, (_, _, values) in result.items()}), flush=True)
os._exit(0)  # as two_fmus.py
"""

Columns = dict[str, NDArray[np.float64]]


def simulate_alone(system: Path, folder: Path, steps: int, edit: Callable[[str], str] = str) -> Columns:
    """Copy a system alone to a new folder, its texts edited, and run it there; give what libcosim saw."""
    folder.mkdir()
    with zipfile.ZipFile(system) as source, zipfile.ZipFile(folder / system.name, "w") as copy:
        for name in source.namelist():
            content = source.read(name)
            copy.writestr(name, edit(content.decode()) if name.endswith(".ssv") else content)
    command = [sys.executable, "-c", ALONE, str(NANOSECONDS), str(steps)]
    output = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True).stdout
    return {name: np.array(values) for name, values in json.loads(output).items()}


@pytest.fixture(scope="module")
def ran(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Path]:
    """Run the example; give what it printed and the folder of its files."""
    folder = tmp_path_factory.mktemp("two-fmus")
    return run_example(folder, "two_fmus"), folder


def test_the_circuit_obeys_its_equations_and_the_coupling_converges(ran: tuple[str, Path]) -> None:
    printed, folder = ran
    assert "4 openings" in printed
    assert is_picture(folder / "two-fmus.png")
    assert validate_fmu(str(folder / "TestBench.fmu")) == []
    measured = read_table(folder / "two-fmus-FMPy.csv")

    # Table: its sine. Circuit: the matrix exponential of its equations, given the conductance of each step.
    time = measured["time"]
    sine = 400 * np.sin(2 * np.pi * 1000 * time)
    # What rounding makes of a phase of 25 rad.
    assert np.max(np.abs(measured["table.acceleration"] - sine)) < 400 * 25 * np.finfo(float).eps
    conductances = measured["contact.conductance"]
    rest = SOURCE / (LOAD + 1 / conductances[0])
    state = np.array([rest, rest / conductances[0]])
    worst = 0.0
    for n, conductance in enumerate(conductances[:-1]):
        state = advanced(state, conductance, NANOSECONDS / 1e9)
        voltage = contact_voltage(state, conductance)
        worst = max(worst, abs(measured["contact.voltage"][n + 1] - voltage))
        worst = max(worst, abs(measured["contact.current"][n + 1] - voltage * conductance) * LOAD)
    # Both are exact but for rounding: 2000 steps times the spacing of numbers at 6 V.
    assert worst < 2000 * np.spacing(6.0)

    # A sine held over h is late by h/2, and all that it causes; what is left is of the next order.

    def order(values: Array) -> float:
        return float(np.polyfit(np.log(steps), np.log(values), 1)[0])

    steps, late, difference = read_table(folder / "two-fmus-convergence.csv").values()
    assert np.allclose(1e9 * steps, [NANOSECONDS, 2 * NANOSECONDS, 4 * NANOSECONDS])
    assert np.all(np.abs(late / steps - 0.5) < 0.05)
    assert abs(order(late) - 1) < 0.05
    # Each of 7 jumps of the voltage is late by h/2, and by anything up to h until the next point: h with a standard
    # deviation of h / sqrt(12 * 7) = 0.11 h. Over a factor of 4 in h that makes an order of 1 +- 0.11; twice this.
    assert abs(order(difference) - 1) < 0.22


def test_both_ways_give_the_same_and_the_system_runs_alone_by_its_parameters(
    ran: tuple[str, Path], tmp_path: Path
) -> None:
    pytest.importorskip("libcosimpy", exc_type=ImportError)
    folder = ran[1]
    fmpy, libcosim = (read_table(folder / f"two-fmus-{way}.csv") for way in ("FMPy", "libcosim"))
    assert all(np.array_equal(column, fmpy[name][1:]) for name, column in libcosim.items())

    system = folder / "system.ssp"
    elements = read_ssd(str(system), validate=True).system.elements
    assert [element.name for element in elements] == ["contact", "bench"]
    with zipfile.ZipFile(system) as archive:
        inside = archive.namelist()
    assert all(element.source in inside for element in elements)
    assert [binding.source in inside for element in elements for binding in element.parameterBindings] == [True, True]
    steps = len(fmpy["time"]) - 1
    alone = simulate_alone(system, tmp_path / "alone", steps)
    for name, values in alone.items():
        assert np.array_equal(values, fmpy[name][1:]), name
    # The circuit is linear, and halves are exact.
    halved = simulate_alone(system, tmp_path / "halved", steps, lambda text: text.replace('"6.0"', '"3.0"'))
    assert np.array_equal(2 * halved["contact.voltage"], alone["contact.voltage"])
    assert np.array_equal(halved["contact.force"], alone["contact.force"])
    coarse = simulate_alone(system, tmp_path / "coarse", steps, lambda text: text.replace('"1e-07"', '"0.001"'))
    error = np.max(np.abs(coarse["contact.force"] - alone["contact.force"])[: steps // 8])
    # Before the first opening, where errors do not grow: felt, and below the tolerance asked for.
    assert 0 < error < 1e-3 * 0.15


def test_without_libcosim_fmpy_runs_the_wiring_alone(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = tmp_path / "empty" / "libcosimpy"
    package.mkdir(parents=True)
    (package / "__init__.py").write_text("raise ImportError('not installed')", encoding="utf-8")
    monkeypatch.setenv("PYTHONPATH", str(package.parent))
    assert "libcosim is not here (not installed)" in run("two_fmus")
    assert sorted(path.name for path in tmp_path.glob("two-fmus-*.csv")) == [
        "two-fmus-FMPy.csv",
        "two-fmus-convergence.csv",
    ]
