"""Draws the component's icon, docs/model.png: a cantilever spring with its rivet on the fixed contact."""

from pathlib import Path

import matplotlib as mpl
import numpy as np

mpl.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.patches import Circle, Rectangle

FOLDER = Path(__file__).parent
BLUE, ORANGE, GREY, BLACK = "#0072B2", "#D55E00", "#555555", "#1b1f24"


def icon() -> None:
    """Draw the icon."""
    figure = plt.figure(figsize=(3, 2), dpi=100)
    axes = figure.add_axes((0, 0, 1, 1), xlim=(0, 15), ylim=(0, 10), aspect="equal")
    axes.axis("off")
    # Clamp and fixed contact on the base, with the hatching of a fixed support; the base moves as one.
    for corner, width, height in (((0.5, 2.0), 1.3, 5.6), ((0.5, 1.0), 11.3, 1.0)):
        axes.add_patch(
            Rectangle(corner, width, height, facecolor="#dddddd", edgecolor=GREY, hatch="///", linewidth=1.5)
        )
    axes.add_patch(Rectangle((9.0, 2.0), 2.8, 2.75, facecolor=ORANGE, edgecolor="none"))
    # Spring: straight where nothing touches it (dashed), bent by the overtravel like a cantilever under a tip load.
    x = np.linspace(0, 1, 50)
    axes.plot(1.8 + 8.6 * x, 4.5 + 0 * x, color=BLUE, linewidth=1.2, linestyle=(0, (4, 2)))
    axes.plot(1.8 + 8.6 * x, 4.5 + 0.7 * (3 * x**2 - x**3), color=BLUE, linewidth=6, solid_capstyle="butt")
    axes.add_patch(Circle((10.4, 5.9), 1.15, facecolor=BLUE, edgecolor="none"))
    # Length, overtravel, motion of the base.
    axes.plot([11.5, 12.9], [5.9, 5.9], color=GREY, linewidth=0.8)
    axes.plot([11.9, 12.9], [4.5, 4.5], color=GREY, linewidth=0.8)
    for ends, place, text in (
        (((1.8, 8.4), (10.4, 8.4)), (6.1, 9.1), "L"),
        (((12.5, 4.5), (12.5, 5.9)), (13.2, 5.2), "s"),
        (((13.3, 0.4), (13.3, 3.0)), (14.1, 1.7), "a"),
    ):
        style = {"arrowstyle": "<->", "color": BLACK, "linewidth": 1.3, "shrinkA": 0, "shrinkB": 0}
        axes.annotate("", xy=ends[0], xytext=ends[1], arrowprops=style)
        axes.text(*place, text, ha="center", va="center", fontsize=12, fontstyle="italic", color=BLACK)
    # Without metadata the file is the same every time.
    figure.savefig(FOLDER / "model.png", metadata={"Software": None})


if __name__ == "__main__":
    icon()
