"""Run the published 1 kHz case under FMPy, compare it with the publication, write a table and a figure.

The case is scenes/paper-1khz.toml. The published values are those of Zhang, Zhang, Meng, Ren, "Machines" 2025,
13(1), 52: base acceleration of 98 m/s2 at 1000 Hz on a spring of 15.5 mm with 0.2 mm of overtravel.
"""

import sys
from dataclasses import dataclass, replace
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from tqdm import tqdm

from common import BLACK, BLUE, ORANGE, RED, SKY, legend_beside, parser, read_arguments, save, write_table
from relay_contact import Array, Component, Scene, run, scenes

PRELOAD = ["preload.force", "preload.contactStiffness", "preload.frequency"]
MEASURED_RESISTANCE = (25e-3, 63e-3)  # Ohm
PERIODS_SHOWN = 3
# The periods count as equal when the force differs by less than this part of its amplitude: far below what the
# figure and the table show, far above the tolerance of the solver.
DECAYED = 1e-4


@dataclass
class Run:
    """Result of a simulation, SI units."""

    excitation: str
    """What was simulated, for the figure's title."""
    time: Array
    acceleration: Array
    outputs: dict[str, Array]
    period: int
    """Communication steps of a period of the excitation."""

    def last(self, name: str, back: int = 0) -> Array:
        """Give an output over the last period, or over one `back` periods earlier."""
        values = self.outputs[name]
        end = len(values) - back * self.period
        return values[end - self.period - 1 : end]


def simulate(component: Component, scene: Scene) -> Run:
    """Run the scene under FMPy, with a progress bar."""
    amplitude, frequency, phase = (
        float(scene.values.get(name, component.start(name)))
        for name in ("excitation.amplitude", "excitation.frequency", "excitation.phase")
    )
    form = "{l_bar}{bar}| {n:.1f} ms"
    with tqdm(total=round(1e3 * scene.stop, 3), desc="simulated", bar_format=form) as bar:
        watched = replace(scene, outputs=scene.outputs + PRELOAD)
        outputs = run(watched, component=component, progress=lambda time: bar.update(1e3 * time - bar.n))
    time = outputs.pop("time")
    acceleration = amplitude * np.sin(2 * np.pi * frequency * time + phase)
    excitation = f"base vibration of {amplitude:g} m/s² at {frequency:g} Hz"
    return Run(excitation, time, acceleration, outputs, round(1 / (frequency * scene.step)))


def decay_left(course: Run) -> float:
    """Give the largest difference of the force between the last two periods, relative to its amplitude."""
    last = course.last("contact.force")
    difference: float = np.max(np.abs(last - course.last("contact.force", back=1)))
    return float(difference / max(half_range(last), np.finfo(float).tiny))


def half_range(values: Array) -> float:
    """Give half the distance between the extremes."""
    return float(np.ptp(values) / 2)


def comparison(course: Run) -> str:
    """Give the published and the simulated values as a table."""
    force, resistance = course.last("contact.force"), course.last("contact.resistance")
    rows = [
        ("static force", "N", 0.152, float(course.outputs["preload.force"][-1])),
        ("contact stiffness", "N/m", 3.54e6, float(course.outputs["preload.contactStiffness"][-1])),
        ("lowest frequency", "Hz", 1354.5, float(course.outputs["preload.frequency"][-1])),
        ("force amplitude", "cN", 4.812, 100 * half_range(force)),
        ("least resistance (measured)", "mOhm", 1e3 * MEASURED_RESISTANCE[0], 1e3 * float(resistance.min())),
        ("most resistance (measured)", "mOhm", 1e3 * MEASURED_RESISTANCE[1], 1e3 * float(resistance.max())),
    ]
    lines = [f"{'':28} {'unit':5} {'published':>10} {'simulated':>12} {'deviation':>10}"]
    for name, unit, published, simulated in rows:
        deviation = f"{100 * (simulated / published - 1):+.2f} %"
        lines.append(f"{name:28} {unit:5} {published:10.6g} {simulated:12.6g} {deviation:>10}")
    lines += [
        "The section of the spring, its rivet mass, the contact radius and the damping are identified from the",
        "first four rows, so these show that the model is consistent; the resistances follow by the power law.",
    ]
    return "\n".join(lines)


def draw(course: Run, path: Path) -> None:
    """Draw the last periods."""
    shown = slice(len(course.time) - PERIODS_SHOWN * course.period - 1, None)
    time = 1e3 * course.time[shown]
    figure, (above, middle, below) = plt.subplots(3, 1, sharex=True, figsize=(8, 6), layout="constrained")
    above.plot(time, course.acceleration[shown], color=BLACK)
    above.set_ylabel("base acceleration\n[m/s²]")
    middle.plot(time, 100 * course.outputs["contact.force"][shown], color=BLUE, label="simulated")
    middle.axhline(100 * course.outputs["preload.force"][-1], color=ORANGE, linestyle="--", label="at rest")
    middle.set_ylabel("contact force\n[cN]")
    below.plot(time, 1e3 * course.outputs["contact.resistance"][shown], color=RED, label="simulated")
    low, high = (1e3 * value for value in MEASURED_RESISTANCE)
    below.axhspan(low, high, color=SKY, alpha=0.25, label="measured range")
    below.set_ylabel("contact resistance\n[mΩ]")
    below.set_xlabel("time [ms]")
    for axes in (middle, below):
        legend_beside(axes)
    for axes in (above, middle, below):
        axes.grid(alpha=0.3)
    above.set_title(f"Relay contact, {course.excitation}", fontsize="medium")
    figure.align_ylabels()
    save(figure, path)


def main() -> int:
    """Run the case."""
    given = read_arguments(parser("Run the published 1 kHz case under FMPy and compare."))
    course = simulate(Component(given.fmu), Scene.read(scenes()["paper-1khz"]))
    left = decay_left(course)
    if not left < DECAYED:
        print(f"the last two periods differ by {left:.1e} of the force amplitude: simulate for longer", file=sys.stderr)
        return 1
    print(comparison(course))
    table, figure = given.out / "paper-1khz.csv", given.out / "paper-1khz.png"
    columns = [
        course.time,
        course.acceleration,
        *(course.outputs[f"contact.{each}"] for each in ("force", "resistance")),
    ]
    write_table(table, "time,base.acceleration,contact.force,contact.resistance", np.column_stack(columns))
    draw(course, figure)
    print(f"{table}\n{figure}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
