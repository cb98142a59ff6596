"""Entries of spring files by name, so that they can be varied as parameters are: each value is a factor.

`spring.segment.1.thickness` is an entry of the first segment, `spring.mode.1.damping` of the first mode. Without a
number an entry is that of all: `spring.thickness` of every segment, as a strip is as thick as its sheet;
`spring.clamp_stiffness` and `spring.contact_position` are there once. `spring.stiffness` is the bending stiffness of
the whole, clamp included, whether the spring is a uniform section, segments or modes.
"""

import hashlib
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import tomlkit

from relay_contact.files import RelayContactError, read_toml

SPRING_FILES = ("beam.file", "fixed.file")
"""Parameters that name spring files."""
PREFIX = "spring."
STIFFNESS = f"{PREFIX}stiffness"
ENDS = ("", "_start", "_end")
RIGIDITY = {"youngs_modulus": 1.0, "clamp_stiffness": 1.0, "frequency": 0.5, "compliance": -1.0}
"""Entries that change with the bending stiffness, with their power of it."""
TABLES = ("segment", "mass", "mode")

Place = tuple[Any, str]
"""A table of a spring file, and the key of an entry in it."""


def entries(content: Any) -> dict[str, list[Place]]:  # noqa: ANN401
    """Give where the entries of a spring file are that can be varied, by name."""
    found: dict[str, list[Place]] = {}

    def add(name: str, table: Any, key: str) -> None:  # noqa: ANN401
        found.setdefault(PREFIX + name, []).append((table, key))

    for key, value in content.items():
        if isinstance(value, int | float):
            add(key, content, key)
    for kind in TABLES:
        for number, table in enumerate(content.get(kind, []), 1):
            for key in table:
                name = key.removesuffix("_start").removesuffix("_end")
                add(f"{kind}.{number}.{name}", table, key)
                if kind != "mass":
                    add(name, table, key)
    return found


def known(file: str) -> list[str]:
    """Give the names of what can be varied in a spring; `file` is empty for a uniform section."""
    return [STIFFNESS, *(entries(read_toml(Path(file))) if file else ())]


def text_of(file: str, factors: Mapping[str, float]) -> str:
    """Give the text of a spring file with entries multiplied by factors."""
    content = tomlkit.parse(Path(file).read_text(encoding="utf-8"))
    places = entries(content)
    for name, factor in factors.items():
        if name == STIFFNESS:
            chosen = [(place, power) for key, power in RIGIDITY.items() for place in places.get(PREFIX + key, [])]
        else:
            chosen = [(place, 1.0) for place in places[name]]
        for (table, key), power in chosen:
            table[key] = float(table[key]) * factor**power
    return tomlkit.dumps(content)


def applied(values: Mapping[str, Any], start: float, folder: Path) -> dict[str, Any]:
    """Give parameters of the component alone: those of entries of the spring are in a changed file in a folder.

    `start` is Young's modulus of the component (Pa), of all that has none of its own.
    """
    factors = {name: value for name, value in values.items() if name.startswith(PREFIX)}
    own = {name: value for name, value in values.items() if name not in factors}
    if not factors:
        return own
    file = str(own.get("beam.file", ""))
    for name, value in factors.items():
        if name not in known(file):
            raise RelayContactError(f"{name}: no such entry; there are {', '.join(known(file))}")
        # That of a participation in another axis may be of either sign.
        signed = name.endswith(".participation")
        if isinstance(value, str) or not math.isfinite(value) or not (value > 0 or signed):
            raise RelayContactError(f"{name} = {value}: not allowed, allowed is a factor greater than 0")
    if STIFFNESS in factors:
        own["beam.youngsModulus"] = float(own.get("beam.youngsModulus", start)) * factors[STIFFNESS]
    if file:
        text = text_of(file, factors)
        path = folder / f"spring-{hashlib.sha256(text.encode()).hexdigest()[:16]}.toml"
        path.write_text(text, encoding="utf-8")
        own["beam.file"] = str(path)
    return own
