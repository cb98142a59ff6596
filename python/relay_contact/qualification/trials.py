"""The tests as the component runs them: steady vibration, shaped random vibration, shocks; levels that interrupt."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from relay_contact.component import Array, Component, Contact, Values
from relay_contact.figures import GRAVITY as G
from relay_contact.qualification.response import Response
from relay_contact.qualification.standards import Contacts, Random, Shock, Sine

RESOLUTION = 1e-4  # of levels
WATCHED = 10  # periods
PIECES = 16  # of a period of a rise, over each of which base.acceleration is linear
SUDDEN = 3.0  # factor of its level from which on a vibration may start suddenly: the contact stays closed
SHOWN = 400  # points of a course of force

# Random vibration is simulated around the largest dips of the force in a record of it.
RECORD = 60.0  # s
SAMPLE = 2e-5  # s
DIPS = 3
SEED = 1


@dataclass(frozen=True)
class Specimen:
    """A contact in a position of its coil, monitored as a standard asks."""

    component: Component
    values: Values
    contacts: Contacts
    response: Response

    def start(self, values: Values) -> Contact:
        """Give the contact at rest, with further parameters."""
        monitored = {
            "chatter.minimumDuration": self.contacts.opening,
            "chatter.resistanceThreshold": self.contacts.threshold,
        }
        return self.component.started({**monitored, **self.values, **values})


def monitor(contact: Contact) -> tuple[int, float]:
    """Give the number of interruptions so far that count, and the time (s) of all."""
    return int(contact.get("chatter.count")), contact.get("chatter.totalInterruption")


def threshold(interrupts: Callable[[float], bool], guess: float) -> float:
    """Give the least factor of a level that interrupts: from a guess outwards, then by bisection."""
    low, high = guess / 1.01, guess * 1.01
    while interrupts(low):
        low, high = low / 1.1, low
        if low < 1e-3 * guess:
            return low
    while not interrupts(high):
        low, high = high, high * 1.1
        if high > 1e3 * guess:
            return high
    while high > (1 + RESOLUTION) * low:
        middle = (low * high) ** 0.5
        low, high = (low, middle) if interrupts(middle) else (middle, high)
    return high


def steady(specimen: Specimen, frequency: float, amplitude: float, gently: bool) -> tuple[int, float, float]:
    """Vibrate until the start is forgotten; give interruptions, their mean length (s) and the least force (N) then.

    Gently: raised from rest.
    """
    sine: Values = {"effects.excitation": "Sine", "excitation.frequency": frequency, "excitation.amplitude": amplitude}
    periods = int(np.ceil(max(2.0, specimen.response.settling() * frequency)))
    with specimen.start(sine) as contact, contact.explained():
        time = 0.0
        if gently:
            contact.rise(frequency, amplitude, periods, PIECES)
            time = periods / frequency
        contact.step(time, periods / frequency)
        before = monitor(contact)
        contact.step(time + periods / frequency, WATCHED / frequency)
        now = monitor(contact)
        count = now[0] - before[0]
        return count, (now[1] - before[1]) / count if count else 0.0, contact.get("step.minimumForce")


def sweep(specimen: Specimen, test: Sine, frequencies: Array) -> Array:
    """Vibrate at frequencies of a sweep; give rows of frequency (Hz) and what `steady` gives."""
    known, factors = specimen.response.sine(test, specimen.contacts.opening)
    rows = []
    for frequency, factor in zip(frequencies, np.interp(frequencies, known, factors), strict=True):
        amplitude = float(test.amplitude(np.array(frequency)))
        rows.append([frequency, *steady(specimen, float(frequency), amplitude, factor < SUDDEN)])
    return np.array(rows)


def sine_threshold(specimen: Specimen, test: Sine, frequency: float, guess: float) -> float:
    """Give the factor of the level that interrupts in steady vibration at a frequency (Hz)."""
    amplitude = float(test.amplitude(np.array(frequency)))
    return threshold(lambda factor: steady(specimen, frequency, factor * amplitude, True)[0] > 0, guess)


def shock(specimen: Specimen, test: Shock, factor: float, points: int = 1) -> tuple[int, float, Array]:
    """Run a shock of a factor of its level, negative: opens the contact; observe for as long again, or until calm.

    Give the interruptions, the longest (s), and rows of time (s), force and least force since the last row (N).
    """
    pulse: Values = {
        "effects.excitation": "HalfSine",
        "excitation.amplitude": factor * G * test.acceleration,
        "excitation.duration": test.duration,
    }
    length = test.duration + max(test.duration, specimen.response.settling())
    with specimen.start(pulse) as contact, contact.explained():
        force = contact.get("contact.force")
        rows = [[0.0, force, force]]
        for number in range(points):
            contact.step(number * length / points, length / points)
            rows.append([(number + 1) * length / points, *contact.real("contact.force", "step.minimumForce")])
        return int(contact.get("chatter.count")), contact.get("chatter.longestInterruption"), np.array(rows)


def shock_threshold(specimen: Specimen, test: Shock, sign: float, guess: float) -> float:
    """Give the factor of the level that interrupts in a direction."""
    return threshold(lambda factor: shock(specimen, test, sign * factor)[0] > 0, guess)


def record(specimen: Specimen, test: Random) -> tuple[Array, Array]:
    """Give random acceleration (m/s2) at every sample, and the change of force (N) by linear theory.

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
    force = np.fft.irfft(spectrum * transfer, count)
    return np.fft.irfft(spectrum / np.sinc(frequency * SAMPLE) ** 2, count), force


def window(specimen: Specimen, acceleration: Array, factor: float) -> tuple[int, float, Array]:
    """Run part of a record, its first half as a rise; give interruptions, the longest (s), force and least (N)."""
    rise = len(acceleration) // 2
    shape = np.ones(len(acceleration))
    shape[:rise] = (1 - np.cos(np.pi * np.arange(rise) / rise)) / 2
    course = factor * shape * acceleration
    with specimen.start({}) as contact, contact.explained():
        rows = []
        for number in range(len(course) - 1):
            contact.change("base.acceleration", course[number], course[number + 1], SAMPLE)
            contact.step(number * SAMPLE, SAMPLE)
            rows.append(contact.real("contact.force", "step.minimumForce"))
        return int(contact.get("chatter.count")), contact.get("chatter.longestInterruption"), np.array(rows)


def dips(specimen: Specimen, test: Random) -> list[tuple[Array, float]]:
    """Give the acceleration around the largest dips of a record, and the factors that interrupt by linear theory."""
    acceleration, force = record(specimen, test)
    after = round(2e-3 / SAMPLE)
    before = 2 * round(max(specimen.response.settling(), 5e-3) / SAMPLE)
    _, mean = specimen.response.moments(test)
    needed = specimen.response.preload * (1 + (np.pi * mean * specimen.contacts.opening) ** 2 / 2)
    found = []
    force[:before] = force[-after:] = 0.0
    for _ in range(DIPS):
        at = int(force.argmin())
        found.append((acceleration[at - before : at + after], float(needed / -force[at])))
        force[max(0, at - before) : at + before] = 0.0
    return found
