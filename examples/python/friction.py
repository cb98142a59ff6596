"""Friction between the contacts: what it does to natural frequency, damping, force over travel, and how far it slips.

A page on the result: docs/friction.md. The published frequencies are those of Zhang, Zhang, Meng, Ren, "Machines" 2025,
13(1), 52, section 3.1 and Fig. 5.
"""

import math
from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from scipy.linalg import expm
from scipy.optimize import brentq
from tqdm import tqdm

from common import parser, read_arguments, save
from relay_contact import Array, Component, Value, write_table
from relay_contact.component import sine
from relay_contact.figures import BLACK, BLUE, GREEN, ORANGE, PURPLE, RED, SKY

FRICTION: dict[str, Value] = {"effects.friction": "Coulomb", "effects.axialForce": "None"}
PER_RATIO = 8.063e-6  # s: damping times of beam and contact per published damping ratio; the start values have ratio 10

LENGTHS = (7.5e-3, 11.5e-3, 15.5e-3)  # m
OVERTRAVELS = 1e-3 * np.linspace(0.05, 0.5, 10)  # m
HEIGHTS = (1e-4, 3e-4, 1e-3)  # m
LEVELS = (3.0, 15.0, 30.0, 60.0)  # m/s2, of the response with little damping
FRETTED = (40.0, 98.0, 294.0)  # m/s2, of the slip
# Length, overtravel (mm) and frequency (Hz), prestressed; and the third without prestress.
PUBLISHED = ((7.5, 0.25, 4426.0), (11.5, 0.45, 2777.2), (11.5, 0.5, 2652.3), (15.5, 0.2, 1354.5))
WITHOUT_PRESTRESS = 1397.6
# By damping ratio, the frequency of the largest force amplitude (Hz) and that amplitude (cN); ratio 1: not published.
PEAKS = {1: None, 10: (1250, 5.2), 20: (750, 3.3), 30: (250, 3.1)}
GRID = np.arange(250.0, 2001.0, 250.0)  # Hz
PAPER = 98.0  # m/s2

RISE, SETTLED = 5e-3, 25e-3  # s: of the rise, and until the motion of the weakest damping here repeats
WATCHED = 4  # periods
TRAVEL, SLOW = 1e-4, 0.2  # m and s: of the fixed contact to and fro, and its period
# What is reported of connectors: a few micrometres to 100 um (Electrical Contacts, ed. P. G. Slade, 2nd edition, CRC
# Press, section 7.3).
FRETTING = (2.0, 100.0)  # um


def lowest_frequency(start: dict[str, float], contact: float, turning: float) -> float:
    """Give the lowest natural frequency (Hz) of the uniform spring with a mass at its tip.

    Its tip is held by springs against deflection (N/m) and rotation (N m/rad).
    """
    bending = start["beam.youngsModulus"] * start["beam.width"] * start["beam.thickness"] ** 3 / 12
    line = start["beam.density"] * start["beam.width"] * start["beam.thickness"]
    length = start["beam.length"]

    def determinant(z: float) -> float:
        """Moment and force at the tip for unit curvature and shear at the clamp, where w'''' = (z / L)^4 w."""
        along = np.diag(np.ones(3), 1)
        along[3, 0] = (z / length) ** 4
        w, slope, curvature, shear = expm(along * length)[:, 2:]
        held = contact - start["tip.mass"] * along[3, 0] * bending / line
        return float(np.linalg.det([bending * curvature + turning * slope, bending * shear - held * w]))

    high = 0.1
    while determinant(high) * determinant(high + 0.01) > 0:
        high += 0.01
    root: float = brentq(determinant, high, high + 0.01, xtol=1e-14)
    return (root / length) ** 2 * math.sqrt(bending / line) / (2 * math.pi)


def tangential_ratio(start: dict[str, float]) -> float:
    """Give the stiffness of the contact along the spring over that along its normal (Mindlin)."""
    names = "youngsModulus", "poissonRatio"
    sides = [[start[f"contact.{side}.{name}"] for name in names] for side in ("moving", "fixed")]
    normal = sum((1 - nu**2) / e for e, nu in sides)
    return 4 * normal / sum((2 - nu) * 2 * (1 + nu) / e for e, nu in sides)


@dataclass(frozen=True)
class Vibration:
    """What a period of steady vibration has."""

    amplitude: float
    """Of the contact force, N."""
    slip: float
    """Distance, m."""
    energy: float
    """Dissipated by slip, J."""
    opens: bool


def damped(ratio: float) -> dict[str, Value]:
    """Give the parameters of a published damping ratio."""
    return {"beam.stiffnessDamping": PER_RATIO * ratio, "contact.damping": PER_RATIO * ratio}


class Study:
    """Runs of one component."""

    def __init__(self, component: Component) -> None:
        """Take the component."""
        self.component = component
        names = [name for name, each in component.variables.items() if each.causality == "parameter"]
        starts = {name: component.start(name) for name in names}
        self.start = {name: value for name, value in starts.items() if isinstance(value, float)}

    def frequencies(self, length: float, overtravel: float) -> list[float]:
        """Give the lowest natural frequency of a contact that slips, and of one that sticks at each height, Hz."""
        values: dict[str, Value] = {"beam.length": length, "contact.overtravel": overtravel}
        found = []
        for height in (0.0, *HEIGHTS):
            with self.component.started(FRICTION | values | {"tip.contactHeight": height}) as contact:
                (stiffness,) = contact.real("preload.contactStiffness")
            turning = height**2 * tangential_ratio(self.start) * stiffness
            found.append(lowest_frequency(self.start | {"beam.length": length}, stiffness, turning))
        return found

    def vibration(self, frequency: float, amplitude: float, values: dict[str, Value]) -> Vibration:
        """Start a vibration gently and give what a period of it has once it is steady."""
        with self.component.started(FRICTION | sine(frequency, amplitude, RISE) | values) as contact:
            periods = np.arange(math.ceil((RISE + SETTLED) * frequency) + WATCHED + 1)
            names = ["step.minimumForce", "step.maximumForce", "contact.slipDistance", "friction.energy"]
            rows = contact.drive(periods / frequency, {}, names)
        least, greatest, distance, energy = (rows[name][-WATCHED - 1 :] for name in names)
        low, high = float(least.min()), float(greatest.max())
        slip, lost = (float(each[-1] - each[0]) / WATCHED for each in (distance, energy))
        return Vibration((high - low) / 2, slip, lost, low <= 0)

    def peak(self, ratio: float, friction: float) -> str:
        """Give the largest force amplitude over the published grid, as text."""
        values = damped(ratio) | {"friction.coefficient": friction}
        found = [(self.vibration(float(f), PAPER, values), f) for f in GRID]
        opens = [f"{f:g} Hz" for each, f in found if each.opens]
        if opens:
            return "opens at " + ", ".join(opens)
        highest, at = max(found, key=lambda each: each[0].amplitude)
        return f"{100 * highest.amplitude:.2f} cN at {at:g} Hz"

    def loop(self, values: dict[str, Value]) -> tuple[Array, Array]:
        """Move the fixed contact to and fro, slowly; give its displacement (m) and the contact force (N)."""
        time = SLOW * np.linspace(0, 1.5, 1501)
        moved = TRAVEL * np.sin(2 * np.pi * time / SLOW)
        with self.component.started(FRICTION | values) as contact:
            first = contact.get("contact.force")
            rows = contact.drive(time, {"support.displacement": moved}, ["contact.force"])
        return moved, np.append(first, rows["contact.force"])


def draw_frequencies(axes: Axes, rows: Array) -> None:
    """Draw natural frequencies over overtravel: slipping, sticking, published."""
    styles = [(BLACK, "-", "slips, or no friction")]
    styles += [
        (colour, stroke, f"sticks, height {1e3 * h:g} mm")
        for colour, stroke, h in zip((SKY, BLUE, PURPLE), ("--", "-.", ":"), HEIGHTS, strict=True)
    ]
    for length in LENGTHS:
        own = rows[np.isclose(rows[:, 0], length)]
        for column, (colour, stroke, label) in enumerate(styles, start=2):
            name = label if length == LENGTHS[0] else None
            axes.plot(1e3 * own[:, 1], own[:, column], stroke, color=colour, label=name)
        axes.annotate(f"{1e3 * length:g} mm", (0.5, own[-1, 2]), (3, 0), textcoords="offset points", fontsize="small")
    _, at, frequency = np.array(PUBLISHED).T
    axes.plot(at, frequency, "o", color=RED, label="published, prestressed")
    axes.plot(0.2, WITHOUT_PRESTRESS, "o", color=RED, fillstyle="none", label="published, not prestressed")
    axes.set(xlabel="overtravel [mm]", ylabel="first natural frequency [Hz]", yscale="log")
    axes.set(xlim=(0.03, 0.57), ylim=(1200, 14000))
    axes.yaxis.set_major_formatter("{x:g}")
    axes.yaxis.set_minor_formatter("{x:g}")
    axes.set_title("Springs of 7.5, 11.5 and 15.5 mm", fontsize="medium")


def draw_responses(axes: Axes, rows: Array) -> None:
    """Draw the response of the contact force over frequency, by level; what opens is left out."""
    looks = zip(LEVELS, (PURPLE, BLUE, GREEN, ORANGE), ("s", "o", "^", "v"), strict=True)
    curves = [(level, 1.0, colour, marker) for level, colour, marker in looks]
    for level, friction, colour, marker in [*curves, (LEVELS[0], 0.0, BLACK, "")]:
        own = rows[(rows[:, 1] == level) & (rows[:, 2] == friction)]
        if len(own):
            closed = np.where(own[:, 6] == 0, 1e3 * own[:, 3] / level, np.nan)
            label = f"{level:g} m/s²" if friction else "any, without friction"
            stroke = "-" if friction else "--"
            axes.plot(own[:, 0], closed, stroke, color=colour, label=label, marker=marker, markevery=6, markersize=5)
    axes.set(xlabel="frequency [Hz]", ylabel="force amplitude per acceleration [mN / (m/s²)]")
    axes.set_title("Damping ratio 1, contact closed", fontsize="medium")


def draw_loop(axes: Axes, loop: Array) -> None:
    """Draw the force over travel less that without friction."""
    travel, force = 1e6 * loop[:, 0], 1e3 * (loop[:, 1] - loop[:, 2])
    axes.plot(travel, force, color=BLUE, label="with friction")
    axes.axhline(0, color=BLACK, linestyle="--", label="without")
    for place, way, offset in ((0, "closing →", 10), (len(loop) // 3, "← opening", -16)):
        at = (travel[place], force[place])
        axes.annotate(way, at, (0, offset), textcoords="offset points", ha="center", fontsize="small")
    axes.set(xlabel="travel of the fixed contact [µm]", ylabel="contact force less that\nwithout friction [mN]")
    axes.set_title("Force over travel, to and fro", fontsize="medium")


def draw_slip(axes: Axes, rows: Array) -> None:
    """Draw the slip of a period, one way, over frequency."""
    for level, colour, marker in zip(FRETTED, (PURPLE, BLUE, GREEN), ("s", "o", "^"), strict=True):
        own = rows[rows[:, 1] == level]
        slip = 1e6 * np.where(own[:, 6] == 0, own[:, 4] / 2, np.nan)
        axes.plot(own[:, 0], slip, color=colour, label=f"{level:g} m/s²", marker=marker, markevery=4, markersize=5)
    axes.axhspan(*FRETTING, color=RED, alpha=0.12, lw=0, label="reported where connectors fret")
    axes.set(xscale="log", yscale="log", xlabel="frequency [Hz]", ylabel="slip in one direction [µm]", ylim=(1e-2, 20))
    axes.set_title("Slip in a period, start values", fontsize="medium")


def draw(path: Path, *tables: Array) -> None:
    """Draw frequencies, responses, the loop and the slip."""
    figure, panels = plt.subplots(2, 2, figsize=(12, 9), layout="constrained")
    functions = (draw_frequencies, draw_responses, draw_loop, draw_slip)
    for letter, axes, function, rows in zip("abcd", panels.flat, functions, tables, strict=True):
        function(axes, rows)
        axes.set_title(letter, loc="left", fontweight="bold")
        axes.grid(alpha=0.3)
        axes.legend(fontsize="small", frameon=False, ncols=2 if function is draw_frequencies else 1)
    save(figure, path)


def main() -> None:
    """Run the study."""
    given = read_arguments(parser(__doc__, "few frequencies and levels", "about a minute"))
    study = Study(Component(given.fmu))
    quick = given.quick
    frequencies = [
        [length, overtravel, *study.frequencies(length, overtravel)]
        for length in LENGTHS
        for overtravel in OVERTRAVELS[:: 9 if quick else 1]
    ]
    wide = np.geomspace(100, 3000, 4 if quick else 40)
    near = np.linspace(900, 2200, 4 if quick else 66)
    runs = [("responses", f, a, 1) for a in (LEVELS[2:3] if quick else LEVELS) for f in near]
    runs += [("responses", f, LEVELS[0], 0) for f in near]
    runs += [("slips", f, a, 1) for a in (FRETTED[1:2] if quick else FRETTED) for f in wide]
    rows: dict[str, list[list[float]]] = {"responses": [], "slips": []}
    for kind, frequency, level, friction in tqdm(runs, unit="run"):
        values: dict[str, Value] = {} if friction else {"friction.coefficient": 0.0}
        found = study.vibration(float(frequency), level, values | (damped(1) if kind == "responses" else {}))
        rows[kind].append([frequency, level, friction, found.amplitude, found.slip, found.energy, found.opens])
    moved, force = study.loop({})
    loop = np.column_stack([moved, force, study.loop({"friction.coefficient": 0.0})[1]])

    tables = [np.array(each) for each in (frequencies, rows["responses"], loop, rows["slips"])]
    vibration = "frequency [Hz],acceleration [m/s2],friction,force amplitude [N],slip [m],energy [J],opens"
    names = {
        "frequencies": "length [m],overtravel [m],slips [Hz]," + ",".join(f"sticks at {h:g} m [Hz]" for h in HEIGHTS),
        "responses": vibration,
        "loop": "support.displacement [m],contact.force [N],without friction [N]",
        "slips": vibration,
    }
    for (name, columns), table in zip(names.items(), tables, strict=True):
        write_table(given.out / f"friction-{name}.csv", columns, table)
    draw(given.out / "friction.png", *tables)
    paper = study.vibration(1000.0, PAPER, {})
    slip, lost = 1e6 * paper.slip / 2, 1e9 * paper.energy
    print(f"{PAPER:g} m/s² at 1000 Hz: force amplitude {100 * paper.amplitude:.3f} cN; in a period ", end="")
    print(f"slip of {slip:.3f} µm to and as much fro, {lost:.1f} nJ")
    for ratio, published in {10: PEAKS[10]}.items() if quick else PEAKS.items():
        known = f"{published[1]} cN at {published[0]} Hz" if published else "an amplitude at each frequency"
        print(f"ratio {ratio}, published: {known}")
        for name, coefficient in (("without friction", 0.0), ("with", 0.2)):
            at = study.vibration(1000.0, PAPER, damped(ratio) | {"friction.coefficient": coefficient})
            print(f"  {name}: {study.peak(ratio, coefficient)}; at 1000 Hz slip of {1e6 * at.slip / 2:.3f} µm")
    print(*(given.out / f"friction-{name}.csv" for name in names), given.out / "friction.png", sep="\n")


if __name__ == "__main__":
    main()
