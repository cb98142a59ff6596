"""Run the published 1 kHz case under FMPy, compare it with the publication, write a table and a figure.

The case is scenes/paper-1khz.toml. The published values are those of Zhang, Zhang, Meng, Ren, "Machines" 2025,
13(1), 52: base acceleration of 98 m/s2 at 1000 Hz on a spring of 15.5 mm with 0.2 mm of overtravel.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

from common import legend_beside, parser, read_arguments, save
from relay_contact import Array, Component, Scene, run, write_table
from relay_contact.figures import BLACK, BLUE, ORANGE, RED, SKY

PRELOAD = ["preload.force", "preload.contactStiffness", "preload.frequency"]
COLUMNS = ["time", "base.acceleration", "contact.force", "contact.resistance"]
MEASURED_RESISTANCE = (25e-3, 63e-3)  # Ohm
PERIODS_SHOWN = 3
# Periods count as equal if the force differs by less than this part of its amplitude: far below what the figure and
# the table show, far above the tolerance of the solver.
DECAYED = 1e-4

Outputs = dict[str, Array]
"""Time, base acceleration and outputs, SI units."""


def simulate(component: Component, scene: Scene) -> Outputs:
    """Run the scene under FMPy, with a progress bar."""
    outputs = run(scene, outputs=scene.outputs + PRELOAD, component=component, progress=True).columns
    amplitude, frequency = (float(scene.values[f"excitation.{each}"]) for each in ("amplitude", "frequency"))
    return outputs | {"base.acceleration": amplitude * np.sin(2 * np.pi * frequency * outputs["time"])}


def half_range(values: Array) -> float:
    """Give half the difference of maximum and minimum."""
    return float(np.ptp(values) / 2)


def comparison(outputs: Outputs, period: int) -> str:
    """Give the published and the simulated values as a table; `period` in communication steps."""
    force, resistance = (outputs[f"contact.{name}"][-period - 1 :] for name in ("force", "resistance"))
    rows = [
        ("static force", "N", 0.152, outputs["preload.force"][-1]),
        ("contact stiffness", "N/m", 3.54e6, outputs["preload.contactStiffness"][-1]),
        ("lowest frequency", "Hz", 1354.5, outputs["preload.frequency"][-1]),
        ("force amplitude", "cN", 4.812, 100 * half_range(force)),
        ("minimum resistance (measured)", "mOhm", 1e3 * MEASURED_RESISTANCE[0], 1e3 * resistance.min()),
        ("maximum resistance (measured)", "mOhm", 1e3 * MEASURED_RESISTANCE[1], 1e3 * resistance.max()),
    ]
    table = pd.DataFrame(rows, columns=["", "unit", "published", "simulated"])
    table["deviation"] = (100 * (table["simulated"] / table["published"] - 1)).map("{:+.2f} %".format)
    return f"""{table.to_string(index=False, float_format="{:.6g}".format)}
The section of the spring, its rivet mass, the contact radius and the damping are identified from the
first four rows, so these show that the model is consistent; the resistances follow by the power law."""


def draw(outputs: Outputs, period: int, title: str, path: Path) -> None:
    """Draw the last periods."""
    time, acceleration, force, resistance = (outputs[name][-PERIODS_SHOWN * period - 1 :] for name in COLUMNS)
    figure, (above, middle, below) = plt.subplots(3, 1, sharex=True, figsize=(8, 6), layout="constrained")
    above.plot(1e3 * time, acceleration, color=BLACK)
    above.set_ylabel("base acceleration\n[m/s²]")
    middle.plot(1e3 * time, 100 * force, color=BLUE, label="simulated")
    middle.axhline(100 * outputs["preload.force"][-1], color=ORANGE, linestyle="--", label="at rest")
    middle.set_ylabel("contact force\n[cN]")
    below.plot(1e3 * time, 1e3 * resistance, color=RED, label="simulated")
    low, high = (1e3 * value for value in MEASURED_RESISTANCE)
    below.axhspan(low, high, color=SKY, alpha=0.25, label="measured range")
    below.set_ylabel("contact resistance\n[mΩ]")
    below.set_xlabel("time [ms]")
    for axes in (middle, below):
        legend_beside(axes)
    for axes in (above, middle, below):
        axes.grid(alpha=0.3)
    above.set_title(title, fontsize="medium")
    figure.align_ylabels()
    save(figure, path)


def main() -> int:
    """Run the case."""
    given = read_arguments(parser(__doc__))
    scene = Scene.read("paper-1khz")
    outputs = simulate(Component(given.fmu), scene)
    period = round(1 / (float(scene.values["excitation.frequency"]) * scene.step))
    force = outputs["contact.force"]
    last = force[-period - 1 :]
    left = float(np.max(np.abs(last - force[-2 * period - 1 : -period]))) / half_range(last)
    if not left < DECAYED:
        print(f"the last two periods differ by {left:.1e} of the force amplitude: simulate for longer", file=sys.stderr)
        return 1
    print(comparison(outputs, period))
    table, figure = given.out / "paper-1khz.csv", given.out / "paper-1khz.png"
    write_table(table, ",".join(COLUMNS), np.column_stack([outputs[name] for name in COLUMNS]))
    draw(outputs, period, f"Relay contact. {scene.title}: 98 m/s² at 1000 Hz", figure)
    print(f"{table}\n{figure}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
