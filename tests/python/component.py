"""The packaged component: whole runs."""

from pathlib import Path

from relay_contact import Array, Component, Scene, Values, fmu_path
from relay_contact import run as run_scene

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


def resting(values: Values, *names: str) -> list[float]:
    """Return outputs at rest."""
    with COMPONENT.started(values) as contact:
        return contact.real(*names)


def run(
    values: Values, stop: float, step: float, output: list[str], moved: dict[str, Array] | None = None
) -> dict[str, Array]:
    """Simulate from 0 to `stop`, with inputs over time; give time and the outputs at every communication point."""
    return run_scene(Scene("", stop, step, output, dict(values), moved or {}), component=COMPONENT).columns
