"""Command line, tables and figures of the examples. Copy it along with an example that imports it."""

import argparse
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib as mpl
from numpy.typing import ArrayLike

mpl.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from relay_contact import ROOT, fmu_path

GRAVITY = 9.80665  # m/s2
# Colours of Okabe and Ito, told apart also by the colour-blind.
BLUE, ORANGE, RED, GREEN = "#0072B2", "#E69F00", "#D55E00", "#009E73"
PURPLE, SKY, BLACK, GREY = "#CC79A7", "#56B4E9", "#000000", "#666666"


def parser(description: str | None, **options: Any) -> argparse.ArgumentParser:  # noqa: ANN401
    """Give a command line with the options that every example has; `read_arguments` reads it."""
    line = argparse.ArgumentParser(description=description, **options)
    line.add_argument("--fmu", type=Path, default=fmu_path(), help="the component (%(default)s)")
    line.add_argument("--out", type=Path, default=ROOT / "out", help="folder for what is written (%(default)s)")
    return line


def read_arguments(line: argparse.ArgumentParser) -> argparse.Namespace:
    """Read the command line, see that the component is there, and make the folder for what is written."""
    given = line.parse_args()
    if not given.fmu.is_file():
        raise SystemExit(f"{given.fmu} is missing: build it with `cargo xtask fmu`")
    given.out.mkdir(parents=True, exist_ok=True)
    return given


def within(low: float, high: float, unit: str) -> Callable[[str], float]:
    """Give what reads a number of the command line that has to be in a range."""

    def number(text: str) -> float:
        value = float(text)
        if not low <= value <= high:
            raise argparse.ArgumentTypeError(f"{text}: must be from {low:g} to {high:g} {unit}")
        return value

    return number


def write_table(path: Path, names: str, rows: ArrayLike, digits: int = 12) -> None:
    """Write a CSV file with a line of names."""
    np.savetxt(path, rows, delimiter=",", header=names, comments="", fmt=f"%.{digits}g")


def save(figure: Figure, path: Path, dpi: int = 150) -> None:
    """Write a picture."""
    figure.savefig(path, dpi=dpi)
    plt.close(figure)


def legend_beside(axes: Axes) -> None:
    """Put the legend to the right of a panel."""
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize="small", frameon=False)


def acceleration_in_g(axes: Axes, vertical: bool = True) -> None:
    """Give an axis of base acceleration in m/s2 a second scale in g."""
    functions: Any = (lambda a: a / GRAVITY, lambda a: a * GRAVITY)
    if vertical:
        axes.secondary_yaxis("right", functions=functions).set_ylabel("base acceleration [g]")
    else:
        axes.secondary_xaxis("top", functions=functions).set_xlabel("base acceleration [g]")
