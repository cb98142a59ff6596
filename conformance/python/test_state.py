"""Saved states through FMPy: restored in the instance, in another one and in another process, they go on as before."""

import multiprocessing
from pathlib import Path

import fmpy
from component import Instance
from results import record

STEP = 1e-6
HALF = 900  # the contact opens in the first half and closes in the second


def forces(instance: Instance, first: int, count: int) -> list[float]:
    """Step `count` times from the step `first` on; give the contact force after each."""
    result = []
    for step in range(first, first + count):
        instance.step(step * STEP, STEP)
        result.append(instance.get("contact.force"))
    return result


def shaken(folder: Path) -> Instance:
    """Give an instance whose contact opens."""
    instance = Instance(folder)
    instance.choose("effects.excitation", "Sine")
    instance.set("excitation.amplitude", 400.0)
    instance.initialise()
    return instance


def go_on(folder: Path, serialised: bytes) -> list[float]:
    """Restore a state from bytes in a new instance and go on from it."""
    with Instance(folder) as instance:
        state = instance.slave.deSerializeFMUstate(serialised)
        instance.slave.setFMUstate(state)
        instance.slave.freeFMUstate(state)
        return forces(instance, HALF, HALF)


def test_a_restored_state_goes_on_bit_by_bit(tmp_path: Path) -> None:
    """Going on gives the same bits as at the first time, wherever it happens."""
    with shaken(tmp_path / "first") as instance:
        before = forces(instance, 0, HALF)
        state = instance.slave.getFMUstate()
        serialised = instance.slave.serializeFMUstate(state)
        after = forces(instance, HALF, HALF)
        assert min(before) == 0.0 < max(after)
        instance.slave.setFMUstate(state)
        assert forces(instance, HALF, HALF) == after
        instance.slave.freeFMUstate(state)
    assert go_on(tmp_path / "second", serialised) == after
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        assert pool.apply(go_on, (tmp_path / "third", serialised)) == after
    record("FMPy", fmpy.__version__, "saved states")
