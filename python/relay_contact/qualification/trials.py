"""The tests as the component runs them: steady vibration, shaped random vibration, shocks; levels that fail."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from relay_contact.component import Array, Component, Contact, Values
from relay_contact.figures import GRAVITY as G
from relay_contact.qualification.response import Response, open_at_rest
from relay_contact.qualification.standards import Contacts, Random, Shock, Sine

RESOLUTION = 1e-4  # of levels
WATCHED = 10  # periods
SAMPLES = 64  # of the gap of an open first contact in a period: 0.1 % of its least value may be missed
PIECES = 16  # of a period of a rise, over each of which base.acceleration is linear
SUDDEN = 3.0  # factor of its level from which on a vibration may start suddenly: the contact does not fail
SHOWN = 400  # points of a course of force or gap

APART, BESIDE, TRIED = 0.01, 0.05, 9
"""Part by which a level that fails differs from linear theory, from which on the weakest frequency is sought with the
component; step of the search, as a part of the frequency, at most; frequencies tried before its last."""

# Random vibration is simulated around the largest dips of force or gap in a record of it.
RECORD = 60.0  # s
SAMPLE = 2e-5  # s
DIPS = 3
SEED = 1


CLOSED, OPEN = "closed contact", "open contact"
"""What may fail, by its state at rest: by an interruption and by a false make."""
INTERRUPTIONS = ("chatter.count", "chatter.totalInterruption", "chatter.longestInterruption")
MAKES = ("chatter.falseMakes", "chatter.totalFalseMake", "chatter.longestFalseMake")
OTHER_MAKES = ("second.falseMakes", "second.totalFalseMake", "second.longestFalseMake")

Lengths = dict[str, float]
"""Length (s) of interruptions or makes that count, by contact, of those contacts that failed."""


@dataclass(frozen=True)
class Specimen:
    """The contacts in a position of the coil, monitored as a standard asks."""

    component: Component
    values: Values
    contacts: Contacts
    response: Response

    @cached_property
    def is_open(self) -> bool:
        """Whether the first contact is open at rest."""
        return open_at_rest(self.component, self.values)

    @property
    def lasting(self) -> float:
        """The shortest failure of the first contact (s)."""
        return self.contacts.false_make if self.is_open else self.contacts.opening

    @cached_property
    def monitors(self) -> dict[str, tuple[str, str, str]]:
        """The outputs that count failures, add up and compare their lengths, by contact."""
        if self.is_open:
            return {OPEN: MAKES}
        second = self.values.get("effects.secondContact", False)
        return {CLOSED: INTERRUPTIONS} | ({OPEN: OTHER_MAKES} if second else {})

    def start(self, values: Values) -> Contact:
        """Give the contacts at rest, with further parameters."""
        monitored = {
            "chatter.minimumDuration": self.contacts.opening,
            "second.minimumDuration": self.contacts.false_make,
            "chatter.resistanceThreshold": self.contacts.threshold,
        }
        return self.component.started({**monitored, **self.values, **values})

    def left(self, contact: Contact) -> list[float]:
        """Give the least force (N) of the closed contact in the last step, and gap (m) of the open one.

        The gap of an open first contact is that at the end of the step.
        """
        if self.is_open:
            tip, gap = contact.real("tip.displacement", "contact.overtravel")
            return [tip - gap]
        return contact.real("step.minimumForce", "step.minimumGap")[: len(self.monitors)]

    def observed(self, contact: Contact) -> list[float]:
        """Give the force (N) of the closed contact less that of the open one, or the gap (m) of a lone open contact.

        And what `left` gives.
        """
        left = self.left(contact)
        if self.is_open:
            return [left[0], *left]
        first, second = contact.real("contact.force", "second.force")
        return [first - second, *left]

    def longest(self, contact: Contact) -> Lengths:
        """Give the longest failure so far, by contact."""
        return {name: contact.get(each[2]) for name, each in self.monitors.items() if contact.get(each[0])}


def threshold(
    fails: Callable[[float], Lengths], guess: float, failing: Lengths | None = None
) -> tuple[float, list[str]]:
    """Return a factor of a level that fails, just above one that does not, and which contacts fail there.

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
        pieces = WATCHED * (SAMPLES if specimen.is_open else 1)
        step = 1 / frequency * WATCHED / pieces
        left = []
        for piece in range(pieces):
            contact.step(time + piece * step, step)
            left.append(specimen.left(contact))
        # Of failures that last long enough; also of one without an end.
        still = [name for name, total in totals().items() if total > before[name]]
        lengths = {name: length for name, length in specimen.longest(contact).items() if name in still}
        return lengths, np.min(left, axis=0).tolist()


def sweep(specimen: Specimen, test: Sine, frequencies: Array) -> list[tuple[Lengths, list[float]]]:
    """Vibrate at frequencies (Hz) of a sweep; give what `steady` gives at each."""
    known, factors = specimen.response.sine(test, specimen.lasting)
    rows = []
    for frequency, factor in zip(frequencies, np.interp(frequencies, known, factors), strict=True):
        amplitude = float(test.amplitude(np.array(frequency)))
        rows.append(steady(specimen, float(frequency), amplitude, factor < SUDDEN))
    return rows


def sine_threshold(
    specimen: Specimen, test: Sine, frequency: float, guess: float, failing: Lengths | None = None
) -> tuple[float, list[str]]:
    """Return the factor of the level that fails in steady vibration at a frequency (Hz), and which contacts."""
    amplitude = float(test.amplitude(np.array(frequency)))
    return threshold(lambda factor: steady(specimen, frequency, factor * amplitude, True)[0], guess, failing)


def sine_least(specimen: Specimen, test: Sine) -> tuple[float, float, list[str]]:
    """Return the frequency (Hz) of a sweep that fails at the least level, its factor of the level, and which contacts.

    That of linear theory, if the component fails there as expected. Else steps from there to lower levels, then the
    vertex of a parabola: the resonance of a contact that is far from linear, or rubs, is elsewhere.
    """
    known, factors = specimen.response.sine(test, specimen.lasting)
    at = int(factors.argmin())
    first, guess = float(known[at]), float(factors[at])
    step = 1 + min(BESIDE, specimen.response.bandwidth(first) / first / 2)

    def tried(place: float) -> tuple[float, float, list[str]]:
        frequency = first * step**place
        if not test.frequencies[0] <= frequency <= test.frequencies[1]:
            return frequency, np.inf, []
        return frequency, *sine_threshold(specimen, test, frequency, found[0.0][1] if found else guess)

    found: dict[float, tuple[float, float, list[str]]] = {}
    found[0.0] = tried(0.0)
    if abs(found[0.0][1] / guess - 1) > APART:
        best = 0.0
        while beside := {best - 1, best + 1} - found.keys():
            found |= {place: tried(place) for place in beside}
            best = min(found, key=lambda place: found[place][1])
            if len(found) > TRIED:
                break
        else:
            low, middle, high = (found[best + each][1] for each in (-1, 0, 1))
            bent = low - 2 * middle + high
            if np.isfinite(bent) and bent > 0:
                vertex = best + (low - high) / (2 * bent)
                found[vertex] = tried(vertex)
    return min(found.values(), key=lambda each: each[1])


def shock(specimen: Specimen, test: Shock, factor: float, points: int = 1) -> tuple[Lengths, Array]:
    """Run a shock of a factor of its level, negative: opens the first contact.

    It is observed until calm. Give the longest failures, and rows of time (s), force or gap, and what was left at least
    since the last row: so many in three times the length of the shock, and one at the end.
    """
    pulse: Values = {
        "effects.excitation": "HalfSine",
        "excitation.amplitude": factor * G * test.acceleration,
        "excitation.duration": test.duration,
    }
    end = max(3 * test.duration, test.duration + specimen.response.settling())
    with specimen.start(pulse) as contact, contact.explained():
        rows = []
        time = 0.0
        for instant in [*np.linspace(0, 3 * test.duration, points + 1)[1:], end]:
            if instant > time:
                contact.step(time, instant - time)
                time = float(instant)
                rows.append([time, *specimen.observed(contact)])
        return specimen.longest(contact), np.array(rows)


def shock_threshold(
    specimen: Specimen, test: Shock, sign: float, guess: float, failing: Lengths | None = None
) -> tuple[float, list[str]]:
    """Return the factor of the level that fails in a direction, and which contacts."""
    return threshold(lambda factor: shock(specimen, test, sign * factor)[0], guess, failing)


def record(specimen: Specimen, test: Random) -> tuple[Array, Array]:
    """Give random acceleration (m/s2) at every sample, and the change of force (N) or gap (m) by linear theory.

    The acceleration is the sum of sines a sixtieth of a Hz apart with normally distributed amplitudes; between samples
    it is linear, for which the amplitudes are raised.
    """
    count = round(RECORD / SAMPLE)
    frequency: Array = np.fft.rfftfreq(count, SAMPLE).astype(np.float64)
    normal = np.random.default_rng(SEED).standard_normal((2, len(frequency)))
    amplitude = np.sqrt(test.spectrum(frequency) / (4 * RECORD)) * (count * SAMPLE) / SAMPLE
    spectrum = amplitude * (normal[0] + 1j * normal[1])
    known = specimen.response
    transfer = np.interp(frequency, known.frequency, known.transfer)
    change = np.fft.irfft(spectrum * transfer, count)
    return np.fft.irfft(spectrum / np.sinc(frequency * SAMPLE) ** 2, count), change


def window(specimen: Specimen, acceleration: Array, factor: float, watched: bool = False) -> tuple[Lengths, Array]:
    """Run part of a record, its first half as a rise; give the longest failures, and what is observed if watched."""
    rise = len(acceleration) // 2
    shape = np.ones(len(acceleration))
    shape[:rise] = (1 - np.cos(np.pi * np.arange(rise) / rise)) / 2
    course = factor * shape * acceleration
    with specimen.start({}) as contact, contact.explained():
        rows = []
        for number in range(len(course) - 1):
            contact.change("base.acceleration", course[number], course[number + 1], SAMPLE)
            contact.step(number * SAMPLE, SAMPLE)
            if watched:
                rows.append(specimen.observed(contact))
        return specimen.longest(contact), np.array(rows)


def middle_dip(specimen: Specimen, test: Random) -> tuple[float, list[str], Array, float]:
    """Return at which part of the level of linear theory the contacts fail, and which, in the middle of the dips.

    That is, of the largest dips of a record, the one whose part is neither least nor greatest; with its acceleration,
    and the factor of its level that fails by linear theory.
    """
    found = []
    for course, guess in dips(specimen, test):
        level, failed = threshold(lambda factor, course=course: window(specimen, course, factor)[0], guess)  # type: ignore[misc]
        found.append((level / guess, failed, course, guess))
    return sorted(found, key=lambda each: each[0])[len(found) // 2]


def dips(specimen: Specimen, test: Random) -> list[tuple[Array, float]]:
    """Give the acceleration around the largest dips of a record, and the factors that fail by linear theory."""
    acceleration, change = record(specimen, test)
    after = round(2e-3 / SAMPLE)
    before = 2 * round(max(specimen.response.settling(), 5e-3) / SAMPLE)
    _, mean = specimen.response.moments(test)
    needed = specimen.response.reserve * (1 + (np.pi * mean * specimen.lasting) ** 2 / 2)
    found = []
    change[:before] = change[-after:] = 0.0
    for _ in range(DIPS):
        at = int(change.argmin())
        found.append((acceleration[at - before : at + after], float(needed / -change[at])))
        change[max(0, at - before) : at + before] = 0.0
    return found
