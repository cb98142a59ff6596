"""The packaged component under FMPy: whole runs."""

from pathlib import Path
from typing import Any

import numpy as np
from fmpy import simulate_fmu

from relay_contact import Array, Component, Values, fmu_path

ROOT = Path(__file__).resolve().parents[2]
FMU = fmu_path()
# The same with all numbers as Reals, and the one that carries a spring.
PLAIN = FMU.with_name("RelayContact-plain.fmu")
SPRUNG = FMU.with_name("RelayContact-tapered-cube.fmu")
COMPONENT = Component(FMU)

# Start values of the parameters.
STARTS = {
    name: COMPONENT.start(name) for name, variable in COMPONENT.variables.items() if variable.causality == "parameter"
}


def run(
    values: Values,
    stop: float,
    step: float,
    output: list[str],
    signals: Any = None,  # noqa: ANN401
) -> dict[str, Array]:
    """Simulate from 0 to `stop`; give time and the outputs at every communication point."""
    start = {
        name: value if COMPONENT.variables[name].type == "String" else COMPONENT.number(name, value)
        for name, value in values.items()
    }
    result = simulate_fmu(
        str(FMU), stop_time=stop, output_interval=step, start_values=start, output=output, input=signals
    )
    return {name: np.asarray(result[name]) for name in ["time", *output]}
