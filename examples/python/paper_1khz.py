"""Run the published 1 kHz case under FMPy, compare it with the publication, write a table and a figure.

The case is scenes/paper-1khz.toml. The published values are those of Zhang, Zhang, Meng, Ren, "Machines" 2025,
13(1), 52: base acceleration of 98 m/s2 at 1000 Hz on a spring of 15.5 mm with 0.2 mm of overtravel.
"""

import argparse
import sys
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from fmpy import read_model_description, simulate_fmu
from numpy.typing import NDArray
from tqdm import tqdm

mpl.use("Agg")
import matplotlib.pyplot as plt

ROOT = Path(__file__).resolve().parents[2]
PRELOAD = ["preload.force", "preload.contactStiffness", "preload.frequency"]
MEASURED_RESISTANCE = (25e-3, 63e-3)  # Ohm
PERIODS_SHOWN = 3
# The periods count as equal when the force differs by less than this part of its amplitude: far below what the
# figure and the table show, far above the tolerance of the solver.
DECAYED = 1e-4

Array = NDArray[np.float64]
Value = float | int | str


@dataclass
class Scene:
    """What a scene file holds."""

    stop: float
    step: float
    outputs: list[str]
    values: dict[str, Value]
    """Parameters and inputs by name, choices by their names."""


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


def read_scene(path: Path) -> Scene:
    """Read a scene file."""
    content = tomllib.loads(path.read_text(encoding="utf-8"))
    values = dict(flat(content.get("parameters", {})) | flat(content.get("inputs", {})))
    return Scene(content["stop"], content["communicationStep"], content["outputs"], values)


def flat(table: dict[str, Any], prefix: str = "") -> dict[str, Value]:
    """Name the values of nested tables by dotted names."""

    def entries() -> Iterator[tuple[str, Value]]:
        for key, value in table.items():
            if isinstance(value, dict):
                yield from flat(value, f"{prefix}{key}.").items()
            else:
                yield f"{prefix}{key}", value

    return dict(entries())


def start_values(scene: Scene, description: Any) -> dict[str, float]:  # noqa: ANN401
    """Give the scene's values as FMPy sets them: choices by their numbers."""
    variables = {variable.name: variable for variable in description.modelVariables}
    values: dict[str, float] = {}
    for name, value in scene.values.items():
        if isinstance(value, str):
            items = {item.name: int(item.value) for item in variables[name].declaredType.items}
            values[name] = items[value]
        else:
            values[name] = value
    return values


def simulate(fmu: Path, scene: Scene) -> Run:
    """Run the scene under FMPy, with a progress bar."""
    description = read_model_description(fmu)
    values = start_values(scene, description)
    starts = {variable.name: variable.start for variable in description.modelVariables}
    amplitude, frequency, phase = (
        float(values.get(f"excitation.{name}", starts[f"excitation.{name}"]))
        for name in ("amplitude", "frequency", "phase")
    )
    with tqdm(
        total=round(1e3 * scene.stop, 3), unit="ms", desc="simulated", bar_format="{l_bar}{bar}| {n:.1f} ms"
    ) as bar:

        def progress(time: float, _recorder: object) -> bool:
            bar.update(1e3 * time - bar.n)
            return True

        result = simulate_fmu(
            str(fmu),
            stop_time=scene.stop,
            output_interval=scene.step,
            start_values=values,
            output=scene.outputs + PRELOAD,
            step_finished=progress,
        )
    time = result["time"]
    acceleration = amplitude * np.sin(2 * np.pi * frequency * time + phase)
    outputs = {name: result[name] for name in scene.outputs + PRELOAD}
    excitation = f"base vibration of {amplitude:g} m/s² at {frequency:g} Hz"
    return Run(excitation, time, acceleration, outputs, round(1 / (frequency * scene.step)))


def decay_left(run: Run) -> float:
    """Give the largest difference of the force between the last two periods, relative to its amplitude."""
    last = run.last("contact.force")
    difference: float = np.max(np.abs(last - run.last("contact.force", back=1)))
    return float(difference / max(half_range(last), np.finfo(float).tiny))


def half_range(values: Array) -> float:
    """Give half the distance between the extremes."""
    return float(np.ptp(values) / 2)


def comparison(run: Run) -> str:
    """Give the published and the simulated values as a table."""
    force, resistance = run.last("contact.force"), run.last("contact.resistance")
    rows = [
        ("static force", "N", 0.152, float(run.outputs["preload.force"][-1])),
        ("contact stiffness", "N/m", 3.54e6, float(run.outputs["preload.contactStiffness"][-1])),
        ("lowest frequency", "Hz", 1354.5, float(run.outputs["preload.frequency"][-1])),
        ("force amplitude", "cN", 4.812, 100 * half_range(force)),
        ("least resistance (measured)", "mOhm", 1e3 * MEASURED_RESISTANCE[0], 1e3 * float(resistance.min())),
        ("most resistance (measured)", "mOhm", 1e3 * MEASURED_RESISTANCE[1], 1e3 * float(resistance.max())),
    ]
    lines = [f"{'':28} {'unit':5} {'published':>10} {'simulated':>12} {'deviation':>10}"]
    for name, unit, published, simulated in rows:
        deviation = f"{100 * (simulated / published - 1):+.2f} %"
        lines.append(f"{name:28} {unit:5} {published:10.6g} {simulated:12.6g} {deviation:>10}")
    lines.append(
        "The section of the spring, its rivet mass, the contact radius and the damping are identified from the"
    )
    lines.append(
        "first four rows, so these show that the model is consistent; the resistances follow by the power law."
    )
    return "\n".join(lines)


def write_table(run: Run, path: Path) -> None:
    """Write time, excitation, force and resistance, SI units."""
    names = ["time", "base.acceleration", "contact.force", "contact.resistance"]
    columns = [run.time, run.acceleration, run.outputs["contact.force"], run.outputs["contact.resistance"]]
    np.savetxt(path, np.column_stack(columns), delimiter=",", header=",".join(names), comments="", fmt="%.12g")


def draw(run: Run, path: Path) -> None:
    """Draw the last periods."""
    shown = slice(len(run.time) - PERIODS_SHOWN * run.period - 1, None)
    time = 1e3 * run.time[shown]
    figure, (above, middle, below) = plt.subplots(3, 1, sharex=True, figsize=(8, 6), layout="constrained")
    # Colours of Okabe and Ito, told apart also by the colour-blind.
    above.plot(time, run.acceleration[shown], color="#000000")
    above.set_ylabel("base acceleration\n[m/s²]")
    middle.plot(time, 100 * run.outputs["contact.force"][shown], color="#0072B2", label="simulated")
    middle.axhline(100 * run.outputs["preload.force"][-1], color="#E69F00", linestyle="--", label="at rest")
    middle.set_ylabel("contact force\n[cN]")
    below.plot(time, 1e3 * run.outputs["contact.resistance"][shown], color="#D55E00", label="simulated")
    low, high = (1e3 * value for value in MEASURED_RESISTANCE)
    below.axhspan(low, high, color="#56B4E9", alpha=0.25, label="measured range")
    below.set_ylabel("contact resistance\n[mΩ]")
    below.set_xlabel("time [ms]")
    for axes in (middle, below):
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize="small", frameon=False)
    for axes in (above, middle, below):
        axes.grid(alpha=0.3)
    above.set_title(f"Relay contact, {run.excitation}", fontsize="medium")
    figure.align_ylabels()
    figure.savefig(path, dpi=150)
    plt.close(figure)


def main() -> int:
    """Run the case."""
    parser = argparse.ArgumentParser(description="Run the published 1 kHz case under FMPy and compare.")
    parser.add_argument("--fmu", type=Path, default=ROOT / "dist" / "RelayContact.fmu", help="the component")
    parser.add_argument("--out", type=Path, default=ROOT / "out", help="folder for the table and the figure")
    arguments = parser.parse_args()
    if not arguments.fmu.is_file():
        print(f"{arguments.fmu} is missing: build it with `cargo xtask fmu`", file=sys.stderr)
        return 1
    run = simulate(arguments.fmu, read_scene(ROOT / "scenes" / "paper-1khz.toml"))
    left = decay_left(run)
    if not left < DECAYED:
        print(f"the last two periods differ by {left:.1e} of the force amplitude: simulate for longer", file=sys.stderr)
        return 1
    print(comparison(run))
    arguments.out.mkdir(parents=True, exist_ok=True)
    table, figure = arguments.out / "paper-1khz.csv", arguments.out / "paper-1khz.png"
    write_table(run, table)
    draw(run, figure)
    print(f"{table}\n{figure}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
