"""Runs of the component under FMPy: settings, driven inputs, communication steps, the demonstration."""

import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fmpy import simulate_fmu

from component import FMU, run
from relay_contact import ROOT, Array, Values, read_table

AMPLITUDE, FREQUENCY = 98.0, 1000.0
SCENE: Values = {"effects.excitation": "Sine", "excitation.amplitude": AMPLITUDE, "excitation.frequency": FREQUENCY}
# solver.tolerance is relative to max(F_0, 3 E I s_ref / L^3); for the specimen the second is F_0 without axial force.
FORCE_SCALE = 0.1520261


def test_default_settings_keep_the_contact_at_rest() -> None:
    result = simulate_fmu(str(FMU))
    start = result["contact.force"][0]
    assert len(result) > 100
    assert start == pytest.approx(0.152, rel=5e-3)
    # At rest nothing moves; what is left is the rounding of the equilibrium, far below the default tolerance.
    assert np.max(np.abs(result["contact.force"] - start)) <= 1e-6 * FORCE_SCALE
    assert result["contact.closed"].all()
    assert (result["contact.lastOpening"] == -1).all()
    assert (result["contact.lastClosing"] == -1).all()


@pytest.mark.parametrize("tolerance", [1e-4, 1e-6, 1e-8])
def test_force_does_not_depend_on_the_communication_step(tolerance: float) -> None:
    # Each run may be wrong by the tolerance, so two may differ by twice as much.
    allowed = 2 * tolerance * FORCE_SCALE
    values = {**SCENE, "solver.tolerance": tolerance}
    forces: list[Array] = []
    for step in (1e-6, 1e-5, 1e-4, 1e-3):
        result = run(values, 0.01, step, ["contact.force"])
        common = result["contact.force"][:: round(1e-3 / step)]
        assert len(common) == 11
        forces.append(common)
    assert np.ptp(forces[0]) > 0.001
    for force in forces[1:]:
        assert np.max(np.abs(force - forces[0])) <= allowed
    # The three that have points every 100 us are compared there too: the kilohertz points all lie in the same phase.
    fine, coarse = (run(values, 0.005, step, ["contact.force"])["contact.force"] for step in (1e-6, 1e-4))
    assert np.ptp(coarse) > 0.05
    assert np.max(np.abs(fine[::100] - coarse)) <= allowed


def accelerations(time: Array, values: Array) -> Any:  # noqa: ANN401
    """Give the table of inputs as FMPy takes it, the other inputs 0."""
    names = ["base.acceleration", "support.displacement", "contact.current"]
    signals = np.zeros(len(time), dtype=[("time", np.float64), *((name, np.float64) for name in names)])
    signals["time"], signals["base.acceleration"] = time, values
    return signals


def sine(time: Array) -> Array:
    """Give the acceleration of the generator."""
    values: Array = AMPLITUDE * np.sin(2 * np.pi * FREQUENCY * time)
    return values


def test_a_staircase_of_acceleration_gives_the_same_force_whatever_the_communication_step() -> None:
    # An input is held over each step, so stairs of 122 us are the same input to steps of 122 us and of 1 us. Each run
    # may be wrong by the tolerance, so two may differ by twice as much. Powers of two keep the instants exact.
    tolerance, stair, fine_step = 1e-8, 2.0**-13, 2.0**-20
    stop = 40 * stair
    edges: Array = np.arange(41, dtype=np.float64) * stair
    heights = sine(edges[:-1] + stair / 2)
    signals = accelerations(np.repeat(edges, 2)[1:-1], np.repeat(heights, 2))
    values = {"solver.tolerance": tolerance}
    coarse, fine = (run(values, stop, step, ["contact.force"], signals)["contact.force"] for step in (stair, fine_step))
    assert np.ptp(coarse) > 0.05
    assert np.max(np.abs(fine[::128] - coarse)) <= 2 * tolerance * FORCE_SCALE


@pytest.mark.parametrize("step", [1e-6, 4e-6])
def test_a_sine_held_over_each_step_gives_the_force_of_the_generator(step: float) -> None:
    # Held at the sine's value in the middle of each step h, the acceleration is off by a sawtooth of height A w h / 2
    # and mean 0 over each step. What the force has had the time to follow of it is S(h), its response at h to a unit
    # jump of the acceleration: the last step's sawtooth gives at most A w (h/2) S(h). In the steps before, only the
    # variation of the impulse response g within a step counts: A w h^2/8 times the variation of g after h, which is
    # no more than 2 g(h) <= 2 S(h) / h; together less than A w h S(h). An input one step late would give more than
    # five times that. S(h) is measured.
    values = {"solver.tolerance": 1e-9}
    jump = run({**values, "base.acceleration": 10.0}, step, step, ["contact.force"])["contact.force"]
    response = (jump[1] - jump[0]) / 10.0
    bound = AMPLITUDE * 2 * np.pi * FREQUENCY * step * response

    stop = 0.003
    time: Array = np.arange(round(stop / step) + 1, dtype=np.float64) * step
    held = run(values, stop, step, ["contact.force"], accelerations(time, sine(time + step / 2)))
    generated = run({**SCENE, **values}, stop, step, ["contact.force"])
    assert np.ptp(generated["contact.force"]) > 0.05
    difference = np.max(np.abs(held["contact.force"] - generated["contact.force"]))
    assert difference <= bound + 2e-9 * FORCE_SCALE
    assert difference > 0


def test_demonstration_writes_its_table_and_figure(tmp_path: Path) -> None:
    script = ROOT / "examples" / "python" / "paper_1khz.py"
    command = [sys.executable, str(script), "--fmu", str(FMU), "--out", str(tmp_path)]
    finished = subprocess.run(command, capture_output=True, text=True, check=False)
    assert finished.returncode == 0, finished.stderr
    rows = [line for line in finished.stdout.splitlines() if line.endswith("%")]
    assert len(rows) == 6
    # The first four are what the specimen was identified from, to the digits published.
    for row in rows[:4]:
        assert abs(float(row.split()[-2])) < 0.1
    table = read_table(tmp_path / "paper-1khz.csv")
    assert [len(column) for column in table.values()] == [2001] * 4
    assert (tmp_path / "paper-1khz.png").stat().st_size > 10_000
