"""Draws the component's icon, docs/model.png: a cantilever spring with its rivet on the fixed contact."""

from pathlib import Path

import matplotlib as mpl
import numpy as np

mpl.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.patches import Circle, Rectangle

BLUE, ORANGE, GREY = "#0072B2", "#D55E00", "#555555"


def main() -> None:
    """Draw the icon."""
    figure = plt.figure(figsize=(2, 2), dpi=100)
    axes = figure.add_axes((0, 0, 1, 1), xlim=(0, 10), ylim=(0, 10), aspect="equal")
    axes.axis("off")
    # Clamp, with the hatching of a fixed support.
    axes.add_patch(Rectangle((0.5, 2.6), 1.3, 5.6, facecolor="#dddddd", edgecolor=GREY, hatch="///", linewidth=2))
    # Spring: bent upwards by the fixed contact, in the shape of a cantilever under a tip load.
    x = np.linspace(0, 1, 50)
    axes.plot(1.8 + 6.2 * x, 5 + 0.7 * (3 * x**2 - x**3), color=BLUE, linewidth=9, solid_capstyle="butt")
    # Rivet and fixed contact.
    axes.add_patch(Circle((8.0, 5.95), 1.15, facecolor=BLUE, edgecolor="none"))
    axes.add_patch(Rectangle((6.6, 2.6), 2.8, 2.2, facecolor=ORANGE, edgecolor="none"))
    axes.add_patch(Rectangle((6.6, 1.6), 2.8, 1.0, facecolor="#dddddd", edgecolor=GREY, hatch="///", linewidth=2))
    # Vibration of the base.
    axes.annotate("", xy=(4.4, 1.2), xytext=(4.4, 4.3), arrowprops={"arrowstyle": "<->", "color": GREY, "linewidth": 3})
    # Without metadata the file is the same every time.
    figure.savefig(Path(__file__).with_suffix(".png"), metadata={"Software": None})


if __name__ == "__main__":
    main()
