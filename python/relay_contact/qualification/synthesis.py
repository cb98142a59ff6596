"""Shock response spectra, and pulses of damped sines that meet a required one.

The spectrum is the largest absolute acceleration, during the pulse and after, of oscillators that it shakes; by the
recursive filter of D. O. Smallwood, Shock and Vibration Bulletin 51 (1981), exact for acceleration that is linear
between samples. Damped sines: D. O. Smallwood and A. R. Nord, Shock and Vibration Bulletin 44 (1974); their amplitudes
are corrected by the ratio of required and reached spectrum, again and again.
"""

from functools import lru_cache

import numpy as np

from relay_contact.component import Array
from relay_contact.figures import GRAVITY as G

SPACING = 2 ** (1 / 6)
"""Ratio of the frequencies of neighbouring sines: a sixth of an octave."""
DAMPING = 0.05
"""Share of critical of the sines; that of the one that takes back their change of velocity is CALM."""
CALM, BELOW = 0.5, 3.0
"""Its damping, and by which factor its frequency is below the lowest."""
SMOOTH = 16.0  # samples in a period of the highest sine; the pulse is straight between them, for the filter too
LEFT = 1e-3  # of a sine at the end of the pulse
ROUNDS, STRENGTH = 15, 0.7  # of corrections, and the power of each


def response(acceleration: Array, step: float, frequencies: Array, quality: float) -> Array:
    """Return the spectrum of a pulse at frequencies (Hz), in its unit."""
    # It takes long to import.
    from scipy.signal import lfilter

    found = []
    for frequency in frequencies:
        omega, damping = 2 * np.pi * frequency, 0.5 / quality
        turn = omega * np.sqrt(1 - damping**2) * step
        decay = np.exp(-damping * omega * step)
        cosine, sine = decay * np.cos(turn), decay * np.sin(turn) / turn
        # A period more: what it does after the pulse is largest within.
        padded = np.concatenate((acceleration, np.zeros(int(np.ceil(1 / frequency / step)))))
        own = lfilter((1 - sine, 2 * (sine - cosine), decay**2 - sine), (1, -2 * cosine, decay**2), padded)
        found.append(np.abs(own).max())
    return np.array(found)


def grid(low: float, high: float, spacing: float = SPACING) -> Array:
    """Return frequencies (Hz) evenly spaced on a logarithmic scale, `spacing` apart at most, both ends included."""
    return np.geomspace(low, high, int(np.ceil(np.log(high / low) / np.log(spacing) - 1e-9)) + 1)


@lru_cache
def pulse(required: tuple[tuple[float, float], ...], quality: float) -> tuple[Array, Array]:
    """Return time (s) and acceleration (m/s2) of a pulse whose spectrum is the required one (Hz, g) or more."""
    corners, levels = np.array(required).T
    frequencies, between = (grid(corners[0], corners[-1], spacing) for spacing in (SPACING, SPACING**0.25))
    wanted, whole = (
        G * np.exp(np.interp(np.log(each), np.log(corners), np.log(levels))) for each in (frequencies, between)
    )
    omega = 2 * np.pi * frequencies
    slow = omega[0] / BELOW
    step = 1 / SMOOTH / frequencies[-1]
    time = step * np.arange(int(np.ceil(np.log(1 / LEFT) / (DAMPING * omega[0]) / step)) + 1)
    shapes = np.exp(-DAMPING * np.multiply.outer(omega, time)) * np.sin(np.multiply.outer(omega, time))
    back = np.exp(-CALM * slow * time) * np.sin(slow * time)
    velocity = np.trapezoid(shapes, time) / np.trapezoid(back, time)
    # Signs that alternate keep the peak of the pulse low.
    amplitudes = wanted / quality * np.where(np.arange(len(omega)) % 2, -1.0, 1.0)
    best: tuple[float, Array] = (np.inf, time)
    for _ in range(ROUNDS):
        # At its end it is calm: what is left there is taken off in a line.
        course = amplitudes @ shapes - (amplitudes @ velocity) * back
        course -= course[-1] * (time / time[-1])
        ratio = wanted / response(course, step, frequencies, quality)
        excess = ratio.max() / ratio.min()
        if excess < best[0]:
            best = excess, course
        amplitudes *= ratio**STRENGTH
    # Raised to what is required between the sines, too.
    return time, best[1] * (whole / response(best[1], step, between, quality)).max()
