"""The component under FMPy: its variables by name, and instances of it stepped by hand."""

import difflib
import re
import shutil
import sys
import warnings
import weakref
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from copy import copy
from ctypes import c_int, c_size_t, c_void_p
from dataclasses import dataclass
from functools import cache, cached_property, lru_cache
from numbers import Real
from pathlib import Path
from tempfile import mkdtemp
from typing import Any, Self, TypeVar
from zipfile import BadZipFile

import numpy as np
from fmpy import extract, fmi2, platform, read_model_description, supported_platforms
from fmpy.fmi1 import FMICallException
from numpy.typing import ArrayLike, NDArray

from relay_contact.files import RelayContactError, RelayContactWarning, fmu_path, shown
from relay_contact.spring import OF_FILES, applied, is_entry

DIFFERENCE = re.compile(r"\S*[/\\]\S*|\d[\d.e+-]*")
"""Paths and numbers, by which two warnings may differ that say the same."""
SIGNS = {"Ohm": "Ω", "mOhm": "mΩ", "um": "µm", "us": "µs", "degC": "°C", "m/s2": "m/s²", "kg/m3": "kg/m³",
         "kg.m2": "kg m²", "Ohm.m": "Ω m", "N/um": "N/µm", "1": ""}  # fmt: skip

KEPT: ContextVar[dict[str, str] | None] = ContextVar("warnings", default=None)
"""Where the first warning of each kind is kept, of what runs beside others too."""

SETTABLE = ("parameter", "input")
LARGEST_REAL = sys.float_info.max
FOLLOW = "relayContactFollow"

Given = TypeVar("Given")

Array = NDArray[np.float64]
Value = float | str
"""Value of a variable; a choice, such as that of effects.excitation, by its name; a file by its path."""
Values = Mapping[str, Value]


@contextmanager
def warnings_kept() -> Iterator[dict[str, str]]:
    """Give the first warning of each kind of what runs in this block, by its kind."""
    kept: dict[str, str] = {}
    before = KEPT.set(kept)
    try:
        yield kept
    finally:
        KEPT.reset(before)


def sine(frequency: float, amplitude: float, rise: float = 0.0) -> dict[str, Value]:
    """Return the parameters of a vibration (Hz, m/s2) that rises (s), or starts at once, which may open a contact."""
    return {
        "effects.excitation": "Sine", "excitation.frequency": frequency, "excitation.amplitude": amplitude,
        "excitation.riseTime": rise,
    }  # fmt: skip


def half_sine(amplitude: float, duration: float) -> dict[str, Value]:
    """Return the parameters of a shock (m/s2, s)."""
    return {"effects.excitation": "HalfSine", "excitation.amplitude": amplitude, "excitation.duration": duration}


def nearest(name: str, known: Iterable[str]) -> str:
    """Give the end of a message about an unknown name: what it may have been meant to be."""
    near = difflib.get_close_matches(name, list(known), n=1, cutoff=0.5)
    return f"; did you mean {near[0]}?" if near else ""


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


class FMU2Functions(fmi2.FMU2Slave):  # type: ignore[misc]
    """The functions of the library, which FMPy takes longer to look up than the component to initialise.

    Each instance has a copy.
    """

    @cached_property
    def follow(self) -> Any:  # noqa: ANN401
        """The function of the library, beside those of FMI, that does many communication steps."""
        follow, some = self.dll[FOLLOW], (c_void_p, c_size_t)
        follow.argtypes, follow.restype = (c_void_p, *some, *some, c_void_p, *some, c_void_p), c_int
        return follow

    def freeInstance(self) -> None:  # noqa: N802
        """Free the instance, not the library, which others have in common."""
        self.fmi2FreeInstance(self.component)


def choices(path: Path, variable: Any) -> dict[str, int]:  # noqa: ANN401
    """Return the numbers of the choices of a variable, by name; one that has none is refused."""
    if variable.type != "Enumeration":
        text = "a variant for other tools, whose choices are numbers: not allowed, allowed is RelayContact.fmu"
        raise RelayContactError(f"{path}: {text}")
    return {str(each.name): int(each.value) for each in variable.declaredType.items}


class Component:
    """The component as a file: its description, and the folder it is unpacked in."""

    def __init__(self, path: Path | str | None = None, folder: Path | None = None) -> None:
        """Unpack it, into a temporary folder if none is given, which is deleted together with this object."""
        self.path = Path(path) if path else fmu_path()
        if not self.path.is_file():
            raise RelayContactError(f"{self.path} is missing: build it with `cargo xtask fmu`")
        try:
            there = supported_platforms(str(self.path))
        except BadZipFile as error:
            raise RelayContactError(f"{self.path}: no component, or not the whole of it: {error}") from error
        if platform not in there:
            text = f"has libraries for {', '.join(there)} only, not for this machine ({platform})"
            raise RelayContactError(f"{self.path} {text}")
        self.description = read_model_description(str(self.path))
        self.variables = known = {variable.name: variable for variable in self.description.modelVariables}
        own = self.path
        self.choices = cache(lambda name: choices(own, known[name]))
        """The numbers of the choices of a variable, by name."""
        if folder is None:
            folder = Path(mkdtemp())
            weakref.finalize(self, shutil.rmtree, folder, ignore_errors=True)
        self.folder = Path(extract(self.path, folder, lambda name: not name.startswith("documentation/")))
        self.told: set[str] = set()
        self.idle: list[Reused] = []
        """Instances that no contact has at present."""

    @cached_property
    def functions(self) -> FMU2Functions:
        """The functions of the library, without an instance; it is loaded until this object is gone."""
        functions = FMU2Functions(
            guid=self.description.guid,
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            unzipDirectory=self.folder,
        )
        weakref.finalize(self, unload, functions, self.idle)
        return functions

    def warn(self, message: str) -> None:
        """Keep a warning, and tell it as a Python warning, once for all instances."""
        message = re.sub(r"^fmi2\w+: ", "", message)
        kind = DIFFERENCE.sub("", message)
        if (kept := KEPT.get()) is not None:
            kept.setdefault(kind, message)
        if kind not in self.told:
            self.told.add(kind)
            warnings.warn(message, RelayContactWarning, stacklevel=3)

    def name(self, name: str, meant: Collection[str] = ()) -> str:
        """Return the name of a variable, in which underscores may stand for dots.

        An unknown one is refused; `meant` are the causalities of those that it may have been meant to be, if not any.
        """
        known = self.variables
        dotted = name if name in known else name.replace("_", ".")
        if dotted not in known:
            near = [each for each, variable in known.items() if not meant or variable.causality in meant]
            raise RelayContactError(f"{name}: no such variable{nearest(dotted, near)}")
        return dotted

    def settable(self, name: str, kind: str = "") -> str:
        """Return the name of a parameter or an input, or of the one `kind` of them; another variable is refused."""
        name = self.name(name, [kind] if kind else SETTABLE)
        causality = self.variables[name].causality
        if causality not in SETTABLE:
            raise RelayContactError(f"{name}: an output, which cannot be set")
        if kind not in ("", causality):
            raise RelayContactError(f"{name}: not a{'n' * (kind == 'input')} {kind}, which are allowed here alone")
        return name

    def settables(self, values: Mapping[str, Given], kind: str = "") -> dict[str, Given]:
        """Return values by the names of parameters or inputs; one that is there twice, as a_b and a.b, is refused."""
        named: dict[str, Given] = {}
        for name, value in values.items():
            dotted = self.settable(name, kind)
            if dotted in named:
                raise RelayContactError(f"{dotted}: given twice, with dots and with underscores")
            named[dotted] = value
        return named

    def named(self, values: Mapping[str, Given]) -> dict[str, Given]:
        """Return the same with entries of spring files, which look for their file and its modulus by name."""
        entries = {name: value for name, value in values.items() if is_entry(name)}
        return self.settables({name: value for name, value in values.items() if name not in entries}) | entries

    def number(self, name: str, value: Value) -> float:
        """Return the number that stands for a value of a variable; a value of another type is refused."""
        kind = self.variables[name].type
        choices = self.choices(name) if kind == "Enumeration" else {}
        if isinstance(value, np.bool_ | np.floating):
            # Of a column of a table: a truth is no number there, and the largest number of single precision is smaller.
            value = value.item()
        if isinstance(value, str) and value in choices:
            return choices[value]
        # Not a text such as "0.6": whoever writes it may mean a unit, too.
        if isinstance(value, Real) and (kind == "Boolean" or not isinstance(value, bool)):
            if kind == "Real" and abs(value) <= LARGEST_REAL:
                return float(value)
            if kind != "Real" and abs(value) < 2**31 and value == int(value) and (kind != "Boolean" or value in (0, 1)):
                return int(value)
        if isinstance(value, str | bool):
            # The variant for other tools takes neither, and is refused here by its name.
            self.choices("effects.excitation")
        others = {"Boolean": "true, false", "Real": "a finite number"}
        allowed = ", ".join(choices) or others.get(kind, "a whole number")
        near = nearest(value, choices) if isinstance(value, str) else ""
        raise RelayContactError(f"{name} = {shown(value)}: not allowed, allowed is {allowed}{near}")

    def read(self, name: str, text: str) -> Value:
        """Read a value as people write it, such as 1e-3, true or Sine."""
        try:
            kind = self.variables[name].type
            return {"true": 1.0, "false": 0.0}.get(text, text) if kind == "Boolean" else float(text)
        except ValueError:
            return text

    def start(self, name: str) -> Value:
        """Give the start value of a variable."""
        variable = self.variables[name]
        match variable.type:
            case "Boolean":
                return bool(variable.start == "true")
            case "String":
                return str(variable.start or "")
            case "Enumeration":
                return self.numbered(name, variable.start)
            case _:
                return float(variable.start)

    def value(self, values: Values, name: str) -> float:
        """Return the number of a parameter among these, else its start value; an entry of a spring file is a factor."""
        return float(values.get(name, 1.0 if is_entry(name) else self.start(name)))

    def choice(self, values: Values, name: str) -> str:
        """Return the choice of a parameter among these, else its start value."""
        value = values.get(name, self.start(name))
        return value if isinstance(value, str) else self.numbered(name, value)

    def numbered(self, name: str, wanted: Value) -> str:
        """Return the choice of a number."""
        return next(each for each, number in self.choices(name).items() if number == int(wanted))

    def started(self, values: Values | None = None) -> "Contact":
        """Give an instance that is initialised with these parameters and inputs, at time 0.

        Entries of the spring file may be among them, as factors (`relay_contact.spring`).
        """
        contact = Contact(self)
        try:
            contact.begin(values or {})
        except BaseException:
            contact.give_back()
            raise
        return contact


class Reused:
    """An instance that one contact has after another; what it logs is told to the one that has it now."""

    def __init__(self, functions: FMU2Functions) -> None:
        """Instantiate the component."""
        self.log: Callable[[int, str], object] = silent

        def told(_environment: int, _instance: bytes, status: int, _category: bytes, message: bytes) -> None:
            # A format without arguments: FMI doubles these two.
            self.log(status, message.decode().replace("%%", "%").replace("##", "#"))

        # Not by FMPy's instantiate_fmu: its loggers share a single place, so that messages go to the last instance that
        # was made, and crash the process when that is gone.
        callbacks = fmi2.fmi2CallbackFunctions()
        callbacks.logger = fmi2.fmi2CallbackLoggerTYPE(told)
        self.fmu = copy(functions)
        self.fmu.instantiate(callbacks=callbacks)


def silent(_status: int, _message: str) -> None:
    """Tell nobody."""


def unload(functions: FMU2Functions, instances: list[Reused]) -> None:
    """Free the instances of a library, and the library."""
    for each in instances:
        each.fmu.freeInstance()
    functions.freeLibrary()


def default_component() -> Component:
    """Return the component that is used where none is given, which has told no warning yet.

    It is unpacked once for all runs, which takes as long as many of them; anew once its file has changed, or its folder
    is gone, as after a process forked from this one has ended.
    """
    path = fmu_path()
    changed = path.stat().st_mtime_ns if path.is_file() else 0
    component = unpacked(path, changed)
    if not component.folder.is_dir():
        unpacked.cache_clear()
        component = unpacked(path, changed)
    component.told.clear()
    return component


@lru_cache(maxsize=1)
def unpacked(path: Path, _changed: int) -> Component:
    """Unpack a component that was changed at a time (ns)."""
    return Component(path)


class Contact:
    """An instance of the component, its variables known by name, for a `with` block that gives it back."""

    def __init__(self, component: Component) -> None:
        """Take an instance that is idle, or a new one."""
        self.component = component
        self.messages: list[str] = []
        """Errors and warnings."""
        self.warnings: list[str] = []
        """Those messages that are warnings, whatever the status of the call that logged them."""
        self.told = 0
        self.changed_files: dict[str, str] = {}
        """Files of the user, which messages name, by the temporary ones with changed entries."""

        try:
            self.own = component.idle.pop()
        except IndexError:
            self.own = Reused(component.functions)
        self.own.log = self.keep
        self.fmu = self.own.fmu

    def keep(self, status: int, message: str) -> None:
        """Keep a message of the instance."""
        for temporary, own in self.changed_files.items():
            message = message.replace(temporary, own)
        self.messages.append(message)
        if status == fmi2.fmi2Warning:
            self.warnings.append(message)

    def give_back(self) -> None:
        """End the simulation, and leave the instance to others; one that has failed for good is freed."""
        if "fmu" not in vars(self):
            # It was given back before, and may be another's.
            return
        try:
            self.own.fmu.reset()
            usable = True
        except FMICallException:
            self.own.fmu.freeInstance()
            usable = False
        self.own.log = silent
        # What is called from now on would be called of another's.
        del self.fmu
        if usable:
            self.component.idle.append(self.own)

    def __enter__(self) -> Self:
        """Use the instance until the end of the block."""
        return self

    def __exit__(self, *_: object) -> None:
        """Give the instance back."""
        self.give_back()

    @contextmanager
    def explained(self) -> Iterator[None]:
        """Have what the component refuses raise an error with its message."""
        try:
            yield
        except FMICallException as error:
            # Without the functions of FMI that it was refused by.
            errors = [message.split(": ", 1)[-1] if message.startswith("fmi2") else message for message in self.messages
                      if message not in self.warnings]  # fmt: skip
            raise RelayContactError(" ".join(errors) or str(error)) from error

    def tell(self) -> None:
        """Tell the warnings that are new; not within the logger, from which nothing can be raised."""
        for message in self.warnings[self.told :]:
            self.component.warn(message)
        self.told = len(self.warnings)

    def references(self, *names: str) -> list[int]:
        """Give the numbers by which the component knows its variables."""
        return [self.component.variables[self.component.name(name)].valueReference for name in names]

    def set(self, name: str, value: Value) -> None:
        """Set a parameter or an input."""
        self.set_all({name: value})

    def set_all(self, values: Values) -> None:
        """Set parameters and inputs, those of a type in one call: each takes longer than what it sets."""
        by_type: dict[str, dict[int, Value]] = {}
        for given, value in values.items():
            name = self.component.name(given)
            variable = self.component.variables[name]
            kind = "Integer" if variable.type == "Enumeration" else variable.type
            if kind == "String" and not isinstance(value, str):
                raise RelayContactError(f"{name} = {shown(value)}: not allowed, allowed is a text")
            own = value if kind == "String" else self.component.number(name, value)
            by_type.setdefault(kind, {})[variable.valueReference] = own
        for kind, known in by_type.items():
            getattr(self.fmu, f"set{kind}")([*known], [*known.values()])

    def change(self, name: str, begin: float, end: float, length: float) -> None:
        """Have an input change linearly over the next step, of this length."""
        references = self.references(name)
        self.fmu.setReal(references, [begin])
        self.fmu.setRealInputDerivatives(references, [1], [(end - begin) / length])

    def drive(self, time: ArrayLike, courses: Mapping[str, ArrayLike], watched: Sequence[str] = ()) -> dict[str, Array]:
        """Have inputs follow straight lines between points of time, a communication step each.

        Return what is watched after each step. A time given twice is a jump; the first is that already reached. A call
        from Python takes longer than a step: here the component steps by itself, and Python is free for something else.
        """
        # Differences of times would be taken as numbers of their unit.
        times = np.ascontiguousarray(np.asarray(time).astype(np.float64, casting="same_kind", copy=False))
        if times.ndim != 1:
            raise RelayContactError(f"time of {times.ndim} dimensions: not allowed, allowed is one")
        given = np.zeros((len(times), len(courses)))
        for column, course in enumerate(courses.values()):
            given[:, column] = course
        inputs, outputs = (np.array(self.references(*names), dtype=np.uint32) for names in (courses, watched))
        if len(set(inputs)) < len(inputs):
            raise RelayContactError(f"{', '.join(courses)}: not allowed, allowed is each input once")
        rows = np.zeros((max(0, len(times) - 1), len(watched)))
        try:
            follow = self.fmu.follow
        except AttributeError as error:
            raise RelayContactError(f"{self.component.path} is older than this package: it has no {FOLLOW}") from error
        status = follow(
            self.fmu.component, times.ctypes.data, len(times), inputs.ctypes.data, len(inputs), given.ctypes.data,
            outputs.ctypes.data, len(outputs), rows.ctypes.data,
        )  # fmt: skip
        if status > fmi2.fmi2Warning:
            raise FMICallException(function=FOLLOW, status=status)
        self.tell()
        taken = np.count_nonzero(times[1:] != times[:-1])
        return {name: rows[:taken, column] for column, name in enumerate(watched)}

    def get(self, name: str) -> float:
        """Give the value of any variable that is no text, of an enumeration its number."""
        return self.every(name)[name]

    def every(self, *names: str) -> dict[str, float]:
        """Give such values of several variables by the names given, those of a type in one call."""
        variables = {name: self.component.variables[self.component.name(name)] for name in names}
        found = dict.fromkeys(names, 0.0)
        for kind in {variable.type for variable in variables.values()}:
            own = {name: each.valueReference for name, each in variables.items() if each.type == kind}
            if kind == "String":
                raise RelayContactError(f"{', '.join(own)}: a text, which is no output")
            read = getattr(self.fmu, f"get{'Integer' if kind == 'Enumeration' else kind}")
            found |= zip(own, map(float, read([*own.values()])), strict=True)
        return found

    def real(self, *names: str) -> list[float]:
        """Give the values of several real variables."""
        values: list[float] = self.fmu.getReal(self.references(*names))
        return values

    def rates(self, *names: str) -> list[float]:
        """Give the derivatives of several real outputs by time."""
        rates: list[float] = self.fmu.getRealOutputDerivatives(self.references(*names), [1] * len(names))
        return rates

    def initialise(self) -> None:
        """Go through the initialisation at time 0."""
        self.fmu.setupExperiment()
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def begin(self, values: Values) -> None:
        """Set parameters, inputs and entries of the spring file, and go through the initialisation."""
        start = self.component.value({}, "beam.youngsModulus")
        values = self.component.named(values)
        with self.explained():
            for parameter, prefix in OF_FILES.items():
                if parameter in values and any(name.startswith(prefix) for name in values):
                    # Its entries are changed only once the component has accepted it.
                    self.set(parameter, values[parameter])
            own = applied(values, start, self.component.folder)
            self.changed_files = {
                str(own[name]): str(values[name]) for name in OF_FILES if own.get(name) and own[name] != values[name]
            }
            self.set_all(own)
            self.initialise()
        self.tell()

    def begin_anew(self, values: Values) -> None:
        """Begin once more, with these parameters and inputs alone, which is faster than a new instance."""
        self.messages.clear()
        self.warnings.clear()
        self.told = 0
        self.fmu.reset()
        self.begin(values)

    def step(self, time: float, length: float) -> None:
        """Do a communication step."""
        self.fmu.doStep(currentCommunicationPoint=time, communicationStepSize=length)
        if len(self.warnings) > self.told:
            self.tell()
