"""Measured accelerations over time, from the files of measuring programs: channels by name, in SI units.

Text (CSV), MDF4 (`asammdf`), UFF58 (`pyuff`), TDMS (`npTDMS`) and MATLAB's `.mat`; each package is imported only for a
file of its kind (`pip install 'relay-contact[records]'`). The time is that of the file, its offset and unequal steps
included: nothing is resampled.
"""

import importlib
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from relay_contact import tables
from relay_contact.component import Array, nearest
from relay_contact.figures import three
from relay_contact.files import RelayContactError
from relay_contact.tables import ACCELERATIONS, TIMES, spelled

EQUAL = 1e-3
"""Part by which steps of time may differ from their median, as the digits of a file make them."""
COARSE = 4
"""Steps in a period below which a record may lack what shakes a resonance: the filter of a recorder passes up to two
fifths of its rate, and the resonance has a width. Straight lines leave 81 % there."""
ATTENUATED = 0.01  # part of a vibration, from which on it is told that straight lines take it off
SHORTEST = 1e-6  # s, of steps between samples of an acceleration
FEWEST = 9  # values: two periods of what is sampled four times in each
NAMED = 5  # channels that are named, of those that are not tested
GRAMS = re.compile("(?!.*acc).*(mass|weight|force|load)", re.IGNORECASE)
"""Names of channels whose g is the gram."""
LOOKED = 200  # lines of a text in which the names of its columns are sought
TIME = ("time", "t")
"""Names of the column, or of the variable, of time."""
MASTERS = ("nothing", "s", "angle", "distance", "index")
"""What channels of MDF are over, by its number: time, which is in s, or another."""


@dataclass(frozen=True)
class Record:
    """A channel: acceleration (m/s2) over the time of the file (s)."""

    path: Path
    channel: str
    time: Array
    acceleration: Array
    clock: str = "s"
    """Unit of time in the file, empty if it has none."""
    others: tuple[str, ...] = ()
    """Channels that are not tested, as they have another unit or none, are masses, or not over time."""
    overruled: str = ""
    """What is to be said of a unit given where the file has another; empty if nothing."""

    @property
    def notes(self) -> list[str]:
        """Return what has to be said of its time, and of what is beside it in the file."""
        steps = np.diff(self.time)
        usual = float(np.median(steps))
        told = [self.overruled] if self.overruled else []
        told += [] if self.clock else ["time without a unit, taken as s"]
        if usual < SHORTEST:
            told.append(f"steps of time of {three(1e6 * usual)} µs: is it in s?")
        if self.time[0]:
            told.append(f"time begins at {self.time[0]:.9g} s, which is kept")
        if np.abs(steps - usual).max() > EQUAL * usual:
            told.append(
                f"steps of time are unequal, {three(1e6 * steps.min())} to {three(1e6 * steps.max())} µs: each is used "
                "as it is"
            )
        if self.acceleration[0]:
            told.append(f"before the record the acceleration is its first value, {three(self.acceleration[0])} m/s²")
        if self.others:
            more = f" and {len(self.others) - NAMED} more" * (len(self.others) > NAMED)
            named = ", ".join(self.others[:NAMED])
            told.append(f"not tested, as no acceleration in g or m/s² over time: {named}{more}")
        return told

    @property
    def coarsest(self) -> float:
        """Return the largest step of its time (s)."""
        return float(np.diff(self.time).max())

    def kept(self, frequency: float) -> float:
        """Return the part of a vibration (Hz) that is left at least in straight lines between its values, or 0."""
        turn = frequency * self.coarsest
        return float(np.sinc(turn) ** 2) if COARSE * turn <= 1 else 0.0

    def sampled(self, resonance: float) -> list[str]:
        """Return what has to be said of its steps for a resonance (Hz)."""
        lost = 1 - self.kept(resonance)
        step, count = three(1e6 * self.coarsest), three(1 / (resonance * self.coarsest))
        told = f"steps of time of up to {step} µs, {count} in a period of the resonance at {three(resonance)} Hz: "
        if lost == 1:
            return [f"{told}fewer than {COARSE} do not show what excites it, and the test is not passed"]
        text = f"straight lines take up to {three(100 * lost)} % off a vibration there, and the interval begins lower"
        return [told + text] if lost > ATTENUATED else []


class Channel(NamedTuple):
    """A channel as a file has it."""

    name: str
    unit: str
    time: Any
    """None: by the rate."""
    values: Any
    """Or what gives them, where they are not read before."""
    clock: str = "s"
    """Unit of time, empty if the file has none."""
    invalid: Any = False
    """Which values the file marks as invalid."""


def read(path: Path, channel: str = "", unit: str = "", rate: float | None = None) -> list[Record]:
    """Return the accelerations of a file: of all channels in such a unit, or of the one asked for.

    `unit` is that of channels without one, `rate` (samples a second) that of a file without time.
    """
    if not path.is_file():
        raise RelayContactError(f"{path}: no such file; it has to be a record of acceleration")
    found = []
    names = []
    others = []
    for each in channels(path):
        if isinstance(each.values, np.ndarray) and not np.issubdtype(each.values.dtype, np.number):
            # Texts beside the record.
            continue
        name, own = each.name, each.unit
        names.append(name)
        known = spelled(own) or spelled(unit)
        is_other = known not in ACCELERATIONS or (spelled(own) != "m/s2" and GRAMS.match(name))
        if channel.lower() != name.lower() if channel else is_other:
            others += [] if channel else [f"{name} ({own or 'no unit'})"]
            continue
        if known not in ACCELERATIONS:
            text_ = f"unit {own or 'none'}: not allowed, allowed is {', '.join(ACCELERATIONS)}"
            raise RelayContactError(f"{path}: channel {name}: {text_}{'' if own else '; give the unit'}")
        overrules = spelled(own) and spelled(unit) not in ("", spelled(own))
        told = f"in {own}, as the file says, not in {unit}" if overrules else ""
        found.append(replace(checked(path, each, ACCELERATIONS[known], rate), overruled=told))
    if not found:
        there = f"there are {', '.join(names)}" if names else "there is none"
        if channel:
            raise RelayContactError(f"{path}: no channel {channel}; {there}{nearest(channel, names)}")
        there = f"there are {', '.join(others)}" if others else there
        raise RelayContactError(f"{path}: no channel with an acceleration in g or m/s2; {there}; a unit may be given")
    return [replace(each, others=tuple(others)) for each in found]


def channels(path: Path) -> Iterator[Channel]:
    """Read a file of any kind; what its package finds wrong is an error that names the file."""
    try:
        yield from READERS.get(path.suffix.lower(), text)(path)
    except RelayContactError:
        raise
    except Exception as error:
        raise RelayContactError(f"{path}: cannot be read: {error}") from error


def checked(path: Path, channel: Channel, factor: float, rate: float | None) -> Record:
    """Return a channel, `factor` its unit in SI, with values that are valid and differ, over a time that rises."""
    where, time, clock = f"{path}: channel {channel.name}", channel.time, spelled(channel.clock)
    given = channel.values() if callable(channel.values) else channel.values
    values = np.asarray(np.real(given), dtype=float) * factor
    if time is None or len(time) == 0:
        if rate is None:
            raise RelayContactError(
                f"{where}: no time, a column named {' or '.join(TIME)}; give the rate, in samples a second"
            )
        time, clock = np.arange(len(values)) / rate, "s"
    elif rate is not None:
        raise RelayContactError(f"{where}: a rate is given, and the file has a time")
    if clock and clock not in TIMES:
        raise RelayContactError(f"{where}: time in {clock}: not allowed, allowed is {', '.join(TIMES)}")
    time = np.asarray(time, dtype=float) * TIMES[clock or "s"]
    if len(values) != len(time) or len(values) < FEWEST:
        told = f"{len(values)} values for {len(time)} times"
        raise RelayContactError(f"{where}: {told}: not allowed, allowed are as many, {FEWEST} or more")
    for what, bad in (
        ("one that the file does not mark as invalid", np.broadcast_to(channel.invalid, values.shape)),
        ("a real number", np.imag(given) != 0),
        ("a finite number", ~(np.isfinite(values) & np.isfinite(time))),
        ("more than the time before", np.concatenate([[False], np.diff(time) <= 0])),
    ):
        if bad.any():
            at, count = int(bad.argmax()), int(bad.sum())
            first = f", the first of {count}" if count > 1 else ""
            told = f"value {at + 1}: {values[at]:g} at {time[at]:.9g} s{first}"
            raise RelayContactError(f"{where}: {told}: not allowed, allowed is {what}")
    if np.ptp(values) == 0:
        told = f"{values[0]:g} m/s2 all the time"
        another = "[[history]] in the file of a standard may name another channel"
        raise RelayContactError(f"{where}: {told}: not allowed, allowed are values that differ; {another}")
    return Record(path, channel.name, time, values, clock)


def text(path: Path) -> Iterator[Channel]:
    """Read columns of numbers: one named time, the others with their units; or acceleration alone."""
    lines = tables.decoded(path).splitlines()[:LOOKED]
    known: dict[str, Mapping[str, float]] = {}
    for line in lines:
        heads = [tables.parted(cell) for each in tables.SEPARATORS if each in line for cell in tables.split(line, each)]
        heads = heads or [tables.parted(line.strip(tables.BLANK))]
        if any(name in TIME for name, _ in heads) or any(unit in ACCELERATIONS for _, unit in heads):
            # The last such line: before it may stand the time of the measurement, `Time;12:30:00`.
            known = {name: TIMES if name in TIME else ACCELERATIONS for name, _ in heads if name} or known
    if not known:
        raise RelayContactError(f"{path}: no line with the names of the columns, such as: time [s],acceleration [g]")
    table = tables.read(path, known)
    if not table.rows:
        raise table.wrong("no row below the names of the columns")
    there = [name for name in table.units if name in TIME]
    if there:
        table.ascending(there[0])
    time, clock = (table[there[0]], table.units[there[0]] and "s") if there else (None, "s")
    for name, unit in table.units.items():
        if name not in TIME:
            # Words of others are not read.
            yield Channel(name, unit, time, partial(table.numbers, name), clock)


def asked(package: str, path: Path) -> Any:  # noqa: ANN401
    """Import a package for a file of its kind."""
    try:
        return importlib.import_module(package)
    except ImportError as error:
        needs = f"{path}: needs the package {package}: pip install 'relay-contact[records]'"
        raise RelayContactError(needs) from error


def mdf(path: Path) -> Iterator[Channel]:
    """Read a file of ASAM MDF."""
    with asked("asammdf", path).MDF(path) as file:
        for signal in file.iter_channels():
            time = signal.timestamps if signal.group_index in file.masters_db else None
            bits = signal.invalidation_bits
            bad = False if bits is None else np.asarray(bits)
            clock = MASTERS[signal.master_metadata[1]]
            yield Channel(signal.name, signal.unit, time, signal.samples, clock, bad)


def uff(path: Path) -> Iterator[Channel]:
    """Read the sets 58 of a universal file; those that are not over time are named by their number."""
    sets = asked("pyuff", path).UFF(str(path)).read_sets()
    for number, each in enumerate(sets if isinstance(sets, list) else [sets], 1):
        if each.get("type") == 58 and each["func_type"] != 1:
            yield Channel(f"set {number}", f"function type {each['func_type']:.0f}", None, None)
        elif each.get("type") == 58:
            unit = str(each.get("ordinate_axis_units_lab", "")).strip()
            name = str(each.get("id1", "")).strip()
            clock = str(each.get("abscissa_axis_units_lab", "")).strip().replace("NONE", "")
            name = name if name not in ("", "NONE") else f"set {number}"
            yield Channel(name, unit, each["x"], each["data"], clock or "s")


def tdms(path: Path) -> Iterator[Channel]:
    """Read a file of LabVIEW."""
    for group in asked("nptdms", path).TdmsFile.read(path).groups():
        for channel in group.channels():
            step, first = (channel.properties.get(f"wf_{name}", 0.0) for name in ("increment", "start_offset"))
            time = first + step * np.arange(len(channel)) if step else None
            unit = str(channel.properties.get("unit_string", ""))
            clock = str(channel.properties.get("wf_xunit_string", "")).strip()
            yield Channel(channel.name, unit, time, channel[:], clock or "s")


def mat(path: Path) -> Iterator[Channel]:
    """Read the vectors of MATLAB's workspace; one of them may be the time."""
    try:
        found = asked("scipy.io", path).loadmat(path)
    except NotImplementedError as error:
        raise RelayContactError(f"{path}: MATLAB 7.3: not allowed; save it with -v7") from error
    vectors = {name: np.ravel(value) for name, value in found.items()
               if isinstance(value, np.ndarray) and value.size == max(value.shape) > 1}  # fmt: skip
    time = next((value for name, value in vectors.items() if name.lower() in TIME), None)
    for name, value in vectors.items():
        if name.lower() not in TIME:
            yield Channel(name, "", time, value, "")
    for name, value in found.items():
        if isinstance(value, np.ndarray) and min(value.shape) > 1:
            # Which of its columns are what, nothing says.
            yield Channel(name, "a matrix", time, value, "")


READERS: dict[str, Callable[[Path], Iterator[Channel]]] = {
    ".mf4": mdf, ".mdf": mdf, ".uff": uff, ".unv": uff, ".tdms": tdms, ".mat": mat,
}  # fmt: skip
"""By the end of the name of a file; others are text."""
