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


@dataclass(frozen=True)
class Surface:
    """A quantity over the scores of parameters, by its values in some draws."""

    scores: Array
    values: Array

    def __call__(self, scores: Array) -> Array:
        """Return it for other scores."""
        if not self.scores.shape[1]:
            return np.full(len(scores), self.values[0])
        count = len(self.scores)
        plane, *_ = np.linalg.lstsq(terms(self.scores, count), self.values)
        left = self.values - terms(self.scores, count) @ plane
        # Distances as radial functions, and a constant.
        corner = np.ones((count, 1))
        between = np.block([[distances(self.scores, self.scores), corner], [corner.T, np.zeros((1, 1))]])
        *radial, constant = np.linalg.solve(between, np.append(left, 0.0))
        return np.asarray(terms(scores, count) @ plane + distances(scores, self.scores) @ radial + constant)

    @property
    def error(self) -> float:
        """Return its standard error in draws that it does not know."""
        if not self.scores.shape[1]:
            return 0.0
        left = []
        for fold in range(FOLDS):
            out = np.arange(len(self.scores)) % FOLDS == fold
            left.append(Surface(self.scores[~out], self.values[~out])(self.scores[out]) - self.values[out])
        return float(np.sqrt(np.mean(np.concatenate(left) ** 2)))


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
