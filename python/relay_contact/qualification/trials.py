"""The component in tests: what it observes, steady vibration and sweeps; `courses` has the others."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cache, cached_property, partial
from typing import Any, NamedTuple

import numpy as np

from relay_contact.component import Array, Component, Contact, Values, sine, warnings_kept
from relay_contact.figures import GRAVITY as G
from relay_contact.many import side_by_side
from relay_contact.qualification.excitation import Sine, rounded
from relay_contact.qualification.level import MOST, Lengths, Tried, threshold
from relay_contact.qualification.parts import CLOSED, CONTACT, OPEN, STOP, Part, Rest, at_rest, parts
from relay_contact.qualification.response import Response
from relay_contact.qualification.standards import Contacts

TOLERANCE = 1e-4  # solver.tolerance, which levels feel by less than their resolution
GROWS = 1.5  # power of the time for which a contact fails that grows with the level; 2, did it not bounce
WATCHED = 10  # periods at most: as many as the first of them is remembered for
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
    found: dict[Any, Any] = field(default_factory=dict, init=False, repr=False)
    """What `once` has found, and warnings."""

    def once(self, key: tuple[Any, ...], run: Callable[[], Any]) -> Any:  # noqa: ANN401
        """Return what a run finds, or has found by its key: tests that differ in level alone search the same."""
        if key not in self.found:
            with warnings_kept() as warnings:
                self.found[key] = run(), warnings
        found, warnings = self.found[key]
        for message in warnings.values():
            self.component.warn(message)
        return found

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
    settling = max(1.0, specimen.response.settling * frequency)
    rising, steadily = (int(np.ceil(part * settling)) for part in start)
    time = (rising + steadily) / frequency
    with specimen.start(sine(frequency, amplitude, rising / frequency)) as contact, contact.explained():
        contact.step(0.0, time)
        samples = SAMPLES if specimen.sampled else 1
        pieces, step = int(np.ceil(min(settling, WATCHED))) * samples, 1 / frequency / samples
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
        level = rounded(factor * amplitude)
        lengths, _, ahead = specimen.once((frequency, level), lambda: vibrated(specimen, frequency, level))
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
    width, settling = response.bandwidth(order * frequency) / order, response.settling
    high, low = min(frequency + ABOVE * width, test.band[1]), max(FALLS * frequency, test.band[0])
    lasting = settling * (1 + min(CROSSING * (high - low) / width, SLOWEST))
    # Of the excitation: without a limit 0.
    stroke = (test.double_amplitude or 0.0) / 2
    most = G * test.acceleration if test.acceleration else float(test.amplitude(np.array(high)))
    if float(test.amplitude(np.array(low))) == most:
        stroke = 0.0
    given = frequency, high, low, lasting, rounded(factor * most), rounded(factor * stroke)
    found: tuple[Lengths, float, float] = specimen.once(given, lambda: descended(specimen, *given))
    return found


def descended(
    specimen: Specimen, frequency: float, high: float, low: float, lasting: float, most: float, stroke: float
) -> tuple[Lengths, float, float]:
    """Sweep from a high frequency (Hz) to a low one in a time (s), by `most` (m/s2) within a stroke (m)."""
    settling = specimen.response.settling
    values: Values = {
        "effects.excitation": "LogSweep", "excitation.amplitude": most, "excitation.frequency": high,
        "excitation.endFrequency": low, "excitation.duration": lasting, "excitation.displacementLimit": stroke,
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


def across(specimen: Specimen, test: Sine, least: Weakest, guess: float, roughly: bool = False) -> Weakest:
    """Return where a slow sweep fails as a multiple of its frequency resonates, if below the least level so far."""
    natural, (low, high) = specimen.response.natural, test.band
    for multiple in ORDERS if high < natural and not test.steps else ():
        if low < natural / multiple < high / FALLS:
            least = followed(specimen, test, natural / multiple, multiple, least, guess, roughly)
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


def followed(
    specimen: Specimen, test: Sine, first: float, order: int, least: Weakest, guess: float, roughly: bool = False
) -> Weakest:
    """Return where a slow sweep across a resonance fails, by its frequency and order, if below the least level so far.

    A gap, or the force of a stop, is not known in steps as long as those of a sweep.
    """
    level = least.factor * (1 - APART) if least.factor < MOST else guess
    between = specimen.part == STOP or (specimen.part == CONTACT and specimen.is_open)
    run = cache(partial(swept, specimen, test, first, order=order))
    if between or not run(level)[0]:
        return least
    level, failed = threshold(lambda factor: run(factor)[:2], level, roughly=roughly)
    # In draws only the level matters, which need not have been run.
    return Weakest(first if roughly else run(level)[2], level, failed, order)
