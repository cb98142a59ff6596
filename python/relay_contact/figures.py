"""Colours and numbers of all figures."""

import math

GRAVITY = 9.80665  # m/s2
# Colours of Okabe and Ito, told apart also by the colour-blind.
BLUE, ORANGE, RED, GREEN = "#0072B2", "#E69F00", "#D55E00", "#009E73"
PURPLE, SKY, BLACK, GREY = "#CC79A7", "#56B4E9", "#000000", "#666666"

ROUNDED = 1e-9
"""Part by which a ratio of equal numbers differs from 1 after rounding, and more."""


def three(value: float) -> str:
    """Return a number with three significant digits, without an exponent; on its own side of 1, if it takes more."""
    if not value or not math.isfinite(value):
        return f"{value:g}"
    if math.isclose(value, 1, rel_tol=ROUNDED):
        return "1.00"
    for digits in range(3, 16):
        rounded = float(f"{value:.{digits - 1}e}")
        if (rounded < 1) == (value < 1) and (rounded > 1) == (value > 1):
            break
    places = digits - 1 - math.floor(math.log10(abs(rounded)))
    return f"{rounded:.{max(places, 0)}f}"
