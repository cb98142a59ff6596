"""Saved states through FMPy: restored in the instance, in another one and in another process, they go on as before."""

import multiprocessing

import fmpy

from component import COMPONENT
from relay_contact import Contact, Scene
from results import record

STEP = 1e-6
HALF = 900  # the contact opens in the first half and closes in the second


def forces(instance: Contact, first: int, count: int) -> list[float]:
    """Step `count` times from the step `first` on; give the contact force after each."""
    result = []
    for step in range(first, first + count):
        instance.step(step * STEP, STEP)
        result.append(instance.get("contact.force"))
    return result


def go_on(serialised: bytes) -> list[float]:
    """Restore a state from bytes in a new instance and go on from it."""
    with Contact(COMPONENT) as instance:
        state = instance.fmu.deSerializeFMUstate(serialised)
        instance.fmu.setFMUstate(state)
        instance.fmu.freeFMUstate(state)
        return forces(instance, HALF, HALF)


def test_a_restored_state_goes_on_bit_by_bit() -> None:
    """Going on gives the same bits as at the first time, wherever it happens."""
    with COMPONENT.started(Scene.read("chatter-41g").values) as instance:
        before = forces(instance, 0, HALF)
        state = instance.fmu.getFMUstate()
        serialised = instance.fmu.serializeFMUstate(state)
        after = forces(instance, HALF, HALF)
        assert min(before) == 0.0 < max(after)
        instance.fmu.setFMUstate(state)
        assert forces(instance, HALF, HALF) == after
        instance.fmu.freeFMUstate(state)
    assert go_on(serialised) == after
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        assert pool.apply(go_on, (serialised,)) == after
    record("FMPy", fmpy.__version__, "saved states")
