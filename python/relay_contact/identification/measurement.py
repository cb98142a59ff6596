"""Measurements as CSV files: the names of the columns tell what was measured, units in brackets in which unit.

    # position = coil energised
    travel [mm],force [cN]
    0.00,14.2
    0.05,15.1

Lines that begin with # may set the position of the coil, whether the contact is open or closed, the calibration of the
instrument, and any parameter of the component for this measurement; others are remarks.
"""

import difflib
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from relay_contact.component import Array, Component, Value
from relay_contact.files import RelayContactError
from relay_contact.tables import ACCELERATIONS, FORCES, FREQUENCIES, LENGTHS, TIMES, VELOCITIES, Table, Units
from relay_contact.tables import read as read_table

FORCE, RINGDOWN, RESPONSE, CHATTER = "static force", "ring-down", "frequency response", "chatter level"
BOUNCE, FREQUENCY = "bounce", "frequency"
ANY = {"V": 1.0}
"""Unit of a sensor without calibration: the size of a ring-down is free."""
COLUMNS: Units = {
    "travel": LENGTHS, "overtravel": LENGTHS, "time": TIMES, "frequency": FREQUENCIES, "speed": VELOCITIES,
    "acceleration": ACCELERATIONS,
    "displacement": LENGTHS | ANY, "velocity": VELOCITIES | ANY, "force": FORCES | ANY, "level": ACCELERATIONS,
    "bounce": TIMES,
}  # fmt: skip
MOTIONS = ("displacement", "velocity", "force")
KINDS = {
    FORCE: (("travel",), ("force",)),
    FREQUENCY: (("overtravel",), ("frequency",)),
    RESPONSE: (("frequency", "acceleration"), MOTIONS),
    CHATTER: (("frequency",), ("level",)),
    BOUNCE: (("speed",), ("bounce",)),
    RINGDOWN: (("time",), MOTIONS),
}
"""What is measured: over which columns, and one of which. The first kind that a file has all columns of."""
RELATIVE = (FREQUENCY, RESPONSE, CHATTER, BOUNCE)
"""Kinds whose scatter is in proportion to the value."""
SIGNED = ("travel", "time", "force", "displacement", "velocity")
MOST = {"travel": 0.02, "overtravel": 0.01, "displacement": 0.02, "force": 100.0, "velocity": 100.0,
        "acceleration": 1e5, "level": 1e5, "speed": 10.0, "bounce": 0.1, "frequency": 1e6}  # fmt: skip
"""Sizes (SI) beyond those of any relay: a column has another unit than it says."""
OPPOSITE = -0.8  # correlation of travel and force below which one of them is reversed
FEWEST = {FORCE: 5, FREQUENCY: 5, RINGDOWN: 20, RESPONSE: 5, CHATTER: 5, BOUNCE: 5}


@dataclass(frozen=True)
class Measurement:
    """What a file holds, SI units."""

    path: Path
    kind: str
    over: Array
    """Travel (m) from the working position, overtravel (m), time (s), frequency (Hz) or speed of closing (m/s)."""
    quantity: str
    unit: str
    """Of the quantity as it was measured."""
    values: Array
    acceleration: Array = field(default_factory=lambda: np.zeros(0))
    """Amplitude of the base (m/s2) of a frequency response, else empty."""
    position: str = ""
    is_open: bool = False
    """Whether the contact was taken away from the spring."""
    calibration: float = 0.0
    """Of the instrument: by which part its values may be wrong, all alike, with 95 % confidence."""
    settings: dict[str, Value] = field(default_factory=dict)
    """Parameters of the component."""

    @property
    def conditions(self) -> tuple[object, ...]:
        """Return all that a prediction depends on, beside the parameters of the component."""
        return self.kind, self.quantity, self.is_open, self.over.tobytes(), self.acceleration.tobytes()

    @property
    def name(self) -> str:
        """Return how it is called."""
        return f"{self.kind}, {self.path.name}"


def read(path: Path, component: Component, positions: list[str], pushed: bool = False) -> Measurement:
    """Read a measurement of a relay with these positions of its coil; `pushed`: a pusher may touch its spring."""
    table = read_table(path, COLUMNS)
    kind, quantity = what(table)
    over = KINDS[kind][0]
    for name in (*over, quantity):
        sized(table, name, kind == RINGDOWN and name == quantity)
    if kind == RINGDOWN:
        table.ascending("time")
    if len(table.rows) < FEWEST[kind]:
        text = f"{len(table.rows)} rows: not allowed, allowed is {FEWEST[kind]} or more for a {kind}"
        raise table.wrong(text, [table.head, *table.rows][-1])
    for name in (over[0], quantity):
        if kind in (FORCE, RINGDOWN) and np.ptp(table[name]) == 0:
            raise table.wrong(f"column {name}: the same in all rows: not allowed, allowed are values that differ")
    if kind == FORCE:
        signs(table)
    told = interpreted(table, component, positions)
    presses = quantity in ("force", "level", "frequency")
    is_open = told.pop("contact", "closed" if presses else "open") == "open"
    if presses and is_open:
        text = f"contact = open: not allowed, allowed is closed for a {quantity}"
        raise table.wrong(text, table.settings["contact"][1])
    position, calibration = str(told.pop("position", positions[0])), float(told.pop("calibration", 0.0))
    if len(positions) > 1 and (pushed or not is_open) and "position" not in table.settings:
        raise table.wrong(f"which position of the coil? A line before says so: # position = {' or '.join(positions)}")
    acceleration = table["acceleration"] if "acceleration" in over else np.array([])
    return Measurement(
        path, kind, table[over[0]], quantity, table.unit(quantity), table[quantity], acceleration,
        position, is_open, calibration, told,
    )  # fmt: skip


def what(table: Table) -> tuple[str, str]:
    """Return what was measured, and the column of its values."""
    there = set(table.places)
    for kind, (over, either) in KINDS.items():
        measured = [name for name in either if name in there]
        if measured and set(over) <= there:
            if len(measured) > 1:
                raise table.wrong(f"columns {' and '.join(measured)}: not allowed, allowed is one; rename the other")
            return kind, measured[0]
    known = "; ".join(f"{kind}: {', '.join(over)}, {' or '.join(each)}" for kind, (over, each) in KINDS.items())
    names = ", ".join([*table.places, *table.passed])
    raise table.wrong(f"columns {names}: no measurement that is known; there are {known}")


def sized(table: Table, name: str, free: bool) -> None:
    """Refuse values of a column that no relay has; `free`: of any size."""
    unit, values = table.unit(name), table[name]
    if free:
        return
    if unit in ANY:
        allowed = ", ".join(each for each in COLUMNS[name] if each not in ANY)
        raise table.wrong(f"column {name}: unit {unit}: not allowed, allowed is {allowed}")
    if name not in SIGNED:
        table.refuse(name, values <= 0, f"more than 0 {unit}")
    if name in MOST:
        most = f"up to {MOST[name] / COLUMNS[name][unit]:g} {unit}; is the unit right, as in {name} [{unit}]?"
        table.refuse(name, np.abs(values) > MOST[name], most)


def signs(table: Table) -> None:
    """Refuse a static force of the wrong sign: it is compression, and travel presses."""
    travel, force = table["travel"], table["force"]
    if np.median(force) < 0:
        text = "negative in most rows: not allowed, allowed is compression as positive; change its sign"
        raise table.wrong(f"column force: {text}")
    if np.corrcoef(travel, force)[0, 1] < OPPOSITE:
        text = "the force falls as it rises: not allowed, allowed is travel that presses as positive; change its sign"
        raise table.wrong(f"column travel: {text}")


def interpreted(table: Table, component: Component, positions: list[str]) -> dict[str, Value]:
    """Return the settings of a file by name, checked; those of the component among them."""
    own = {"position": positions, "contact": ["open", "closed"]}
    found: dict[str, Value] = {}
    for name, (text, line) in table.remarks.items():
        setting = name if name in component.variables else name.lower()
        if setting in (*own, "calibration", *component.variables):
            raise table.wrong(f"{name}: {text}: not allowed, allowed is {setting} = {text}", line)
    for name, (text, line) in table.settings.items():
        if name in table.again and (name in (*own, "calibration") or name in component.variables):
            raise table.wrong(f"{name} = {text}: there twice: not allowed, allowed is once", table.again[name])
        if name in own:
            if text not in own[name]:
                raise table.wrong(f"{name} = {text}: not allowed, allowed is {' or '.join(own[name])}", line)
            found[name] = text
        elif name == "calibration":
            try:
                found[name] = float(text)
            except ValueError:
                found[name] = -1.0
            if not 0 <= float(found[name]) <= 1:
                allowed = "0 to 1, as a part of the value"
                raise table.wrong(f"calibration = {text}: not allowed, allowed is {allowed}", line)
        elif "." in name and " " not in name:
            try:
                name = component.settable(name)
                found[name] = component.read(name, text)
                component.number(name, found[name]) if component.variables[name].type != "String" else None
            except RelayContactError as error:
                raise table.wrong(str(error), line) from error
        # Anything else with an equals sign is a remark.
        elif near := difflib.get_close_matches(name.lower(), [*own, "calibration"], cutoff=0.75):
            raise table.wrong(f"{name}: unknown; did you mean {near[0]}?", line)
    return found
