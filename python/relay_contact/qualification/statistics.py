"""From a margin in some draws of the uncertain parameters to its distribution: many draws, the chance of failing.

The component answers a pulse in some hundred draws, whose margins a polynomial and radial functions between them
follow; how well is told by draws that are left out in turn. The margins of very many draws then cost nothing.
"""

from dataclasses import dataclass

import numpy as np

from relay_contact.component import Array

MANY = 10_000
"""Draws: a chance of 1000 ppm is known to a fifth of it, and none that fails means less than 369 ppm."""
SEED = 2
FOLDS = 8
CONFIDENCE = 0.95
HARMONICS = 10
SHARE = 3  # of the draws that a polynomial has coefficients, at most one in so many


def terms(scores: Array, count: int) -> Array:
    """Return the terms of a polynomial of second degree, of squares alone if `count` draws do not tell more."""
    number = scores.shape[1]
    products = [scores[:, i] * scores[:, j] for i in range(number) for j in range(i)]
    if SHARE * (1 + 2 * number + len(products)) > count:
        products = []
    return np.column_stack([np.ones(len(scores)), scores, scores**2, *products])


def distances(scores: Array, others: Array) -> Array:
    """Return how far rows of scores are from others."""
    squares = (scores**2).sum(axis=1)[:, None] + (others**2).sum(axis=1) - 2 * scores @ others.T
    return np.asarray(np.sqrt(np.maximum(squares, 0.0)))


def followed(known: Array, values: Array, scores: Array) -> Array:
    """Return columns of values, known in some rows of scores, for others: a polynomial and radial functions."""
    count, columns = values.shape
    if not count:
        return np.zeros((len(scores), columns))
    plane, *_ = np.linalg.lstsq(terms(known, count), values)
    # Distances as radial functions, and a constant.
    corner = np.ones((count, 1))
    between = np.block([[distances(known, known), corner], [corner.T, np.zeros((1, 1))]])
    *radial, constant = np.linalg.solve(between, np.vstack((values - terms(known, count) @ plane, np.zeros(columns))))
    return np.asarray(terms(scores, count) @ plane + distances(scores, known) @ np.array(radial) + constant)


@dataclass(frozen=True)
class Surface:
    """The logarithm of a margin over the scores of parameters, by its values in some draws.

    It falls without end where less and less is left at rest. What is left goes evenly down to nothing, and what is more
    than its logarithm goes evenly, too: both are followed.
    """

    scores: Array
    values: Array
    left: Array
    """Force (N) or gap (m) at rest, by draws; of one that fails at rest none. NaN: not known. 1 if none fails."""

    def __call__(self, scores: Array) -> Array:
        """Return it for other scores; of those that fail at rest -inf."""
        if not self.scores.shape[1]:
            return np.full(len(scores), self.values[0])
        over, left = self.apart(scores)
        with np.errstate(divide="ignore"):
            return np.asarray(over + np.log(np.maximum(left, 0.0)))

    def apart(self, scores: Array) -> Array:
        """Return for other scores what is more than the logarithm of what is left, and what is left."""
        own = self.left > 0
        known = np.column_stack((self.values[own] - np.log(self.left[own]), self.left[own]))
        return followed(self.scores[own], known, scores).T

    @property
    def error(self) -> float:
        """Return its standard error in draws that it does not know, that of what is left as a part of its mean."""
        if not self.scores.shape[1] or not (self.left > 0).any():
            return 0.0
        wrong, missed = [], []
        for fold in range(FOLDS):
            out = np.arange(len(self.scores)) % FOLDS == fold
            own = self.left[out] > 0
            over, left = Surface(self.scores[~out], self.values[~out], self.left[~out]).apart(self.scores[out])
            wrong.append((over - self.values[out])[own] + np.log(self.left[out][own]))
            missed.append(np.maximum(left, 0.0) - np.maximum(self.left[out], 0.0))
        shape, left = (np.concatenate(each) for each in (wrong, missed))
        mean = np.mean(self.left, where=self.left > 0)
        return float(np.sqrt(np.mean(shape**2)) + np.sqrt(np.nanmean(left**2)) / mean)


def drawn(count: int) -> Array:
    """Return many independent scores of so many quantities, in columns."""
    return np.random.default_rng(SEED).standard_normal((MANY, count))


def chance(margins: Array, error: float) -> tuple[float, float, float]:
    """Return the chance that a margin is below 1, and the ends of its own interval.

    By Clopper and Pearson, with the margins wrong by an error, as parts of them, either way.
    """
    # Loaded here: it takes a tenth of the time of a short qualification, and is needed with draws alone.
    from scipy.special import betaincinv

    number = len(margins)
    fewest, found, most = (int((margins < level).sum()) for level in (1 - error, 1, 1 + error))
    tail = (1 - CONFIDENCE) / 2
    low = float(betaincinv(fewest, number - fewest + 1, tail)) if fewest else 0.0
    high = float(betaincinv(most + 1, number - most, 1 - tail)) if most < number else 1.0
    return found / number, low, high


def first_order(scores: Array, margins: Array, names: list[str]) -> dict[str, float]:
    """Return the first-order Sobol index of each quantity: by which share the variance falls once it is known.

    From the draws themselves, so that quantities may be correlated: what is known of one then tells of the others. In
    the order of a quantity, up over every other draw and down over the rest, what follows it has few harmonics
    (E. Plischke, Reliability Engineering and System Safety 95, 2010; corrected by Tissot and Prieur, ibid. 107, 2012).
    """
    if not names or np.ptp(margins) <= 1e-9 * margins.mean():
        return dict.fromkeys(names, 0.0)
    found = {}
    for name, score in zip(names, scores.T, strict=True):
        order = np.argsort(score)
        power = np.abs(np.fft.rfft(margins[np.concatenate((order[::2], order[1::2][::-1]))])[1:]) ** 2
        share, by_chance = power[:HARMONICS].sum() / power.sum(), 2 * HARMONICS / len(margins)
        found[name] = float(np.clip(1 - (1 - share) / (1 - by_chance), 0.0, 1.0))
    return found
