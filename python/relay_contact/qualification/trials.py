"""The tests as the component runs them: steady vibration, and courses over time; levels that fail."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from threading import Lock

import numpy as np
from scipy.signal import find_peaks

from relay_contact.component import Array, Component, Contact, Values
from relay_contact.figures import GRAVITY as G
from relay_contact.many import side_by_side
from relay_contact.qualification.excitation import STEP, Breakpoint, Course, Random, Sine, overall, straight
from relay_contact.qualification.parts import CLOSED, CONTACT, OPEN, Part, Rest, at_rest, parts
from relay_contact.qualification.response import Response, stays
from relay_contact.qualification.standards import Contacts

RESOLUTION = 1e-4  # of levels
WATCHED = 10  # periods
SAMPLES = 64  # of the gap of an open first contact in a period: 0.1 % of its least value may be missed
PIECES = 16  # of a period of a rise, over each of which base.acceleration is linear
SUDDEN = 3.0  # factor of its level from which on a vibration may start suddenly: the contact does not fail
SHOWN = 400  # points of a course of force or gap

APART, BESIDE, TRIED = 0.01, 0.05, 9
"""Part by which a level that fails differs from linear theory, from which on the weakest frequency is sought with the
component; step of the search, as a part of the frequency, at most; frequencies tried before its last."""

# A long course, such as a record or random vibration, is simulated around its largest dips of force or gap.
SHORT = 0.25  # s, up to which a course is simulated as a whole
DIPS = 3
BEFORE, AFTER = 5e-3, 2e-3  # s, of a dip, at least
RECORD = 60.0  # s, of random vibration
SAMPLE = 2e-5  # s
SEED = 1
RANKS = 30  # dips of noise by which it is told what clipping does to the largest


INTERRUPTIONS = ("chatter.count", "chatter.totalInterruption", "chatter.longestInterruption")
MAKES = ("chatter.falseMakes", "chatter.totalFalseMake", "chatter.longestFalseMake")
OTHER_MAKES = ("second.falseMakes", "second.totalFalseMake", "second.longestFalseMake")

Lengths = dict[str, float]
"""Length (s) of the failures that count, by what failed; of a part that is held, of the steps in which it was left."""


@dataclass(frozen=True)
class Specimen:
    """The relay in a position of the coil, monitored as a standard asks, and one of its parts to judge."""

    component: Component
    values: Values
    contacts: Contacts
    response: Response
    """Of the part."""
    part: str = CONTACT

    @cached_property
    def rest(self) -> Rest:
        """What is judged, by the state at rest."""
        return at_rest(self.component, self.values)

    @cached_property
    def held(self) -> tuple[Part, ...]:
        """The parts beside the contacts."""
        return parts(self.component, self.values, self.rest)

    @property
    def is_open(self) -> bool:
        """Whether the first contact is open at rest."""
        return self.rest.is_open

    @property
    def lasting(self) -> float:
        """The shortest failure of the part (s): of one that is held, none."""
        if self.part != CONTACT:
            return 0.0
        return self.contacts.false_make if self.is_open else self.contacts.opening

    @cached_property
    def monitors(self) -> dict[str, tuple[str, str, str]]:
        """The outputs that count failures, add up and compare their lengths, by contact."""
        if self.is_open:
            return {OPEN: MAKES}
        second = self.values.get("effects.secondContact", False)
        return {CLOSED: INTERRUPTIONS} | ({OPEN: OTHER_MAKES} if second else {})

    @cached_property
    def names(self) -> list[str]:
        """What is observed, in the order of its columns: the contacts, and the parts that are held."""
        return [*self.monitors, *(part.name for part in self.held)]

    def own(self, lengths: Lengths) -> Lengths:
        """Return those failures that are of the part to judge."""
        names = self.monitors if self.part == CONTACT else [self.part]
        return {name: length for name, length in lengths.items() if name in names}

    @cached_property
    def sampled(self) -> bool:
        """Whether a gap or a force is known at the ends of steps alone, which have to be short then."""
        return self.is_open or any(not part.least for part in self.held)

    def start(self, values: Values) -> Contact:
        """Return the contacts at rest, with further parameters."""
        monitored = {
            "chatter.minimumDuration": self.contacts.opening,
            "second.minimumDuration": self.contacts.false_make,
            "chatter.resistanceThreshold": self.contacts.threshold,
        }
        return self.component.started({**monitored, **self.values, **values})

    @cached_property
    def watched(self) -> list[str]:
        """The outputs that tell force and gap, and what was left of them in a step."""
        least = ["step.minimumForce", "step.minimumGap"][: len(self.monitors)]
        first = ["contact.indentation"] if self.is_open else ["contact.force", "second.force", *least]
        return list(dict.fromkeys([*first, *self.watched_of_held]))

    @cached_property
    def watched_of_held(self) -> list[str]:
        """The outputs that tell what was left of the forces that hold parts."""
        return [name for part in self.held for name in ([part.least] if part.least else part.outputs)]

    def observed(self, rows: dict[str, Array]) -> Array:
        """Return columns of the force (N) of the closed contact less that of the open one, and what is left of each.

        Left are the least force of the closed contact in each step, and gap (m) of the open one, and the least forces
        that hold parts. Of an open first contact its gap at the end of a step stands for all.
        """
        held = [self.left(part, rows) for part in self.held]
        if self.is_open:
            apart = -rows["contact.indentation"]
            return np.column_stack((apart, apart, *held))
        own = [rows[name] for name in self.watched[: 2 + len(self.monitors)]]
        return np.column_stack((own[0] - own[1], *own[2:], *held))

    def left(self, part: Part, rows: dict[str, Array]) -> Array:
        """Return the force (N) that is left of a part in each step."""
        return np.maximum(rows[part.least] if part.least else part.force(rows), 0.0)

    def longest(self, contact: Contact) -> Lengths:
        """Return the longest failure so far, by contact."""
        return {name: contact.get(each[2]) for name, each in self.monitors.items() if contact.get(each[0])}

    def leaving(self, lengths: Array, rows: dict[str, Array]) -> Lengths:
        """Return how long parts were left, at the lengths (s) of the steps in which they were."""
        away = {part.name: float(lengths[self.left(part, rows) <= 0].sum()) for part in self.held}
        return {name: length for name, length in away.items() if length}


def threshold(
    fails: Callable[[float], Lengths], guess: float, failing: Lengths | None = None
) -> tuple[float, list[str]]:
    """Return a factor of a level that fails, just above one that does not, and what fails there.

    From a guess outwards, then by bisection; `failing` is what is known to fail at the guess itself.
    """
    low, high = guess / 1.01, guess if failing else guess * 1.01
    failed: Lengths = failing or {}
    while found := fails(low):
        low, high, failed = low / 1.1, low, found
        if low < 1e-3 * guess:
            return low, list(failed)
    while not failed and not (failed := fails(high)):
        low, high = high, high * 1.1
        if high > 1e3 * guess:
            return high, []
    while high > (1 + RESOLUTION) * low:
        middle = (low * high) ** 0.5
        if found := fails(middle):
            high, failed = middle, found
        else:
            low = middle
    return high, list(failed)


def steady(specimen: Specimen, frequency: float, amplitude: float, gently: bool) -> tuple[Lengths, list[float]]:
    """Vibrate until the start is forgotten; return the longest failures of contacts that still fail, and what is left.

    The length is the longest since the start of the vibration, what is left the least after it is forgotten. Gently:
    raised from rest.
    """
    sine: Values = {"effects.excitation": "Sine", "excitation.frequency": frequency, "excitation.amplitude": amplitude}
    periods = int(np.ceil(max(2.0, specimen.response.settling() * frequency)))
    with specimen.start(sine) as contact, contact.explained():
        time = 0.0
        if gently:
            contact.rise(frequency, amplitude, periods, PIECES)
            time = periods / frequency
        contact.step(time, periods / frequency)

        def totals() -> dict[str, float]:
            return {name: contact.get(total) for name, (_, total, _) in specimen.monitors.items()}

        before = totals()
        time += periods / frequency
        pieces = WATCHED * (SAMPLES if specimen.sampled else 1)
        step = 1 / frequency * WATCHED / pieces
        rows = contact.drive(time + step * np.arange(pieces + 1.0), {}, specimen.watched)
        left = specimen.observed(rows)[:, 1:]
        # Of failures that last long enough; also of one without an end.
        still = [name for name, total in totals().items() if total > before[name]]
        lengths = {name: length for name, length in specimen.longest(contact).items() if name in still}
        return lengths | specimen.leaving(np.full(pieces, step), rows), left.min(axis=0).tolist()


def sweep(
    specimen: Specimen, test: Sine, frequencies: Array, responses: list[Response]
) -> list[tuple[Lengths, list[float]]]:
    """Vibrate at frequencies (Hz) of a sweep; return what `steady` gives at each. The responses are of all parts."""
    least = [np.interp(frequencies, *response.sine(test, specimen.lasting)) for response in responses]

    def at(point: tuple[float, float]) -> tuple[Lengths, list[float]]:
        frequency, factor = point
        return steady(specimen, float(frequency), float(test.amplitude(np.array(frequency))), factor < SUDDEN)

    return side_by_side(at, list(zip(frequencies, np.min(least, axis=0), strict=True)))


def sine_threshold(
    specimen: Specimen, test: Sine, frequency: float, guess: float, failing: Lengths | None = None
) -> tuple[float, list[str]]:
    """Return the factor of the level that fails in steady vibration at a frequency (Hz), and what of the part."""
    amplitude = float(test.amplitude(np.array(frequency)))

    def fails(factor: float) -> Lengths:
        return specimen.own(steady(specimen, frequency, factor * amplitude, True)[0])

    return threshold(fails, guess, failing)


def sine_least(specimen: Specimen, test: Sine) -> tuple[float, float, list[str]]:
    """Return the frequency (Hz) of a sweep that fails at the least level, its factor of the level, and which contacts.

    That of linear theory, if the component fails there as expected, or the test has no other. Else steps from there to
    lower levels, then the vertex of a parabola: the resonance of a contact that is far from linear, or rubs, is
    elsewhere.
    """
    known, factors = specimen.response.sine(test, specimen.lasting)
    at = int(factors.argmin())
    first, guess = float(known[at]), float(factors[at])
    if test.steps:
        # The response is known beside it.
        first = min(test.steps, key=lambda each: abs(each - first))
    step = 1 + min(BESIDE, specimen.response.bandwidth(first) / first / 2)

    low, high = test.band

    def tried(place: float) -> tuple[float, float, list[str]]:
        frequency = first * step**place
        if not low <= frequency <= high:
            return frequency, np.inf, []
        return frequency, *sine_threshold(specimen, test, frequency, found[0.0][1] if found else guess)

    found: dict[float, tuple[float, float, list[str]]] = {}
    found[0.0] = tried(0.0)
    if len(known) > 1 and not test.steps and abs(found[0.0][1] / guess - 1) > APART:
        best = 0.0
        while beside := {best - 1, best + 1} - found.keys():
            found |= {place: tried(place) for place in beside}
            best = min(found, key=lambda place: found[place][1])
            if len(found) > TRIED:
                break
        else:
            below, middle, above = (found[best + each][1] for each in (-1, 0, 1))
            bent = below - 2 * middle + above
            if np.isfinite(bent) and bent > 0:
                vertex = best + (below - above) / (2 * bent)
                found[vertex] = tried(vertex)
    return min(found.values(), key=lambda each: each[1])


@dataclass(frozen=True)
class Piece:
    """A course, or what of it is around a dip, and the factor of its level that fails by linear theory."""

    course: Course
    guess: float
    begin: float
    """Time (s) of the whole course at which it begins."""

    def follow(self, specimen: Specimen, factor: float, points: int = 0) -> tuple[Lengths, Array]:
        """Run it at a factor of its level; return the longest failures, and rows of time (s) and what is observed.

        There are so many points at least, if any; of parts that are held always. A course that ends at 0 is observed
        until calm.
        """
        course = self.course
        values = {**course.generator, **({"excitation.amplitude": factor * course.acceleration.max()}
                                         if course.generator else {})}  # fmt: skip
        time, acceleration = course.time, factor * course.acceleration
        if not acceleration[-1]:
            end = max(3 * course.end, course.end + specimen.response.settling())
            time, acceleration = np.append(time, end), np.append(acceleration, 0.0)
        points = points or (1 if specimen.held else 0)
        if points:
            dense = np.linspace(0.0, min(3 * course.end, time[-1]), points + 1)
            if specimen.held and specimen.sampled:
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
            rows = contact.drive(time, course_, specimen.watched if points else [])
            lengths = specimen.longest(contact)
        if not points:
            return lengths, np.zeros((0, 0))
        taken = np.diff(time) > 0
        lengths |= specimen.leaving(np.diff(time)[taken], rows)
        return lengths, np.column_stack((time[1:][taken], specimen.observed(rows)))

    def threshold(self, specimen: Specimen, sign: float, failing: Lengths | None = None, guess: float = 0.0) -> (
        tuple[float, list[str]]
    ):  # fmt: skip
        """Return the factor of its level that fails with a sign, and what of the part."""

        def fails(factor: float) -> Lengths:
            return specimen.own(self.follow(specimen, sign * factor)[0])

        return threshold(fails, guess or self.guess, failing)


def pieces(specimen: Specimen, course: Course, sign: float, count: int = DIPS) -> list[Piece]:
    """Return a course as a whole if it is short, else what is around its largest dips, by linear theory."""
    response = specimen.response
    whole = course.padded(response.settling())
    change = sign * response.change(whole.sampled())
    level = stays(change, specimen.lasting)
    lead = whole.end - course.end
    if whole.end <= SHORT:
        return [Piece(whole, response.reserve / max(float(-level.min()), 1e-12), -lead)]
    before = 2 * max(response.settling(), BEFORE)
    found = []
    for _ in range(count):
        at = int(level.argmin())
        dip, now = float(-level[at]), STEP * at
        begin = max(now - before, 0.0)
        found.append(
            Piece(whole.part(begin, now + specimen.lasting + AFTER), response.reserve / max(dip, 1e-12), begin - lead)
        )
        level[max(0, at - round(before / STEP)) : at + round(before / STEP)] = np.inf
    return found


def noise(test: Random) -> tuple[Course, Course]:
    """Return a record of random acceleration as it is before and after clipping; the same for all positions."""
    with MAKING:
        return record(test.density, test.clipping, test.sines)


MAKING = Lock()
"""One position makes the record that all others wait for."""


@lru_cache(maxsize=1)
def record(
    density: tuple[Breakpoint, ...], clipping: float | None, sines: tuple[tuple[float, float], ...]
) -> tuple[Course, Course]:
    """Return a record of random acceleration as it is before and after clipping.

    It is the sum of sines a sixtieth of a Hz apart with normally distributed amplitudes, and of the sines of the test
    with any phases; between samples it is linear, for which the amplitudes are raised.
    """
    count = round(RECORD / SAMPLE)
    frequency: Array = np.fft.rfftfreq(count, SAMPLE).astype(np.float64)
    generator = np.random.default_rng(SEED)
    normal = generator.standard_normal((2, len(frequency)))
    amplitude = np.sqrt(G**2 * straight(density, frequency) / (4 * RECORD)) * (count * SAMPLE) / SAMPLE
    spectrum = amplitude * (normal[0] + 1j * normal[1])
    time = SAMPLE * np.arange(count)
    acceleration = np.fft.irfft(spectrum / np.sinc(frequency * SAMPLE) ** 2, count)
    most = G * overall(density) * (clipping or np.inf)
    tones = np.zeros(count)
    for (tone, level), phase in zip(sines, generator.uniform(0, 2 * np.pi, len(sines)), strict=True):
        tones += G * level / np.sinc(tone * SAMPLE) ** 2 * np.sin(2 * np.pi * tone * time + phase)
    return Course(time, acceleration + tones), Course(time, np.clip(acceleration, -most, most) + tones)


def middle_dip(specimen: Specimen, dips: list[Piece]) -> tuple[float, list[str], Piece]:
    """Return at which part of the level of linear theory the contacts fail, and which, in the middle of the dips.

    That is, of the largest dips of a record of noise, the one whose part is neither least nor greatest.
    """
    found = []
    for piece in dips:
        level, failed = piece.threshold(specimen, 1.0)
        found.append((level / piece.guess, failed, piece))
    return sorted(found, key=lambda each: each[0])[len(found) // 2]


def noise_dips(specimen: Specimen, test: Random) -> tuple[list[Piece], float]:
    """Return what is around the largest dips of a record of noise, and the part by which clipping raises the level."""
    free, clipped = noise(test)
    return pieces(specimen, clipped, 1.0), eased(specimen, test, free, clipped) if test.clipping else 1.0


def eased(specimen: Specimen, test: Random, free: Course, clipped: Course) -> float:
    """Return by which part clipping raises the level that fails in the time of a test.

    The largest dips of a record with and without it, by rank, are on a line, which is followed to the largest dip in
    the time of the test: where the contact resonates it has a slope near 1, as many clipped peaks make a dip, and where
    it follows the acceleration its slope is 0.
    """
    response = specimen.response
    apart = max(1, round(1 / response.moments(test)[1] / STEP))
    sizes = []
    for course in (free, clipped):
        change = -response.change(course.sampled())
        peaks, _ = find_peaks(change, distance=apart)
        sizes.append(np.sort(change[peaks])[-RANKS:])
    slope, _ = np.polyfit(sizes[0], sizes[1], 1)
    largest = response.reserve / response.random(test, 0.0)
    dip = sizes[1].mean() + float(np.clip(slope, 0.0, 1.0)) * (largest - sizes[0].mean())
    return float(max(largest / dip, 1.0))
