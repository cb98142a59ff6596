"""Figures of the report: curves over one pair of axes, drawn by matplotlib for the page and for docs/."""

import io
import re
from dataclasses import dataclass
from pathlib import Path
from textwrap import wrap
from typing import Any, Literal

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure as Drawing
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter
from numpy.typing import ArrayLike
from PIL import Image

from relay_contact.figures import BLUE, GREEN, ORANGE, PURPLE, RED, SKY

INK, LINE, PAPER = "#1b1f24", "#d1d7de", "#ffffff"
"""Text, grid and paper of a picture; on the page the colours of the style sheet stand in their place."""
COLOURS = (BLUE, RED, GREEN, PURPLE, ORANGE, SKY, INK)
STROKES: tuple[tuple[float, ...], ...] = ((), (9, 2), (9, 2, 2, 2), (9, 2, 2, 2, 2, 2), (16, 3))
DASHES: tuple[tuple[float, ...], ...] = ((4, 2.5), (1.5, 2), (3, 5), (5, 5), (5, 2))
"""Of lines and of dashed curves, by the order of their colours, so that they differ without colour, too."""
MARKERS = "osD^vp*"
STYLE: Any = {
    "font.size": 9.5, "font.family": "sans-serif", "text.color": INK, "axes.labelcolor": INK, "axes.edgecolor": INK,
    "xtick.color": INK, "ytick.color": INK, "axes.grid": True, "grid.color": LINE, "axes.axisbelow": True,
    "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False, "svg.fonttype": "none",
    "svg.hashsalt": "relay-contact", "axes.formatter.use_mathtext": True,
}  # fmt: skip
WIDE, NARROW = 9.6, 4.2
"""Widths of figures (in), for a desktop and for a phone."""

Style = Literal["line", "dashed", "points", "marked"]


@dataclass(frozen=True)
class Curve:
    """A curve, or points alone; those that belong together have the same colour, and need one name."""

    name: str
    x: ArrayLike
    y: ArrayLike
    style: Style = "line"
    colour: int = 0


@dataclass(frozen=True)
class Figure:
    """Curves, with the labels of the axes; `log` names the axes that are logarithmic, such as "xy"."""

    id: str
    title: str
    x: str
    y: str
    curves: list[Curve]
    log: str = ""

    def drawing(self, width: float) -> Drawing:
        """Draw the figure."""
        with mpl.rc_context(STYLE):
            drawing = Drawing(figsize=(width, 3.8), layout="constrained")
            axes = drawing.add_subplot()
            for curve in self.curves:
                self.draw(axes, curve)
            axes.set(xlabel=self.x, ylabel="\n".join(wrap(self.y, 36)))
            axes.margins(x=0.01)
            for letter, axis in (("x", axes.xaxis), ("y", axes.yaxis)):
                if letter in self.log:
                    logarithmic(axes, axis, letter)
            names = [curve.name for curve in self.curves if curve.name]
            if len(names) > 1:
                columns = max(1, int(11 * width / (max(map(len, names)) + 9)))
                drawing.set_figheight(3.8 + 0.21 * -(-len(names) // columns))
                drawing.legend(loc="outside lower left", ncols=columns, handlelength=3.4)
        return drawing

    def draw(self, axes: Axes, curve: Curve) -> None:
        """Draw a curve."""
        lines, marks = ("line",), ("points", "marked")
        colour = COLOURS[curve.colour % len(COLOURS)]
        line = axes.plot(curve.x, curve.y, color=colour, label=curve.name, linewidth=1.9, markersize=5.5)[0]
        if curve.style == "dashed":
            line.set(dashes=DASHES[self.rank(curve, ("dashed",)) % len(DASHES)], linewidth=1.4)
        elif curve.style == "line" and (dashes := STROKES[self.rank(curve, lines) % len(STROKES)]):
            line.set(dashes=dashes)
        if curve.style in marks:
            line.set(marker=MARKERS[self.rank(curve, marks) % len(MARKERS)])
        if curve.style == "points":
            # Hollow, so that what lies below them is seen.
            line.set(linestyle="none", fillstyle="none", markeredgewidth=1.5)
            line.set_markersize(3.5 if np.size(curve.x) > 100 else 6.5)

    def rank(self, curve: Curve, styles: tuple[str, ...]) -> int:
        """Return which of the colours of the curves of some styles a curve has."""
        colours = dict.fromkeys(each.colour for each in self.curves if each.style in styles)
        return list(colours).index(curve.colour)

    def svg(self, width: float) -> str:
        """Return the figure as part of a page, in the colours of its style sheet."""
        text = io.StringIO()
        with mpl.rc_context(STYLE):
            self.drawing(width).savefig(text, format="svg", transparent=True, metadata={"Date": None, "Creator": None})
        svg = text.getvalue()[text.getvalue().index("<svg") :]
        svg = svg.replace(INK, "var(--ink)").replace(LINE, "var(--line)")
        # Names within a picture are names of the page, too.
        own = f"{self.id}-{'wide' if width == WIDE else 'narrow'}-"
        svg = re.sub(r'(\bid="|href="#|url\(#)', rf"\g<1>{own}", svg)
        return svg.replace("<svg ", f'<svg role="img" aria-label="{self.title}: {self.y} over {self.x}" ', 1)

    def write(self, folder: Path) -> Path:
        """Write the figure as a small picture."""
        data = io.BytesIO()
        with mpl.rc_context(STYLE):
            self.drawing(0.75 * WIDE).savefig(data, dpi=90)
        path = folder / f"{self.id}.png"
        picture = Image.open(data).convert("RGB")
        # This method alone keeps the colours of thin lines.
        picture.quantize(256, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE).save(path, optimize=True)
        return path


def logarithmic(axes: Axes, axis: Axis, letter: str) -> None:
    """Make an axis logarithmic: over few decades, up to 1e5, with plain numbers, at 2 and 5 too."""
    axes.set(**{f"{letter}scale": "log"})
    low, high = axis.get_view_interval()
    decades = np.log10(high / low)
    axis.set_minor_formatter(NullFormatter())
    if decades < 4.5 and high < 1e5:
        axis.set_major_locator(LogLocator(subs=(1, 2, 5) if decades < 3 else (1,)))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
