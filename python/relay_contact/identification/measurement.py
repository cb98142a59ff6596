"""Measurements as CSV files: the names of the columns tell what was measured, units in brackets in which unit.

    # position = coil energised
    travel [mm],force [cN]
    0.00,14.2
    0.05,15.1

Lines that begin with # may set the position of the coil, whether the contact is open or closed, the calibration of the
instrument, and any parameter of the component for this measurement; others are remarks.
"""

import difflib
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from relay_contact.component import Array, Component, Value, nearest
from relay_contact.figures import GRAVITY
from relay_contact.files import RelayContactError

FORCE, RINGDOWN, RESPONSE, CHATTER = "static force", "ring-down", "frequency response", "chatter level"
BOUNCE = "bounce"
MOVED = {"m": 1.0, "mm": 1e-3, "um": 1e-6, "nm": 1e-9}
TIMES = {"s": 1.0, "ms": 1e-3, "us": 1e-6}
ACCELERATIONS = {"m/s2": 1.0, "g": GRAVITY}
UNITS = {
    "travel": MOVED, "displacement": MOVED, "time": TIMES, "frequency": {"Hz": 1.0, "kHz": 1e3},
    "force": {"N": 1.0, "cN": 1e-2, "mN": 1e-3, "gf": 1e-3 * GRAVITY}, "velocity": {"m/s": 1.0, "mm/s": 1e-3},
    "acceleration": ACCELERATIONS, "level": ACCELERATIONS, "speed": {"m/s": 1.0, "mm/s": 1e-3}, "bounce": TIMES,
}  # fmt: skip
"""Columns, and their units in SI; the first is that of a column without one."""
MOTIONS = ("displacement", "velocity", "force")
KINDS = {
    FORCE: (("travel",), ("force",)),
    RINGDOWN: (("time",), MOTIONS),
    RESPONSE: (("frequency", "acceleration"), MOTIONS),
    CHATTER: (("frequency",), ("level",)),
    BOUNCE: (("speed",), ("bounce",)),
}
"""What is measured: over which columns, and one of which."""
RELATIVE = (RESPONSE, CHATTER, BOUNCE)
"""Kinds whose scatter is in proportion to the value."""
SIGNED = ("travel", "time", "force", "displacement", "velocity")
FEWEST = {FORCE: 5, RINGDOWN: 20, RESPONSE: 5, CHATTER: 5, BOUNCE: 5}


@dataclass(frozen=True)
class Measurement:
    """What a file holds, SI units."""

    path: Path
    kind: str
    over: Array
    """Travel (m) from the working position, time (s), frequency (Hz) or speed of closing (m/s)."""
    quantity: str
    unit: str
    """Of the quantity as it was measured."""
    values: Array
    acceleration: Array
    """Amplitude of the base (m/s2) of a frequency response, else empty."""
    position: str
    is_open: bool
    """Whether the contact was taken away from the spring."""
    calibration: float
    """Of the instrument: by which part its values may be wrong, all alike, with 95 % confidence."""
    settings: dict[str, Value] = field(default_factory=dict)
    """Parameters of the component."""

    @property
    def conditions(self) -> tuple[object, ...]:
        """Give all that a prediction depends on, beside the parameters of the component."""
        return self.kind, self.quantity, self.is_open, self.over.tobytes(), self.acceleration.tobytes()

    @property
    def name(self) -> str:
        """Give how it is called."""
        return f"{self.kind}, {self.path.name}"


@dataclass
class Reader:
    """A file on its way to a measurement."""

    path: Path
    line: int = 0

    def wrong(self, text: str) -> RelayContactError:
        """Give an error that names file and line."""
        return RelayContactError(f"{self.path}: line {self.line}: {text}")

    def lines(self) -> Iterator[str]:
        """Give the lines that are not empty."""
        for number, text in enumerate(self.path.read_text(encoding="utf-8-sig").splitlines(), 1):
            self.line = number
            if text.strip():
                yield text.strip()

    def column(self, text: str) -> tuple[str, str]:
        """Give name and unit of a column."""
        name, _, unit = (part.strip() for part in text.strip().partition("["))
        unit = unit.removesuffix("]").replace("µ", "u").replace("²", "2")
        if name not in UNITS:
            raise self.wrong(f"column {name}: unknown; there may be {', '.join(UNITS)}{nearest(name, UNITS)}")
        allowed = UNITS[name]
        if unit and unit not in (*allowed, "V"):
            raise self.wrong(f"column {name}: unit {unit}: not allowed, allowed is {', '.join(allowed)}")
        return name, unit or next(iter(allowed))

    def kind(self, names: list[str]) -> tuple[str, str]:
        """Give what was measured, and the column of its values."""
        for kind, (over, either) in KINDS.items():
            measured = [name for name in either if name in names]
            if measured and set(names) == {*over, measured[0]}:
                return kind, measured[0]
        known = "; ".join(f"{kind}: {', '.join(over)}, {' or '.join(each)}" for kind, (over, each) in KINDS.items())
        raise self.wrong(f"columns {', '.join(names)}: no measurement that is known; there are {known}")

    def row(self, text: str, separator: str, columns: list[tuple[str, str]]) -> list[float]:
        """Give the numbers of a row in SI units."""
        cells = text.split(separator)
        if len(cells) != len(columns):
            raise self.wrong(f"{len(cells)} values: not allowed, allowed is {len(columns)}, one in each column")
        numbers = []
        for cell, (name, unit) in zip(cells, columns, strict=True):
            try:
                number = float(cell.replace(",", "."))
            except ValueError as error:
                raise self.wrong(
                    f"column {name}: {cell.strip() or 'nothing'}: not allowed, allowed is a number"
                ) from error
            if not np.isfinite(number) or (name not in SIGNED and number <= 0):
                allowed = "a finite number" if name in SIGNED else f"more than 0 {unit}"
                raise self.wrong(f"column {name}: {cell.strip()} {unit}: not allowed, allowed is {allowed}")
            numbers.append(number * UNITS[name].get(unit, 1.0))
        return numbers


def read(path: Path, component: Component, positions: list[str]) -> Measurement:
    """Read a measurement of a relay with these positions of its coil."""
    reader = Reader(path)
    settings: dict[str, tuple[str, int]] = {}
    columns: list[tuple[str, str]] = []
    rows: list[list[float]] = []
    separator = ","
    try:
        for text in reader.lines():
            if text.startswith("#"):
                name, equals, value = (part.strip() for part in text[1:].partition("="))
                if equals:
                    settings[name] = value, reader.line
            elif not columns:
                separator = next((each for each in (";", "\t") if each in text), ",")
                columns = [reader.column(cell) for cell in text.split(separator)]
                kind, quantity = reader.kind([name for name, _ in columns])
                head = reader.line
            else:
                rows.append(reader.row(text, separator, columns))
                if kind == RINGDOWN:
                    at = [name for name, _ in columns].index("time")
                    if len(rows) > 1 and rows[-1][at] <= rows[-2][at]:
                        raise reader.wrong(f"column time: {rows[-1][at]:g} s: not allowed, allowed is a later one")
    except UnicodeDecodeError as error:
        raise RelayContactError(f"{path}: not a text in UTF-8: {error}") from error
    if not columns:
        raise reader.wrong("no line with the names of the columns")
    if len(rows) < FEWEST[kind]:
        raise reader.wrong(f"{len(rows)} rows: not allowed, allowed is {FEWEST[kind]} or more for a {kind}")
    table = dict(zip((name for name, _ in columns), np.array(rows).T, strict=True))
    units = dict(columns)
    for name, unit in units.items():
        if unit == "V" and not (kind == RINGDOWN and name == quantity):
            reader.line = head
            raise reader.wrong(f"column {name}: unit V: not allowed, allowed is {', '.join(UNITS[name])}")
    told = interpreted(reader, settings, component, positions)
    is_open = told.pop("contact", "closed" if quantity in ("force", "level") else "open") == "open"
    position, calibration = str(told.pop("position", positions[0])), float(told.pop("calibration", 0.0))
    if len(positions) > 1 and not is_open and "position" not in settings:
        reader.line = head
        raise reader.wrong(f"which position of the coil? A line before says so: # position = {' or '.join(positions)}")
    over = table[KINDS[kind][0][0]]
    return Measurement(
        path, kind, over, quantity, units[quantity], table[quantity], table.get("acceleration", np.array([])),
        position, is_open, calibration, told,
    )  # fmt: skip


def interpreted(
    reader: Reader, settings: dict[str, tuple[str, int]], component: Component, positions: list[str]
) -> dict[str, Value]:
    """Give the settings of a file by name, checked; those of the component among them."""
    own = {"position": positions, "contact": ["open", "closed"]}
    found: dict[str, Value] = {}
    for name, (text, line) in settings.items():
        reader.line = line
        if name in own:
            if text not in own[name]:
                raise reader.wrong(f"{name} = {text}: not allowed, allowed is {' or '.join(own[name])}")
            found[name] = text
        elif name == "calibration":
            try:
                found[name] = float(text)
            except ValueError:
                found[name] = -1.0
            if not 0 <= float(found[name]) <= 1:
                raise reader.wrong(f"calibration = {text}: not allowed, allowed is 0 to 1, as a part of the value")
        elif "." in name:
            try:
                name = component.settable(name)
                found[name] = component.read(name, text)
                component.number(name, found[name]) if component.variables[name].type != "String" else None
            except RelayContactError as error:
                raise reader.wrong(str(error)) from error
        # Anything else with an equals sign is a remark.
        elif near := difflib.get_close_matches(name, [*own, "calibration"], cutoff=0.75):
            raise reader.wrong(f"{name}: unknown; did you mean {near[0]}?")
    return found
