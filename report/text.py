"""Texts in Markdown: numbers, tables and templates."""

import math
import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from relay_contact.figures import significant
from report.figure import Figure

TEMPLATES = Path(__file__).parent / "templates"


def number(value: float, digits: int) -> str:
    """Return a number with digits after the point; never minus zero, whose sign would be that of rounding."""
    text = f"{value:.{digits}f}"
    return text if any(digit in "123456789" for digit in text) else text.removeprefix("-")


def signed(value: float, digits: int) -> str:
    """Return a number with its sign, unless it is rounded to zero."""
    text = number(value, digits)
    return f"+{text}" if float(text) > 0 else text


def percent(ratio: float, digits: int = 2) -> str:
    """Return the deviation of a ratio from 1."""
    return f"{signed(100 * (ratio - 1), digits)} %"


def two_digits(value: float) -> str:
    """Return a number with two significant digits, or all before the point; very small and large ones with one."""
    if not value:
        return "0"
    if 0.01 <= value < 1e4:
        return number(value, max(1 - math.floor(math.log10(value)), 0))
    return short(value)


def plain(value: float) -> str:
    """Return a round number without zeros behind: 0.1, 10."""
    return f"{value:g}"


def short(value: float, digits: int = 0) -> str:
    """Return a number with an exponent that has no zeros in front: 1e-6."""
    mantissa, _, exponent = f"{value:.{digits}e}".partition("e")
    return f"{mantissa}e{int(exponent)}"


def table(columns: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table; columns that mostly hold numbers are aligned to the right."""
    rows = list(rows)

    def numeric(cell: str) -> bool:
        return re.match(r"[^\w(]*\d|[^\w(]*$", cell) is not None

    rules = []
    for place in range(len(columns)):
        cells = [row[place] for row in rows if row[place]]
        rules.append("---:" if 2 * sum(map(numeric, cells)) > len(cells) else "---")
    lines = [columns, rules, *rows]
    return "\n".join(f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in line)} |" for line in lines)


def rendered(name: str, figures: Iterable[Figure], values: dict[str, Any]) -> tuple[str, dict[str, str]]:
    """Return a template of Markdown with its values, and `leads`: what its sections say in a sentence, by titles."""
    known = {each.id: each for each in figures}

    def figure(id: str) -> str:  # noqa: A002
        title = known[id].title
        return f"### {title}\n\n![{title}](report/{id}.png)"

    environment = Environment(
        loader=FileSystemLoader(TEMPLATES), undefined=StrictUndefined, keep_trailing_newline=True, autoescape=False
    )
    for each in (number, plain, signed, percent, significant, two_digits, short):
        environment.filters[each.__name__] = each
    module = environment.get_template(name).make_module({"figure": figure, **values})
    return str(module), getattr(module, "leads", {})
