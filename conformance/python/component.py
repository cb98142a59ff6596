"""The packaged component under FMPy: whole runs, and instances stepped by hand with their messages kept."""

import os
from collections.abc import Mapping
from ctypes import byref
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import numpy as np
from fmpy import calloc, extract, free, read_model_description, simulate_fmu
from fmpy.fmi2 import (
    FMU2Slave,
    fmi2CallbackAllocateMemoryTYPE,
    fmi2CallbackFreeMemoryTYPE,
    fmi2CallbackFunctions,
    fmi2CallbackLoggerTYPE,
)
from fmpy.logging import addLoggerProxy
from numpy.typing import NDArray

Array = NDArray[np.float64]

ROOT = Path(__file__).resolve().parents[2]
FMU = Path(os.environ.get("RELAY_CONTACT_FMU", ROOT / "dist" / "RelayContact.fmu"))

# Of a parameter: a choice of an enumeration by its name.
Value = float | str
Values = Mapping[str, Value]

DESCRIPTION = read_model_description(str(FMU))
# Numbers of the choices of each enumeration, by its name and theirs.
CHOICES: dict[str, dict[str, int]] = {
    variable.name: {item.name: int(item.value) for item in variable.declaredType.items}
    for variable in DESCRIPTION.modelVariables
    if variable.type == "Enumeration"
}


def _start(variable: Any) -> Value:  # noqa: ANN401
    match variable.type:
        case "Boolean":
            return bool(variable.start == "true")
        case "Enumeration":
            return next(name for name, number in CHOICES[variable.name].items() if number == int(variable.start))
        case _:
            return float(variable.start)


# Start values of the parameters.
STARTS = {
    variable.name: _start(variable) for variable in DESCRIPTION.modelVariables if variable.causality == "parameter"
}


def number(name: str, value: Value) -> float:
    """Give the number that stands for a value of the variable `name`."""
    return CHOICES[name][value] if isinstance(value, str) else value


def run(
    values: Values,
    stop: float,
    step: float,
    output: list[str],
    signals: Any = None,  # noqa: ANN401
) -> dict[str, Array]:
    """Simulate from 0 to `stop`; give time and the outputs at every communication point."""
    start = {name: number(name, value) for name, value in values.items()}
    result = simulate_fmu(
        str(FMU), stop_time=stop, output_interval=step, start_values=start, output=output, input=signals
    )
    return {name: np.asarray(result[name]) for name in ["time", *output]}


def extremes(values: Array) -> tuple[float, float]:
    """Give least and greatest value of a smooth curve sampled evenly, by the parabola through three points."""

    def greatest(samples: Array) -> float:
        peak = int(np.argmax(samples[1:-1])) + 1
        left, middle, right = samples[peak - 1 : peak + 2]
        return float(middle + (right - left) ** 2 / (8 * (2 * middle - left - right)))

    return -greatest(-values), greatest(values)


class Instance:
    """An instance whose functions are called one by one."""

    def __init__(self, folder: Path) -> None:
        """Instantiate the component, unpacked in `folder`."""
        self.references = {variable.name: variable.valueReference for variable in DESCRIPTION.modelVariables}
        self.messages: list[str] = []
        self.slave = FMU2Slave(
            guid=DESCRIPTION.guid,
            unzipDirectory=extract(str(FMU), unzipdir=str(folder)),
            modelIdentifier=DESCRIPTION.coSimulation.modelIdentifier,
            instanceName="instance",
        )
        self.callbacks = fmi2CallbackFunctions()
        self.callbacks.logger = fmi2CallbackLoggerTYPE(self._log)
        self.callbacks.allocateMemory = fmi2CallbackAllocateMemoryTYPE(calloc)
        self.callbacks.freeMemory = fmi2CallbackFreeMemoryTYPE(free)
        addLoggerProxy(byref(self.callbacks))
        self.slave.instantiate(callbacks=self.callbacks, loggingOn=True)

    def __enter__(self) -> Self:
        """Use the instance until the end of the block."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Free the instance."""
        self.slave.freeInstance()

    def _log(self, _environment: object, _instance: bytes, _status: int, _category: bytes, message: bytes) -> None:
        self.messages.append(message.decode())

    def set(self, name: str, value: float) -> None:
        """Set a real variable."""
        self.slave.setReal([self.references[name]], [value])

    def choose(self, name: str, value: Value) -> None:
        """Set an integer or enumeration variable."""
        self.slave.setInteger([self.references[name]], [int(number(name, value))])

    def get(self, name: str) -> float:
        """Give the value of a real variable."""
        return float(self.slave.getReal([self.references[name]])[0])

    def initialise(self, tolerance: float | None = None) -> None:
        """Go through initialisation, starting at 0."""
        self.slave.setupExperiment(tolerance=tolerance, startTime=0.0)
        self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()

    def step(self, time: float, length: float) -> None:
        """Do a communication step."""
        self.slave.doStep(currentCommunicationPoint=time, communicationStepSize=length)
