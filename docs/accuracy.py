"""Draws the figures of docs/accuracy.md from accuracy.csv: python docs/accuracy.py FOLDER."""

import csv
import math
import sys
from collections import defaultdict
from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke

Row = dict[str, str]

# Okabe and Ito's colours, distinguishable with colour blindness; the markers differ too.
STYLES = {
    "relay-contact": ("#000000", "o"),
    "CVODE BDF": ("#D55E00", "s"),
    "diffsol BDF": ("#0072B2", "^"),
    "diffsol ESDIRK34": ("#56B4E9", "v"),
    "Newmark": ("#009E73", "D"),
    "generalised-alpha": ("#CC79A7", "P"),
}
LABELLED = ("relay-contact", "CVODE BDF", "diffsol BDF", "Newmark")
GREY = "#777777"
SCENES = {
    "paper": "paper: 98 m/s², 1 kHz, stays closed",
    "chatter": "chatter: 400 m/s², 1 kHz, opens in every period",
    "closing bounce": "closing bounce: at 60 mm/s",
    "linear": "linear: as paper, bonded contact",
}
WIDTH, DPI = 10.0, 100


def number(row: Row, column: str) -> float:
    """Value of a column, nan where it is empty."""
    return float(row[column]) if row[column] else math.nan


def label(row: Row) -> str:
    """Give the setting in few characters: a tolerance as its power of ten, a step in microseconds."""
    value = number(row, "value")
    if row["setting"] == "tolerance":
        return f"1e-{round(-math.log10(value))}"
    return f"{1e6 * value:g} µs"


def curve(axes: Axes, rows: list[Row], column: str, limits: tuple[float, float], **style: object) -> list[Row]:
    """Draw time over error; return the rows that could not be drawn."""
    low, high = limits
    good = [row for row in rows if row["outcome"] == "ok" and number(row, column) <= high]
    bad = [row for row in rows if row not in good]
    x = [max(number(row, column), low) for row in good]
    y = [number(row, "seconds_per_second") for row in good]
    axes.plot(x, y, **style)  # type: ignore[arg-type]
    return bad


def work_precision(axes: Axes, rows: list[Row], column: str, reference: str, limits: tuple[float, float]) -> None:
    """One panel: a curve for each integrator, crosses at the right edge for failed runs and those beyond it."""
    by_name: dict[str, list[Row]] = defaultdict(list)
    for row in rows:
        if row["part"] == "peers":
            by_name[row["integrator"]].append(row)
    axes.set(xscale="log", yscale="log", xlim=(limits[0], limits[1] * 3))
    edge = limits[1] * 1.7
    for name, own in by_name.items():
        color, marker = STYLES[name]
        bold = name == "relay-contact"
        width = 2.2 if bold else 1.3
        style = {"color": color, "marker": marker, "markersize": 5, "linewidth": width, "zorder": 5 if bold else 3}
        bad = curve(axes, own, column, limits, **style)
        for row in own:
            x, y = number(row, column), number(row, "seconds_per_second")
            digits = math.log10(number(row, "value"))
            wanted = abs(digits - round(digits)) < 1e-9 and (row["setting"] == "step" or round(digits) % 3 == 0)
            if row not in bad and wanted and name in LABELLED:
                above = name != "relay-contact"
                axes.annotate(
                    label(row),
                    (max(x, limits[0]), y),
                    textcoords="offset points",
                    xytext=(4, 5) if above else (-4, -11),
                    ha="left" if above else "right",
                    fontsize=7,
                    color=color,
                    path_effects=[withStroke(linewidth=2, foreground="white")],
                    zorder=6,
                )
        # Failed runs have no time: they are drawn at the bottom, side by side.
        stack = 0
        for row in bad:
            y = number(row, "seconds_per_second")
            if math.isnan(y):
                height = 0.03 + 0.035 * stack
                transform = axes.get_xaxis_transform()
                position = edge * 0.8 ** (list(by_name).index(name) - len(by_name) / 2)
                axes.plot(position, height, "x", color=color, transform=transform, markersize=6, markeredgewidth=1.6)
                stack += 1
            else:
                axes.plot(edge, y, "x", color=color, markersize=6, markeredgewidth=1.6, zorder=4)
    delivered = [row for row in rows if row["part"] == "delivered"]
    if column != "event_error_us":
        style = {"color": GREY, "linestyle": "--", "linewidth": 1.3, "zorder": 4}
        curve(axes, delivered, column, limits, **style)
    limit = max(number(row, reference) for row in rows if row["part"] == "peers")
    if limit > limits[0]:
        axes.axvspan(limits[0], limit, color="#dddddd", zorder=0)
    axes.grid(visible=True, which="major", color="#e5e5e5", linewidth=0.6)
    axes.set_axisbelow(True)


def first_figure(rows: list[Row], path: Path) -> None:
    """Time per simulated second over force error, and over the error of opening durations."""
    figure, grid = plt.subplots(3, 2, figsize=(WIDTH, 12.5), dpi=DPI, layout="constrained")
    panels = list(grid.flat)
    for axes, (scene, title) in zip(panels[:4], SCENES.items(), strict=True):
        own = [row for row in rows if row["scene"] == scene]
        work_precision(axes, own, "force_error", "reference_force_error", (1e-13, 1.0))
        axes.set_title(title, fontsize=11)
        axes.set_xlabel("largest error of the contact force, relative to the preload [-]")
    for axes, scene in zip(panels[4:], ("chatter", "closing bounce"), strict=True):
        own = [row for row in rows if row["scene"] == scene]
        column = "opening_duration_error_us"
        work_precision(axes, own, column, "reference_event_error_us", (1e-10, 1e2))
        axes.axvline(10, color="#D55E00", linestyle=":", linewidth=1.5)
        axes.text(8, 0.97, "10 µs ", ha="right", va="top", fontsize=8, transform=axes.get_xaxis_transform())
        axes.set_title(f"{scene}: durations of the openings", fontsize=11)
        axes.set_xlabel("largest error of an opening's duration [µs]")
    for row in grid:
        row[0].set_ylabel("processor time per simulated second [s]")
    handles = [
        Line2D([], [], color=color, marker=marker, linewidth=2.2 if name == "relay-contact" else 1.3, label=name)
        for name, (color, marker) in STYLES.items()
    ]
    handles += [
        Line2D([], [], color=GREY, linestyle="--", label="relay-contact, modes chosen automatically"),
        Line2D([], [], color=GREY, marker="x", linestyle="none", label="failed, or error beyond the axis"),
        Line2D([], [], color="#dddddd", linewidth=8, label="error of the reference"),
    ]
    figure.legend(handles=handles, loc="outside upper center", ncols=3, fontsize=9, frameon=False)
    figure.savefig(path, metadata={"Software": None})


def second_figure(rows: list[Row], path: Path) -> None:
    """Draw the error of the component, from modes and from time steps."""
    figure, grid = plt.subplots(1, 2, figsize=(WIDTH, 4.6), dpi=DPI, layout="constrained", sharey=True)
    modes_axes, steps_axes = grid
    colors = ("#0072B2", "#D55E00", "#009E73", "#CC79A7")
    for (scene, title), color, marker in zip(SCENES.items(), colors, "osD^", strict=True):
        own = [row for row in rows if row["scene"] == scene and row["outcome"] == "ok"]
        style = {"color": color, "marker": marker, "markersize": 4, "linewidth": 1.3, "label": title}
        modes = [row for row in own if row["part"] == "modes"]
        modes_axes.semilogy(
            [int(row["modes"]) for row in modes], [number(row, "force_error") for row in modes], **style
        )
        steps = [row for row in own if row["part"] == "steps"]
        x = [number(row, "value") for row in steps]
        steps_axes.loglog(x, [number(row, "force_error") for row in steps], **style)
    tolerances = [1e-12, 1e-1]
    steps_axes.plot(tolerances, tolerances, color=GREY, linestyle="--", linewidth=1, label="tolerance")
    modes_axes.set_xlabel("number of modes, at the smallest tolerance [-]")
    steps_axes.set_xlabel("tolerance, with 20 modes [-]")
    modes_axes.set_ylabel("largest error of the contact force,\nrelative to the preload [-]")
    steps_axes.legend(fontsize=8, frameon=False)
    steps_axes.invert_xaxis()
    for axes in grid:
        axes.grid(visible=True, color="#e5e5e5", linewidth=0.6)
    figure.savefig(path, metadata={"Software": None})


def main() -> None:
    """Draw both figures next to the CSV."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "docs")
    with (folder / "accuracy.csv").open(newline="") as file:
        rows = [row for row in csv.DictReader(file) if not row["outcome"].startswith("skipped")]
    first_figure(rows, folder / "accuracy.png")
    second_figure(rows, folder / "accuracy-split.png")


if __name__ == "__main__":
    main()
