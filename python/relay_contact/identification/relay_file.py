"""The relay's file with what was found: values, their uncertainties, and a spring file beside it."""

import math
import os
from pathlib import Path
from typing import Any

import numpy as np
import tomlkit
from tomlkit.container import OutOfOrderTableProxy
from tomlkit.items import InlineTable

from relay_contact.component import Component
from relay_contact.files import write_at_once
from relay_contact.identification.result import Found, Identification, has
from relay_contact.qualification.relay import TABLES
from relay_contact.schema import leaves
from relay_contact.spring import PREFIX, SPRING_FILES, STIFFNESS, text_of

MODULUS = "beam.youngsModulus"


def number(value: float, half: float) -> Any:  # noqa: ANN401
    """Give a value for a file, with two digits more than its interval."""
    text = f"{value:.{min(12, max(3, 2 - math.floor(math.log10(max(half, 1e-12)))))}g}"
    return tomlkit.value(text if set(text) & set(".e") else f"{text}.0")


def uncertainty(found: Found) -> Any:  # noqa: ANN401
    """Give the distribution of a parameter: a normal one, or a triangle where that goes beyond what is allowed."""
    room = found.unknown.start * math.exp(found.unknown.high) / found.value - 1
    # Four standard deviations; a triangle has the same standard deviation with 1.25 times the half of 95 %.
    if 2 * found.half < room:
        return number(found.half, 0.1)
    low, high = -min(1.25 * found.half, 0.99), max(0.0, min(1.25 * found.half, room))
    table = tomlkit.inline_table()
    table.update({"distribution": "triangular", "low": low, "mode": 0.0, "high": high})
    return table


def put(table: Any, name: str, item: Any, remark: str = "") -> None:  # noqa: ANN401
    """Set an entry of a table of a file by its dotted name, with a remark behind it."""
    if remark:
        item.comment(remark)
    path = [name] if name in table else name.split(".")
    for number, key in enumerate(path):
        if isinstance(table, InlineTable):
            # A remark would end the line of all of it.
            item.trivia.comment = ""
        if key not in table and isinstance(table, OutOfOrderTableProxy):
            # The lines of this table do not follow each other: to the first of them.
            table[tomlkit.key(path[number:])] = item
            return
        if key not in table and isinstance(table, InlineTable):
            for inner in reversed(path[number + 1 :]):
                item = tomlkit.inline_table().append(inner, item)
            table[key] = item
            return
        if key not in table:
            # Before remarks that belong to what follows.
            body = table.value.body
            last = max((place for place, (known, _) in enumerate(body) if known), default=-1) + 1
            rest, body[last:] = body[last:], []
            table.append(tomlkit.key(path[number:]), item)
            body.extend(rest)
            return
        if number == len(path) - 1:
            table[key] = item
        table = table[key]


def text(result: Identification, spring: str, folder: Path) -> str:
    """Give the text of the relay's file in a folder; `spring` is the name of the spring file there, if it has one."""
    content: Any = tomlkit.parse(result.path.read_text(encoding="utf-8-sig") + "\n")
    for name in ("parameters", "uncertainty"):
        if name not in content:
            content.append(name, tomlkit.table())
    # For the page of `qualify`, which would take these as known.
    exact = [label for label in result.missing if label.split(",")[0] not in result.relay.uncertainty]
    content["title"] = f"{result.relay.title}, identified{' but for ' if exact else ''}{', '.join(exact)}"
    tables = dict(zip(result.relay.positions, content.get("position", [{}]), strict=True))
    for each in result.found:
        name = each.unknown.name
        if not name.startswith(PREFIX):
            remark = f"identified, ± {100 * each.half:.2g} %; was {each.unknown.start:g}"
            own = [tables[place] for place in each.unknown.positions if has(tables[place], name)]
            whole = content if name.partition(".")[0] in TABLES else content["parameters"]
            for table in [place["parameters"] for place in own] or [whole]:
                put(table, name, number(each.value, each.half), remark)
        widest = max((other for other in result.found if other.unknown.name == name), key=lambda other: other.half)
        if name not in result.wider:
            put(content["uncertainty"], name, uncertainty(widest), "identified")
    names, matrix = correlations(result)
    content["correlation"] = tomlkit.table()
    content["correlation"]["names"] = names
    # With fewer digits strong correlations might not be possible together.
    content["correlation"]["matrix"] = [[round(each, 8) for each in row] for row in matrix]
    of_relay = [content, *tables.values()]
    for each in (*of_relay, *content.get("model", [])):
        for name, _, value in list(leaves(each.get("parameters", {}))):
            if name in SPRING_FILES and value:
                found = spring if name == "beam.file" and any(each is own for own in of_relay) else ""
                there = os.path.relpath((result.path.parent / str(value)).resolve(), folder.resolve())
                put(each["parameters"], name, tomlkit.item(found or Path(there).as_posix()))
    return tomlkit.dumps(content)


def correlations(result: Identification) -> tuple[list[str], list[list[float]]]:
    """Return names and coefficients of correlation of all that is uncertain; of one in several positions the first."""
    first: dict[str, int] = {}
    for place, name in enumerate([*(each.unknown.name for each in result.found), *result.others]):
        first.setdefault(name, place)
    chosen = list(first.values())
    matrix = result.whole[np.ix_(chosen, chosen)]
    matrix = (matrix + matrix.T) / 2
    np.fill_diagonal(matrix, 1.0)
    return list(first), np.clip(matrix, -1.0, 1.0).tolist()


def spring_text(result: Identification, component: Component) -> tuple[str, str]:
    """Give name and text of the spring file with what was found of it; nothing if the relay has none."""
    files = {str(values.get("beam.file", "")) for values in result.relay.positions.values()}
    if files == {""}:
        return "", ""
    # All positions have the same spring.
    file = Path(next(iter(files)))
    found = {each.unknown.name: each.value for each in result.found}
    # Segments without a modulus have that of the relay, which stays.
    modulus = found.get(MODULUS, result.relay.value(component, MODULUS)) if STIFFNESS in found else None
    entries = {name: value for name, value in found.items() if name.startswith(PREFIX)}
    return file.name, text_of(str(file), entries, modulus)


def write(folder: Path, result: Identification, component: Component) -> None:
    """Write both files."""
    name, spring = spring_text(result, component)
    if name:
        write_at_once(folder / name, spring)
    write_at_once(folder / f"{result.path.stem}.toml", text(result, name, folder))
