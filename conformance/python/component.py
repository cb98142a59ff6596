"""The packaged component under FMPy: whole runs, and instances stepped by hand with their messages kept."""

import os
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

# Choices of effects.excitation and effects.axialForce.
SINE = 2
NO_AXIAL_FORCE = 2
PRESCRIBED = 4


def run(
    values: dict[str, float],
    stop: float,
    step: float,
    output: list[str],
    signals: Any = None,  # noqa: ANN401
) -> dict[str, Array]:
    """Simulate from 0 to `stop`; give time and the outputs at every communication point."""
    result = simulate_fmu(
        str(FMU), stop_time=stop, output_interval=step, start_values=values, output=output, input=signals
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
        description = read_model_description(str(FMU))
        self.references = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.messages: list[str] = []
        self.slave = FMU2Slave(
            guid=description.guid,
            unzipDirectory=extract(str(FMU), unzipdir=str(folder)),
            modelIdentifier=description.coSimulation.modelIdentifier,
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

    def choose(self, name: str, value: int) -> None:
        """Set an integer or enumeration variable."""
        self.slave.setInteger([self.references[name]], [value])

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
