"""A ring-down by itself: rate of decay and frequency, all that its record tells of the spring, and how well it does.

Size, phase and offset are free: they are eliminated for each trial of the two others (G. H. Golub, V. Pereyra, SIAM J.
Numer. Anal. 10 (1973) 413-432). What a record tells of all parameters of a relay it tells by these two numbers, so that
parameters on which both depend alike stay undetermined, however fine the record is.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import lstsq, qr
from scipy.optimize import least_squares

from relay_contact.component import Array

DECAYS = (0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0)  # over the record, from which the search starts
FREE = 5  # size, phase, offset, rate of decay, frequency
GROWTH = 3.0  # over the record, of a vibration that grows by chance


@dataclass(frozen=True)
class RingDown:
    """What a record tells, its values relative to the largest."""

    pole: Array
    """Rate of decay (1/s) and angular frequency (rad/s)."""
    root: Array
    """By these: what of the residuals size, phase and offset cannot take away, in two rows, as a triangle."""
    left: float
    """Sum of squares of the residuals."""
    freedom: int
    """Their degrees of freedom."""


def shapes(time: Array, pole: Array) -> Array:
    """Return the motions with a pole, which together have any size, phase and offset, in columns."""
    since = time - time[0]
    size, phase = np.exp(-pole[0] * since), pole[1] * since
    return np.column_stack((size * np.cos(phase), size * np.sin(phase), np.ones(len(time))))


def fitted(time: Array, values: Array, pole: Array) -> tuple[Array, Array]:
    """Return the motion with a pole that is closest to a record, and its derivatives by the pole, in columns."""
    columns = shapes(time, pole)
    cosine, sine, offset = lstsq(columns, values)[0]
    since = time - time[0]
    along = columns[:, 0] * cosine + columns[:, 1] * sine
    across = columns[:, 0] * sine - columns[:, 1] * cosine
    return along + offset, np.column_stack((-since * along, since * across))


def ring_down(time: Array, values: Array) -> RingDown:
    """Fit a decaying sine to a record over time (s)."""
    values = values / np.abs(values).max()
    length = time[-1] - time[0]

    def residuals(pole: Array) -> Array:
        return values - fitted(time, values, pole)[0]

    def derivatives(pole: Array) -> Array:
        """By the pole; size, phase and offset follow (L. Kaufman, BIT 15 (1975) 49-57)."""
        basis, _ = qr(shapes(time, pole), mode="economic")
        by_pole = fitted(time, values, pole)[1]
        return np.asarray(basis @ (basis.T @ by_pole) - by_pole)

    angular = 2 * np.pi * strongest(time, values)
    trials = [np.array([decay / length, angular]) for decay in DECAYS]
    start = min(trials, key=lambda pole: float((residuals(pole) ** 2).sum()))
    bounds = ([-GROWTH / length, 0.0], [np.inf, np.pi * (len(time) - 1) / length])
    scale = np.array([max(start[0], 1 / length)] * 2)
    found = least_squares(residuals, start, derivatives, bounds, x_scale=scale, ftol=1e-12, xtol=1e-12, gtol=None)
    root = qr(-derivatives(found.x), mode="r")[0][:2]
    return RingDown(found.x, root, float((residuals(found.x) ** 2).sum()), len(time) - FREE)


def strongest(time: Array, values: Array) -> float:
    """Return the frequency (Hz) at which a record has its largest amplitude, of 8 for each line of its spectrum."""
    even = np.linspace(time[0], time[-1], len(time))
    spectrum = np.abs(np.fft.rfft(np.interp(even, time, values) - values.mean(), 8 * len(time)))
    return float(max(1, int(spectrum.argmax())) * (len(time) - 1) / (8 * len(time) * (time[-1] - time[0])))
