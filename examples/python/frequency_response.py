"""Draw out/frequency-response.csv, which `cargo run --example frequency_response` writes."""

import argparse
import csv
from collections import defaultdict
from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

# Colours of Okabe and Ito, told apart also by the colour-blind.
COLOURS = ("#0072B2", "#E69F00", "#D55E00")
GRAVITY = 9.80665  # m/s2
PRELOAD_COLOUR = "#666666"

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
    """Draw the amplitude of the force over the frequency."""
    preload = curves["linear threshold"][0][2]
    axes.axhline(100 * preload, color=PRELOAD_COLOUR, linestyle=":", linewidth=1.2)
    axes.annotate(
        "preload", (2990, 100 * preload), xytext=(0, -4), textcoords="offset points", ha="right", va="top",
        color=PRELOAD_COLOUR, fontsize="small",
    )  # fmt: skip
    accelerations = sorted({point[0] for point in curves["linear"]})
    styles = {
        "linear": {"linestyle": "-", "linewidth": 1.6},
        "up": {"linestyle": "none", "marker": "^", "markersize": 5},
        "down": {"linestyle": "none", "marker": "v", "markersize": 5, "fillstyle": "none"},
    }
    for acceleration, colour in zip(accelerations, COLOURS, strict=True):
        for curve, style in styles.items():
            points = [point for point in curves[curve] if point[0] == acceleration]
            axes.plot([p[1] for p in points], [100 * p[2] for p in points], color=colour, **style)
    handles = [Line2D([], [], color="black", label=name, **styles[key]) for key, name in (
        ("linear", "linear"), ("up", "nonlinear, swept up"), ("down", "nonlinear, swept down"))]  # fmt: skip
    handles += [
        Line2D([], [], color=colour, linewidth=5, label=f"{a:g} m/s² ({a / GRAVITY:.0f} g)")
        for a, colour in zip(accelerations, COLOURS, strict=True)
    ]
    axes.legend(handles=handles, fontsize="small", frameon=False)
    axes.set(xlabel="frequency [Hz]", ylabel="amplitude of the contact force [cN]", xlim=(0, 3000), ylim=(0, None))
    axes.set_title("Response to base vibration", fontsize="medium")


def thresholds(axes: Axes, curves: dict[str, Points]) -> None:
    """Draw the acceleration at which the contact opens over the frequency."""
    linear, nonlinear = curves["linear threshold"], curves["threshold"]
    axes.plot([p[1] for p in linear], [p[0] for p in linear], color="#0072B2", label="linear: amplitude = preload")
    axes.plot(
        [p[1] for p in nonlinear], [p[0] for p in nonlinear], color="#D55E00", marker="o", linestyle="none",
        label="nonlinear, periodic motion",
    )  # fmt: skip
    axes.set(xlabel="frequency [Hz]", ylabel="base acceleration [m/s²]", xlim=(0, 3050), ylim=(0, None))
    in_g = axes.secondary_yaxis("right", functions=(lambda a: a / GRAVITY, lambda g: g * GRAVITY))
    in_g.set_ylabel("[g]")
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
    figure.savefig(path, dpi=150)
    print(path)


if __name__ == "__main__":
    main()
