"""The tests as the component runs them: steady vibration, and courses over time."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, cached_property, lru_cache, partial
from threading import Lock
from typing import Any, NamedTuple

import numpy as np

from relay_contact.component import Array, Component, Contact, Values, sine
from relay_contact.figures import GRAVITY as G
from relay_contact.many import side_by_side
from relay_contact.qualification.excitation import BAND, STEP, Breakpoint, Course, Random, Sine, overall, straight
from relay_contact.qualification.level import MOST, Lengths, Tried, threshold
from relay_contact.qualification.parts import CLOSED, CONTACT, OPEN, STOP, Part, Rest, at_rest, parts
from relay_contact.qualification.response import Response, fast, stays
from relay_contact.qualification.standards import Contacts

TOLERANCE = 1e-4  # solver.tolerance, which levels feel by less than their resolution
GROWS = 1.5  # power of the time for which a contact fails that grows with the level; 2, did it not bounce
WATCHED = 10  # periods
GENTLY, SOON, AT_ONCE = (1.0, 1.0), (0.4, 1.3), (0.0, 1.0)
"""Times in which a vibration rises, and for which it goes on until the start is forgotten, in those that it takes to
settle. Soon: with less swing off the resonance, where only the level matters that fails."""
SAMPLES = 64  # of the gap of an open first contact in a period: 0.1 % of its least value may be missed
SUDDEN = 3.0  # factor of its level from which on a vibration may start suddenly: the contact does not fail
SHOWN = 400  # points of a course of force or gap

APART, BESIDE, TRIED = 0.01, 0.05, 9
"""Part by which a level that fails differs from linear theory, from which on the weakest frequency is sought with the
component; step of the search, as a part of the frequency, at most; frequencies tried before its last."""

ABOVE, FALLS = 3.0, 0.7
"""Widths above a resonance at which a slow sweep begins, and the part of its frequency that it goes down to."""
ORDERS = (2, 3, 4, 5)
"""Multiples of a frequency that may resonate where it does not."""
CROSSING, SLOWEST = 1.0, 10.0
"""Times of settling for which it crosses a width, and all that it takes at most."""

# A long course, such as a record or random vibration, is simulated around its largest dips of force or gap.
SHORT = 0.25  # s, up to which a course is simulated as a whole
DIPS = 3
BEFORE, AFTER = 5e-3, 2e-3  # s, of a dip, at least
BENT = 5  # steps to either side, by which a dip is bent
RECORD = 60.0  # s, of random vibration
SAMPLE = 2e-5  # s
EVENLY = 16  # times at which its change is known in a period of its highest frequency
SEED = 1
RANKS = 30  # dips of noise by which it is told what clipping does to the largest


INTERRUPTIONS = ("chatter.count", "chatter.totalInterruption", "chatter.longestInterruption")
MAKES = ("chatter.falseMakes", "chatter.totalFalseMake", "chatter.longestFalseMake")
OTHER_MAKES = ("second.falseMakes", "second.totalFalseMake", "second.longestFalseMake")


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
        monitored: Values = {
            "chatter.minimumDuration": self.contacts.opening,
            "second.minimumDuration": self.contacts.false_make,
            "chatter.resistanceThreshold": self.contacts.threshold, "solver.tolerance": TOLERANCE,
        }  # fmt: skip
        return self.component.started({**monitored, **self.values, **values})

    @cached_property
    def watched(self) -> list[str]:
        """The outputs that tell force and gap, and what was left of them in a step."""
        least = ["step.minimumForce", "step.minimumGap"][: len(self.monitors)]
        first = ["contact.indentation"] if self.is_open else ["contact.force", "second.force", *least]
        held = [name for part in self.held for name in ([part.least] if part.least else part.outputs)]
        return list(dict.fromkeys([*first, *held]))

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

    def ahead(self, contact: Contact, lengths: Lengths, left: Sequence[float] | Array, longer: float) -> float:
        """Return by which part a level has to rise until the part fails, if all is in proportion; 0: not known.

        By what is left of its force or gap; of a contact that was interrupted or made by the longest time, which grows
        as the level rises above a touch. By the part `longer` it is where it just fails.
        """
        if self.part != CONTACT:
            return float(left[self.names.index(self.part)]) / self.response.reserve
        length = contact.get(self.monitors[self.names[0]][2])
        if not length:
            return float(left[0]) / self.response.reserve + longer
        if not self.lasting or (length >= self.lasting) != (self.names[0] in lengths):
            return 0.0
        return float(longer * (1 - (length / self.lasting) ** GROWS))

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

    def failing(self, contact: Contact, time: Array, steps: Array, frequency: float) -> tuple[Lengths, Array, float]:
        """Vibrate (Hz) from time to time (s), in steps of these lengths (s).

        Return the longest failures of contacts that fail in that time, what is left in each step, and `ahead`.
        """

        def totals() -> dict[str, float]:
            return {name: contact.get(total) for name, (_, total, _) in self.monitors.items()}

        before = totals()
        rows = contact.drive(time, {}, self.watched)
        left = self.observed(rows)[:, 1:]
        # Of failures that last long enough; also of one without an end.
        still = [name for name, total in totals().items() if total > before[name]]
        lengths = {name: length for name, length in self.longest(contact).items() if name in still}
        lengths |= self.leaving(steps, rows)
        least = left.min(axis=0).tolist()
        return lengths, left, self.ahead(contact, lengths, least, (np.pi * frequency * self.lasting) ** 2 / 2)


def steady(specimen: Specimen, frequency: float, amplitude: float, gently: bool) -> tuple[Lengths, list[float]]:
    """Vibrate until the start is forgotten; return the longest failures of contacts that still fail, and what is left.

    The length is the longest since the start of the vibration, what is left the least after it is forgotten. Gently:
    raised from rest.
    """
    return vibrated(specimen, frequency, amplitude, GENTLY if gently else AT_ONCE)[:2]


def vibrated(
    specimen: Specimen, frequency: float, amplitude: float, start: tuple[float, float] = SOON
) -> tuple[Lengths, list[float], float]:
    """Return what `steady` does, and `Specimen.ahead`."""
    settling = max(2.0, specimen.response.settling() * frequency)
    rising, steadily = (int(np.ceil(part * settling)) for part in start)
    time = (rising + steadily) / frequency
    with specimen.start(sine(frequency, amplitude, rising / frequency)) as contact, contact.explained():
        contact.step(0.0, time)
        pieces = WATCHED * (SAMPLES if specimen.sampled else 1)
        step = 1 / frequency * WATCHED / pieces
        steps = np.full(pieces, step)
        lengths, left, ahead = specimen.failing(contact, time + step * np.arange(pieces + 1.0), steps, frequency)
        return lengths, left.min(axis=0).tolist(), ahead


def sweep(
    specimen: Specimen, test: Sine, frequencies: Array, responses: list[Response]
) -> list[tuple[Lengths, list[float]]]:
    """Vibrate at frequencies (Hz) of a sweep; return what `steady` gives at each. The responses are of all parts."""
    least = [np.interp(frequencies, *response.sine(test, specimen.lasting)) for response in responses]

    def at(point: tuple[float, float]) -> tuple[Lengths, list[float]]:
        frequency, factor = point
        return steady(specimen, float(frequency), float(test.amplitude(np.array(frequency))), factor < SUDDEN)

    return side_by_side(at, list(zip(frequencies, np.min(least, axis=0), strict=True)))


def sine_tried(specimen: Specimen, test: Sine, frequency: float) -> Tried:
    """Return what tells what of the part fails in steady vibration at a frequency (Hz), by factors of the level."""
    amplitude = float(test.amplitude(np.array(frequency)))

    def tried(factor: float) -> tuple[Lengths, float]:
        lengths, _, ahead = vibrated(specimen, frequency, factor * amplitude)
        return specimen.own(lengths), ahead

    return tried


def swept(
    specimen: Specimen, test: Sine, frequency: float, factor: float, order: int = 1
) -> tuple[Lengths, float, float]:
    """Sweep slowly from above a resonance (Hz) to below it; return the longest failures, `Specimen.ahead`, and where.

    The stiffness of a contact falls as its force does, and with it the resonance: to follow it down takes a lower level
    than to raise a vibration beside it. Where is the frequency (Hz) at which the least is left. Of a higher order it is
    the frequency whose multiple resonates, as the force of a contact that is not linear has harmonics.
    """
    response = specimen.response
    width, settling = response.bandwidth(order * frequency) / order, response.settling()
    high, low = min(frequency + ABOVE * width, test.band[1]), max(FALLS * frequency, test.band[0])
    lasting = settling * (1 + min(CROSSING * (high - low) / width, SLOWEST))
    # Of the excitation: without a limit 0.
    stroke = (test.double_amplitude or 0.0) / 2
    most = G * test.acceleration if test.acceleration else float(test.amplitude(np.array(high)))
    values: Values = {
        "effects.excitation": "LogSweep", "excitation.amplitude": factor * most, "excitation.frequency": high,
        "excitation.endFrequency": low, "excitation.duration": lasting, "excitation.displacementLimit": factor * stroke,
    }  # fmt: skip
    with specimen.start(values) as contact, contact.explained():
        # Until its sudden start is forgotten.
        contact.step(0.0, settling)
        time = np.linspace(settling, lasting, SHOWN + 1)
        lengths, left, ahead = specimen.failing(contact, time, np.diff(time), frequency)
    at = int(left[:, specimen.names.index(specimen.part) if specimen.part != CONTACT else 0].argmin())
    return specimen.own(lengths), ahead, float(high * (low / high) ** (time[at + 1] / lasting))


def sine_threshold(
    specimen: Specimen, test: Sine, frequency: float, guess: float, failing: Lengths | None = None
) -> tuple[float, list[str]]:
    """Return the factor of the level that fails in steady vibration at a frequency (Hz), and what of the part."""
    return threshold(sine_tried(specimen, test, frequency), guess, failing)


class Weakest(NamedTuple):
    """Where a sine fails at the least level."""

    frequency: float
    """Hz"""
    factor: float
    """Of the level."""
    failed: list[str]
    order: int = 0
    """Of the resonance that a sweep follows down to it; 0: a vibration raised there fails."""


def sine_least(specimen: Specimen, test: Sine) -> Weakest:
    """Return the frequency of a sweep that fails at the least level.

    That of linear theory, unless another fails at a lower level in the component, of those at which the contact opens
    there: an open contact is not linear. Below its resonance, a contact that is not linear before it opens, either, may
    do so where a multiple of the frequency resonates. What the test hardly shakes does not fail.
    """
    known, factors = specimen.response.sine(test, specimen.lasting)
    at = int(factors.argmin())
    if factors[at] >= MOST:
        return Weakest(float(known[at]), MOST, [])
    least = sine_near(specimen, test, float(known[at]), float(factors[at]))
    _, touches = specimen.response.sine(test, 0.0)
    if specimen.component.value(specimen.values, "effects.parallelContact"):
        # Once the other contact has opened nothing is linear: any frequency may be the weakest.
        touches = np.zeros(len(known))
    order = touches.argsort(kind="stable")
    parts = known if test.steps else np.floor(np.log(known) / BESIDE)
    _, first = np.unique(parts[order], return_index=True)
    # Of all that are so near that one tells of the others, the first to open.
    for each in order[np.sort(first)]:
        frequency, level = float(known[each]), least[1] * (1 - APART)
        if touches[each] < level and sine_tried(specimen, test, frequency)(level)[0]:
            least = sine_near(specimen, test, frequency, level)
    return across(specimen, test, least, float(factors[at]))


def across(specimen: Specimen, test: Sine, least: Weakest, guess: float) -> Weakest:
    """Return where a slow sweep fails as a multiple of its frequency resonates, if below the least level so far."""
    natural, (low, high) = specimen.response.natural, test.band
    for multiple in ORDERS if high < natural and not test.steps else ():
        if low < natural / multiple < high / FALLS:
            least = followed(specimen, test, natural / multiple, multiple, least, guess)
    return least


def sine_near(specimen: Specimen, test: Sine, first: float, guess: float) -> Weakest:
    """Return what `sine_least` does, near a frequency (Hz) and a level that are expected.

    There, if the component fails as expected, or the test has no other frequency. Else steps from there to lower
    levels, then the vertex of a parabola: the resonance of a contact that is far from linear, or rubs, is elsewhere.
    At last a sweep, which may follow it further down.
    """
    step = 1 + min(BESIDE, specimen.response.bandwidth(first) / first / 2)
    low, high = test.band

    def exactly(place: float, guess: float) -> Weakest:
        frequency = first * step**place
        return Weakest(frequency, *sine_threshold(specimen, test, frequency, guess))

    def roughly(place: float, guess: float) -> float:
        frequency = first * step**place
        tried = sine_tried(specimen, test, frequency)
        return threshold(tried, guess, roughly=True)[0] if low <= frequency <= high else np.inf

    exact = [exactly(0.0, guess)]
    bends = not test.steps and abs(exact[0].factor / guess - 1) > APART
    if bends and exact[0].factor < MOST:
        found, best = {0.0: exact[0].factor}, 0.0
        while beside := {best - 1, best + 1} - found.keys():
            found |= {place: roughly(place, found[best]) for place in beside}
            best = min(found, key=lambda place: found[place])
            if len(found) > TRIED:
                break
        else:
            below, middle, above = (found[best + each] for each in (-1, 0, 1))
            bent = below - 2 * middle + above
            if np.isfinite(bent) and bent > 0:
                exact.append(exactly(best + (below - above) / (2 * bent), middle))
        if found[best] < min(each.factor for each in exact):
            exact.append(exactly(best, found[best]))
    least = min(exact, key=lambda each: each.factor)
    return followed(specimen, test, first, 1, least, guess) if bends else least


def followed(specimen: Specimen, test: Sine, first: float, order: int, least: Weakest, guess: float) -> Weakest:
    """Return where a slow sweep across a resonance fails, by its frequency and order, if below the least level so far.

    A gap, or the force of a stop, is not known in steps as long as those of a sweep.
    """
    level = least.factor * (1 - APART) if least.factor < MOST else guess
    between = specimen.part == STOP or (specimen.part == CONTACT and specimen.is_open)
    run = cache(partial(swept, specimen, test, first, order=order))
    if between or not run(level)[0]:
        return least
    level, failed = threshold(lambda factor: run(factor)[:2], min(guess, level))
    return Weakest(run(level)[2], level, failed, order)


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
            end = max(3 * course.end, course.end + specimen.response.settling())
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

        def tried(factor: float) -> tuple[Lengths, float]:
            lengths, _, ahead = self.follow(specimen, sign * factor)
            return specimen.own(lengths), ahead

        return tried

    def threshold(
        self, specimen: Specimen, sign: float, failing: Lengths | None = None, guess: float = 0.0
    ) -> tuple[float, list[str]]:
        """Return the factor of its level that fails with a sign, and what of the part."""
        return threshold(self.tried(specimen, sign), guess or self.guess, failing)


def pieces(specimen: Specimen, course: Course, sign: float) -> list[Piece]:
    """Return a course as a whole if it is short, else what is around its largest dips, by linear theory."""
    response, lasting = specimen.response, specimen.lasting
    whole = course if isinstance(course, Noise) else course.padded(response.settling())
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
    before, since = 2 * max(response.settling(), BEFORE), len(response.answer)
    if isinstance(course, Noise):
        level, step = course.change(response)
        level *= sign
        level[: round(before / step)] = np.inf
    else:
        level, step = stays(sign * response.moved(whole), lasting), STEP
    found = []
    # Of noise some more, as a change that is known at fewer times may miss their depth by some per cent.
    for _ in range(2 * DIPS + 2 if isinstance(course, Noise) else DIPS):
        at = int(level.argmin())
        first, last = (round((step * at + each) / STEP) for each in (-before / 2, before / 2))
        time = STEP * np.arange(first - since, last)
        near = np.interp(time, whole.time, whole.acceleration, left=0.0, right=0.0)
        dip, longer, own = deepest(sign * response.change(near)[since : len(near)])
        now = STEP * (first + own)
        # Also of a course with steps longer than that, three points before the dip: it rises from the first.
        latest = max(0, np.searchsorted(whole.time, now, "right") - 3)
        begin = float(whole.time[min(np.searchsorted(whole.time, now - 0.8 * before), latest)])
        part = whole.part(begin, now + lasting + AFTER)
        found.append((dip, Piece(part, response.reserve / dip, begin - lead, longer)))
        level[max(0, at - round(before / step)) : at + round(before / step)] = np.inf
    return [piece for _, piece in sorted(found, key=lambda each: -each[0])[:DIPS]]


@dataclass(frozen=True)
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


def middle_dip(specimen: Specimen, dips: list[Piece]) -> tuple[float, list[str], Piece]:
    """Return at which part of the level of linear theory the contacts fail, and which, in the middle of three dips.

    That is, of the largest dips of a record of noise, the one whose part is neither least nor greatest.
    """
    # A search begins with the level that was just tried.
    trials = {piece.begin: cache(piece.tried(specimen, 1.0)) for piece in dips}

    def sought(piece: Piece, part: float) -> tuple[float, list[str], Piece]:
        level, failed = threshold(trials[piece.begin], piece.guess * part)
        return level / piece.guess, failed, piece

    def fails(piece: Piece, part: float) -> bool:
        return bool(trials[piece.begin](piece.guess * part)[0])

    one, other, third = dips
    first = sought(one, 1.0)
    weaker = fails(other, first[0])
    if fails(third, first[0]) != weaker:
        return first
    second = sought(other, first[0])
    return second if fails(third, second[0]) == weaker else sought(third, second[0])


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
