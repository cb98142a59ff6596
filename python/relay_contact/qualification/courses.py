"""Courses over time as the component runs them: pulses, records and noise, whole or around their largest dips."""

from dataclasses import dataclass, replace
from functools import lru_cache
from threading import Lock
from typing import Any

import numpy as np

from relay_contact.component import Array
from relay_contact.figures import GRAVITY as G
from relay_contact.qualification.excitation import (  # fmt: skip
    BAND,
    STEP,
    Breakpoint,
    Course,
    Random,
    Shock,
    Transient,
    overall,
    rounded,
    straight,
)
from relay_contact.qualification.level import RESOLUTION, Lengths, Tried, threshold
from relay_contact.qualification.response import FLIES, Response, fast, stays
from relay_contact.qualification.trials import APART, Specimen

# A long course, such as a record or random vibration, is simulated around its largest dips of force or gap.
SHORT = 0.25  # s, up to which a course is simulated as a whole
DIPS, MOST_DIPS = 3, 100
BEFORE, AFTER = 5e-3, 2e-3  # s, of a dip, at least
BENT = 5  # steps to either side, by which a dip is bent
RECORD = 60.0  # s, of random vibration
SAMPLE = 2e-5  # s
EVENLY = 8  # times at which its change is known in a period of its highest frequency
SEED = 1
RANKS = 30  # dips of noise by which it is told what clipping does to the largest


@dataclass(frozen=True)
class Piece:
    """A course, or what of it is around a dip, and the factor of its level that fails by linear theory."""

    course: Course
    guess: float
    begin: float
    """Time (s) of the whole course at which it begins."""
    longer: float = 0.0
    """Part of its level by which what fails is above a touch, by linear theory."""

    def follow(self, specimen: Specimen, factor: float, points: int = 0) -> tuple[Lengths, Array, float]:
        """Run it at a factor of its level; return the longest failures, rows of what is observed, `Specimen.ahead`.

        Their first column is the time (s); there are so many at least. A course that ends at 0 is observed until calm.
        """
        course = self.course
        values = {**course.generator, **({"excitation.amplitude": factor * course.acceleration.max()}
                                         if course.generator else {})}  # fmt: skip
        time, acceleration = course.time, factor * course.acceleration
        if not acceleration[-1]:
            end = max(3 * course.end, course.end + specimen.response.settling)
            time, acceleration = np.append(time, end), np.append(acceleration, 0.0)
        if course.generator and not specimen.sampled:
            # It needs no points to be exact.
            time = np.unique([0.0, course.end, time[-1]])
            acceleration = np.zeros(len(time))
        if points or specimen.sampled:
            dense = np.linspace(0.0, min(3 * course.end, time[-1]), points + 1)
            if specimen.sampled:
                every = STEP * np.arange(1, time[-1] / STEP)
                # Not beside points of the course that rounding alone sets apart.
                near = np.searchsorted(time, every - STEP / 4) < np.searchsorted(time, every + STEP / 4)
                dense = np.union1d(dense, every[~near])
            dense = np.setdiff1d(dense, time)
            at = np.searchsorted(time, dense)
            acceleration = np.insert(acceleration, at, np.interp(dense, time, acceleration))
            time = np.insert(time, at, dense)
        with specimen.start(values) as contact, contact.explained():
            course_ = {} if course.generator else {"base.acceleration": acceleration}
            rows = contact.drive(time, course_, specimen.watched)
            taken = np.diff(time) > 0
            lengths = specimen.longest(contact) | specimen.leaving(np.diff(time)[taken], rows)
            observed = specimen.observed(rows)
            ahead = specimen.ahead(contact, lengths, observed[:, 1:].min(axis=0), self.longer)
        return lengths, np.column_stack((time[1:][taken], observed)), ahead

    def tried(self, specimen: Specimen, sign: float) -> Tried:
        """Return what tells what of the part fails, by factors of its level, with a sign."""
        # Pulses that differ in level alone search the same.
        shape = tuple(self.course.generator.values()) or self.course
        peak = float(np.abs(self.course.acceleration).max())

        def tried(factor: float) -> tuple[Lengths, float]:
            level = sign * factor
            lengths, ahead = specimen.once((shape, rounded(level * peak)), lambda: self.follow(specimen, level)[::2])
            return specimen.own(lengths), ahead

        return tried

    def threshold(
        self, specimen: Specimen, sign: float, failing: Lengths | None = None, guess: float = 0.0
    ) -> tuple[float, list[str]]:
        """Return the factor of its level that fails with a sign, and what of the part."""
        return threshold(self.tried(specimen, sign), guess or self.guess, failing)


def pieces(specimen: Specimen, course: Course, sign: float, failing: float = 0.0) -> list[Piece]:
    """Return a course as a whole if it is short, else what is around its largest dips, by linear theory.

    Those apart from each other, or up to a hundred of all that fail at a factor of its level.
    """
    response, lasting = specimen.response, specimen.lasting
    whole = course if isinstance(course, Noise) else course.padded(response.settling)
    lead = whole.end - course.end

    def deepest(change: Array) -> tuple[float, float, int]:
        level = stays(change, lasting)
        at, last = int(level.argmin()), len(change) - 1
        dip = max(float(-level[at]), 1e-12)
        bent = change[max(at - BENT, 0)] - 2 * change[at] + change[min(at + BENT, last)]
        return dip, float(bent / (BENT * STEP) ** 2 * lasting**2 / 8 / dip), at

    if whole.end <= SHORT:
        dip, longer, _ = deepest(sign * response.moved(whole))
        return [Piece(whole, response.reserve / dip, -lead, longer)]
    before, since = 2 * max(response.settling, BEFORE), len(response.answer)
    if isinstance(course, Noise):
        level, step = course.change(response)
        level *= sign
        level[: round(before / step)] = np.inf
    else:
        level, step = stays(sign * response.moved(whole), lasting), STEP
    found: list[tuple[float, Piece]] = []
    if failing:
        # Far from linear theory a contact may fail some periods after a dip by it.
        count, most, around, after = MOST_DIPS, MOST_DIPS, AFTER, 2 * AFTER
    else:
        # Of noise some more, as a change that is known at fewer times may miss their depth by some per cent.
        count, most, around, after = 4 * DIPS if isinstance(course, Noise) else DIPS, DIPS, before, AFTER
    while len(found) < count:
        at = int(level.argmin())
        if failing and -level[at] * failing <= response.reserve:
            break
        first, last = (round((step * at + each) / STEP) for each in (-around / 2, around / 2 + lasting))
        time = STEP * np.arange(first - since, last)
        near = np.interp(time, whole.time, whole.acceleration, left=0.0, right=0.0)
        dip, longer, own = deepest(sign * response.change(near)[since : len(near)])
        now = STEP * (first + own)
        # Also of a course with steps longer than that, three points before the dip: it rises from the first.
        latest = max(0, np.searchsorted(whole.time, now, "right") - 3)
        begin = float(whole.time[min(np.searchsorted(whole.time, now - 0.8 * before), latest)])
        part = whole.part(begin, now + lasting + after, lasting)
        found.append((dip, Piece(part, response.reserve / dip, begin - lead, longer)))
        level[max(0, at - round(around / step)) : at + round(around / step)] = np.inf
    return [piece for _, piece in sorted(found, key=lambda each: -each[0])[:most]]


def further(specimen: Specimen, test: Transient | Random, level: float, linear: float) -> list[tuple[str, Piece]]:
    """Return what is around all dips that fail at a level by linear theory, by direction, the largest first.

    Where that is off, others than its largest may fail first: none where it is not, or far off, or of a pulse.
    """
    if isinstance(test, Shock) or not APART < level / linear - 1 < 1 / FLIES:
        return []
    course, ways = (noise(test)[1], {"": 1.0}) if isinstance(test, Random) else (test.course(), test.directions)
    found = [(way, each) for way, sign in ways.items() for each in pieces(specimen, course, sign, level)]
    return sorted(found, key=lambda each: each[1].guess)[:MOST_DIPS]


@dataclass(frozen=True, eq=False)
class Noise(Course):
    """A record of random acceleration, which might be repeated."""

    spectrum: Any = None
    """Its Fourier transform, straight between samples as it is, in parts of the number of samples; up to the frequency
    from which on it has nothing that a contact feels."""

    def change(self, response: Response) -> tuple[Array, float]:
        """Return the change of force or gap at even times by linear theory, and how far (s) these are apart."""
        frequency = np.arange(len(self.spectrum)) / RECORD
        count = fast(EVENLY * len(frequency))
        changed = self.spectrum * np.interp(frequency, response.frequency, response.transfer)
        return np.fft.irfft(changed, count, norm="forward"), RECORD / count


def noise(test: Random) -> tuple[Noise, Noise]:
    """Return a record of random acceleration as it is before and after clipping; the same for all positions."""
    with MAKING:
        return record(test.density, test.clipping, test.sines)


MAKING = Lock()
"""One position makes the record that all others wait for."""


@lru_cache(maxsize=1)
def record(
    density: tuple[Breakpoint, ...], clipping: float | None, sines: tuple[tuple[float, float], ...]
) -> tuple[Noise, Noise]:
    """Return a record of random acceleration as it is before and after clipping.

    It is the sum of sines a sixtieth of a Hz apart with normally distributed amplitudes, and of the sines of the test
    with any phases; between samples it is linear, for which the amplitudes are raised.
    """
    count = round(RECORD / SAMPLE)
    generator = np.random.default_rng(SEED)
    top = BAND[1] if clipping else max(density[-1][0], *(tone for tone, _ in sines), 0.0)
    lines = np.arange(int(top * RECORD) + 1) / RECORD
    real, imaginary = generator.standard_normal((2, count // 2 + 1))[:, : len(lines)]
    amplitude = np.sqrt(G**2 * straight(density, lines) / (4 * RECORD))
    known, between = amplitude * (real + 1j * imaginary), np.sinc(lines * SAMPLE) ** 2
    time = np.arange(float(count))
    time *= SAMPLE
    acceleration = np.fft.irfft(known / between, count, norm="forward")
    if not (clipping or sines):
        return (Noise(time, acceleration, spectrum=known),) * 2
    tones = np.zeros(count)
    for (tone, level), phase in zip(sines, generator.uniform(0, 2 * np.pi, len(sines)), strict=True):
        tones += G * level / np.sinc(tone * SAMPLE) ** 2 * np.sin(2 * np.pi * tone * time + phase)
    most = G * overall(density) * (clipping or np.inf)
    found = [
        Noise(time, course, spectrum=np.fft.rfft(course, norm="forward")[: len(lines)] * between)
        for course in (acceleration + tones, *([np.clip(acceleration, -most, most) + tones] if clipping else []))
    ]
    return found[0], found[-1]


def middle_dip(
    specimen: Specimen, test: Random, dips: list[Piece], enough: float = np.inf
) -> tuple[float, list[str], Piece]:
    """Return at which part of the level of linear theory the contacts fail, and which, in the middle of three dips.

    That is, of the largest dips of a record of noise, the one whose part is neither least nor greatest. Where linear
    theory is off, others may fail first: then the second to fail, in place of the second largest. None of them is
    tried where the first three fail from `enough` of linear theory on.
    """

    def sought(piece: Piece, part: float) -> tuple[float, list[str], Piece]:
        level, failed = piece.threshold(specimen, 1.0, guess=piece.guess * part)
        return level / piece.guess, failed, piece

    def fails(piece: Piece, part: float) -> bool:
        return bool(piece.tried(specimen, 1.0)(piece.guess * part)[0])

    one, other, third = dips
    found = sought(one, 1.0)
    weaker = fails(other, found[0])
    if fails(third, found[0]) == weaker:
        second = sought(other, found[0])
        found = second if fails(third, second[0]) == weaker else sought(third, second[0])
    least: list[tuple[float, list[str], Piece]] = []
    apart = 2 * max(specimen.response.settling, BEFORE)
    others = further(specimen, test, found[0] * other.guess, other.guess) if found[0] < enough else []
    for _, each in others:
        if len(least) < 2 or fails(each, least[-1][0] / each.guess * (1 - RESOLUTION)):
            part, failed, _ = sought(each, 1.0)
            # Of those that are the same failure the first.
            same = [known for known in least if abs(known[2].begin - each.begin) < apart]
            first = min([*same, (part * each.guess, failed, each)], key=lambda known: known[0])
            least = sorted([first, *(known for known in least if known not in same)], key=lambda known: known[0])[:2]
    if len(least) < 2:
        return found
    level, failed, piece = least[-1]
    return level / other.guess, failed, replace(piece, guess=other.guess)


def noise_dips(specimen: Specimen, test: Random) -> tuple[list[Piece], float]:
    """Return what is around the largest dips of a record of noise, and the part by which clipping raises the level."""
    free, clipped = noise(test)
    return pieces(specimen, clipped, 1.0), eased(specimen, test, free, clipped) if test.clipping else 1.0


def eased(specimen: Specimen, test: Random, free: Noise, clipped: Noise) -> float:
    """Return by which part clipping raises the level that fails in the time of a test.

    The largest dips of a record with and without it, by rank, are on a line, which is followed to the largest dip in
    the time of the test: where the contact resonates it has a slope near 1, as many clipped peaks make a dip, and where
    it follows the acceleration its slope is 0.
    """
    # It takes long to import.
    from scipy.signal import find_peaks

    response = specimen.response
    sizes = []
    for course in (free, clipped):
        change, step = course.change(response)
        peaks, _ = find_peaks(-change, distance=max(1, round(1 / response.moments(test)[1] / step)))
        sizes.append(np.sort(-change[peaks])[-RANKS:])
    slope, _ = np.polyfit(sizes[0], sizes[1], 1)
    largest = response.reserve / response.random(test, 0.0)
    dip = sizes[1].mean() + float(np.clip(slope, 0.0, 1.0)) * (largest - sizes[0].mean())
    return float(max(largest / dip, 1.0))
