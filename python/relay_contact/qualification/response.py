"""The contact as a linear system: the force of a closed contact, or the gap of an open one, under base acceleration.

The component answers a short pulse of the base acceleration, so weak that a closed contact of any law stays closed and
is linear about its preload, and an open one stays open. The Fourier transform of the answer over that of the pulse is
the response to any vibration below the level at which the contact opens, or closes; the margins of the tests follow
from it. At that level a closed contact has just not opened, so that only the stiffness of the contact, which changes
with the force, is missing. A contact with friction has the response of one that slips freely.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from relay_contact.component import Array, Component, Values
from relay_contact.figures import GRAVITY
from relay_contact.files import RelayContactError
from relay_contact.qualification.standards import Random, Shock, Sine, Test

STEP = 1e-5
"""Length (s) of the steps: resonances above 50 kHz are folded back, a thousand times weaker."""
WATCHED, LONGEST = 1000, 200_000  # steps: an answer ends after some of at most
CALM = 1e-6  # part of its largest force
POINTS = 2**18  # of the transform at least, every 0.38 Hz
WEAK = 3e-6
"""Velocity that a pulse brings, of that of a vibration by the overtravel at the frequency of the closed contact: the
force changes by some 3e-4 of the preload, and the response is linear to 1e-5 of its largest value."""
EXACT = 1e-11
"""solver.tolerance of motions that are so small a part of the preload."""
FREE: Values = {
    "effects.secondContact": False, "effects.chatter": False, "effects.extremes": False, "effects.friction": "None",
}  # fmt: skip
"""Effects that a linear response is without."""


@dataclass(frozen=True)
class Response:
    """Force (N) of a contact that is closed at rest, or gap (m) of an open one, by base acceleration over frequency."""

    reserve: float
    """Force that vibration has to take off the contact for an interruption, or the gap at rest."""
    natural: float
    """Lowest frequency (Hz) of the contact at rest by its stiffness."""
    frequency: Array
    transfer: NDArray[np.complex128]
    """Force or gap over base acceleration, N or m per m/s2."""
    answer: Array
    """Change of force or gap after a pulse of one step that brings a velocity of 1 m/s, at every step."""

    @property
    def gain(self) -> Array:
        """Magnitude of the transfer function, N per m/s2."""
        return np.abs(self.transfer)

    def settling(self, part: float = 1e-3) -> float:
        """Give the time (s) after which less than a part of a vibration is left."""
        left = np.maximum.accumulate(np.abs(self.answer[::-1]))[::-1]
        return STEP * int(np.argmax(left < part * left[0]))

    def bandwidth(self, frequency: float) -> float:
        """Give the width (Hz) of a resonance at half of its power."""
        at = int(np.searchsorted(self.frequency, frequency))
        low = self.gain < self.gain[at] / np.sqrt(2)
        below, above = np.flatnonzero(low[:at]), np.flatnonzero(low[at:])
        first = below[-1] if len(below) else 0
        last = at + (above[0] if len(above) else len(low) - at - 1)
        return float(self.frequency[last] - self.frequency[first])

    def sine(self, test: Sine, opening: float) -> tuple[Array, Array]:
        """Give the factors of the level that fail for a time (s), at the frequencies (Hz) of a sweep."""
        low, high = test.frequencies
        inside = (self.frequency >= low) & (self.frequency <= high)
        frequency = self.frequency[inside]
        # Force or gap is below zero for the time where its amplitude is the reserve over this cosine.
        needed = self.reserve / np.cos(np.minimum(np.pi * frequency * opening, 1.5))
        return frequency, needed / (test.amplitude(frequency) * self.gain[inside])

    def moments(self, test: Random) -> tuple[float, float]:
        """Give rms (N or m) and mean frequency (Hz) of force or gap in random vibration."""
        density = test.spectrum(self.frequency) * self.gain**2
        step = self.frequency[1]
        power = float(density.sum() * step)
        return power**0.5, float((density * self.frequency**2).sum() * step / power) ** 0.5

    def random(self, test: Random, opening: float, chance: float = 0.5) -> float:
        """Give the factor of the level that fails within the test with a chance, by Rice's rate of crossings."""
        rms, mean = self.moments(test)
        needed = self.reserve * (1 + (np.pi * mean * opening) ** 2 / 2)
        return float(needed / (rms * np.sqrt(2 * np.log(mean * test.duration / -np.log1p(-chance)))))

    def shock(self, test: Shock, opening: float) -> dict[str, float]:
        """Give the factors of the level that fail, by the direction of the acceleration on the contact."""
        pulse = half_sine(test)
        count = 2 ** int(np.ceil(np.log2(len(pulse) + len(self.answer))))
        change = np.fft.irfft(np.fft.rfft(pulse, count) * np.fft.rfft(self.answer, count), count) * STEP
        dwell = max(1, round(opening / STEP))

        def dip(course: Array) -> float:
            """Give the level below which it stays for the time."""
            lasting = np.lib.stride_tricks.sliding_window_view(course, dwell + 1).max(axis=1)
            return float(-lasting.min())

        return {way: self.reserve / max(dip(sign * change), 1e-12) for way, sign in (("closing", 1), ("opening", -1))}


def half_sine(test: Shock) -> Array:
    """Give a shock at every step, m/s2."""
    time = STEP * np.arange(round(test.duration / STEP) + 1)
    return np.asarray(GRAVITY * test.acceleration * np.sin(np.pi * time / test.duration))


def open_at_rest(component: Component, values: Values) -> bool:
    """Tell whether the first contact of a position is open: a gap in place of overtravel."""
    return float(values.get("contact.overtravel", component.start("contact.overtravel"))) < 0


def respond(component: Component, values: Values, threshold: float, calm: float = CALM) -> Response:
    """Have the component answer a pulse, until only the part `calm` of its largest answer is left.

    `threshold` is the resistance (Ohm) above which the contact is interrupted.
    """
    is_open = open_at_rest(component, values)
    with component.started({**values, **FREE, "solver.tolerance": EXACT}) as contact, contact.explained():
        read = contact.references("tip.displacement" if is_open else "contact.force")
        input_ = contact.references("base.acceleration")
        rest = contact.fmu.getReal(read)[0]
        natural = contact.get("preload.frequency")
        if is_open:
            reserve = -contact.get("preload.indentation")
            # A velocity (m/s) that moves a contact of more than 10 Hz by less than a third of its gap.
            size = 10 * reserve
        else:
            lost = interrupting_force(contact.real("resistance.coefficient", "resistance.exponent"), threshold)
            overtravel = float(values.get("contact.overtravel", component.start("contact.overtravel")))
            reserve, size = rest - lost, WEAK * overtravel * 2 * np.pi * natural
        # Up within a step and down within the next.
        peak = size / STEP
        answer: list[float] = []
        largest = left = 1.0
        while left >= calm * largest:
            if len(answer) >= LONGEST:
                raise RelayContactError(
                    f"the contact still vibrates {STEP * LONGEST:g} s after a blow: too little damping"
                )
            for number in range(len(answer), len(answer) + WATCHED):
                if number < 3:
                    begin, end = ((0.0, peak), (peak, 0.0), (0.0, 0.0))[number]
                    contact.fmu.setReal(input_, [begin])
                    contact.fmu.setRealInputDerivatives(input_, [1], [(end - begin) / STEP])
                contact.step(number * STEP, STEP)
                answer.append((contact.fmu.getReal(read)[0] - rest) / size)
            left, largest = max(map(abs, answer[-WATCHED:])), max(map(abs, answer))
    # The triangle begins one step before its peak, which the first of these is at.
    course = np.array(answer)
    # Lines close enough for the narrowest resonance, which the answer just shows.
    count = max(POINTS, 4 * len(course))
    spectrum = np.fft.rfft(course, count)
    frequency: Array = np.fft.rfftfreq(count, STEP).astype(np.float64)
    return Response(
        reserve, natural, frequency[frequency < 1e4],
        (spectrum * STEP / np.sinc(frequency * STEP) ** 2)[frequency < 1e4], course,
    )  # fmt: skip


def interrupting_force(law: list[float], threshold: float) -> float:
    """Give the contact force (N) at which the resistance is the threshold, by the power law."""
    coefficient, exponent = law
    return float((coefficient / threshold) ** (1 / exponent))


def margin(response: Response, test: Test, opening: float, chance: float = 0.5) -> float:
    """Return the factor of the level of a test that fails, that is, interrupts or closes the contact for a time (s).

    In random vibration it does so within the test with a chance.
    """
    match test:
        case Sine():
            return float(response.sine(test, opening)[1].min())
        case Random():
            return response.random(test, opening, chance)
        case Shock():
            return min(response.shock(test, opening).values())
    raise TypeError(test)
