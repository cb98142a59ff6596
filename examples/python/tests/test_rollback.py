"""The adaptive master: rejected steps leave no trace, its error falls with the tolerance, states are freed."""

from collections import defaultdict
from pathlib import Path

import numpy as np
import pytest

from conftest import COIL, FMU, SOURCE, advanced, is_picture, run_inside, table
from relay_contact import Array, Component, Scene, read_table

STOP = 2.5e-3


def outputs(steps: Array, names: list[str]) -> Array:
    """Give outputs at the start and after each step: a plain master that never goes back."""
    with Component(FMU).started(Scene.read("chatter-41g").values) as contact:
        values = [contact.real(*names)]
        for time, length in steps:
            contact.step(time, length)
            values.append(contact.real(*names))
    return np.array(values)


COUNTED = """
from fmpy.fmi2 import FMU2Slave
alive, most, all = set(), 0, 0
def get(self, get=FMU2Slave.getFMUstate):
    global most, all
    state = get(self)
    alive.add(state.value)
    most, all = max(most, len(alive)), all + 1
    return state
def free(self, state, free=FMU2Slave.freeFMUstate):
    alive.remove(state.value)
    free(self, state)
def end(self, end=FMU2Slave.freeInstance):
    assert not alive, "states outlive their instance"
    end(self)
FMU2Slave.getFMUstate, FMU2Slave.freeFMUstate, FMU2Slave.freeInstance = get, free, end
try:
    run()
finally:
    print("states:", all, most, len(alive))
"""


@pytest.fixture(scope="module")
def ran(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Path]:
    """Run the example, its states counted; give what it printed and the folder of its files."""
    folder = tmp_path_factory.mktemp("rollback")
    result = run_inside(COUNTED, "rollback", "--out", str(folder))
    assert result.returncode == 0, result.stderr
    return result.stdout, folder


def test_rejected_steps_leave_no_trace(ran: tuple[str, Path]) -> None:
    said, folder = ran
    assert "the same bits" in said
    assert is_picture(folder / "rollback-steps.png")
    rows = np.column_stack(list(read_table(folder / "rollback-steps.csv").values()))
    assert len(rows) > 100
    time, length, current, voltage, mean = rows.T

    # Without a gap from start to stop; sums of lengths round.
    assert time[0] == 0
    assert time[1:] == pytest.approx(time[:-1] + length[:-1], abs=1e-15)
    assert time[-1] + length[-1] == pytest.approx(STOP, abs=2e-9)

    # The component gives the very same bits where nobody ever goes back. (The table holds all digits.)
    values = outputs(rows[:, :2], ["contact.conductance"])[:, 0]
    assert np.array_equal((values[:-1] + values[1:]) / 2, mean)

    # And the circuit follows from them. Rounding: the exponential of a 3 x 3 matrix of entries up to 6e3 V/H * 50 us.
    for index in range(len(rows) - 1):
        after = advanced(np.array([current[index], voltage[index]]), mean[index], length[index])
        assert after == pytest.approx([current[index + 1], voltage[index + 1]], rel=1e-11, abs=1e-11)

    # Points at the openings and closings themselves, located to 1 ns.
    ends = np.append(time, STOP)
    for instant in (708.827593e-6, 1089.427605e-6):
        assert np.abs(ends - instant).min() < 1e-9


def test_error_falls_with_the_tolerance_and_with_the_step(ran: tuple[str, Path]) -> None:
    folder = ran[1]
    assert is_picture(folder / "rollback.png")
    work: dict[str, list[tuple[float, float, float]]] = defaultdict(list)
    for row in table(folder / "rollback.csv"):
        entry = float(row["setting"]), float(row["steps.done"]), float(row["error.load.current"])
        work[row["master"]].append(entry)

    # Fixed steps: late by half a step as by a whole one, at a slope changed by 6 V / 1 mH at most.
    fixed = np.array(work["fixed"])
    assert np.all(fixed[:, 2] < fixed[:, 0] * SOURCE / COIL)
    assert np.array_equal(fixed[:, 1], np.round(STOP / fixed[:, 0]))
    # The largest of four delays scatters by a sixth; a line through six such points by 0.05. Five times that, as the
    # longest step is longer than the circuit's own time of 10 us.
    order = np.polyfit(np.log(fixed[:, 0]), np.log(fixed[:, 2]), 1)[0]
    assert order == pytest.approx(1, abs=0.25)

    # With events the rest is smooth, of second order. The error of a step, h^3, is kept at the tolerance, and the sum
    # goes with h^2: the tolerance to the power 2/3. Each error scatters by a fifth, as steps start where they happen
    # to: the slope over four decades by 0.04. Three times that.
    with_events = np.array([entry for entry in work["adaptive with events"] if entry[0] <= 1e-4])
    assert len(with_events) == 4
    assert np.polyfit(np.log(with_events[:, 0]), np.log(with_events[:, 2]), 1)[0] == pytest.approx(2 / 3, abs=0.12)
    assert np.all(np.diff(with_events[:, 2]) < 0)
    assert np.all(np.diff(with_events[:, 1]) > 0)
    # Without: it misses events in the second half of a step, but the error falls.
    without = np.array(work["adaptive"])
    assert without[-1, 2] < without[0, 2] / 10
    # What the events are worth: a tenth of the calls of the best fixed master, for a fiftieth of its error.
    assert with_events[0, 1] < fixed[-1, 1] / 10
    assert with_events[0, 2] < fixed[-1, 2] / 50


def test_every_state_is_freed(ran: tuple[str, Path]) -> None:
    saved, most, left = (int(word) for word in ran[0].splitlines()[-1].split()[1:])
    assert saved > 1000
    assert (most, left) == (1, 0)
    assert "FMU states not freed: 0" in ran[0]
