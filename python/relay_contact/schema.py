"""Files in TOML against a schema; what is wrong is said with file, line, value, what is allowed, nearest name."""

import re
import tomllib
from bisect import bisect_left
from collections.abc import Container, Iterator, Mapping
from contextlib import contextmanager, nullcontext, suppress
from functools import cache
from pathlib import Path
from typing import Annotated, Any, TypeVar, get_args

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from relay_contact.component import Component, Contact, Value, Values, nearest
from relay_contact.files import RelayContactError, read_toml, shown
from relay_contact.spring import SPRING_FILES

STRICT = ConfigDict(extra="forbid")
"""No entries that the schema does not name."""
WORDS = {
    r"a (valid )?(dictionary|mapping).*": "a table",
    r"a valid (list|tuple)": "a list",
    "a valid boolean": "true or false",
    "valid ": "",
}
"""Of pydantic, and those for them in an error."""
SWITCHES = {
    "second.": ("effects.secondContact",), "parallel.": ("effects.parallelContact",), "fixed.": ("fixed.file",),
    "friction.": ("effects.friction", "Coulomb"), "tip.contactHeight": ("effects.friction", "Coulomb"),
    "contact.stiffness": ("effects.contactLaw", "Rough"), "beam.axialForce": ("effects.axialForce", "Prescribed"),
    "pusher.": ("effects.pusher", "Prescribed", "Armature"), "armature.": ("effects.pusher", "Armature"),
    "pusher.displacement": ("effects.pusher", "Prescribed"), "coil.relativeCurrent": ("effects.pusher", "Armature"),
    "second.minimumDuration": ("second.minimumDuration",),
    "excitation.": ("effects.excitation", "Sine", "LogSweep", "HalfSine", "Random"),
}  # fmt: skip
"""By the beginning of the names of parameters and inputs, the longest last: what they are not used without."""
SWITCHED = cache(lambda name: next((on for own, on in reversed(SWITCHES.items()) if name.startswith(own)), (name,)))
Place = tuple[str | int, ...]
"""Keys and indices from the top of a file to an entry."""
Model = TypeVar("Model")


def within(least: float, most: float) -> Any:  # noqa: ANN401
    """Return the condition of a number between two others, which are allowed."""
    return Field(strict=True, ge=least, le=most, allow_inf_nan=False)


Positive = Annotated[float, Field(strict=True, gt=0, allow_inf_nan=False)]
Share = Annotated[float, Field(strict=True, ge=0, lt=1)]
"""Part of a value."""
Nested = Annotated[dict[str, Any], Field(default_factory=dict)]
"""Values by dotted names, in tables within each other."""


class Table(BaseModel):
    """A table of a file."""

    model_config = STRICT | ConfigDict(frozen=True)


def read(path: Path, model: type[Model]) -> Model:
    """Return the contents of a file, checked; all that is wrong is one error."""
    content = read_toml(path)
    try:
        return TypeAdapter(model).validate_python(content)
    except ValidationError as errors:
        told = sorted({message(path, model, each) for each in errors.errors()})
        raise RelayContactError("\n".join(text for _, text in told)) from errors


def message(path: Path, model: Any, error: Any) -> tuple[int, str]:  # noqa: ANN401
    """Return the line of an error that pydantic found, and the error in words."""
    # Without the names of the types of which it may have one.
    place = tuple(each for each in error["loc"] if "[" not in str(each))
    match error["type"]:
        case "extra_forbidden" | "unexpected_keyword_argument":
            known = entries(model, place[:-1])
            what = f"{dotted(place)}: no such entry, allowed are {', '.join(known)}{nearest(str(place[-1]), known)}"
        case "missing":
            what = f"{dotted(place)}: missing"
        case kind:
            what = f"{dotted(place)} = {shown(error['input'])}: not allowed, {allowed(error)}"
            if kind == "list_type" and len(place) == 1 and isinstance(error["input"], dict):
                what += f", each of its entries under [[{dotted(place)}]]"
    at = line(path, place)
    return at, f"{path}:{at}: {what}"


def allowed(error: Any) -> str:  # noqa: ANN401
    """Return what is allowed in place of what pydantic found, in words."""
    text: str = error["msg"].removeprefix("Value error, ").replace("Input should be ", "allowed is ")
    for pattern, word in WORDS.items():
        text = re.sub(pattern, word, text)
    return text


def refused(path: Path, place: Place, value: Any, text: str) -> RelayContactError:  # noqa: ANN401
    """Return the error of an entry of a file; the text says why, or what is allowed."""
    return RelayContactError(f"{path}:{line(path, place)}: {dotted(place)} = {shown(value)}: not allowed, {text}")


def dotted(place: Place) -> str:
    """Return the name of an entry; those of lists are counted from 1."""
    return ".".join(str(each + 1) if isinstance(each, int) else each for each in place)


def entries(model: Any, place: Place) -> list[str]:  # noqa: ANN401
    """Return the names of the entries of a table."""
    for key in place:
        if isinstance(key, str):
            model = model.__pydantic_fields__[key].annotation
            while not hasattr(model, "__pydantic_fields__"):
                model = get_args(model)[0]
    return [field.alias or name for name, field in model.__pydantic_fields__.items()]


def line(path: Path, place: Place) -> int:
    """Return the line in which an entry begins, or what it is missing in: the first with which the file has it."""
    lines = path.read_text(encoding="utf-8-sig").split("\n")
    ends = [0]
    for end in range(1, len(lines) + 1):
        # An entry may have several lines.
        with suppress(tomllib.TOMLDecodeError):
            tomllib.loads("\n".join(lines[ends[-1] : end]))
            ends.append(end)

    def holds(end: int) -> bool:
        table: Any = tomllib.loads("\n".join(lines[:end]))
        with suppress(KeyError, IndexError, TypeError):
            for key in place:
                table = table[key]
            return True
        return False

    while not holds(len(lines)):
        place = place[:-1]
    return ends[max(bisect_left(ends, True, key=holds) - 1, 0)] + 1


@contextmanager
def at(path: Path, *place: str | int) -> Iterator[None]:
    """Add file and line of an entry to an error."""
    try:
        yield
    except RelayContactError as error:
        raise RelayContactError(f"{path}:{line(path, place)}: {error}") from error


def leaves(table: Mapping[str, Any], *above: str) -> Iterator[tuple[str, Place, Any]]:
    """Return dotted name, keys and value of each value in nested tables; an empty table or a distribution is one."""
    for key, value in table.items():
        keys = (*above, key)
        if isinstance(value, dict) and value and "distribution" not in value:
            yield from leaves(value, *keys)
        else:
            yield ".".join(keys), keys, value


def variables(
    path: Path, table: Mapping[str, Any], place: Place, component: Component | None, kind: str = "parameter",
    inputs: Container[str] = (),
) -> dict[str, Value]:  # fmt: skip
    """Return variables of one kind in a table of a file, by name, each accepted by the component, if there is one.

    `inputs` are allowed beside those of the kind. The path of a spring file is relative to the file.
    """
    values = {}
    with Contact(component) if component else nullcontext() as contact:
        for name, keys, value in leaves(table):
            if name in values:
                raise refused(path, (*place, *keys), value, "given twice")
            if name in SPRING_FILES and isinstance(value, str) and value:
                value = str(path.absolute().parent / value)
            if contact:
                with at(path, *place, *keys), contact.explained():
                    contact.set(exact(contact.component, name, "" if name in inputs else kind), value)
                if contact.component.variables[name].type == "Enumeration":
                    # By its name, whichever way it is given.
                    value = contact.component.choice({name: value}, name)
            values[name] = value
    return values


def lacking(component: Component, name: str, known: list[Values]) -> str:
    """Return what a parameter is not used without, if all of some sets of parameters lack it."""
    switch, *on = SWITCHED(name)
    if switch == name:
        return ""
    if any(component.choice(values, switch) in on if on else values.get(switch) for values in known):
        return ""
    return f"{switch} = {' or '.join(on)}" if on else switch


def exact(component: Component, name: str, kind: str) -> str:
    """Return the name of a variable of a kind; underscores for dots, as in Python, are refused."""
    known = component.settable(name, kind)
    if known != name:
        raise RelayContactError(f"{name}: no such variable; did you mean {known}?")
    return name
