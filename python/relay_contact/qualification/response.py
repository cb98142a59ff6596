"""The relay as a linear system: the force of a closed contact, or the gap of an open one, under base acceleration.

The component answers a short pulse of the base acceleration, so weak that a closed contact of any law stays closed and
is linear about its preload, and an open one stays open. The Fourier transform of the answer over that of the pulse is
the response to any vibration below the level at which the contact opens, or closes; the margins of the tests follow
from it. At that level a closed contact has just not opened, so that only the stiffness of the contact, which changes
with the force, is missing. A contact with friction has the response of one that slips freely.

The same answer has the forces that hold an armature at its core or stop and a spring at its pusher
(`relay_contact.qualification.parts`). Up to the level at which the first part fails all are held, and the relay is
linear: whatever fails first does so at its own level.
"""

from dataclasses import dataclass
from functools import cache, cached_property, lru_cache

import numpy as np
from numpy.fft import fft, ifft, irfft, rfft
from numpy.typing import NDArray

from relay_contact.component import Array, Component, Contact, Values
from relay_contact.figures import GRAVITY as G
from relay_contact.files import RelayContactError
from relay_contact.qualification.distributions import below
from relay_contact.qualification.excitation import BAND, STEP, Course, Random, Sine, overall
from relay_contact.qualification.parts import CONTACT, Part, Rest, at_rest, parts

PHASES = 1024
"""Combinations of the phases of sines on noise, over which the rate of crossings is averaged."""
SWELLS = 8
"""Times that the largest dip of noise is put into the number of swells that it follows from."""
NARROW, LINES = 50.0, 1000
"""Band (Hz) of noise below which its lines are closer than those of the response, and their number."""
WATCHED, LONGEST = 1000, 200_000  # steps: an answer ends after some of at most
LONG = 2**20  # steps of a course, from which on it is convolved in pieces
CALM = 1e-6  # part of its largest force
POINTS = 2**18  # of the transform at least, every 0.38 Hz
WEAK = 3e-6
"""Velocity that a pulse brings, of that of a vibration by the overtravel at the frequency of the closed contact: the
force changes by some 3e-4 of the preload, and the response is linear to 1e-5 of its largest value."""
SHALLOW, LINEAR = 1e-5, 1e-3
"""Overtravel (m) that the pulse goes by at least, where a pusher closes the contact, and the largest change of a force
by it, as a part of the force, in which all that is held is linear."""
ROUNDED = 1e-3
"""Least share of the force of a stop that a contact's is taken to be, for the tolerance."""
STILL = 1e-9
"""Part of a force, or gap, below which its change is calm: a balanced armature does not feel the pulse at all."""
FLIES = 0.5
"""Part of a vibration that a failure takes at least: beyond twice the level of a touch the contact, which then is open
for long and flies by itself, is not that of linear theory."""
EXACT = 1e-11
"""solver.tolerance of motions that are so small a part of the preload."""
FREE: Values = {
    "effects.secondContact": False, "effects.chatter": False, "effects.extremes": False, "effects.friction": "None",
}  # fmt: skip
"""Effects that a linear response is without."""


@dataclass(frozen=True, eq=False)
class Response:
    """Force (N) of a part that is held at rest, or gap (m) of an open contact, by base acceleration over frequency."""

    reserve: float
    """Force that vibration has to take off the part, of a contact for an interruption; or the gap at rest."""
    natural: float
    """Lowest frequency (Hz) of the contact at rest by its stiffness."""
    frequency: Array
    transfer: NDArray[np.complex128]
    """Force or gap over base acceleration, N or m per m/s2."""
    answer: Array
    """Change of force or gap after a pulse of one step that brings a velocity of 1 m/s, at every step."""
    slowest: float = 0.0
    """Time (s) after which all of the relay has settled."""

    @cached_property
    def gain(self) -> Array:
        """Magnitude of the transfer function, N per m/s2."""
        return np.abs(self.transfer)

    @cached_property
    def settling(self) -> float:
        """The time (s) after which less than a thousandth of a vibration is left, in all of the relay."""
        return max(settled(self.answer), self.slowest)

    def bandwidth(self, frequency: float) -> float:
        """Return the width (Hz) of a resonance at half of its power."""
        at = min(int(np.searchsorted(self.frequency, frequency)), len(self.frequency) - 1)
        low = self.gain < self.gain[at] / np.sqrt(2)
        below, above = np.flatnonzero(low[:at]), np.flatnonzero(low[at:])
        first = below[-1] if len(below) else 0
        last = at + (above[0] if len(above) else len(low) - at - 1)
        return float(self.frequency[last] - self.frequency[first])

    def sine(self, test: Sine, opening: float) -> tuple[Array, Array]:
        """Return the factors of the level that fail for a time (s), at the frequencies (Hz) of a test."""
        frequency = test.tried(self.frequency, self.gain)
        gain = np.interp(frequency, self.frequency, self.gain)
        return frequency, self.reserve / kept(frequency, opening) / np.maximum(test.amplitude(frequency) * gain, 1e-300)

    def weakest(self, test: Sine, opening: float) -> float:
        """Return the frequency (Hz) of a test at which the least factor of the level fails for a time (s)."""
        frequency, factors = self.sine(test, opening)
        return float(frequency[factors.argmin()])

    def moments(self, test: Random) -> tuple[float, float, float]:
        """Return rms (N or m) and mean frequency (Hz) of force or gap in random vibration, without its sines.

        Third is how wide its spectrum is about its centre, in parts of the mean frequency.
        """
        low, high = test.density[0][0], test.density[-1][0]
        # A narrow band has lines of its own, as few of these are within.
        inside = (self.frequency >= low) & (self.frequency <= high)
        frequency = np.linspace(low, high, LINES) if high - low < NARROW else self.frequency[inside]
        density = test.spectrum(frequency)
        gain = np.interp(frequency, self.frequency, self.gain)
        powers = density / density.sum() * (G * overall(test.density)) ** 2 * gain**2
        power, first, second = (float((powers * frequency**order).sum()) for order in range(3))
        return power**0.5, (second / power) ** 0.5, max(1 - first**2 / (power * second), 0.0) ** 0.5

    def random(
        self, test: Random, opening: float, chance: float = 0.5, moments: tuple[float, float, float] | None = None
    ) -> float:
        """Return the factor of the level that fails within the test with a chance, by Rice's rate of crossings.

        Those in one swell of a narrow resonance count once (E. H. Vanmarcke, Journal of Applied Mechanics 42, 1975,
        p. 215): the largest dip is that of so many swells, whose peaks are independent.
        """
        if not self.gain.any():
            return np.inf
        rms, mean, width = moments or self.moments(test)
        needed = self.reserve / kept(mean, opening)
        crossings = -np.log1p(-chance) / test.duration

        def of(swells: float) -> float:
            return float(np.sqrt(-2 * np.log(-np.expm1(np.log1p(-chance) / swells))))

        dip = of(1 + mean * test.duration)
        for _ in range(SWELLS):
            dip = of(1 - mean * test.duration * np.expm1(-np.sqrt(2 * np.pi) * width**1.2 * dip))
        largest = rms * dip
        if test.sines:
            frequency, level = np.array(test.sines).T
            size = G * level * np.interp(frequency, self.frequency, self.gain)
            phases = 2 * np.pi * spread(PHASES, len(size))
            shift, speed = np.cos(phases) @ size, np.sin(phases) @ (2 * np.pi * frequency * size)
            slope = 2 * np.pi * mean * rms
            # Noise and sines are independent: at each phase the crossings are those of noise that moves with them.
            moving = slope * bell(speed / slope) + speed * below(speed / slope)

            def excess(dip: float) -> float:
                rate = float((bell((dip - shift) / rms) / rms * moving).mean())
                return float(np.log(max(rate, 1e-300) / crossings))

            # It takes long to import.
            from scipy.optimize import brentq

            # In a swell they cross at phases that differ: each of these counts, up to the largest of both together.
            largest += size.sum()
            if excess(largest) < 0:
                least = min(rms, largest)
                largest = brentq(excess, least, largest) if excess(least) > 0 else least
        return float(needed / largest)

    def change(self, course: Array) -> Array:
        """Return the change of force (N) or gap (m), at every step, by an acceleration (m/s2) at every step."""
        if len(course) > LONG:
            # In pieces; it takes long to import.
            from scipy.signal import oaconvolve

            return np.asarray(oaconvolve(course, self.answer)) * STEP
        count = len(course) + len(self.answer) - 1
        size = fast(count)
        return np.asarray(irfft(rfft(course, size) * rfft(self.answer, size), size)[:count]) * STEP

    @lru_cache(maxsize=2)  # noqa: B019
    def moved(self, course: Course) -> Array:
        """Return the change of force or gap by a course to its end, as nobody knows what follows; by 0 until calm."""
        sampled = course.sampled()
        return self.change(sampled)[: len(sampled) - 1 if course.acceleration[-1] else None]

    def course(self, course: Course, sign: float, opening: float) -> float:
        """Return the factor of a course that fails, with a sign."""
        change = self.moved(course.padded(self.settling))
        return self.reserve / max(float(-stays(sign * change, opening).min()), 1e-12)


def kept(frequency: Array | float, opening: float) -> Array:
    """Return the part of a sine (Hz) that it exceeds for a time (s), or the part that is linear."""
    return np.asarray(np.maximum(np.cos(np.minimum(np.pi * frequency * opening, np.pi)), FLIES))


def stays(change: Array, opening: float) -> Array:
    """Return the level below which a change stays for a time (s) from each step on, or the part that is linear.

    A change that is shorter stays nowhere.
    """
    dwell = max(1, round(opening / STEP))
    if len(change) <= dwell:
        return np.zeros(1)
    most, window = change, 1
    while 2 * window <= dwell + 1:
        most, window = np.maximum(most[:-window], most[window:]), 2 * window
    rest = dwell + 1 - window
    most = np.maximum(most[: len(most) - rest], most[rest:])
    return np.minimum(most, FLIES * change[: len(most)])


@cache
def fast(count: int) -> int:
    """Return the least count from this one on with which a Fourier transform is fast: of factors 2, 3 and 5 alone."""
    odd: list[int] = [3**three * 5**five for three in range(9) for five in range(7)]
    return min(each << (-(-count // each) - 1).bit_length() for each in odd)


def settled(answer: Array) -> float:
    """Return the time (s) after which less than a thousandth of an answer is left."""
    left = np.maximum.accumulate(np.abs(answer[::-1]))[::-1]
    return STEP * int(np.argmax(left < 1e-3 * left[0]))


def respond(component: Component, values: Values, threshold: float, calm: float = CALM) -> Response:
    """Return the response of the first contact; `answers` says more."""
    return answers(component, values, threshold, at_rest(component, values), calm)[CONTACT]


def answers(
    component: Component, values: Values, threshold: float, rest: Rest, calm: float = CALM
) -> dict[str, Response]:
    """Have the component answer a pulse, until only the part `calm` of it is left; return the responses of all parts.

    `threshold` is the resistance (Ohm) above which the contact is interrupted; `rest` says what is judged.
    """
    held = parts(component, values, rest)
    with component.started({**values, **FREE, "solver.tolerance": EXACT}) as contact, contact.explained():
        natural, reserves, size = reserved(contact, values, threshold, rest, held)
        if not held and reserves[CONTACT] > 0:
            answer = answered(contact, rest, held, size, calm, {CONTACT: 0.0})[CONTACT]
            return {CONTACT: transformed(reserves[CONTACT], natural, answer, 0.0)}
    if not held or any(reserves[part.name] <= 0 for part in held):
        # It fails at rest: gravity is stronger, or it is another relay, in which not all is held.
        return {name: transformed(own, natural, np.zeros(WATCHED), 0.0) for name, own in reserves.items()}
    tolerance = EXACT
    if not rest.is_open:
        # Relative to the force of the contact; that of a stop may be a thousand times larger, and is rounded.
        largest = max(reserves[part.name] for part in held)
        tolerance *= max(1.0, largest / max(reserves[CONTACT], ROUNDED * largest))
    still = {name: STILL * abs(own) for name, own in reserves.items()}
    while True:
        with component.started({**values, **FREE, "solver.tolerance": tolerance}) as contact, contact.explained():
            found = answered(contact, rest, held, size, calm, still)
        # Held by a force, all is linear only while the force is there.
        shares = [size * np.abs(found[part.name]).max() / reserves[part.name] for part in held]
        if not rest.is_open and reserves[CONTACT] > 0:
            shares.append(size * np.abs(found[CONTACT]).max() / reserves[CONTACT])
        if max(shares) <= LINEAR:
            break
        size *= 0.5 * LINEAR / max(shares)
    slowest = max(settled(answer) for answer in found.values())
    return {name: transformed(reserves[name], natural, answer, slowest) for name, answer in found.items()}


def reserved(
    contact: Contact, values: Values, threshold: float, rest: Rest, held: tuple[Part, ...]
) -> tuple[float, dict[str, float], float]:
    """Return the lowest frequency (Hz) at rest, the reserves of all parts, and the usual velocity of a pulse (m/s)."""
    natural = contact.get("preload.frequency")
    if rest.is_open:
        reserve = -contact.get("preload.indentation")
        # A velocity (m/s) that moves a contact of more than 10 Hz by less than a third of its gap.
        size = 10 * reserve
    else:
        lost = interrupting_force(contact, values, threshold)
        overtravel = contact.component.value(values, "contact.overtravel")
        overtravel = max(abs(overtravel), SHALLOW) if held else overtravel
        (force,) = contact.real("contact.force")
        reserve, size = force - lost, WEAK * overtravel * 2 * np.pi * natural
    return natural, {CONTACT: reserve} | {part.name: part.now(contact) for part in held}, size


def answered(
    contact: Contact, rest: Rest, held: tuple[Part, ...], size: float, calm: float, still: dict[str, float]
) -> dict[str, Array]:
    """Return the changes of force or gap after a pulse that brings a velocity (m/s), by part, in parts of it.

    What changes by less than `still` (N or m) is calm, whatever its largest change.
    """
    first = Part(CONTACT, (("contact.indentation", -1.0) if rest.is_open else ("contact.force", 1.0),))
    every = (first, *held)
    before = {part.name: part.now(contact) for part in every}
    names = list(dict.fromkeys(name for part in every for name in part.outputs))
    # Up within a step and down within the next.
    time, pulse = STEP * np.arange(WATCHED + 1.0), np.zeros(WATCHED + 1)
    pulse[1] = size / STEP
    found = {part.name: np.zeros(0) for part in every}
    while True:
        count = len(found[CONTACT])
        if count >= LONGEST:
            dampings = "beam.stiffnessDamping", "beam.massDamping", *("contact.damping",) * (not rest.is_open)
            by = ", ".join(f"{name} = {contact.get(name):g}" for name in dampings)
            text = f"too little damping, by {by}, or that of modes in a spring file"
            raise RelayContactError(f"the contact still vibrates {STEP * LONGEST:g} s after a blow: {text}")
        watched = contact.drive(time + STEP * count, {"base.acceleration": pulse}, names)
        new = {part.name: (part.force(watched) - before[part.name]) / size for part in every}
        found = {name: np.concatenate((answer, new[name])) for name, answer in found.items()}
        pulse = np.zeros(WATCHED + 1)
        left = {name: np.abs(each).max() for name, each in new.items()}
        if all(left[name] < max(calm * np.abs(answer).max(), still[name] / size) for name, answer in found.items()):
            return found


def transformed(reserve: float, natural: float, answer: Array, slowest: float) -> Response:
    """Return the response by the answer to a pulse."""
    # The triangle begins one step before its peak, which the first of these is at.
    frequency, factors, chirp, kernel = transformation(len(answer))
    # Bluestein's: the transform at lines that are closer than those of the answer itself.
    whole = ifft(fft(answer * chirp, len(kernel)) * kernel)[len(answer) - 1 :][: len(frequency)]
    return Response(reserve, natural, frequency, whole * factors, answer, slowest)


@lru_cache(maxsize=4)
def transformation(length: int) -> tuple[Array, NDArray[np.complex128], NDArray[np.complex128], NDArray[np.complex128]]:
    """Return the frequencies (Hz) of the response by an answer of so many steps, and what its Fourier transform takes.

    The factors of its lines have the share of a sine that a triangle of a step has, too.
    """
    # Lines are close enough for the narrowest resonance, which the answer just shows, and end where its aliases begin.
    count = max(POINTS, 4 * length)
    lines = int(count * BAND[1] * STEP) + 1
    frequency = np.arange(lines) / (count * STEP)
    chirp = np.exp(-1j * np.pi / count * np.arange(max(length, lines)) ** 2)
    size = fast(length + lines - 1)
    kernel = fft(1 / np.concatenate((chirp[length - 1 : 0 : -1], chirp[:lines])), size)
    return frequency, chirp[:lines] * STEP / np.sinc(frequency * STEP) ** 2, chirp[:length], kernel


def bell(score: Array) -> Array:
    """Return the density of a standard normal distribution."""
    return np.asarray(np.exp(-(score**2) / 2) / np.sqrt(2 * np.pi))


def spread(count: int, columns: int) -> Array:
    """Return points between 0 and 1 that are even in each column, in random orders."""
    order = np.argsort(np.random.default_rng(0).random((count, columns)), axis=0)
    return np.asarray((order + 0.5) / count)


def interrupting_force(contact: Contact, values: Values, threshold: float) -> float:
    """Return the contact force (N) at which the resistance is the threshold (Ohm): src/electrical.rs has the laws."""
    component = contact.component
    names = ("coefficient", "exponent", "film", "open", "resistivity", "hardness")
    coefficient, exponent, film, apart, resistivity, hardness = (
        component.value(values, f"resistance.{name}") for name in names
    )
    constriction = 1 / max(1 / threshold - 1 / apart, 1e-300) - film
    match component.choice(values, "effects.resistance"):
        case "Holm":
            coefficient, exponent = resistivity / 2 * np.sqrt(np.pi * hardness), 0.5
        case "Barber":
            rough = component.value(values, "contact.stiffnessExponent")
            exponent = {"Hertz": 1 / 3, "Rough": rough}.get(component.choice(values, "effects.contactLaw"), 0.0)
            force, stiffness = contact.real("preload.force", "preload.contactStiffness")
            coefficient = resistivity / compliance(component, values) / stiffness * force**exponent
    if constriction <= 0 or not exponent:
        return 0.0 if coefficient <= constriction else np.inf
    return float((coefficient / constriction) ** (1 / exponent))


def compliance(component: Component, values: Values) -> float:
    """Return that of both contacts as elastic half-spaces, 1/Pa."""
    return sum(
        (1 - component.value(values, f"contact.{side}.poissonRatio") ** 2)
        / component.value(values, f"contact.{side}.youngsModulus")
        for side in ("moving", "fixed")
    )
