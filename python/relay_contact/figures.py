"""Colours, numbers and files of all figures."""

import math
import re
from pathlib import Path
from typing import TYPE_CHECKING

from relay_contact.files import at_once

if TYPE_CHECKING:
    from matplotlib.figure import Figure

GRAVITY = 9.80665  # m/s2
# Colours of Okabe and Ito, told apart also by the colour-blind.
BLUE, ORANGE, RED, GREEN = "#0072B2", "#E69F00", "#D55E00", "#009E73"
PURPLE, SKY, BLACK, GREY = "#CC79A7", "#56B4E9", "#000000", "#666666"

ROUNDED = 1e-9
"""Part by which a ratio of equal numbers differs from 1 after rounding, and more."""


def significant(value: float, digits: int = 4) -> str:
    """Return a number with so many significant digits, without an exponent."""
    if not value or not math.isfinite(value):
        return f"{value:g}"
    rounded = float(f"{value:.{digits - 1}e}")
    return f"{rounded:.{max(digits - 1 - math.floor(math.log10(abs(rounded))), 0)}f}"


def three(value: float) -> str:
    """Return a number with three significant digits, without an exponent; on its own side of 1, if it takes more."""
    if math.isclose(value, 1, rel_tol=ROUNDED):
        return "1.00"
    texts = (significant(value, digits) for digits in range(3, 16))
    return next(text for text in texts if (float(text) < 1) == (value < 1) and (float(text) > 1) == (value > 1))


def verbatim(figure: "Figure") -> "Figure":
    """Return a figure whose texts are no formulas, but those of ticks: users' names may have signs of dollars."""
    # It takes long to import.
    from matplotlib.text import Text

    for text in figure.findobj(Text):
        if isinstance(text, Text):
            # Once, however often it is drawn.
            text.set_text(re.sub(r"(?<!\\)\$", r"\\$", text.get_text()))
    return figure


def save(figure: "Figure", path: Path) -> None:
    """Write a figure, as a whole or not at all."""
    with at_once(path) as part:
        verbatim(figure).savefig(part, format="png", dpi=130)
