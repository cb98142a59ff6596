"""Command line of the examples, and their pictures. Copy it along with an example that imports it."""

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from types import TracebackType

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from relay_contact import RelayContactError, fmu_path

ROOT = Path(__file__).resolve().parents[2]


Bounded = tuple[float, float, float, str, str]
"""A number of the command line: its default, least and greatest value, unit and meaning."""


def parser(description: str | None, quick: str = "", takes: str = "", **bounded: Bounded) -> argparse.ArgumentParser:
    """Give a command line with the options that every example has; `read_arguments` reads it.

    `quick` says what is less with --quick, if that is an option; `bounded` are numbers that have to be in a range.
    """
    epilog = f"Takes {takes}." if takes else None
    line = argparse.ArgumentParser(description=str(description).splitlines()[0], epilog=epilog)
    line.add_argument("--fmu", type=Path, default=fmu_path(), help="the component (%(default)s)")
    line.add_argument("--out", type=Path, default=ROOT / "out", help="folder for what is written (%(default)s)")
    if quick:
        line.add_argument("--quick", action="store_true", help=quick)
    for name, (value, low, high, unit, text) in bounded.items():
        told = f"{text} [{unit}], {low:g} to {high:g} (%(default)s)"
        line.add_argument(f"--{name}", type=within(low, high, unit), default=value, help=told)
    return line


def read_arguments(line: argparse.ArgumentParser) -> argparse.Namespace:
    """Read the command line, see that the component is there, and make the folder for what is written."""
    sys.excepthook = told
    given = line.parse_args()
    if not given.fmu.is_file():
        raise SystemExit(f"{given.fmu} is missing: build it with `cargo xtask fmu`")
    given.out.mkdir(parents=True, exist_ok=True)
    return given


def told(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
    """Say in a line what is wrong with a value or a file."""
    if isinstance(error, RelayContactError | OSError):
        print(error, file=sys.stderr)
    else:
        sys.__excepthook__(kind, error, trace)


def within(low: float, high: float, unit: str) -> Callable[[str], float]:
    """Give what reads a number of the command line that has to be in a range."""

    def number(text: str) -> float:
        value = float(text)
        if not low <= value <= high:
            raise argparse.ArgumentTypeError(f"{text}: must be from {low:g} to {high:g} {unit}")
        return value

    return number


def legend_beside(axes: Axes) -> None:
    """Put the legend to the right of a panel."""
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize="small", frameon=False)


def save(figure: Figure, path: Path, dpi: int = 150) -> None:
    """Write a picture."""
    figure.savefig(path, dpi=dpi)
    plt.close(figure)
