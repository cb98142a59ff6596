"""Friction between the contacts: what it does to natural frequency, damping, force over travel, and how far it slips.

A page on the result: docs/friction.md. The published frequencies are those of Zhang, Zhang, Meng, Ren, "Machines" 2025,
13(1), 52, section 3.1 and Fig. 5.
"""

import math
from collections.abc import Iterable
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from scipy.linalg import expm
from scipy.optimize import brentq
from tqdm import tqdm

from common import parser, read_arguments, save
from relay_contact import Component, Contact, Value
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
# Press, section 7.3.1).
FRETTING = (2.0, 100.0)  # um


AT, LEVEL, COEFFICIENT = "frequency [Hz]", "acceleration [m/s2]", "friction"
AMPLITUDE, SLIP, ENERGY, OPENS = "force amplitude [N]", "slip [m]", "energy [J]", "opens"
"""Columns of the tables of vibrations; the last ones are what a period has once it is steady."""
LENGTH, OVERTRAVEL = "length [m]", "overtravel [m]"
STICKS = [f"sticks at {height:g} m [Hz]" for height in HEIGHTS]


def lowest_frequency(contact: Contact, turning: float) -> float:
    """Give the lowest natural frequency (Hz) of a uniform spring on its contact, which resists rotation (N m/rad)."""
    get = contact.get
    bending = get("beam.youngsModulus") * get("beam.width") * get("beam.thickness") ** 3 / 12
    line = get("beam.density") * get("beam.width") * get("beam.thickness")
    length, stiffness, mass = get("beam.length"), get("preload.contactStiffness"), get("tip.mass")

    def determinant(z: float) -> float:
        """Moment and force at the tip for unit curvature and shear at the clamp, where w'''' = (z / L)^4 w."""
        along = np.diag(np.ones(3), 1)
        along[3, 0] = (z / length) ** 4
        w, slope, curvature, shear = expm(along * length)[:, 2:]
        held = stiffness - mass * along[3, 0] * bending / line
        return float(np.linalg.det([bending * curvature + turning * slope, bending * shear - held * w]))

    high = 0.1
    while determinant(high) * determinant(high + 0.01) > 0:
        high += 0.01
    root: float = brentq(determinant, high, high + 0.01, xtol=1e-14)
    return (root / length) ** 2 * math.sqrt(bending / line) / (2 * math.pi)


def tangential_stiffness(contact: Contact) -> float:
    """Give the stiffness of the contact along the spring (Mindlin), N/m."""
    names = "youngsModulus", "poissonRatio"
    sides = [[contact.get(f"contact.{side}.{name}") for name in names] for side in ("moving", "fixed")]
    normal = sum((1 - nu**2) / e for e, nu in sides)
    ratio = 4 * normal / sum((2 - nu) * 2 * (1 + nu) / e for e, nu in sides)
    return ratio * contact.get("preload.contactStiffness")


def damped(ratio: float) -> dict[str, Value]:
    """Give the parameters of a published damping ratio."""
    return {"beam.stiffnessDamping": PER_RATIO * ratio, "contact.damping": PER_RATIO * ratio}


def frequencies(component: Component, length: float, overtravel: float) -> dict[str, float]:
    """Give the lowest natural frequency of a contact that slips, and of one that sticks at each height."""
    values: dict[str, Value] = {"beam.length": length, "contact.overtravel": overtravel}
    found = {LENGTH: length, OVERTRAVEL: overtravel}
    for name, height in zip(["slips [Hz]", *STICKS], (0.0, *HEIGHTS), strict=True):
        with component.started(FRICTION | values | {"tip.contactHeight": height}) as contact:
            found[name] = lowest_frequency(contact, height**2 * tangential_stiffness(contact))
    return found


def vibration(component: Component, frequency: float, amplitude: float, values: dict[str, Value]) -> dict[str, float]:
    """Start a vibration gently and give what a period of it has once it is steady."""
    with component.started(FRICTION | sine(frequency, amplitude, RISE) | values) as contact:
        periods = np.arange(math.ceil((RISE + SETTLED) * frequency) + WATCHED + 1)
        names = ["step.minimumForce", "step.maximumForce", "contact.slipDistance", "friction.energy"]
        rows = contact.drive(periods / frequency, {}, names)
    least, greatest, distance, energy = (rows[name][-WATCHED - 1 :] for name in names)
    low, high = float(least.min()), float(greatest.max())
    slip, lost = (float(each[-1] - each[0]) / WATCHED for each in (distance, energy))
    return {AMPLITUDE: (high - low) / 2, SLIP: slip, ENERGY: lost, OPENS: float(low <= 0)}


def peak(component: Component, ratio: float, friction: float) -> str:
    """Give the largest force amplitude over the published grid, as text."""
    values = damped(ratio) | {"friction.coefficient": friction}
    found = {f: vibration(component, float(f), PAPER, values) for f in GRID}
    opens = [f"{f:g} Hz" for f, each in found.items() if each[OPENS]]
    if opens:
        return "opens at " + ", ".join(opens)
    at = max(found, key=lambda f: found[f][AMPLITUDE])
    return f"{100 * found[at][AMPLITUDE]:.2f} cN at {at:g} Hz"


def loop(component: Component) -> pd.DataFrame:
    """Move the fixed contact to and fro, slowly, with friction and without; give the contact force."""
    time = SLOW * np.linspace(0, 1.5, 1501)
    moved = TRAVEL * np.sin(2 * np.pi * time / SLOW)
    table = pd.DataFrame({"support.displacement [m]": moved})
    for name, coefficient in (("contact.force [N]", 0.2), ("without friction [N]", 0.0)):
        with component.started(FRICTION | {"friction.coefficient": coefficient}) as contact:
            first = contact.get("contact.force")
            rows = contact.drive(time, {"support.displacement": moved}, ["contact.force"])
        table[name] = np.append(first, rows["contact.force"])
    return table


def draw_frequencies(axes: Axes, table: pd.DataFrame) -> None:
    """Draw natural frequencies over overtravel: slipping, sticking, published."""
    styles = [(BLACK, "-", "slips, or no friction")]
    styles += [
        (colour, stroke, f"sticks, height {1e3 * h:g} mm")
        for colour, stroke, h in zip((SKY, BLUE, PURPLE), ("--", "-.", ":"), HEIGHTS, strict=True)
    ]
    for length in LENGTHS:
        own = table[table[LENGTH] == length]
        for column, (colour, stroke, label) in zip(["slips [Hz]", *STICKS], styles, strict=True):
            name = label if length == LENGTHS[0] else None
            axes.plot(1e3 * own[OVERTRAVEL], own[column], stroke, color=colour, label=name)
        end = (0.5, own["slips [Hz]"].iloc[-1])
        axes.annotate(f"{1e3 * length:g} mm", end, (3, 0), textcoords="offset points", fontsize="small")
    _, at, frequency = np.array(PUBLISHED).T
    axes.plot(at, frequency, "o", color=RED, label="published, prestressed")
    axes.plot(0.2, WITHOUT_PRESTRESS, "o", color=RED, fillstyle="none", label="published, not prestressed")
    axes.set(xlabel="overtravel [mm]", ylabel="first natural frequency [Hz]", yscale="log")
    axes.set(xlim=(0.03, 0.57), ylim=(1200, 14000))
    axes.yaxis.set_major_formatter("{x:g}")
    axes.yaxis.set_minor_formatter("{x:g}")
    axes.set_title("Springs of 7.5, 11.5 and 15.5 mm", fontsize="medium")


def draw_responses(axes: Axes, table: pd.DataFrame) -> None:
    """Draw the response of the contact force over frequency, by level; what opens is left out."""
    looks = zip(LEVELS, (PURPLE, BLUE, GREEN, ORANGE), ("s", "o", "^", "v"), strict=True)
    curves = [(level, 1.0, colour, marker) for level, colour, marker in looks]
    for level, friction, colour, marker in [*curves, (LEVELS[0], 0.0, BLACK, "")]:
        own = table[(table[LEVEL] == level) & (table[COEFFICIENT] == friction)]
        if len(own):
            closed = (1e3 * own[AMPLITUDE] / level).where(own[OPENS] == 0)
            label = f"{level:g} m/s²" if friction else "any, without friction"
            stroke = "-" if friction else "--"
            axes.plot(own[AT], closed, stroke, color=colour, label=label, marker=marker, markevery=6, markersize=5)
    axes.set(xlabel="frequency [Hz]", ylabel="force amplitude per acceleration [mN / (m/s²)]")
    axes.set_title("Damping ratio 1, contact closed", fontsize="medium")


def draw_loop(axes: Axes, table: pd.DataFrame) -> None:
    """Draw the force over travel less that without friction."""
    moved, pressed, without = table.to_numpy().T
    travel, force = 1e6 * moved, 1e3 * (pressed - without)
    axes.plot(travel, force, color=BLUE, label="with friction")
    axes.axhline(0, color=BLACK, linestyle="--", label="without")
    for place, way, offset in ((0, "closing →", 10), (len(table) // 3, "← opening", -16)):
        at = (travel[place], force[place])
        axes.annotate(way, at, (0, offset), textcoords="offset points", ha="center", fontsize="small")
    axes.set(xlabel="travel of the fixed contact [µm]", ylabel="contact force less that\nwithout friction [mN]")
    axes.set_title("Force over travel, to and fro", fontsize="medium")


def draw_slip(axes: Axes, table: pd.DataFrame) -> None:
    """Draw the slip of a period, one way, over frequency."""
    for level, colour, marker in zip(FRETTED, (PURPLE, BLUE, GREEN), ("s", "o", "^"), strict=True):
        own = table[table[LEVEL] == level]
        slip = (1e6 * own[SLIP] / 2).where(own[OPENS] == 0)
        axes.plot(own[AT], slip, color=colour, label=f"{level:g} m/s²", marker=marker, markevery=4, markersize=5)
    axes.axhspan(*FRETTING, color=RED, alpha=0.12, lw=0, label="reported where connectors fret")
    axes.set(xscale="log", yscale="log", xlabel="frequency [Hz]", ylabel="slip in one direction [µm]", ylim=(1e-2, 20))
    axes.set_title("Slip in a period, start values", fontsize="medium")


def draw(path: Path, tables: Iterable[pd.DataFrame]) -> None:
    """Draw frequencies, responses, the loop and the slip."""
    figure, panels = plt.subplots(2, 2, figsize=(12, 9), layout="constrained")
    functions = (draw_frequencies, draw_responses, draw_loop, draw_slip)
    for letter, axes, function, table in zip("abcd", panels.flat, functions, tables, strict=True):
        function(axes, table)
        axes.set_title(letter, loc="left", fontweight="bold")
        axes.grid(alpha=0.3)
        axes.legend(fontsize="small", frameon=False, ncols=2 if function is draw_frequencies else 1)
    save(figure, path)


def main() -> None:
    """Run the study."""
    given = read_arguments(parser(__doc__, "few frequencies and levels", "about a minute"))
    component, quick = Component(given.fmu), given.quick
    overtravels = OVERTRAVELS[:: 9 if quick else 1].tolist()
    springs = [frequencies(component, length, overtravel) for length in LENGTHS for overtravel in overtravels]
    wide = np.geomspace(100, 3000, 4 if quick else 40)
    near = np.linspace(900, 2200, 4 if quick else 66)
    runs = [("responses", f, a, 1) for a in (LEVELS[2:3] if quick else LEVELS) for f in near]
    runs += [("responses", f, LEVELS[0], 0) for f in near]
    runs += [("slips", f, a, 1) for a in (FRETTED[1:2] if quick else FRETTED) for f in wide]
    rows: dict[str, list[dict[str, float]]] = {"responses": [], "slips": []}
    for kind, frequency, level, friction in tqdm(runs, unit="run"):
        values: dict[str, Value] = {} if friction else {"friction.coefficient": 0.0}
        found = vibration(component, float(frequency), level, values | (damped(1) if kind == "responses" else {}))
        rows[kind].append({AT: frequency, LEVEL: level, COEFFICIENT: friction, **found})
    tables = {
        "frequencies": pd.DataFrame(springs), "responses": pd.DataFrame(rows["responses"]),
        "loop": loop(component), "slips": pd.DataFrame(rows["slips"]),
    }  # fmt: skip
    paths = [given.out / f"friction-{name}.csv" for name in tables]
    for path, table in zip(paths, tables.values(), strict=True):
        table.to_csv(path, index=False, float_format="%.12g")
    draw(given.out / "friction.png", tables.values())
    paper = vibration(component, 1000.0, PAPER, {})
    slip, lost = 1e6 * paper[SLIP] / 2, 1e9 * paper[ENERGY]
    print(f"{PAPER:g} m/s² at 1000 Hz: force amplitude {100 * paper[AMPLITUDE]:.3f} cN; in a period ", end="")
    print(f"slip of {slip:.3f} µm to and as much fro, {lost:.1f} nJ")
    for ratio, published in {10: PEAKS[10]}.items() if quick else PEAKS.items():
        known = f"{published[1]} cN at {published[0]} Hz" if published else "an amplitude at each frequency"
        print(f"ratio {ratio}, published: {known}")
        for name, coefficient in (("without friction", 0.0), ("with", 0.2)):
            at = vibration(component, 1000.0, PAPER, damped(ratio) | {"friction.coefficient": coefficient})
            print(f"  {name}: {peak(component, ratio, coefficient)}; at 1000 Hz slip of {1e6 * at[SLIP] / 2:.3f} µm")
    print(*paths, given.out / "friction.png", sep="\n")


if __name__ == "__main__":
    main()
