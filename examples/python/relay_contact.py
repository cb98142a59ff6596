"""The relay contact from Python: its scenes run under FMPy, and the component stepped by hand.

Copy it along with an example that imports it. It needs FMPy and NumPy; scenes and component are found in this
project's folders.

    result = run(Scene.read(scenes()["chatter-41g"]), {"excitation.amplitude": 300.0})
    print(result["contact.force"].min())
"""

import math
import os
import shutil
import tomllib
import weakref
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from tempfile import mkdtemp
from types import TracebackType
from typing import Any, Self

import numpy as np
from fmpy import extract, instantiate_fmu, read_model_description
from fmpy.fmi1 import FMICallException
from numpy.typing import NDArray

ROOT = Path(__file__).resolve().parents[2]

SIGNS = {"Ohm": "Ω", "mOhm": "mΩ", "um": "µm", "us": "µs", "degC": "°C", "m/s2": "m/s²", "kg/m3": "kg/m³", "1": ""}

Array = NDArray[np.float64]
Value = float | str
"""Value of a variable; a choice, such as that of effects.excitation, by its name; a file by its path."""
Values = Mapping[str, Value]


def fmu_path() -> Path:
    """Give the component: the file that RELAY_CONTACT_FMU names, else the one built in this project."""
    return Path(os.environ.get("RELAY_CONTACT_FMU", ROOT / "dist" / "RelayContact.fmu"))


def scenes() -> dict[str, Path]:
    """Give the scene files by name."""
    return {path.stem: path for path in sorted((ROOT / "scenes").glob("*.toml"))}


def read_table(path: Path) -> dict[str, Array]:
    """Read a CSV file of numbers, its columns by name."""
    with path.open(encoding="utf-8") as file:
        names = file.readline().strip().split(",")
        return dict(zip(names, np.loadtxt(file, delimiter=",", ndmin=2).T, strict=True))


@dataclass(frozen=True)
class Scene:
    """What a scene file holds, SI units."""

    title: str
    stop: float
    step: float
    outputs: list[str]
    values: dict[str, Value]
    """Parameters and constant inputs."""
    table: dict[str, Array]
    """Inputs that change, over the column `time`; empty where all are constant."""

    @classmethod
    def read(cls, path: Path) -> Self:
        """Read a scene file."""
        content = tomllib.loads(path.read_text(encoding="utf-8"))
        inputs = content.get("inputs", {})
        file = inputs.pop("file", None)
        values = flat(content.get("parameters", {})) | flat(inputs)
        if "beam.file" in values:
            values["beam.file"] = str(path.resolve().parent / str(values["beam.file"]))
        table = read_table(path.with_name(file)) if file else {}
        return cls(
            content.get("title", ""), content["stop"], content["communicationStep"], content["outputs"], values, table
        )

    def points(self) -> list[float]:
        """Give the communication points; the last is the stop."""
        count = math.ceil(self.stop / self.step - 1e-9)
        return [min(n * self.step, self.stop) for n in range(count + 1)]

    def inputs(self, points: list[float]) -> dict[str, Array]:
        """Give the inputs that change, at the communication points."""
        return {
            name: np.interp(points, self.table["time"], column) for name, column in self.table.items() if name != "time"
        }


@dataclass(frozen=True)
class Unit:
    """How values of a variable, in SI units, are shown."""

    si: str
    shown: str
    factor: float = 1.0
    offset: float = 0.0

    def text(self, value: float) -> str:
        """Give a value in the unit shown; in SI units if it is large there."""
        shown = self.factor * value + self.offset
        return f"{shown:g} {self.shown}" if abs(shown) < 1e4 else f"{value:g} {self.si}"


def units(description: Any) -> dict[str, Unit]:  # noqa: ANN401
    """Give the unit of every variable of FMPy's model description that has one."""
    scales = {(unit.name, other.name): other for unit in description.unitDefinitions for other in unit.displayUnits}
    found = {}
    for variable in description.modelVariables:
        kind = variable.declaredType
        if kind is not None and kind.unit:
            shown = kind.displayUnit or kind.unit
            scale = scales.get((kind.unit, shown))
            si, shown = (SIGNS.get(name, name) for name in (kind.unit, shown))
            found[variable.name] = Unit(si, shown, scale.factor, scale.offset) if scale else Unit(si, shown)
    return found


def flat(table: dict[str, Any], prefix: str = "") -> dict[str, Value]:
    """Give the values of nested TOML tables by their dotted names."""
    values: dict[str, Value] = {}
    for key, value in table.items():
        values |= flat(value, f"{prefix}{key}.") if isinstance(value, dict) else {f"{prefix}{key}": value}
    return values


class Component:
    """The component as a file: its description, and the folder it is unpacked in."""

    def __init__(self, path: Path | None = None, folder: Path | None = None) -> None:
        """Unpack it, into a temporary folder if none is given, which is deleted together with this object."""
        self.path = path or fmu_path()
        self.description = read_model_description(str(self.path))
        self.variables = {variable.name: variable for variable in self.description.modelVariables}
        if folder is None:
            folder = Path(mkdtemp())
            weakref.finalize(self, shutil.rmtree, folder, ignore_errors=True)
        self.folder: str = extract(str(self.path), str(folder))

    def choices(self, name: str) -> dict[str, int]:
        """Give the numbers of the choices of a variable, by name."""
        return {item.name: int(item.value) for item in self.variables[name].declaredType.items}

    def number(self, name: str, value: Value) -> float:
        """Give the number that stands for a value of a variable."""
        if isinstance(value, str):
            return self.choices(name)[value]
        return value if self.variables[name].type == "Real" else int(value)

    def start(self, name: str) -> Value:
        """Give the start value of a variable."""
        variable = self.variables[name]
        match variable.type:
            case "Boolean":
                return bool(variable.start == "true")
            case "String":
                return str(variable.start or "")
            case "Enumeration":
                return next(each for each, number in self.choices(name).items() if number == int(variable.start))
            case _:
                return float(variable.start)

    def started(self, values: Values | None = None) -> "Contact":
        """Give an instance that is initialised with these parameters and inputs, at time 0."""
        contact = Contact(self)
        for name, value in (values or {}).items():
            contact.set(name, value)
        contact.initialise()
        return contact

    def in_scene(self, name: str) -> "Contact":
        """Give an instance that is initialised with the parameters of a scene."""
        return self.started(Scene.read(scenes()[name]).values)


class Contact:
    """An instance of the component, its variables known by name, for a `with` block that frees it."""

    def __init__(self, component: Component, messages: list[str] | None = None) -> None:
        """Instantiate the component; errors and warnings are appended to the messages, if a list is given."""
        self.component = component

        self.messages = [] if messages is None else messages

        def keep(_environment: int, _instance: bytes, _status: int, _category: bytes, message: bytes) -> None:
            self.messages.append(message.decode())

        self.fmu = instantiate_fmu(component.folder, component.description, "CoSimulation", logger=keep)
        self.initialised = False

    def __enter__(self) -> Self:
        """Use the instance until the end of the block."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End the simulation, unless something went wrong, and free the instance."""
        if self.initialised and kind is None:
            self.fmu.terminate()
        self.fmu.freeInstance()

    def references(self, *names: str) -> list[int]:
        """Give the numbers by which the component knows its variables."""
        return [self.component.variables[name].valueReference for name in names]

    def set(self, name: str, value: Value) -> None:
        """Set a parameter or an input."""
        kind = self.component.variables[name].type
        if kind == "String":
            try:
                self.fmu.setString(self.references(name), [str(value)])
            except FMICallException as error:
                raise ValueError(" ".join(self.messages) or str(error)) from error
            return
        put = getattr(self.fmu, f"set{'Integer' if kind == 'Enumeration' else kind}")
        put(self.references(name), [self.component.number(name, value)])

    def change(self, name: str, begin: float, end: float, length: float) -> None:
        """Have an input change linearly over the next step, of this length."""
        self.fmu.setReal(self.references(name), [begin])
        self.fmu.setRealInputDerivatives(self.references(name), [1], [(end - begin) / length])

    def get(self, name: str) -> float:
        """Give the value of any variable, of an enumeration its number."""
        kind = self.component.variables[name].type
        read = getattr(self.fmu, f"get{'Integer' if kind == 'Enumeration' else kind}")
        return float(read(self.references(name))[0])

    def real(self, *names: str) -> list[float]:
        """Give the values of several real variables."""
        values: list[float] = self.fmu.getReal(self.references(*names))
        return values

    def initialise(self, tolerance: float | None = None) -> None:
        """Go through the initialisation at time 0."""
        self.fmu.setupExperiment(tolerance=tolerance, startTime=0.0)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()
        self.initialised = True

    def step(self, time: float, length: float) -> None:
        """Do a communication step."""
        self.fmu.doStep(currentCommunicationPoint=time, communicationStepSize=length)


def run(
    scene: Scene,
    changes: Values | None = None,
    component: Component | None = None,
    progress: Callable[[float], object] = lambda _: None,
) -> dict[str, Array]:
    """Run a scene with changes of its parameters and constant inputs; give time and outputs at every point.

    `progress` is called after each communication step with the time that it reached.
    """
    scene = replace(scene, values=scene.values | dict(changes or {}))
    points = scene.points()
    inputs = scene.inputs(points)
    first = {name: float(course[0]) for name, course in inputs.items()}
    with (component or Component()).started(scene.values | first) as contact:
        rows = [[contact.get(name) for name in scene.outputs]]
        for n, (begin, end) in enumerate(pairwise(points)):
            for name, course in inputs.items():
                contact.change(name, course[n], course[n + 1], end - begin)
            contact.step(begin, end - begin)
            rows.append([contact.get(name) for name in scene.outputs])
            progress(end)
    return {"time": np.array(points)} | dict(zip(scene.outputs, np.array(rows).T, strict=True))
