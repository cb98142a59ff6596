"""The closed contact as a linear system: the force that a base acceleration causes, while the contact stays closed.

The component answers a short pulse of the base acceleration with the contact bonded, that is, linear about its preload.
The Fourier transform of the answer over that of the pulse is the response to any vibration below the level at which the
contact opens; the margins of the tests follow from it. That level is where the contact is still closed, so that only
the stiffness of the contact, which changes with the force, is missing: the spring feels little of it.
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
POINTS = 2**18  # of the transform, every 0.38 Hz


@dataclass(frozen=True)
class Response:
    """Force per base acceleration over frequency, of a contact with a preload."""

    preload: float
    """Force (N) that vibration has to take off the contact for an interruption."""
    natural: float
    """Lowest frequency (Hz) of the closed contact by its stiffness."""
    frequency: Array
    transfer: NDArray[np.complex128]
    """Force over base acceleration, N per m/s2."""
    answer: Array
    """Force (N) after a pulse of one step that brings a velocity of 1 m/s, at every step."""

    @property
    def force(self) -> Array:
        """Magnitude of the transfer function, N per m/s2."""
        return np.abs(self.transfer)

    def settling(self, part: float = 1e-3) -> float:
        """Give the time (s) after which less than a part of a vibration is left."""
        left = np.maximum.accumulate(np.abs(self.answer[::-1]))[::-1]
        return STEP * int(np.argmax(left < part * left[0]))

    def bandwidth(self, frequency: float) -> float:
        """Give the width (Hz) of a resonance at half of its power."""
        at = int(np.searchsorted(self.frequency, frequency))
        low = self.force < self.force[at] / np.sqrt(2)
        below, above = np.flatnonzero(low[:at]), np.flatnonzero(low[at:])
        first = below[-1] if len(below) else 0
        last = at + (above[0] if len(above) else len(low) - at - 1)
        return float(self.frequency[last] - self.frequency[first])

    def sine(self, test: Sine, opening: float) -> tuple[Array, Array]:
        """Give the factors of the level that interrupt for a time (s), at the frequencies (Hz) of a sweep."""
        low, high = test.frequencies
        inside = (self.frequency >= low) & (self.frequency <= high)
        frequency = self.frequency[inside]
        # The force is below zero for the time where its amplitude is the preload over this cosine.
        needed = self.preload / np.cos(np.minimum(np.pi * frequency * opening, 1.5))
        return frequency, needed / (test.amplitude(frequency) * self.force[inside])

    def moments(self, test: Random) -> tuple[float, float]:
        """Give rms (N) and mean frequency (Hz) of the force in random vibration."""
        density = test.spectrum(self.frequency) * self.force**2
        step = self.frequency[1]
        power = float(density.sum() * step)
        return power**0.5, float((density * self.frequency**2).sum() * step / power) ** 0.5

    def random(self, test: Random, opening: float, chance: float = 0.5) -> float:
        """Give the factor of the level that interrupts within the test with a chance, by Rice's rate of crossings."""
        rms, mean = self.moments(test)
        needed = self.preload * (1 + (np.pi * mean * opening) ** 2 / 2)
        return float(needed / (rms * np.sqrt(2 * np.log(mean * test.duration / -np.log1p(-chance)))))

    def shock(self, test: Shock, opening: float) -> dict[str, float]:
        """Give the factors of the level that interrupt, by direction."""
        pulse = half_sine(test)
        count = 2 ** int(np.ceil(np.log2(len(pulse) + len(self.answer))))
        force = np.fft.irfft(np.fft.rfft(pulse, count) * np.fft.rfft(self.answer, count), count) * STEP
        dwell = max(1, round(opening / STEP))

        def dip(course: Array) -> float:
            """Give the level below which the force stays for the time."""
            lasting = np.lib.stride_tricks.sliding_window_view(course, dwell + 1).max(axis=1)
            return float(-lasting.min())

        return {way: self.preload / max(dip(sign * force), 1e-12) for way, sign in (("closing", 1), ("opening", -1))}


def half_sine(test: Shock) -> Array:
    """Give a shock at every step, m/s2."""
    time = STEP * np.arange(round(test.duration / STEP) + 1)
    return np.asarray(GRAVITY * test.acceleration * np.sin(np.pi * time / test.duration))


def respond(component: Component, values: Values, threshold: float) -> Response:
    """Have the component answer a pulse; `threshold` is the resistance (Ohm) above which the contact is interrupted."""
    linear: Values = {"effects.contactLaw": "Bonded", "effects.chatter": False, "effects.extremes": False}
    with component.started({**values, **linear}) as contact, contact.explained():
        force, input_ = contact.references("contact.force"), contact.references("base.acceleration")
        rest = contact.get("contact.force")
        natural = contact.get("preload.frequency")
        lost = interrupting_force(contact.real("resistance.coefficient", "resistance.exponent"), threshold)
        # Up within a step and down within the next, of any size, as the contact is bonded.
        peak = 1.0 / STEP
        answer: list[float] = []
        largest = calm = 1.0
        while calm >= CALM * largest:
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
                answer.append(contact.fmu.getReal(force)[0] - rest)
            calm, largest = max(map(abs, answer[-WATCHED:])), max(map(abs, answer))
    # The triangle begins one step before its peak, which the first of these is at.
    course = np.array(answer)
    spectrum = np.fft.rfft(course, max(POINTS, len(course)))
    frequency: Array = np.fft.rfftfreq(max(POINTS, len(course)), STEP).astype(np.float64)
    return Response(
        rest - lost, natural, frequency[frequency < 1e4],
        (spectrum * STEP / np.sinc(frequency * STEP) ** 2)[frequency < 1e4], course,
    )  # fmt: skip


def interrupting_force(law: list[float], threshold: float) -> float:
    """Give the contact force (N) at which the resistance is the threshold, by the power law."""
    coefficient, exponent = law
    return float((coefficient / threshold) ** (1 / exponent))


def margin(response: Response, test: Test, opening: float) -> float:
    """Give the factor of the level of a test that interrupts."""
    match test:
        case Sine():
            return float(response.sine(test, opening)[1].min())
        case Random():
            return response.random(test, opening)
        case Shock():
            return min(response.shock(test, opening).values())
    raise TypeError(test)
