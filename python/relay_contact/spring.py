"""Entries of spring files by name, so that they can be varied as parameters are: each value is a factor.

`spring.segment.1.thickness` is an entry of the first segment of the moving contact's spring, `spring.mode.1.damping` of
its first mode. Without a number an entry is that of all: `spring.thickness` of every segment, as a strip is as thick as
its sheet; `spring.clamp_stiffness` and `spring.contact_position` are there once. `spring.stiffness` is the bending
stiffness of the whole, clamp included, whether the spring is a uniform section, segments or modes. With
`fixed.spring.` they are those of the spring that carries the fixed contact.
"""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from relay_contact.files import RelayContactError, digest, read_toml, write_at_once

PREFIX, FIXED = "spring.", "fixed.spring."
OF_FILES = {"beam.file": PREFIX, "fixed.file": FIXED}
"""Beginnings of the names of entries, by the parameters that name their files."""
BEGINNINGS = tuple(OF_FILES.values())
SPRING_FILES = tuple(OF_FILES)
MODULUS = "youngs_modulus"
WHOLE = "stiffness"
STIFFNESS = f"{PREFIX}{WHOLE}"
ENDS = ("", "_start", "_end")
RIGIDITY = {MODULUS: 1.0, "clamp_stiffness": 1.0, "frequency": 0.5, "compliance": -1.0, "parallel_compliance": -1.0}
"""Entries that change with the bending stiffness, with their power of it."""
TABLES = ("segment", "mass", "mode")

Place = tuple[Any, str]
"""A table of a spring file, and the key of an entry in it."""


def by_modes(path: Path) -> bool:
    """Return whether a file describes its spring by modes."""
    return "mode" in read_toml(path)


def is_entry(name: str) -> bool:
    """Return whether a name is that of an entry of a spring file."""
    return name.startswith(BEGINNINGS)


def entries(content: Any) -> dict[str, list[Place]]:  # noqa: ANN401
    """Return where the entries of a spring file are that can be varied, by name without its beginning."""
    found: dict[str, list[Place]] = {}

    def add(name: str, table: Any, key: str) -> None:  # noqa: ANN401
        found.setdefault(name, []).append((table, key))

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


def known(file: str, prefix: str = PREFIX) -> list[str]:
    """Return the names of what can be varied in a spring; without a file it is uniform, and a fixed contact rigid."""
    if not file:
        return [STIFFNESS] if prefix == PREFIX else []
    return [prefix + WHOLE, *(prefix + name for name in entries(read_toml(Path(file))))]


def known_of(values: Mapping[str, Any]) -> list[str]:
    """Return the names of all entries of the springs that parameters of the component name."""
    return [name for file, prefix in OF_FILES.items() for name in known(str(values.get(file, "")), prefix)]


def text_of(file: str, factors: Mapping[str, float], modulus: float | None = None, prefix: str = PREFIX) -> str:
    """Return the text of a spring file with entries multiplied by factors.

    Segments without Young's modulus get this one (Pa), if there is one.
    """
    # It takes longer to import than a short simulation, and few change a spring.
    import tomlkit

    content = tomlkit.parse(Path(file).read_text(encoding="utf-8-sig"))
    if modulus is not None:
        for segment in content.get("segment", []):
            segment.setdefault(MODULUS, modulus)
    places = entries(content)
    for name, factor in factors.items():
        if name == prefix + WHOLE:
            chosen = [(place, power) for key, power in RIGIDITY.items() for place in places.get(key, [])]
        else:
            chosen = [(place, 1.0) for place in places[name.removeprefix(prefix)]]
        for (table, key), power in chosen:
            table[key] = float(table[key]) * factor**power
    return tomlkit.dumps(content)


def applied(values: Mapping[str, Any], start: float, folder: Path) -> dict[str, Any]:
    """Return parameters of the component alone: those of entries of springs are in changed files in a folder.

    `start` is Young's modulus of the component (Pa), of all that has none of its own.
    """
    factors = {name: value for name, value in values.items() if is_entry(name)}
    own = {name: value for name, value in values.items() if name not in factors}
    allowed = known_of(own) if factors else []
    for name, value in factors.items():
        if name not in allowed:
            raise RelayContactError(f"{name}: no such entry; there are {', '.join(allowed)}")
        # That of a participation in another axis may be of either sign.
        signed = name.endswith(".participation")
        if isinstance(value, str) or not math.isfinite(value) or not (value > 0 or signed):
            raise RelayContactError(f"{name} = {value}: not allowed, allowed is a factor greater than 0")
    modulus = float(own.get("beam.youngsModulus", start))
    if STIFFNESS in factors and not (own.get("beam.file") and by_modes(Path(own["beam.file"]))):
        own["beam.youngsModulus"] = modulus * factors[STIFFNESS]
    for parameter, prefix in OF_FILES.items():
        mine = {name: value for name, value in factors.items() if name.startswith(prefix)}
        file = str(own.get(parameter, ""))
        # The moduli that the springs have in common are varied in one of them alone.
        shared = prefix == FIXED and bool({STIFFNESS, FIXED + WHOLE} & factors.keys())
        if file and (mine or shared):
            text = text_of(file, mine, modulus if shared else None, prefix)
            path = folder / f"spring-{digest(text.encode())}.toml"
            if not path.exists():
                write_at_once(path, text)
            own[parameter] = str(path)
    return own
