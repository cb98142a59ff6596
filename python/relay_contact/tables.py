"""Tables of numbers as measuring programs export them: columns by name, in SI units.

Before the line with the names of the columns there may be others; below it a line with their units. Between columns are
commas, semicolons or tabs; with the last two the decimal sign may be a comma. Further columns are passed over. Lines
that begin with # are remarks, and settings such as `# calibration = 0.01`, before the names also without #.
"""

import codecs
import csv
import difflib
import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from relay_contact.component import Array
from relay_contact.figures import GRAVITY
from relay_contact.files import RelayContactError

LENGTHS = {"m": 1.0, "mm": 1e-3, "um": 1e-6, "nm": 1e-9}
TIMES = {"s": 1.0, "ms": 1e-3, "us": 1e-6}
VELOCITIES = {"m/s": 1.0, "mm/s": 1e-3}
ACCELERATIONS = {"m/s2": 1.0, "g": GRAVITY}
FORCES = {"N": 1.0, "cN": 1e-2, "mN": 1e-3, "gf": 1e-3 * GRAVITY}
FREQUENCIES = {"Hz": 1.0, "kHz": 1e3}
RATIOS = {"1": 1.0, "%": 1e-2}
CURRENTS = {"A": 1.0, "mA": 1e-3}
SPELLINGS = {"\N{MICRO SIGN}": "u", "\N{GREEK SMALL LETTER MU}": "u", "\N{SUPERSCRIPT TWO}": "2", "^2": "2", "**2": "2"}
OTHERS = {"sec": "s", "msec": "ms", "usec": "us", "hz": "Hz", "khz": "kHz", "G": "g"}
"""Units as some programs write them."""
CELL = re.compile(r"(?P<name>.*?)\s*(?:[\[(](?P<bracket>[^\])]*)[\])]|\bin\s+(?P<word>\S+)|\s/\s*(?P<slash>\S+))?")
"""A name, with a unit as in `travel [mm]`, `travel (mm)`, `travel in mm`, `travel / mm` or `travel / (mm)`."""
SETTING = re.compile(r"(#*)([^=:]*)([=:])(.*)")
"""A remark, or a line before the columns, with a name and a text."""
SEPARATORS, BLANK = ";\t,", ' \t,;"'
ALIKE = 0.75  # of names, from which on one is taken for a slip in the other

Units = Mapping[str, Mapping[str, float]]
"""Columns that are known, with their units in SI; the first is that of a column without one."""


def decoded(path: Path) -> str:
    """Return the text of a file in UTF-8, UTF-16 or, where it is neither, Latin-1 as Windows has it."""
    data = path.read_bytes()
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return data.decode("utf-16", errors="replace")
    if b"\0" in data[:64]:
        # Without a mark at its begin: of a letter of ASCII one half is zero.
        return data.decode("utf-16-be" if data[:1] == b"\0" else "utf-16-le", errors="replace")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("cp1252", errors="replace")


def spelled(unit: str) -> str:
    """Return a unit as it is called here."""
    for sign, plain in SPELLINGS.items():
        unit = unit.replace(sign, plain)
    unit = unit.replace(" ", "").strip("[]()")
    return OTHERS.get(unit, unit)


def parted(cell: str, known: Collection[str] = ()) -> tuple[str, str]:
    """Return name and unit of the head of a column; the name as it is known, otherwise in small letters."""
    found = CELL.fullmatch(cell.strip())
    assert found  # Every text is a name.
    name, *units = (each or "" for each in found.group("name", "bracket", "word", "slash"))
    small = name.strip().lower()
    return next((each for each in known if each.lower() == small), small), spelled("".join(units))


@dataclass(frozen=True)
class Table:
    """Columns of a file that are known."""

    path: Path
    known: Units
    separator: str
    """Between the cells of a row."""
    head: int
    """Line of the names."""
    rows: dict[int, str]
    """By their lines."""
    settings: dict[str, tuple[str, int]]
    """Texts by name, with their lines."""
    remarks: dict[str, tuple[str, int]]
    """The same with a colon in place of the equals sign."""
    again: dict[str, int] = field(default_factory=dict)
    """Lines of those that were there before."""
    places: dict[str, int] = field(default_factory=dict)
    """Of the columns in a row, by name."""
    units: dict[str, str] = field(default_factory=dict)
    """In which the columns are written; checked when a column is asked for."""
    passed: list[str] = field(default_factory=list)
    """Names of further columns."""
    columns: dict[str, Array] = field(default_factory=dict)
    """Values of those that were asked for, in SI units."""

    def __getitem__(self, name: str) -> Array:
        """Return a column in SI units."""
        if name not in self.columns:
            self.columns[name] = self.numbers(name) * self.known[name][self.unit(name)]
        return self.columns[name]

    def unit(self, name: str) -> str:
        """Return the unit in which a column is written."""
        allowed = self.known[name]
        unit = self.units[name] or next(iter(allowed))
        if unit not in allowed:
            raise self.wrong(f"column {name}: unit {unit}: not allowed, allowed is {', '.join(allowed)}")
        return unit

    def cells(self, name: str) -> list[str]:
        """Return the cells of a column."""
        return [split(row, self.separator)[self.places[name]] for row in self.rows.values()]

    def numbers(self, name: str) -> Array:
        """Return the numbers of a column as they are written."""
        if not self.rows:
            return np.zeros(0)
        points = (row if self.separator == "," else row.replace(",", ".") for row in self.rows.values())
        try:
            values = np.loadtxt(points, delimiter=self.separator, usecols=self.places[name], comments=None, ndmin=1)
        except ValueError as error:
            # A cell in quotes, or one that is no number.
            cells = self.cells(name)
            for line, cell in zip(self.rows, cells, strict=True):
                if not is_number(cell):
                    text = f"column {name}: {cell or 'nothing'}: not allowed, allowed is a number"
                    raise self.wrong(text, line) from error
            values = np.array([cell.replace(",", ".") for cell in cells], dtype=float)
        self.refuse(name, ~np.isfinite(values), "a finite number")
        return values

    def refuse_two_signs(self) -> None:
        """Raise an error for the first cell with a comma where others have a decimal point, or the other way round."""
        # A comma that is no separator is in quotes.
        signs = '".' if self.separator == "," else ",."
        if not all(any(sign in row for row in self.rows.values()) for sign in signs):
            return
        seen: dict[str, tuple[int, int, str, str]] = {}
        for name, place in self.places.items():
            for line, cell in zip(self.rows, self.cells(name), strict=True):
                # With both it is no number.
                if ("," in cell) != ("." in cell):
                    seen.setdefault("," if "," in cell else ".", (line, place, name, cell))
        if len(seen) > 1:
            first, other = sorted(seen, key=lambda sign: seen[sign])
            line, _, name, cell = seen[other]
            text = f"column {name}: {cell}: not allowed, allowed is one decimal sign, here {first}"
            raise self.wrong(text, line)

    def refuse(self, name: str, bad: NDArray[np.bool_], allowed: str) -> None:
        """Raise an error for the first row of a column that is bad."""
        if bad.any():
            row = int(bad.argmax())
            text = f"column {name}: {self.cells(name)[row]} {self.unit(name)}: not allowed, allowed is {allowed}"
            raise self.wrong(text, list(self.rows)[row])

    def ascending(self, name: str) -> None:
        """Refuse a column that does not rise from row to row."""
        falls = np.concatenate([[False], np.diff(self[name]) <= 0])
        self.refuse(name, falls, "more than in the row before")

    def wrong(self, text: str, line: int | None = None) -> RelayContactError:
        """Return an error that names file and line, of the names of the columns unless another is given."""
        at = self.head if line is None else line
        return RelayContactError(f"{self.path}:{at}: {text}" if at else f"{self.path}: {text}")


def read(path: Path, known: Units) -> Table:
    """Read the columns of a file that are known."""
    lines = {number: line for number, line in enumerate(decoded(path).splitlines(), 1) if line.strip(BLANK)}
    head, separator = begin(lines, known)
    table = Table(path, known, separator, head, {}, {}, {})
    for number, text in lines.items():
        if number > head and not text.lstrip(BLANK).startswith("#"):
            table.rows[number] = text
        elif number != head and (found := SETTING.match(text.strip(BLANK))) and (found[1] or found[3] == "="):
            # Measuring programs write `name: text` of their own, without #.
            name, sign, value = (part.strip(BLANK) for part in found.groups()[1:])
            kept = table.settings if sign == "=" else table.remarks
            if name in kept:
                table.again[name] = number
            kept[name] = value, number
    if not head:
        raise table.wrong(f"no line with the names of the columns; there may be {', '.join(known)}")
    names = split(lines[head].lstrip(" #"), separator)
    name_columns(table, names)
    first = next(iter(table.rows), head)
    if below := units_below(split(table.rows.get(first, ""), separator), table):
        for name, unit in below.items():
            if table.units[name] not in ("", unit):
                text = f"column {name}: unit {unit}: not allowed, allowed is {table.units[name]}, as in its head"
                raise table.wrong(text, first)
        table.units.update(below)
        del table.rows[first]
    last = max(table.places.values())
    for number, text in table.rows.items():
        if '"' in text or not last <= text.count(separator) < len(names):
            cells = split(text, separator)
            filled = max((place + 1 for place, cell in enumerate(cells) if cell), default=0)
            if filled > len(names) or len(cells) <= last:
                more = "; decimal commas need semicolons or tabs between columns" if filled > len(names) else ""
                text = f"{filled} values: not allowed, allowed is {len(names)}, one in each column{more}"
                raise table.wrong(text, number)
    table.refuse_two_signs()
    return table


def split(text: str, separator: str) -> list[str]:
    """Return the cells of a line."""
    return [cell.strip() for cell in next(csv.reader([text], delimiter=separator), [])]


def begin(lines: Mapping[int, str], known: Units) -> tuple[int, str]:
    """Return the line with the most names of columns, and what is between them; the line 0 if there is none."""
    best, found = 0, (0, ",")
    for number, text in lines.items():
        small = text.lower()
        if not any(name.lower() in small for name in known):
            continue
        for separator in SEPARATORS:
            cells = split(text.lstrip(" #"), separator)
            count = sum(parted(cell, known)[0] in known for cell in cells) if len(cells) > 1 or len(known) == 1 else 0
            if count > best:
                best, found = count, (number, separator)
    return found


def name_columns(table: Table, cells: list[str]) -> None:
    """Keep the places and units of the columns that are known; a slip in a name is refused."""
    for place, (name, unit) in enumerate(parted(cell, table.known) for cell in cells):
        if name not in table.known:
            table.passed.append(name)
        elif name in table.places:
            raise table.wrong(f"column {name}: there twice: not allowed, allowed is once; rename one of them")
        else:
            table.places[name], table.units[name] = place, unit
    absent = [each for each in table.known if each not in table.places]
    for name in table.passed:
        if meant := difflib.get_close_matches(name, absent, n=1, cutoff=ALIKE):
            raise table.wrong(f"column {name}: unknown; did you mean {meant[0]}?")


def units_below(cells: list[str], table: Table) -> dict[str, str]:
    """Return the units by column if a row has them; nothing if it has a number that is no unit."""
    found = {name: spelled(cells[place]) for name, place in table.places.items() if place < len(cells)}
    if any(is_number(unit) and unit not in table.known[name] for name, unit in found.items()):
        return {}
    return {name: unit for name, unit in found.items() if unit}


def is_number(cell: str) -> bool:
    """Tell whether a cell is a number."""
    try:
        float(cell.replace(",", "."))
    except ValueError:
        return False
    # Python takes 1_0 for 10.
    return "_" not in cell
