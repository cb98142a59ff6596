"""The level at which something just fails, found by trying others."""

from collections.abc import Callable

import numpy as np

RESOLUTION, ROUGHLY = 1e-4, 5e-4  # of levels, and of those in draws or at other frequencies
MOST = 1e3
"""Margin from which on a part counts as one that does not fail: what a test does not shake has an endless one."""
FAR = 1e2  # times the level that is expected, up to which no level fails: none does
ASIDE = 0.25  # of a resolution: how far beside the level that is expected just to fail others are tried

Lengths = dict[str, float]
"""Length (s) of the failures that count, by what failed; of a part that is held, of the steps in which it was left."""

Tried = Callable[[float], tuple[Lengths, float]]
"""What fails at a factor of a level and, if it can be told, `Specimen.ahead`."""


def threshold(
    tried: Tried, guess: float, failing: Lengths | None = None, *, roughly: bool = False
) -> tuple[float, list[str]]:
    """Return a factor of a level that fails, just above one that does not, and what fails there.

    `failing` is what is known to fail at the guess itself. From one side to the other of where secants cross 0, by
    halves where they do not close in. `roughly`: by less, and a level where a secant crosses is enough.
    """
    resolution = ROUGHLY if roughly else RESOLUTION
    low, high, failed = 0.0, guess if failing else np.inf, failing or {}
    level = guess / 1.01 if failing else guess
    near: list[tuple[float, float]] = []
    widths = [np.inf, np.inf]
    while True:
        found, ahead = tried(level)
        low, high, failed = (low, level, found) if found else (level, high, failed)
        if high <= (1 + resolution) * low or high < 1e-3 * guess:
            return high, list(failed)
        if high == np.inf and low > min(FAR * guess, MOST):
            return max(low, MOST), []
        if ahead:
            near = sorted([*near, (ahead * level, level)], key=lambda each: abs(each[0]))[:2]
        root = crossing(near)
        met = len(near) > 1 and near[0][1] == level and abs(level / root - 1) < resolution
        if roughly and met and low < (1 + resolution) * root and root < (1 + resolution) * high:
            return root, list(failed)
        nearer = high == np.inf or root - low < high - root
        beyond = root * (1 + (ASIDE if nearer else -ASIDE) * resolution)
        if high == np.inf:
            level = min(beyond, 1.25 * low) if beyond > low else 1.1 * low
        elif not low:
            level = max(beyond, high / 1.25) if beyond < high else high / 1.1
        else:
            widths.append(high - low)
            slow = widths[-1] > widths[-3] / 2
            level = (low * high) ** 0.5 if slow or not low < beyond < high else beyond


def crossing(near: list[tuple[float, float]]) -> float:
    """Return the level at which what is ahead of it vanishes, by what is ahead of one or two others."""
    if not near:
        return np.nan
    (ahead, level), (other, beside) = near[0], near[-1]
    slope = (other - ahead) / (beside - level) if other != ahead else -1.0
    return level - ahead / min(slope, -1e-9)
