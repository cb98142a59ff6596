"""Scenes, and runs of them."""

import math
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, Self

import numpy as np
from fmpy.fmi2 import fmi2Warning
from numpy.lib.recfunctions import unstructured_to_structured
from numpy.typing import ArrayLike
from pydantic import ConfigDict, Field
from pydantic.alias_generators import to_camel
from tqdm import tqdm

from relay_contact.component import Array, Component, Contact, Value, default_component, nearest, units, warnings_kept
from relay_contact.files import RelayContactError, at_once, named, scenes
from relay_contact.schema import Nested, Positive, Table, at, lacking, leaves, read, refused, variables
from relay_contact.tables import ACCELERATIONS, CURRENTS, LENGTHS, RATIOS, TIMES, Units
from relay_contact.tables import read as read_columns

MOST = 10**7
"""Communication steps of a run, whose rows stay in memory."""
PASSED = 0.01
"""Part of the range of an input by which it may pass a row of its table."""
LONG = 100
"""Times the stop, from which on a table may have its time in another unit."""
WIDE = 0.02  # m, from which on it may have a displacement in one
INPUTS: Units = {
    "time": TIMES, "base.acceleration": ACCELERATIONS, "support.displacement": LENGTHS, "second.displacement": LENGTHS,
    "pusher.displacement": LENGTHS, "coil.relativeCurrent": RATIOS,
    "contact.current": CURRENTS,
}  # fmt: skip
"""Columns of a table of inputs, and their units."""


def read_table(path: Path) -> dict[str, Array]:
    """Read a CSV file that `write_table` has written, its columns by name."""
    try:
        with path.open(encoding="utf-8-sig") as file:
            names = file.readline().strip().split(",")
            return dict(zip(names, np.loadtxt(file, delimiter=",", ndmin=2).T, strict=True))
    except ValueError as error:
        raise RelayContactError(f"{path}: not a table as `relay-contact run` writes it: {error}") from error


def input_table(path: Path) -> dict[str, Array]:
    """Read inputs over time as measuring programs export them (`relay_contact.tables`), SI units."""
    table = read_columns(path, INPUTS)
    there = list(table.places)
    if "time" not in there or len(there) < 2:
        names = ", ".join(there + table.passed)
        allowed = f"time and one or more of {', '.join(name for name in INPUTS if name != 'time')}"
        raise table.wrong(f"columns {names}: not allowed, allowed is {allowed}")
    if not table.rows:
        raise table.wrong("no row below the names of the columns")
    table.ascending("time")
    return {name: table[name] for name in there}


def write_table(path: Path, names: str, rows: ArrayLike, digits: int = 12) -> None:
    """Write a CSV file with a line of names."""
    with at_once(path) as part:
        np.savetxt(part, rows, delimiter=",", header=names, comments="", fmt=f"%.{digits}g", encoding="utf-8")


class Content(Table):
    """Contents of a scene file."""

    model_config = ConfigDict(alias_generator=to_camel)

    title: str = ""
    stop: Positive
    communication_step: Positive
    outputs: Annotated[list[str], Field(min_length=1)]
    parameters: Nested
    inputs: Nested


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
    file: Path | None = None
    """Where these were read."""

    @classmethod
    def read(cls, scene: str | Path, component: Component | None = None) -> Self:
        """Read a scene by its name, such as "paper-1khz", or a scene file by its path.

        The component, if given, checks all names and values, which it does as the scene starts otherwise.
        """
        path = named("scene", scene, scenes())
        content = read(path, Content)
        inputs = dict(content.inputs)
        file = inputs.pop("file", "")
        if not isinstance(file, str):
            raise refused(path, ("inputs", "file"), file, "allowed is the path of a table beside this file")
        source = path.parent / file if file else None
        table = {}
        if source:
            if not source.is_file():
                raise refused(path, ("inputs", "file"), file, "no such file beside this one")
            with at(path, "inputs", "file"):
                table = input_table(source)
        for name, keys, value in leaves(inputs):
            if name in table:
                raise refused(path, ("inputs", *keys), value, f"{file} has a column for it")
        values = variables(path, content.parameters, ("parameters",), component)
        values |= variables(path, inputs, ("inputs",), component, "input")
        for number, name in enumerate(content.outputs):
            with at(path, "outputs", number):
                if component:
                    component.name(name)
        return cls(content.title, content.stop, content.communication_step, content.outputs, values, table, source)

    def points(self) -> Array:
        """Return the communication points; the last is the stop."""
        for name, value in (("stop", self.stop), ("communication step", self.step)):
            if not 0 < value < math.inf:
                raise RelayContactError(f"{name} = {value} s: not allowed, allowed is greater than 0")
        if self.stop / self.step > MOST:
            text = f"allowed are {MOST:.0e} communication steps: an earlier stop, or longer steps"
            raise RelayContactError(f"stop = {self.stop:g} s with steps of {self.step:g} s: not allowed, {text}")
        count = max(1, math.ceil(self.stop / self.step - 1e-9))
        points: Array = np.minimum(np.arange(count + 1) * self.step, self.stop)
        return points

    def inputs(self, points: Array) -> dict[str, Array]:
        """Give the inputs that change, at the communication points."""
        return {
            name: np.interp(points, self.table["time"], column) for name, column in self.table.items() if name != "time"
        }

    def uncovered(self) -> list[str]:
        """Return in words where the table does not cover the run; refuse one that has rows between all points."""
        if len(self.table) < 2:
            return []
        time, stop = self.table["time"], self.stop
        begin, end = time[0], time[-1]
        spacing = np.diff(time).min(initial=end - begin)
        if begin >= stop or end < 0:
            text = f"not allowed, the run is from 0 to {stop:g} s"
            raise RelayContactError(f"inputs: time = {begin:g} to {end:g} s: {text}")
        # Times of a recorder are rounded.
        if self.step > 1.01 * spacing > 0:
            text = f"allowed is at most {spacing:g} s, the shortest time between rows of the inputs"
            raise RelayContactError(f"communication step = {self.step:g} s: not allowed, {text}")
        told = {
            f"inputs begin at {begin:g} s: before, their first values are held": begin > 1.01 * spacing,
            f"inputs end at {end:g} s, the run at {stop:g} s: their last values are held": stop - end > 1.01 * spacing,
            f"inputs end at {end:g} s, the run at {stop:g} s: is their time in s?": end > LONG * stop,
        }
        for name, column in self.table.items():
            if INPUTS.get(name) is LENGTHS:
                told[f"inputs: {name} reaches {abs(column).max():g} m: is it in m?"] = abs(column).max() > WIDE
        return [text for text, true in told.items() if true]

    def missed(self, points: Array, inputs: Mapping[str, Array]) -> list[str]:
        """Return in words where inputs pass rows of the table that lie between the communication points."""
        told = []
        for name, course in inputs.items():
            time, column = self.table["time"], self.table[name]
            inside = (time >= 0) & (time <= self.stop)
            beside = np.where(inside, np.abs(np.interp(time, points, course) - column), 0.0)
            at, span = int(beside.argmax()), np.ptp(column)
            if beside[at] > PASSED * span:
                text = f"{name} passes its row at {time[at]:g} s by {100 * beside[at] / span:.2g} % of its range"
                told.append(f"inputs: {text}: between communication points inputs are linear, choose shorter steps")
        return told

    def idle(self, component: Component) -> list[str]:
        """Return in words which values are not used, as nothing says whether the scene has what uses them."""
        values, told = self.values, []
        given = values | self.table
        for name in given.keys() & component.variables.keys():
            own = f" = {values[name]}" if name not in self.table else ""
            needed = lacking(component, name, [values]) if np.any(given[name] != component.start(name)) else ""
            if needed and needed.partition(" ")[0] not in values:
                told.append(f"{name}{own}: not used without {needed}")
        return sorted(told)

    @contextmanager
    def started(self, component: Component, points: Array) -> Iterator[tuple[Contact, dict[str, Array]]]:
        """Give an instance at the begin of the run, which warns of what it does not use, and the inputs."""
        uncovered, inputs = self.uncovered(), self.inputs(points)
        remarks = uncovered + self.missed(points, inputs)
        first = {name: float(course[0]) for name, course in inputs.items()}
        with component.started(self.values | first) as contact, contact.explained():
            for text in remarks + self.idle(component):
                contact.keep(fmi2Warning, text)
            yield contact, inputs

    def changed(self, component: Component, changes: Mapping[str, Value]) -> Self:
        """Return the scene, its table checked, with other parameters and inputs; one of the table is then constant."""
        changed = component.settables(changes)
        table = {name: column for name, column in courses(component, self.table).items() if name not in changed}
        values = component.named(self.values) | changed
        return replace(self, values=values, table=table if table.keys() - {"time"} else {})


class Result(np.ndarray[tuple[int], np.dtype[np.void]]):
    """Time and outputs at the communication points: a structured array; `units` has the SI unit of each field.

    `warnings` has what the component warned of, the first message of each kind.
    """

    units: dict[str, str]
    warnings: list[str]

    def __reduce__(self) -> Any:  # noqa: ANN401
        """Give units and warnings to copies in other processes, too."""
        make, given, state = super().__reduce__()  # type: ignore[str-unpack]
        return make, given, (state, vars(self))

    def __setstate__(self, state: Any) -> None:  # noqa: ANN401
        """Take what `__reduce__` gives."""
        own, kept = state
        super().__setstate__(own)
        vars(self).update(kept)

    def __array_finalize__(self, source: Any) -> None:  # noqa: ANN401
        """Keep units and warnings."""
        self.units = getattr(source, "units", {})
        self.warnings = getattr(source, "warnings", [])

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
    outputs: str | list[str] | None = None,
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
    `progress=True` shows a bar; a function is called every thousand steps with the time that is reached.
    """
    component = component or default_component()
    scene = (scene if isinstance(scene, Scene) else Scene.read(scene, component)).changed(component, changes)
    course = scene.table if inputs is None else courses(component, inputs)
    if twice := course.keys() & {component.settable(name) for name in changes}:
        raise RelayContactError(f"{', '.join(sorted(twice))}: given twice, as a constant and among the inputs")
    outputs = [outputs] if isinstance(outputs, str) else outputs
    names = list(dict.fromkeys(map(component.name, scene.outputs if outputs is None else outputs)))
    stop, step = scene.stop if stop is None else stop, scene.step if step is None else step
    scene = replace(scene, outputs=names, table=course, stop=stop, step=step)
    form = "{desc} {percentage:3.0f} %|{bar}| {n:.3g} of {total:.3g} ms"
    with warnings_kept() as warnings, progress_bar(1e3 * scene.stop, form, progress is True, desc="simulated") as bar:
        tell = progress if callable(progress) else lambda time: bar.update(1e3 * time - bar.n)
        result = simulated(scene, scene.points(), component, tell)
    fields = np.dtype([(name, np.float64) for name in ["time", *names]])
    table = unstructured_to_structured(result, fields).view(Result)
    shown = units(component.description)
    table.units = {"time": "s"} | {name: shown[name].si if name in shown else "" for name in names}
    table.warnings = list(warnings.values())
    return table


SHOWN = 1000
"""Communication steps from which on progress is told again."""
PATIENCE = 2.0
"""What takes longer than this shows its progress, s."""


def progress_bar(total: float | None, form: str, shown: bool, **more: Any) -> Any:  # noqa: ANN401
    """Return a bar on the error output, for what takes longer than 2 s; rarely printed where nobody watches."""
    often = 0.1 if sys.stderr.isatty() else PATIENCE
    return tqdm(total=total, bar_format=form, disable=not shown, delay=PATIENCE, mininterval=often, **more)


def courses(component: Component, given: Mapping[str, ArrayLike]) -> dict[str, Array]:
    """Return inputs over the column `time`, checked."""
    if not len(given.keys()):
        return {}
    if "time" not in given:
        raise RelayContactError('inputs: the column "time" is missing')
    found: dict[str, Array] = {}
    columns = component.settables({name: values for name, values in given.items() if name != "time"}, "input")
    for name, values in {"time": given["time"], **columns}.items():
        try:
            own: Any = np.ma.asarray(values)
            # Not differences of times, in units of their own.
            own = own.astype(float, casting="same_kind" if own.dtype.kind in "mMc" else "unsafe")
            # What is masked is missing.
            found[name] = np.ma.filled(own, np.nan)
        except (TypeError, ValueError) as error:
            raise RelayContactError(f"inputs: {name}: not allowed, allowed are numbers") from error
    for name, column in found.items():
        if column.ndim != 1 or not len(column) or len(column) != len(found["time"]) or not np.isfinite(column).all():
            raise RelayContactError(f"inputs: {name}: not allowed, allowed are finite numbers, as many as times")
    back = np.flatnonzero(np.diff(found["time"]) <= 0)
    if len(back):
        before, after = found["time"][back[0] : back[0] + 2]
        raise RelayContactError(f"inputs: time = {after:g} s after {before:g} s: not allowed, times have to rise")
    return found


def simulated(scene: Scene, time: Array, component: Component, tell: Callable[[float], object]) -> Array:
    """Run a scene; return a row of time and outputs for each communication point."""
    with scene.started(component, time) as (contact, inputs):
        rows = [np.array([[0.0, *(contact.get(name) for name in scene.outputs)]])]
        for begin in range(0, len(time) - 1, SHOWN):
            part = slice(begin, begin + SHOWN + 1)
            own = contact.drive(time[part], {name: course[part] for name, course in inputs.items()}, scene.outputs)
            # The component has inputs as they were set, at the begin of a step.
            own |= {name: course[part][1:] for name, course in inputs.items()}
            rows.append(np.column_stack((time[part][1:], *(own[name] for name in scene.outputs))))
            tell(float(time[part][-1]))
    return np.concatenate(rows)
