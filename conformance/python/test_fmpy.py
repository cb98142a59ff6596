"""The component in FMPy, beside what the other files test: the run common to all importers, and habits of importers."""

import math
import re
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest
from fmpy import simulate_fmu
from fmpy.ssp.ssd import read_ssd

from component import COMPONENT, FMU, ROOT, run
from relay_contact import Component, Contact, Values, read_table
from results import FOLDER, STEP, SYSTEM, TOLERANCE, compare, published, record, staircase


def test_a_sine_given_at_the_communication_points() -> None:
    signals = staircase(["base.acceleration", "support.displacement", "contact.current"])
    stop = float(signals["time"][-1])
    start = {"solver.tolerance": TOLERANCE}
    result = simulate_fmu(
        str(FMU), stop_time=stop, output_interval=STEP, start_values=start, output=["contact.force"], input=signals
    )
    compare("FMPy", fmpy.__version__, "run", result["contact.force"].tolist())


def test_a_force_that_is_no_number_is_not_passed() -> None:
    with pytest.raises(AssertionError):
        compare("FMPy", fmpy.__version__, "run", [0.0, math.nan], expected=[0.0, 0.0])


def test_the_published_run_by_a_choice_that_is_a_number() -> None:
    times = [n * STEP for n in range(2001)]
    expected = read_table(FOLDER / "scenes" / "paper-1khz.csv")["contact.force"].tolist()
    compare("FMPy", fmpy.__version__, "published run", published(times), expected=expected)


def test_the_system_of_two_instances_follows_the_schema_of_ssp() -> None:
    system = read_ssd(str(SYSTEM), validate=True).system
    assert [element.name for element in system.elements] == ["first", "second"]
    record("FMPy", fmpy.__version__, "SSP description")


def test_a_folder_with_spaces_and_letters_beyond_ascii(tmp_path: Path) -> None:
    with Contact(Component(FMU, tmp_path / "ein schöner Ordner #1 100%")) as instance:
        instance.initialise()
        instance.step(0.0, STEP)
        assert instance.messages == []


def test_derivatives_of_inputs_are_set_after_each_step() -> None:
    """Where `set_input_derivatives` fails in FMPy; the error of a sine then falls with the square of the step."""
    amplitude, omega, steps = 98.0, 2 * math.pi * 1000, 200
    values: Values = {"solver.tolerance": 1e-8}
    exact = run({**values, "effects.excitation": "Sine"}, steps * STEP, STEP, ["contact.force"])["contact.force"]
    signals = staircase(["base.acceleration"])
    signals["base.acceleration"] = amplitude * np.sin(omega * signals["time"])
    with pytest.raises(ValueError, match="Can only assign sequence of same size"):
        simulate_fmu(str(FMU), output_interval=STEP, input=signals, set_input_derivatives=True)

    variable = COMPONENT.variables["base.acceleration"].valueReference
    errors = []
    for slope in (0.0, 1.0):

        def drive(fmu: Any, time: float, slope: float = slope) -> bool:  # noqa: ANN401
            """Set the value of the step that begins, and its slope."""
            fmu.setReal([variable], [amplitude * math.sin(omega * time)])
            fmu.setRealInputDerivatives([variable], [1], [slope * amplitude * omega * math.cos(omega * time)])
            return True

        fmu = Contact(COMPONENT).fmu
        drive(fmu, 0.0)
        result = simulate_fmu(
            COMPONENT.folder,
            model_description=COMPONENT.description,
            fmu_instance=fmu,
            fmi_type="CoSimulation",
            stop_time=steps * STEP,
            output_interval=STEP,
            start_values=values,
            output=["contact.force"],
            step_finished=lambda time, recorder, drive=drive: drive(recorder.fmu, time),
        )
        fmu.freeInstance()
        errors.append(np.max(np.abs(result["contact.force"] - exact)) / (np.ptp(exact) / 2))
    # With a hundred steps a period: some pi / 100 of the amplitude, and some of its square.
    assert 0.2 < errors[0] / (math.pi / 100) < 5
    assert 0.2 < errors[1] / (math.pi / 100) ** 2 < 5


def test_a_communication_point_at_every_event() -> None:
    """The recipe of docs/importers.md: back to an event that a step reports, as often as there is an earlier one."""
    text = (ROOT / "docs" / "importers.md").read_text(encoding="utf-8")
    recipe = re.search(r"```python\n(def to_next_event.*?)```", text, re.DOTALL)
    assert recipe
    scope: dict[str, Any] = {}
    exec(recipe[1], scope)
    names = ("contact.lastOpening", "contact.lastClosing")
    sine: Values = {"effects.excitation": "Sine", "excitation.amplitude": 400.0}
    events: set[float] = set()
    with COMPONENT.started(sine) as contact:
        for step in range(20000):
            contact.step(step * 1e-6, 1e-6)
            events |= set(contact.real(*names)) - {-1.0}
    references = [COMPONENT.variables[name].valueReference for name in names]
    with COMPONENT.started(sine) as contact:
        points = [0.0]
        while points[-1] < 0.02 - 1e-9:
            points.append(scope["to_next_event"](contact.fmu, references, points[-1], min(points[-1] + 1e-4, 0.02)))
            # At the instant of an event it is what it is after it.
            opening, closing = contact.real(*names)
            assert contact.get("contact.closed") == (closing >= opening)
    assert len(events) == 39
    # Found again to the tolerance by which the component locates them.
    assert max(min(abs(event - point) for point in points) for event in events) < 1e-9
    assert len(points) == 1 + 220
