"""Scenes, and runs of them."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.lib.recfunctions import unstructured_to_structured
from numpy.typing import ArrayLike
from tqdm import tqdm

from relay_contact.component import Array, Component, Value, nearest, units
from relay_contact.files import RelayContactError, named, read_toml, scenes


def read_table(path: Path) -> dict[str, Array]:
    """Read a CSV file of numbers, its columns by name."""
    with path.open(encoding="utf-8") as file:
        names = file.readline().strip().split(",")
        return dict(zip(names, np.loadtxt(file, delimiter=",", ndmin=2).T, strict=True))


def write_table(path: Path, names: str, rows: ArrayLike, digits: int = 12) -> None:
    """Write a CSV file with a line of names."""
    np.savetxt(path, rows, delimiter=",", header=names, comments="", fmt=f"%.{digits}g", encoding="utf-8")


def flat(table: Mapping[str, Any], prefix: str = "") -> dict[str, Value]:
    """Give the values of nested TOML tables by their dotted names."""
    values: dict[str, Value] = {}
    for key, value in table.items():
        values |= flat(value, f"{prefix}{key}.") if isinstance(value, dict) else {f"{prefix}{key}": value}
    return values


def parameters(table: Mapping[str, Any], path: Path) -> dict[str, Value]:
    """Give the parameters in a table of a file; the path of a spring file in it is relative to that file."""
    values = flat(table)
    if "beam.file" in values:
        values["beam.file"] = str(path.resolve().parent / str(values["beam.file"]))
    return values


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
    def read(cls, scene: str | Path) -> Self:
        """Read a scene by its name, such as "paper-1khz", or a scene file by its path."""
        path = named("scene", scene, scenes())
        content = read_toml(path)
        inputs = content.get("inputs", {})
        file = inputs.pop("file", None)
        values = parameters(content.get("parameters", {}), path) | flat(inputs)
        table = read_table(path.with_name(file)) if file else {}
        try:
            stop, step, outputs = content["stop"], content["communicationStep"], content["outputs"]
        except KeyError as error:
            raise RelayContactError(f"{path}: {error.args[0]} is missing") from error
        return cls(content.get("title", ""), stop, step, outputs, values, table)

    def points(self) -> list[float]:
        """Give the communication points; the last is the stop."""
        count = math.ceil(self.stop / self.step - 1e-9)
        return [min(n * self.step, self.stop) for n in range(count + 1)]

    def inputs(self, points: list[float]) -> dict[str, Array]:
        """Give the inputs that change, at the communication points."""
        return {
            name: np.interp(points, self.table["time"], column) for name, column in self.table.items() if name != "time"
        }

    def changed(self, component: Component, changes: Mapping[str, Value]) -> Self:
        """Give the scene with other parameters and constant inputs."""
        return replace(self, values=self.values | {component.settable(name): each for name, each in changes.items()})


class Result(np.ndarray[tuple[int], np.dtype[np.void]]):
    """Time and outputs at the communication points: a structured array; `units` has the SI unit of each field."""

    units: dict[str, str]

    def __array_finalize__(self, source: Any) -> None:  # noqa: ANN401
        """Keep the units."""
        self.units = getattr(source, "units", {})

    def __getitem__(self, key: Any) -> Any:  # noqa: ANN401
        """Give a field as a plain array; rows as a result."""
        if isinstance(key, str) and self.dtype.names and key not in self.dtype.names:
            raise KeyError(f"{key}: not among the outputs{nearest(key, self.dtype.names)}")
        value = super().__getitem__(key)
        return np.asarray(value) if isinstance(value, Result) and value.dtype.names is None else value

    @property
    def columns(self) -> dict[str, Array]:
        """The fields by name."""
        return {name: self[name] for name in self.dtype.names or ()}

    def write(self, path: Path) -> None:
        """Write a CSV file."""
        write_table(path, ",".join(self.columns), np.column_stack(list(self.columns.values())))


def run(
    scene: Scene | str | Path,
    *,
    outputs: list[str] | None = None,
    inputs: Mapping[str, ArrayLike] | None = None,
    stop: float | None = None,
    step: float | None = None,
    component: Component | None = None,
    progress: bool | Callable[[float], object] = False,
    **changes: Value,
) -> Result:
    """Run a scene, given by its name or its file, and give time and outputs at every communication point, SI units.

    `changes` are parameters and constant inputs: excitation_frequency=500.0, or **{"excitation.frequency": 500.0};
    choices by name: effects_contactLaw="Bonded". `outputs` replaces those of the scene, `stop` its length (s), `step`
    its communication step (s). `inputs` are courses over their column "time", such as {"time": t,
    "base.acceleration": a}, linear between its points: each step gets the input's value and derivative.
    `progress=True` shows a bar; a function is called after each step with the time that it reached.
    """
    component = component or Component()
    scene = (scene if isinstance(scene, Scene) else Scene.read(scene)).changed(component, changes)
    courses = {name: np.asarray(course, dtype=float) for name, course in (inputs or scene.table).items()}
    if courses and "time" not in courses:
        raise RelayContactError('inputs: the column "time" is missing')
    courses = {name if name == "time" else component.settable(name): course for name, course in courses.items()}
    names = [component.name(name) for name in outputs or scene.outputs]
    scene = replace(scene, outputs=names, table=courses, stop=stop or scene.stop, step=step or scene.step)
    points = scene.points()
    form = "{desc} {percentage:3.0f} %|{bar}| {n:.3g} of {total:.3g} ms"
    with tqdm(total=1e3 * scene.stop, desc="simulated", bar_format=form, disable=progress is not True) as bar:
        tell = progress if callable(progress) else lambda time: bar.update(1e3 * time - bar.n)
        result = simulated(scene, points, component, tell)
    fields = np.dtype([(name, np.float64) for name in ["time", *names]])
    table = unstructured_to_structured(result, fields).view(Result)
    shown = units(component.description)
    table.units = {"time": "s"} | {name: shown[name].si if name in shown else "" for name in names}
    return table


def simulated(scene: Scene, points: list[float], component: Component, tell: Callable[[float], object]) -> Array:
    """Run a scene; give a row of time and outputs for each communication point."""
    inputs = scene.inputs(points)
    first = {name: float(course[0]) for name, course in inputs.items()}
    with component.started(scene.values | first) as contact, contact.explained():
        rows = [[0.0, *(contact.get(name) for name in scene.outputs)]]
        for n, (begin, end) in enumerate(pairwise(points)):
            for name, course in inputs.items():
                contact.change(name, course[n], course[n + 1], end - begin)
            contact.step(begin, end - begin)
            rows.append([end, *(contact.get(name) for name in scene.outputs)])
            tell(end)
    return np.array(rows)
