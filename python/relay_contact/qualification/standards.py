"""What standards ask of a contact, from files: sine sweeps, random vibration, shocks, and the interruptions allowed."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import AfterValidator, Field, ValidationInfo, field_validator
from pydantic.dataclasses import dataclass

from relay_contact.component import Array
from relay_contact.figures import GRAVITY as G
from relay_contact.files import HERE, RelayContactError, by_name, named
from relay_contact.schema import STRICT, Flag, Positive, Table, read, refused, within

BAND = (1.0, 1e4)
"""Frequencies (Hz) between which the response to a pulse is known."""
NARROWEST = 1.0
"""Band (Hz) that the response, known every 0.38 Hz, still resolves."""
PERIODS = 10
"""Of the lowest frequency in random vibration, at least: Rice's rate of crossings is one of many."""
ROUNDED = 0.05
"""Largest part by which a printed rms of two digits differs from the exact one."""

Frequency = Annotated[float, within(*BAND)]
Level = Annotated[float, Field(strict=True, gt=0, le=1e5)]
"""Acceleration (g), up to the largest that the component allows."""
Interruption = Annotated[float, within(0.0, 0.1)]
"""Length (s) of an interruption or a make that is allowed."""


def rising(frequencies: tuple[float, ...]) -> tuple[float, ...]:
    """Refuse frequencies (Hz) that do not rise, or a band that is too narrow."""
    if any(high <= low for low, high in pairwise(frequencies)) or frequencies[-1] - frequencies[0] < NARROWEST:
        raise ValueError(f"frequencies have to rise, by {NARROWEST:g} Hz or more from the first to the last")
    return frequencies


Breakpoint = tuple[Frequency, Positive]
"""Frequency (Hz) and density (g2/Hz)."""


def rising_density(breakpoints: tuple[Breakpoint, ...]) -> tuple[Breakpoint, ...]:
    """Refuse breakpoints whose frequencies do not rise."""
    rising(tuple(frequency for frequency, _ in breakpoints))
    return breakpoints


class Monitor(Table):
    """Voltage (V) and current (A) of a monitor, where they are not those of the standard."""

    voltage: Annotated[float, within(1e-6, 1e4)] | None = None
    current: Annotated[float, within(1e-9, 1e4)] | None = None


@dataclass(frozen=True, config=STRICT)
class Contacts:
    """Longest opening of a closed contact and closing of an open one (s), and the monitor (V, A)."""

    opening: Interruption
    false_make: Interruption
    voltage: Annotated[float, within(1e-6, 1e4)]
    current: Annotated[float, within(1e-9, 1e4)]
    clause: str
    verified: Flag

    def monitored(self, monitor: Monitor) -> "Contacts":
        """Return the limits with another monitor."""
        return replace(self, **monitor.model_dump(exclude_none=True))

    @property
    def threshold(self) -> float:
        """Resistance (Ohm) at which the contact has half of the monitor's voltage."""
        return self.voltage / self.current


@dataclass(frozen=True, config=STRICT)
class Test:
    """A test by its name and the clause that it comes from; `verified`: read in the standard's text."""

    name: Annotated[str, Field(min_length=1)]
    clause: str
    verified: Flag


@dataclass(frozen=True, config=STRICT)
class Sine(Test):
    """Sine sweep up and down: acceleration (g), double amplitude (m), frequencies (Hz), time (s)."""

    acceleration: Level
    double_amplitude: Annotated[float, Field(strict=True, gt=0, le=10)]
    frequencies: Annotated[tuple[Frequency, Frequency], AfterValidator(rising)]
    sweep_time: Annotated[float, Field(strict=True, gt=0, le=1e7)]

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


@dataclass(frozen=True, config=STRICT)
class Random(Test):
    """Gaussian acceleration: breakpoints of its density (Hz, g2/Hz), rms as the standard prints it (g), time (s)."""

    density: Annotated[tuple[Breakpoint, ...], Field(min_length=2), AfterValidator(rising_density)]
    rms: Positive
    duration: Annotated[float, Field(strict=True, gt=0, le=1e8)]

    @field_validator("rms")
    @classmethod
    def is_that_of_the_density(cls, rms: float, known: ValidationInfo) -> float:
        """Refuse another rms than that of the density."""
        if "density" in known.data and abs(rms - (own := overall(known.data["density"]))) > ROUNDED * own:
            raise ValueError(f"the density has {own:.4g} g rms, allowed are {100 * ROUNDED:g} % more or less")
        return rms

    @field_validator("duration")
    @classmethod
    def lasts_for_periods(cls, duration: float, known: ValidationInfo) -> float:
        """Refuse a time without enough periods."""
        least = PERIODS / known.data["density"][0][0] if "density" in known.data else 0.0
        if duration < least:
            raise ValueError(f"allowed are {PERIODS} periods of the lowest frequency or more, {least:g} s")
        return duration

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


def overall(breakpoints: tuple[Breakpoint, ...]) -> float:
    """Return the rms (g) of a density: the integral of straight lines on logarithmic scales, in closed form."""
    power = 0.0
    for (low, first), (high, last) in pairwise(breakpoints):
        octaves, slope = np.log(high / low), np.log(last / first) + np.log(high / low)
        power += low * first * octaves * (np.expm1(slope) / slope if slope else 1.0)
    return float(np.sqrt(power))


@dataclass(frozen=True, config=STRICT)
class Shock(Test):
    """Half sine: peak (g) and duration (s), which is at least ten steps of the response to a pulse."""

    acceleration: Level
    duration: Annotated[float, within(1e-4, 1.0)]

    def __str__(self) -> str:
        """Describe the level."""
        return f"half sine of {self.acceleration:.4g} g, {1e3 * self.duration:g} ms, both directions"


class Content(Table):
    """Contents of the file of a standard."""

    title: str | None = None
    contacts: Contacts
    sine: Annotated[list[Sine], Field(default_factory=list)]
    random: Annotated[list[Random], Field(default_factory=list)]
    shock: Annotated[list[Shock], Field(default_factory=list)]


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
        content = read(path, Content)
        seen: set[str] = set()
        for kind in ("sine", "random", "shock"):
            for number, test in enumerate(getattr(content, kind)):
                if test.name in seen:
                    raise refused(path, (kind, number, "name"), test.name, "given twice")
                seen.add(test.name)
        if not seen:
            raise RelayContactError(f"{path}: no tests; there may be [[sine]], [[random]] and [[shock]]")
        longest = max(content.contacts.opening, content.contacts.false_make)
        for number, shock in enumerate(content.shock):
            if shock.duration <= longest:
                text = f"allowed is more than the longest opening and closing in [contacts], {longest:g} s"
                raise refused(path, ("shock", number, "duration"), shock.duration, text)
        return cls(content.title or path.stem, content.contacts, (*content.sine, *content.random, *content.shock))


def standards() -> dict[str, Path]:
    """Give the files of the standards by name."""
    return by_name(HERE / "standards")
