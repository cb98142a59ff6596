"""What tests ask: base acceleration as steady sines, as noise, or as courses over time, with the numbers of a standard.

A test is one of three kinds, by how its margin is found: steady vibration over frequency (`Sine`), noise by the rate of
its largest dips (`Random`), and courses, which have a beginning and an end (`Shock`, `Spectrum`, `History`). A new test
of a standard is another course, or another entry of these.
"""

import dataclasses
import math
import re
from collections.abc import Mapping
from dataclasses import field, replace
from itertools import pairwise
from typing import Annotated, Any, ClassVar, Literal, get_args

import numpy as np
from pydantic import AfterValidator, BeforeValidator, Field, ValidationInfo, field_validator, model_validator
from pydantic.dataclasses import dataclass

from relay_contact.component import Array
from relay_contact.figures import GRAVITY as G
from relay_contact.figures import three
from relay_contact.qualification import synthesis
from relay_contact.records import Record
from relay_contact.schema import STRICT, Positive, within

BAND = (1.0, 1e4)
"""Frequencies (Hz) between which the response to a pulse is known."""
NARROWEST = 1.0
"""Band (Hz) that the response, known every 0.38 Hz, still resolves."""
PERIODS = 10
"""Of the lowest frequency in random vibration, at least: Rice's rate of crossings is one of many."""
ROUNDED = 0.05
"""Largest part by which a printed rms or velocity of two digits differs from the exact one."""
SLOPE = re.compile(r"([+-]?\d+(?:\.\d+)?) ?dB/oct(?:ave)?")
STEP = 1e-5  # s, of courses where they are sampled

Evidence = Literal["measured", "read in the standard", "read in a quotation", "from memory"]
"""Where the numbers of a test are from; the last is the weakest."""
LEVELS: tuple[Evidence, ...] = get_args(Evidence)

IDLE = ("sweep_time", "sweep_rate", "velocity_change")
"""Numbers that no verdict depends on."""

Frequency = Annotated[float, within(*BAND)]
LARGEST = 1e5
"""Acceleration (g) that the component allows."""
Level = Annotated[float, Field(strict=True, gt=0, le=LARGEST)]
WIDEST = 0.5  # m, of shakers for earthquakes


def possible(stroke: float) -> float:
    """Refuse a double amplitude (m) that no shaker has."""
    if stroke > WIDEST:
        raise ValueError(f"allowed is {WIDEST:g} m or less; is it meant in mm?")
    return stroke


Stroke = Annotated[float, Field(strict=True, gt=0), AfterValidator(possible)]


def rising(frequencies: tuple[float, ...]) -> tuple[float, ...]:
    """Refuse frequencies (Hz) that do not rise, or a band that is too narrow."""
    if any(high <= low for low, high in pairwise(frequencies)) or frequencies[-1] - frequencies[0] < NARROWEST:
        raise ValueError(f"frequencies have to rise, by {NARROWEST:g} Hz or more from the first to the last")
    return frequencies


Breakpoint = tuple[Frequency, Positive]
"""Frequency (Hz) and density (g2/Hz), or peak response (g)."""


def rising_points(points: tuple[Breakpoint, ...]) -> tuple[Breakpoint, ...]:
    """Refuse breakpoints whose frequencies do not rise."""
    rising(tuple(frequency for frequency, _ in points))
    return points


def sloped(points: Any) -> Any:  # noqa: ANN401
    """Return breakpoints whose densities are numbers: a text such as "3 dB/octave" is the slope to the next one.

    At the last breakpoint it is the slope from the one before. What is wrong is left for others to refuse.
    """
    try:
        known = [list(each) for each in points]
        # That at the end first: its slope comes from the left.
        for at in [*range(1, len(known)), *reversed(range(len(known) - 1))]:
            frequency, level = known[at]
            beside, other = known[at - 1 if at == len(known) - 1 else at + 1]
            slope = SLOPE.fullmatch(level) if isinstance(level, str) else None
            if slope and type(other) in (int, float):
                known[at][1] = float(other * 10 ** (float(slope[1]) * math.log2(frequency / beside) / 10))
    except (TypeError, ValueError, ArithmeticError):
        return points
    return known


def rounded(value: float) -> float:
    """Return a value equal to those that only rounding has set apart from it."""
    return float(f"{value:.12g}")


def straight(points: tuple[Breakpoint, ...], frequency: Array) -> Array:
    """Return values at frequencies (Hz): straight lines between breakpoints on logarithmic scales, 0 beyond them."""
    corners, values = np.array(points).T
    inside = (frequency >= corners[0]) & (frequency <= corners[-1])
    lines = np.interp(np.log(np.maximum(frequency, 1e-9)), np.log(corners), np.log(values))
    return np.where(inside, np.exp(lines), 0.0)


@dataclass(frozen=True, eq=False)
class Course:
    """Base acceleration (m/s2) over time (s): straight lines between points, a time given twice is a jump.

    A generator of the component, if one makes it, does so exactly; its level is `excitation.amplitude`.
    """

    time: Any
    acceleration: Any
    generator: dict[str, Any] = field(default_factory=dict)

    @property
    def end(self) -> float:
        """Return its last time, s."""
        return float(self.time[-1])

    def padded(self, calm: float) -> "Course":
        """Return a course that does not begin suddenly: before its begin it rises to its first acceleration.

        The rise takes twice the time (s) after which a vibration has decayed; a course that begins at 0 has none.
        """
        if self.generator or not self.acceleration[0] or self.time[1] == self.time[0]:
            return self
        return Course(
            np.concatenate(([0.0, 2 * calm], self.time + 3 * calm)),
            np.concatenate(([0.0, self.acceleration[0]], self.acceleration)),
        )

    def sampled(self) -> Array:
        """Return the acceleration at every step of the response to a pulse; of a jump, the mean of its ends."""
        time = STEP * np.arange(round(self.end / STEP) + 2)
        if (np.diff(self.time) > 0).all():
            return np.asarray(np.interp(time, self.time, self.acceleration, left=0.0, right=0.0))
        twice = np.interp([time - 1e-6 * STEP, time + 1e-6 * STEP], self.time, self.acceleration, left=0.0, right=0.0)
        return np.asarray(twice.mean(axis=0))

    def part(self, begin: float, end: float, lasting: float = 0.0) -> "Course":
        """Return what is from the time of a point to another time (s), its own points.

        It rises from 0 over a fifth of what is before the last of it, which lasts so long (s).
        """
        first, last = np.searchsorted(self.time, (begin, end))
        time, acceleration = self.time[first : last + 1], self.acceleration[first : last + 1]
        if not first:
            return Course(time - time[0], acceleration)
        since = np.minimum((time - time[0]) / (0.2 * (end - lasting - time[0])), 1.0)
        return Course(time - time[0], (1 - np.cos(np.pi * since)) / 2 * acceleration)


@dataclass(frozen=True, config=STRICT)
class Test:
    """A test by its name, the clause that its numbers come from, and where these were read.

    The evidence is that of all numbers, or of each by its name; in a file, the weakest where none is stated.
    """

    name: Annotated[str, Field(min_length=1)]
    clause: str
    evidence: Evidence | dict[str, Evidence]
    axis: str = field(default="", kw_only=True)
    """Of the base acceleration: `normal` to the contact, or one of the relay's file; without it each."""
    kind: ClassVar[str]

    @property
    def weakest_evidence(self) -> Evidence:
        """Return the weakest evidence of a number that a verdict depends on."""
        if isinstance(self.evidence, str):
            return self.evidence
        told = [level for name, level in self.evidence.items() if name not in IDLE]
        return max(told, key=LEVELS.index, default=LEVELS[-1])

    @model_validator(mode="before")
    @classmethod
    def is_the_weakest_unless_stated(cls, given: Any) -> Any:  # noqa: ANN401
        """Return the entries of a file with their evidence."""
        return {"evidence": LEVELS[-1], **given} if isinstance(given, dict) else given

    @model_validator(mode="after")
    def names_its_numbers(self) -> "Test":
        """Refuse the evidence of what is not an entry of the test."""
        if isinstance(self.evidence, dict):
            for name in self.evidence:
                if getattr(self, name, None) is None:
                    raise ValueError(f"evidence.{name}: not an entry of this test")
        return self


def evidence_told(evidence: Evidence | Mapping[str, Evidence]) -> str:
    """Return where each number was read, in words."""
    if isinstance(evidence, str):
        return evidence
    by_level = {level: [name for name, own in evidence.items() if own == level] for level in LEVELS}
    return "; ".join(f"{', '.join(names).replace('_', ' ')} {level}" for level, names in by_level.items() if names)


@dataclass(frozen=True, config=STRICT)
class Sine(Test):
    """Steady vibration of an acceleration (g), a double amplitude (m), or the lesser of both.

    Over `frequencies` it is swept up and down, in `sweep_time` (s) or at `sweep_rate` (octaves a minute); with `dwell`
    it stays at the resonance among them. `steps` are frequencies (Hz) at which it stays.
    """

    kind: ClassVar[str] = "sine"
    acceleration: Level | None = None
    double_amplitude: Stroke | None = None
    frequencies: Annotated[tuple[Frequency, Frequency], AfterValidator(rising)] | None = None
    sweep_time: Annotated[float, Field(strict=True, gt=0, le=1e7)] | None = None
    sweep_rate: Annotated[float, Field(strict=True, gt=0, le=1e3)] | None = None
    dwell: Annotated[bool, Field(strict=True)] = False
    steps: Annotated[tuple[Frequency, ...], Field(min_length=1)] | None = None

    @model_validator(mode="after")
    def is_whole(self) -> "Sine":
        """Refuse what does not fit together."""
        if self.acceleration is None and self.double_amplitude is None:
            raise ValueError("acceleration or double_amplitude: missing")
        if (self.frequencies is None) == (self.steps is None):
            raise ValueError("either frequencies or steps: one of them has to be there")
        timed = (self.sweep_time is not None) + (self.sweep_rate is not None)
        if timed != (self.frequencies is not None and not self.dwell):
            raise ValueError("a sweep over frequencies has one of sweep_time and sweep_rate, dwell and steps have none")
        high = self.band[1]
        if (level := float(self.amplitude(np.array(high))) / G) > LARGEST:
            text = f"double_amplitude: {level:.3g} g at {high:g} Hz: not allowed, allowed are {LARGEST:g} g or less"
            raise ValueError(text)
        return self

    def amplitude(self, frequency: Array) -> Array:
        """Return the amplitude at frequencies (Hz), m/s2: limited by the displacement at low frequencies."""
        constant = np.inf if self.acceleration is None else G * self.acceleration
        stroke = np.inf if self.double_amplitude is None else self.double_amplitude
        return np.minimum(constant, stroke / 2 * (2 * np.pi * frequency) ** 2)

    @property
    def corner(self) -> float:
        """Frequency (Hz) from which on the acceleration limits; 0 where the displacement does not."""
        if self.acceleration is None or self.double_amplitude is None:
            return 0.0
        return float(np.sqrt(2 * G * self.acceleration / self.double_amplitude) / (2 * np.pi))

    @property
    def band(self) -> tuple[float, float]:
        """Return the least and the greatest frequency, Hz."""
        own = self.frequencies or self.steps
        assert own
        return min(own), max(own)

    @property
    def rate(self) -> float:
        """Octaves a minute of the sweep."""
        low, high = self.band
        return self.sweep_rate or 2 * float(np.log2(high / low)) * 60 / (self.sweep_time or np.inf)

    def tried(self, frequency: Array, gain: Array) -> Array:
        """Return the frequencies (Hz) that it vibrates at, of a response with its gain at frequencies (Hz).

        Ends and corner of a sweep and the steps are as they are given: what a double amplitude limits grows with their
        square.
        """
        if self.steps:
            return np.unique(self.steps)
        low, high = self.band
        inside = (frequency > low) & (frequency < high)
        if self.dwell:
            return frequency[inside][[int(gain[inside].argmax())]]
        corner = [self.corner] if low < self.corner < high else []
        return np.sort(np.concatenate(([low, *corner, high], frequency[inside])))

    def __str__(self) -> str:
        """Describe the level."""
        stroke = f"{three(1e3 * self.double_amplitude)} mm peak to peak" if self.double_amplitude else ""
        level = " or ".join(each for each in (f"{three(self.acceleration)} g" if self.acceleration else "", stroke)
                            if each)  # fmt: skip
        low, high = self.band
        if self.steps:
            return f"{level}, {len(self.steps)} frequencies of {low:g} to {high:g} Hz"
        return f"{level}, {'resonance within ' if self.dwell else ''}{low:g} to {high:g} Hz"


@dataclass(frozen=True, config=STRICT)
class Random(Test):
    """Gaussian acceleration: breakpoints of its density (Hz, g2/Hz), rms as the standard prints it (g), time (s).

    `clipping` is the largest acceleration as a multiple of the rms; `sines` are tones (Hz, g) on it.
    """

    kind: ClassVar[str] = "random"
    density: Annotated[
        tuple[Breakpoint, ...], BeforeValidator(sloped), Field(min_length=2), AfterValidator(rising_points)
    ]
    rms: Positive
    duration: Annotated[float, Field(strict=True, gt=0, le=1e8)]
    clipping: Annotated[float, within(2.0, 10.0)] | None = None
    sines: tuple[tuple[Frequency, Level], ...] = ()

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

    @property
    def unit(self) -> "Random":
        """The test at a level of its own, the same for all that differ in their level alone."""
        # A tone has a level of its own.
        first = 1.0 if self.sines else self.density[0][1]
        density = tuple((frequency, rounded(own / first)) for frequency, own in self.density)
        return replace(self, name="noise", clause="", evidence=LEVELS[-1], density=density, rms=overall(density))

    def spectrum(self, frequency: Array) -> Array:
        """Return the one-sided density at frequencies (Hz), (m/s2)2/Hz: straight lines on logarithmic scales."""
        return G**2 * straight(self.density, frequency)

    def __str__(self) -> str:
        """Describe the level."""
        low, high = self.density[0][0], self.density[-1][0]
        clipped = f", clipped at {self.clipping:g} rms" if self.clipping else ""
        tones = f", with {len(self.sines)} sine{'s' * (len(self.sines) > 1)}" if self.sines else ""
        return f"{three(self.rms)} g rms, {low:g} to {high:g} Hz{tones}, {three(self.duration / 60)} min{clipped}"


def overall(breakpoints: tuple[Breakpoint, ...]) -> float:
    """Return the rms (g) of a density: the integral of straight lines on logarithmic scales, in closed form."""
    power = 0.0
    for (low, first), (high, last) in pairwise(breakpoints):
        octaves, slope = np.log(high / low), np.log(last / first) + np.log(high / low)
        power += low * first * octaves * (np.expm1(slope) / slope if slope else 1.0)
    return float(np.sqrt(power))


DIRECTIONS = {"closing": 1.0, "opening": -1.0}
"""Of the base acceleration on the first contact, with their signs."""


@dataclass(frozen=True, config=STRICT)
class Transient(Test):
    """A test that is a course over time."""

    def course(self) -> Course:
        """Return the base acceleration at the level of the test."""
        raise NotImplementedError

    @property
    def directions(self) -> dict[str, float]:
        """Return the directions that it is run in, by name, with their signs."""
        return DIRECTIONS


SHAPES: dict[str, tuple[tuple[float, ...], tuple[float, ...]]] = {
    "half sine": ((), ()),
    "terminal-peak sawtooth": ((0.0, 1.0, 1.0), (0.0, 1.0, 0.0)),
    "initial-peak sawtooth": ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0)),
    "trapezoid": ((0.0, 0.1, 0.9, 1.0), (0.0, 1.0, 1.0, 0.0)),
}
"""Times and accelerations of pulses, as parts of duration and peak; the trapezoid rises and falls in a tenth."""
AREAS = {shape: float(np.trapezoid(height, time)) for shape, (time, height) in SHAPES.items()} | {
    "half sine": 2 / np.pi
}
"""Changes of velocity, in parts of peak times duration."""


@dataclass(frozen=True, config=STRICT)
class Tolerance:
    """Parts by which peak and duration of a pulse may be larger or smaller."""

    peak: Annotated[float, within(0.0, 0.5)] = 0.0
    duration: Annotated[float, within(0.0, 0.5)] = 0.0


@dataclass(frozen=True, config=STRICT)
class Shock(Transient):
    """Pulse: peak (g) and duration (s), which is at least ten steps of the response to a pulse; its shape.

    `velocity_change` (m/s) is checked where the standard prints it.
    """

    kind: ClassVar[str] = "shock"
    acceleration: Level
    duration: Annotated[float, within(10 * STEP, 1.0)]
    shape: Literal["half sine", "terminal-peak sawtooth", "initial-peak sawtooth", "trapezoid"] = "half sine"
    velocity_change: Positive | None = None
    tolerance: Tolerance = Tolerance()

    @field_validator("velocity_change")
    @classmethod
    def is_that_of_the_pulse(cls, velocity: float | None, known: ValidationInfo) -> float | None:
        """Refuse another change of velocity than that of the pulse."""
        if velocity is not None and {"acceleration", "duration", "shape"} <= known.data.keys():
            own = AREAS[known.data["shape"]] * G * known.data["acceleration"] * known.data["duration"]
            if abs(velocity - own) > ROUNDED * own:
                raise ValueError(f"the pulse has {own:.4g} m/s, allowed are {100 * ROUNDED:g} % more or less")
        return velocity

    def course(self) -> Course:
        """Return the pulse."""
        if self.shape == "half sine":
            time = np.linspace(0.0, self.duration, max(10, round(self.duration / STEP)) + 1)
            generator = {"effects.excitation": "HalfSine", "excitation.duration": self.duration}
            height = np.sin(np.pi * time / self.duration)
            # Not what rounding leaves: only a pulse that has ended is observed until it is calm.
            height[-1] = 0.0
            return Course(time, G * self.acceleration * height, generator)
        time, height = (np.array(each) for each in SHAPES[self.shape])
        return Course(self.duration * time, G * self.acceleration * height)

    @property
    def corners(self) -> list["Shock"]:
        """Return the pulses at the ends of the tolerance."""
        return [
            replace(self, acceleration=self.acceleration * (1 + up * self.tolerance.peak), velocity_change=None,
                    duration=self.duration * (1 + longer * self.tolerance.duration), tolerance=Tolerance())
            for up in (-1, 1) for longer in (-1, 1)
        ]  # fmt: skip

    def __str__(self) -> str:
        """Describe the level."""
        return f"{self.shape} of {three(self.acceleration)} g, {three(1e3 * self.duration)} ms, both directions"


@dataclass(frozen=True, config=STRICT)
class Spectrum(Transient):
    """Shock response spectrum: breakpoints of the peak response (Hz, g) of oscillators with a quality factor.

    The pulse that meets it is a sum of damped sines (`relay_contact.qualification.synthesis`).
    """

    kind: ClassVar[str] = "spectrum"
    response: Annotated[tuple[Breakpoint, ...], Field(min_length=2), AfterValidator(rising_points)]
    quality: Annotated[float, within(1.0, 100.0)] = 10.0

    def course(self) -> Course:
        """Return the pulse."""
        return Course(*synthesis.pulse(self.response, self.quality))

    def __str__(self) -> str:
        """Describe the level."""
        low, high = self.response[0][0], self.response[-1][0]
        most = max(level for _, level in self.response)
        return f"response of up to {three(most)} g, {low:g} to {high:g} Hz, Q = {self.quality:g}, both directions"


@dataclasses.dataclass(frozen=True)
class History(Transient):
    """A measured record: its own time is kept, and nothing is resampled for the component."""

    kind: ClassVar[str] = "history"
    record: Record = dataclasses.field(repr=False, compare=False)
    both: bool
    """Whether it is also run reversed."""
    digest: str
    """Of the record."""

    def course(self) -> Course:
        """Return the record, from time 0 on."""
        return Course(self.record.time - self.record.time[0], self.record.acceleration)

    @property
    def directions(self) -> dict[str, float]:
        """Return the directions that it is run in."""
        return {"as recorded": 1.0} | ({"reversed": -1.0} if self.both else {})

    def __str__(self) -> str:
        """Describe the level."""
        rms = float(np.sqrt(np.mean(self.record.acceleration**2))) / G
        peak = float(np.abs(self.record.acceleration).max()) / G
        return f"record of {three(self.course().end)} s, {three(rms)} g rms, peak {three(peak)} g"
