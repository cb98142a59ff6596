"""Figures of opening_map.py, and their results in words."""

import math
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pyarrow as pa
from matplotlib.colors import LogNorm
from scipy.special import betaincinv

from common import save
from relay_contact import Array
from relay_contact.figures import BLACK, BLUE, GRAVITY, GREEN, GREY, ORANGE, PURPLE, RED, SKY, acceleration_in_g
from relay_contact.qualification.excitation import Sine
from relay_contact.qualification.standards import Standard

NAME = "MIL-PRF-28776"
ASKED = Standard.read(NAME)
LIMIT = ASKED.contacts.opening
RELAYS = next(test for test in ASKED.tests if isinstance(test, Sine))
COLOURS = (BLUE, ORANGE, GREEN, PURPLE, RED, SKY, BLACK)
STANDARD = {"color": RED, "linestyle": ":", "linewidth": 1.6}
"""Style of the level of the standard."""


def boundary(accelerations: Array, longest: Array) -> Array:
    """Give, for each row, the middle of the step in acceleration at which interruptions begin to exceed the limit."""
    opens = longest > LIMIT
    index = np.where(opens.any(axis=1), opens.argmax(axis=1), -1)
    middle = (accelerations[index] + accelerations[np.maximum(index - 1, 0)]) / 2
    return np.where(index > 0, middle, np.nan)


def draw_map(table: pa.Table, labels: list[str], scales: list[Any], path: Path) -> None:
    """Draw a map for each value of the parameter, and the boundaries together; print where they are lowest."""
    values, frequencies, accelerations = (np.array(axis, dtype=float) for axis in scales)

    def grid(name: str) -> Array:
        shaped: Array = table[name].to_numpy().reshape(len(values), len(frequencies), len(accelerations))
        return shaped

    longest, sudden = grid("longest_interruption"), grid("longest_after_sudden_start")
    columns = 2 if len(values) < 4 else 3
    rows = math.ceil((len(values) + 1) / columns)
    figure, panels = plt.subplots(
        rows, columns, figsize=(5.2 * columns, 3.8 * rows), layout="constrained", squeeze=False
    )
    last = panels.flat[len(values)]
    for i, (label, axes) in enumerate(zip(labels, panels.flat, strict=False)):
        edge, start = boundary(accelerations, longest[i]), boundary(accelerations, sudden[i])
        interrupted = np.ma.masked_less_equal(1e6 * longest[i].T, 0)
        mesh = axes.pcolormesh(
            frequencies, accelerations, interrupted, norm=LogNorm(10, 1e4), cmap="viridis", shading="nearest"
        )
        axes.plot(frequencies, edge, color=BLACK, linewidth=1.6, label="opens for 10 µs")
        axes.plot(frequencies, start, color=BLACK, linewidth=1.2, linestyle="--", label="the same after a sudden start")
        axes.set_title(label, fontsize="medium")
        last.plot(frequencies, edge, color=COLOURS[i % len(COLOURS)], linewidth=1.6, label=label)
        if not np.isfinite(edge).any():
            print(f"{label}: no step from closed to open between {accelerations[0]:g} and {accelerations[-1]:g} m/s²")
            continue
        least = int(np.nanargmin(edge))
        lowest, slowest = (f"{a:.1f} m/s² ({a / GRAVITY:.1f} g)" for a in (edge[least], edge[0]))
        print(f"{label}: opens from {lowest} at {frequencies[least]:g} Hz, from {slowest} at {frequencies[0]:g} Hz")
        both = np.isfinite(edge) & np.isfinite(start)
        if both.any():
            most = int(np.argmin(np.where(both, start / edge, np.inf)))
            told = " to ".join(f"{a / GRAVITY:.1f} g" for a in (edge[most], start[most]))
            print(f"  a sudden start lowers this by the largest factor at {frequencies[most]:g} Hz: from {told}")
    fine: Array = np.geomspace(frequencies[0], frequencies[-1], 500)
    figure.colorbar(mesh, ax=panels, label="longest interruption [µs] (white: none)", shrink=0.6, extend="both")
    last.set_title("opens for 10 µs: all values", fontsize="medium")
    for axes in panels.flat[: len(values) + 1]:
        axes.plot(fine, RELAYS.amplitude(fine), label=f"{NAME}, {RELAYS.acceleration:g} g", **STANDARD)
        axes.set(xscale="log", xlim=frequencies[[0, -1]], ylim=accelerations[[0, -1]])
        axes.set(xlabel="frequency [Hz]", ylabel="base acceleration [m/s²]")
        axes.xaxis.set_major_formatter("{x:g}")
        axes.legend(fontsize="small", loc="upper left")
        acceleration_in_g(axes)
    for axes in panels.flat[len(values) + 1 :]:
        axes.axis("off")
    figure.suptitle("Steady vibration that opens the contact")
    save(figure, path, dpi=130)


def confidence(count: int, total: int) -> tuple[float, float]:
    """Give the 95 % confidence interval of a share by Clopper and Pearson."""
    low = float(betaincinv(count, total - count + 1, 0.025)) if count else 0.0
    return low, float(betaincinv(count + 1, total - count, 0.975)) if count < total else 1.0


def draw_tolerances(table: pa.Table, settings: dict[str, Any], path: Path) -> None:
    """Draw the distribution of the longest interruption, and the share beyond the limit; print the latter."""
    accelerations = np.array(settings["accelerations"])
    longest = table["longest_interruption"].to_numpy().reshape(-1, len(accelerations)).T
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.8), layout="constrained")
    shares = []
    for i, (acceleration, all_values) in enumerate(zip(accelerations, longest, strict=True)):
        values = np.sort(all_values[np.isfinite(all_values)])
        count, total = int(np.sum(values > LIMIT)), max(1, len(values))
        low, high = confidence(count, total)
        shares.append((count / total, low, high))
        print(
            f"{acceleration:.1f} m/s2 ({acceleration / GRAVITY:.1f} g): {count} of {len(values)} contacts open",
            f"for longer than 10 us, {100 * count / total:.2f} %,",
            f"with 95 % confidence {100 * low:.2f} to {100 * high:.2f} %",
        )
        label = f"{acceleration / GRAVITY:.3g} g"
        # From zero at the left, where the contacts without interruption are, to all at the right.
        across = np.concatenate(([1e-7], np.maximum(values, 1e-7), [1.0]))
        below = np.concatenate(([0.0], np.arange(1, len(values) + 1) / max(1, len(values)), [1.0]))
        left.step(1e6 * across, 100 * below, where="post", color=COLOURS[i % len(COLOURS)], label=label)
    left.axvline(1e6 * LIMIT, color=GREY, linestyle=":", label="10 µs")
    left.set(xscale="log", xlim=(0.5, 1e7 * max(LIMIT, np.nanmax(longest, initial=0.0))), ylim=(-2, 102))
    left.set(xlabel="longest interruption [µs] (left edge: none)", ylabel="cumulative share of contacts [%]")
    left.set_title(f"Longest interruption at {settings['frequency']:g} Hz", fontsize="medium")
    share, below, above = 100 * np.array(shares).T
    right.errorbar(accelerations, share, [share - below, above - share], color=COLOURS[0], marker="o", capsize=4)
    right.set(xlabel="base acceleration [m/s²]", ylabel="contacts that open for longer than 10 µs [%]", ylim=(-2, 102))
    level = float(RELAYS.amplitude(np.array(settings["frequency"])))
    right.axvline(level, label=f"{NAME}, {level / GRAVITY:.3g} g", **STANDARD)
    acceleration_in_g(right, vertical=False)
    right.set_title(f"Share of {settings['samples']} contacts, 95 % confidence", fontsize="medium")
    for axes in (left, right):
        axes.grid(alpha=0.3)
    left.legend(fontsize="small", loc="center right")
    right.legend(fontsize="small", loc="upper left")
    save(figure, path, dpi=130)
