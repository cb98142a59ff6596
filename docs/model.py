"""Draws the component's icon, docs/model.png: a cantilever spring with its rivet on the fixed contact.

And docs/relay.svg, a sketch of the whole relay with the names of its parts.
"""

from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np

mpl.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.axes import Axes
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


def frame(axes: Axes) -> None:
    """Draw all that moves with the base: frame, clamp, core with its coil, rest stop, bracket of the second contact."""
    still: dict[str, Any] = {"facecolor": "#dddddd", "edgecolor": GREY, "linewidth": 1.0}
    for corner, width, height in (
        ((0.5, 0.5), 23.0, 0.8), ((0.5, 1.3), 0.7, 11.0), ((0.5, 11.5), 12.5, 0.8), ((7.0, 1.3), 1.4, 4.9),
        ((22.3, 1.3), 1.2, 6.7),
    ):  # fmt: skip
        axes.add_patch(Rectangle(corner, width, height, hatch="///", **still))
    axes.add_patch(Rectangle((3.0, 1.3), 1.4, 6.0, facecolor="#999999", edgecolor=BLACK, linewidth=1.0))
    for side in (1.9, 4.4):
        axes.add_patch(Rectangle((side, 2.0), 1.1, 4.2, facecolor="white", edgecolor=BLACK, linewidth=1.0, hatch="xxx"))
    axes.add_patch(Rectangle((3.0, 9.9), 1.4, 1.6, facecolor="#999999", edgecolor=BLACK, linewidth=1.0))
    axes.add_patch(Rectangle((19.4, 7.3), 2.9, 0.7, **still))


def parts(axes: Axes) -> None:
    """Draw all that moves of itself, and the contacts."""
    for height, colour in ((5.4, BLUE), (2.7, "#999999")):
        axes.plot([8.4, 19.4], [height, height], color=colour, linewidth=5, solid_capstyle="butt")
    axes.add_patch(Circle((18.5, 4.95), 0.6, facecolor=BLUE, edgecolor="none"))
    axes.add_patch(Rectangle((17.8, 2.9), 1.4, 1.45, facecolor=ORANGE, edgecolor=BLACK, linewidth=1.0))
    axes.add_patch(Rectangle((17.8, 6.9), 1.6, 1.1, facecolor=ORANGE, edgecolor=BLACK, linewidth=1.0))
    # Armature with the pusher, and the return spring.
    axes.add_patch(Rectangle((2.0, 8.1), 11.4, 0.9, facecolor="white", edgecolor=BLACK, linewidth=1.6))
    axes.add_patch(Rectangle((12.3, 5.85), 0.9, 2.25, facecolor="white", edgecolor=BLACK, linewidth=1.6))
    axes.add_patch(Circle((12.75, 5.85), 0.3, facecolor=BLACK, edgecolor="none"))
    turns = np.linspace(9.0, 11.5, 14)
    swing = np.array([0.0, 0.0, *[0.45, -0.45] * 5, 0.0, 0.0])
    axes.plot(11.7 + swing, turns, color=BLACK, linewidth=1.2)


def names(axes: Axes) -> None:
    """Write the names of the parts and of their parameters, and draw what is measured."""
    for place, part, parameters, to, ha in (
        ((15.2, 10.0), "armature", "armature.*", (13.4, 8.6), "left"),
        ((15.2, 11.6), "return spring", "armature.stiffness, .returnForce", (12.3, 10.9), "left"),
        ((4.9, 10.5), "rest stop", "armature.restPosition", (4.4, 10.4), "left"),
        ((11.8, 7.0), "pusher", "pusher.*", (12.3, 7.0), "right"),
        ((24.2, 8.9), "second contact", "second.*", (19.4, 7.7), "left"),
        ((24.2, 4.4), "contact", "contact.*", (19.15, 4.45), "left"),
        ((24.2, 6.6), "moving spring", "beam.*, beam.file", (19.4, 5.45), "left"),
        ((24.2, 2.4), "fixed spring", "fixed.*, fixed.file", (19.4, 2.7), "left"),
        ((-0.4, 4.3), "coil", "coil.relativeCurrent", (1.9, 4.3), "right"),
        ((-0.4, 6.9), "core", "armature.corePosition", (3.0, 6.8), "right"),
    ):
        axes.plot([place[0], to[0]], [place[1], to[1]], color=GREY, linewidth=0.7, zorder=5)
        beside = place[0] + (0.15 if ha == "left" else -0.15)
        axes.text(beside, place[1] + 0.05, part, ha=ha, va="bottom", fontsize=10, color=BLACK)
        axes.text(beside, place[1] - 0.1, parameters, ha=ha, va="top", fontsize=7.5, family="monospace", color=BLACK)
    style = {"arrowstyle": "<->", "color": BLACK, "linewidth": 0.9, "shrinkA": 0, "shrinkB": 0}
    for ends, place, text, ha in (
        (((8.4, 4.7), (12.75, 4.7)), (10.6, 4.55), "pusher.position", "center"),
        (((5.5, 7.3), (5.5, 8.1)), (5.75, 7.6), "armature.gap", "left"),
        (((16.6, 5.55), (16.6, 6.9)), (16.4, 6.15), "second.gap", "right"),
    ):
        axes.annotate("", xy=ends[0], xytext=ends[1], arrowprops=style)
        va = "top" if ha == "center" else "center"
        axes.text(*place, text, ha=ha, va=va, fontsize=7.5, family="monospace", color=BLACK)
    for (left, height), right in (((4.4, 7.3), 5.8), ((16.3, 6.9), 17.8)):
        axes.plot([left, right], [height, height], color=GREY, linewidth=0.7)
    axes.plot([12.75, 12.75], [4.5, 5.3], color=GREY, linewidth=0.7)
    # Which way is positive.
    for start, end, place, text, ha in (
        ((14.3, 8.9), (14.3, 7.7), (14.6, 8.5), "pusher.displacement", "left"),
        ((16.4, 3.4), (16.4, 4.6), (16.2, 3.7), "tip.displacement", "right"),
        ((12.0, -0.3), (12.0, 0.4), (12.3, -0.2), "base.acceleration", "left"),
    ):
        axes.annotate("", xy=end, xytext=start, arrowprops={**style, "arrowstyle": "->"})
        axes.text(*place, text, ha=ha, va="center", fontsize=7.5, family="monospace", color=BLACK)


def relay() -> None:
    """Draw the sketch of the relay."""
    figure = plt.figure(figsize=(8.6, 3.7))
    axes = figure.add_axes((0, 0, 1, 1), xlim=(-6.3, 30.0), ylim=(-0.8, 12.9), aspect="equal")
    axes.axis("off")
    frame(axes)
    parts(axes)
    names(axes)
    # Without date, and with numbers of its own, the file is the same every time.
    with mpl.rc_context({"svg.hashsalt": "relay"}):
        figure.savefig(FOLDER / "relay.svg", metadata={"Date": None, "Creator": None})


def main() -> None:
    """Draw both."""
    icon()
    relay()


if __name__ == "__main__":
    main()
