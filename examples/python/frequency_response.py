"""Draw out/frequency-response.csv, which `cargo run --example frequency_response` writes."""

import argparse
import csv
from collections import defaultdict
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from common import save
from relay_contact.figures import BLUE, GRAVITY, GREY, ORANGE, RED, acceleration_in_g

COLOURS = (BLUE, ORANGE, RED)

# Label and look of each curve.
STYLES: dict[str, tuple[str, dict[str, Any]]] = {
    "linear": ("linear (contact held closed)", {"linestyle": "-", "linewidth": 1.4}),
    "up": ("nonlinear, stepped up", {"linestyle": "none", "marker": "|", "markersize": 8}),
    "down": ("nonlinear, stepped down", {"linestyle": "none", "marker": "o", "markersize": 4, "fillstyle": "none"}),
}

Points = list[tuple[float, float, float]]
"""Acceleration [m/s2], frequency [Hz], amplitude of the force [N]."""


def read(path: Path) -> dict[str, Points]:
    """Give the points of each curve."""
    curves: dict[str, Points] = defaultdict(list)
    with path.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            force = float(row["force_amplitude"] or "nan")
            curves[row["curve"]].append((float(row["acceleration"]), float(row["frequency"]), force))
    return curves


def response(axes: Axes, curves: dict[str, Points]) -> None:
    """Draw the amplitude of the force over the frequency; blows are so strong that the scale is logarithmic."""
    preload = 100 * curves["linear threshold"][0][2]
    axes.axhline(preload, color=GREY, linestyle=":", linewidth=1.2)
    axes.annotate("preload", (30, preload), xytext=(0, 3), textcoords="offset points", color=GREY, fontsize="small")
    accelerations = sorted({point[0] for point in curves["linear"]})
    for acceleration, colour in zip(accelerations, COLOURS, strict=True):
        for curve, (_, style) in STYLES.items():
            points = [point for point in curves[curve] if point[0] == acceleration]
            axes.plot([p[1] for p in points], [100 * p[2] for p in points], color=colour, **style)
    handles = [Line2D([], [], color="black", label=label, **style) for label, style in STYLES.values()]
    handles += [
        Line2D([], [], color=colour, linewidth=5, label=f"{a:g} m/s² ({a / GRAVITY:.1f} g)")
        for a, colour in reversed(list(zip(accelerations, COLOURS, strict=True)))
    ]
    axes.legend(handles=handles, loc="upper right", fontsize="small", frameon=False)
    axes.set(xlabel="frequency [Hz]", ylabel="half of peak-to-peak contact force [cN]", xlim=(0, 3050))
    axes.set_yscale("log")
    axes.yaxis.set_major_formatter("{x:g}")
    axes.set_title("Response to base vibration", fontsize="medium")


def thresholds(axes: Axes, curves: dict[str, Points]) -> None:
    """Draw the acceleration at which the contact opens over the frequency."""
    linear, nonlinear = curves["linear threshold"], curves["threshold"]
    frequencies, accelerations = [p[1] for p in linear], [p[0] for p in linear]
    axes.fill_between(frequencies, accelerations, 1400, color=RED, alpha=0.08, linewidth=0)
    axes.plot(frequencies, accelerations, color=BLUE, label="linear: force amplitude = preload")
    dots: dict[str, Any] = {"color": RED, "marker": "o", "markersize": 5, "linestyle": "none"}
    axes.plot([p[1] for p in nonlinear], [p[0] for p in nonlinear], label="nonlinear: periodic motion opens", **dots)
    axes.text(1100, 750, "opens", color=GREY, ha="center")
    axes.text(1100, 150, "stays closed", color=GREY, ha="center")
    axes.set(xlabel="frequency [Hz]", ylabel="base acceleration [m/s²]", xlim=(0, 3050), ylim=(0, 1400))
    acceleration_in_g(axes)
    axes.set_title("Vibration that opens the contact", fontsize="medium")
    axes.legend(fontsize="small", frameon=False)


def main() -> None:
    """Draw both."""
    parser = argparse.ArgumentParser(description="Draw frequency-response.csv as frequency-response.png.")
    parser.add_argument("folder", type=Path, help="where the table is and the picture goes")
    folder: Path = parser.parse_args().folder
    curves = read(folder / "frequency-response.csv")
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.8), layout="constrained")
    response(left, curves)
    thresholds(right, curves)
    for axes in (left, right):
        axes.grid(alpha=0.3)
    path = folder / "frequency-response.png"
    save(figure, path)
    print(path)


if __name__ == "__main__":
    main()
