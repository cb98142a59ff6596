"""What standards ask of a contact, from files: sine sweeps, random vibration, shocks, and the interruptions allowed."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from relay_contact.component import Array, nearest
from relay_contact.figures import GRAVITY as G
from relay_contact.files import HERE, RelayContactError, by_name, named, read_toml


@dataclass(frozen=True)
class Contacts:
    """Longest opening of a closed contact and closing of an open one (s), and the monitor (V, A)."""

    opening: float
    false_make: float
    voltage: float
    current: float
    clause: str
    verified: bool

    def monitored(self, monitor: Mapping[str, float]) -> "Contacts":
        """Give the limits with another monitor: its voltage (V) and current (A)."""
        return replace(self, voltage=monitor.get("voltage", self.voltage), current=monitor.get("current", self.current))

    @property
    def threshold(self) -> float:
        """Resistance (Ohm) at which the contact has half of the monitor's voltage."""
        return self.voltage / self.current


@dataclass(frozen=True)
class Test:
    """A test by its name and the clause that it comes from; `verified`: read in the standard's text."""

    name: str
    clause: str
    verified: bool


@dataclass(frozen=True)
class Sine(Test):
    """Sine sweep up and down: acceleration (g), double amplitude (m), frequencies (Hz), time (s)."""

    acceleration: float
    double_amplitude: float
    frequencies: tuple[float, float]
    sweep_time: float

    def amplitude(self, frequency: Array) -> Array:
        """Give the amplitude at frequencies (Hz), m/s2: limited by the displacement at low frequencies."""
        return np.minimum(G * self.acceleration, self.double_amplitude / 2 * (2 * np.pi * frequency) ** 2)

    @property
    def corner(self) -> float:
        """Frequency (Hz) from which on the acceleration limits."""
        return float(np.sqrt(2 * G * self.acceleration / self.double_amplitude) / (2 * np.pi))

    def __str__(self) -> str:
        """Describe the level."""
        low, high = self.frequencies
        return f"{self.acceleration:.4g} g or {1e3 * self.double_amplitude:g} mm, {low:g} to {high:g} Hz"


@dataclass(frozen=True)
class Random(Test):
    """Gaussian acceleration: breakpoints of its density (Hz, g2/Hz), rms as the standard prints it (g), time (s)."""

    density: tuple[tuple[float, float], ...]
    rms: float
    duration: float

    def spectrum(self, frequency: Array) -> Array:
        """Give the one-sided density at frequencies (Hz), (m/s2)2/Hz: straight lines on logarithmic scales."""
        corners, values = np.array(self.density).T
        inside = (frequency >= corners[0]) & (frequency <= corners[-1])
        lines = np.interp(np.log(np.maximum(frequency, 1e-9)), np.log(corners), np.log(values))
        return np.where(inside, G**2 * np.exp(lines), 0.0)

    def __str__(self) -> str:
        """Describe the level."""
        low, high = self.density[0][0], self.density[-1][0]
        return f"{self.rms:g} g rms, {low:g} to {high:g} Hz, {self.duration / 60:g} min"


@dataclass(frozen=True)
class Shock(Test):
    """Half sine: peak (g) and duration (s)."""

    acceleration: float
    duration: float

    def __str__(self) -> str:
        """Describe the level."""
        return f"half sine of {self.acceleration:.4g} g, {1e3 * self.duration:g} ms, both directions"


KINDS: dict[str, type[Sine] | type[Random] | type[Shock]] = {"sine": Sine, "random": Random, "shock": Shock}


@dataclass(frozen=True)
class Standard:
    """What a file of a standard holds."""

    title: str
    contacts: Contacts
    tests: tuple[Test, ...]

    @classmethod
    def read(cls, standard: str | Path) -> "Standard":
        """Read a standard by its name, such as "MIL-PRF-28776", or a file of one's own by its path."""
        path = named("standard", standard, standards())
        content = read_toml(path)
        tests = [made(kind, table, path) for name, kind in KINDS.items() for table in content.get(name, [])]
        contacts = made(Contacts, content.get("contacts", {}), path)
        if not tests:
            raise RelayContactError(f"{path}: no tests; there may be [[sine]], [[random]] and [[shock]]")
        return cls(content.get("title", path.stem), contacts, tuple(tests))


def standards() -> dict[str, Path]:
    """Give the files of the standards by name."""
    return by_name(HERE / "standards")


def made(kind: Any, table: dict[str, Any], path: Path) -> Any:  # noqa: ANN401
    """Make a test or the limits from a table of a file, which has to have all entries and no others."""
    fields = kind.__dataclass_fields__
    for name in table:
        if name not in fields:
            raise RelayContactError(f"{path}: {name}: unknown{nearest(name, fields)}")
    missing = [name for name in fields if name not in table]
    if missing:
        raise RelayContactError(f"{path}: {table.get('name', kind.__name__.lower())}: {', '.join(missing)} missing")
    lists = {name: each for name, each in table.items() if isinstance(each, list)}
    tuples = {name: tuple(map(tuple, each) if isinstance(each[0], list) else each) for name, each in lists.items()}
    return kind(**table | tuples)
