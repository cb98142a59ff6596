"""The runs that importers are to reproduce, and the rows of the table of what they did.

`cargo xtask test` writes the runs before these tests and prints the rows after them.
"""

import json
from itertools import pairwise
from typing import Any, NoReturn

import numpy as np
import pytest

from component import PLAIN, ROOT
from relay_contact import Component, read_table

FOLDER = ROOT / "out" / "conformance"
# Two instances, wired together, with their parameters.
SYSTEM = FOLDER / "two-contacts.ssp"

STEP = 1e-5
TOLERANCE = 1e-7
# Choices of the published run by number: Sine, FromPreload.
PUBLISHED = {"effects.excitation": 2.0, "effects.axialForce": 1.0}
# Acceleration of the frame of the two contacts, m/s2.
JUMP = 50.0
# In the first run the importer hands over the numbers that our own run took, so nothing is allowed for. The second of
# the two contacts gets what the first reached at an instant that importers reckon differently: a sum of 500 steps is
# off by at most 500 * 2^-53 * 5 ms = 3e-16 s, in which a spring that moves at less than 10 mm/s moves 3e-18 m, which
# a contact of less than 1e7 N/m feels as less than
ROUNDING = 3e-11  # N


def column(name: str) -> list[float]:
    """Give the values of a column of our own runs, one for each communication point."""
    return [float(value) for value in read_table(FOLDER / "reference.csv")[name]]


def staircase(names: list[str]) -> Any:  # noqa: ANN401
    """Give the acceleration of the run as FMPy takes it, by the first of these names; the others are 0.

    Two rows at every communication point, so that FMPy jumps there and does not interpolate.
    """
    held = column("base.acceleration")
    signals = np.zeros(2 * len(held), dtype=[(name, np.float64) for name in ["time", *names]])
    signals["time"] = np.repeat(np.arange(len(held)) * STEP, 2)
    signals[names[0]] = np.concatenate(([0.0], np.repeat(held, 2)[:-1]))
    return signals


def published(times: list[float]) -> list[float]:
    """Give the contact force of the published run, by FMPy, at the communication points as an importer counts them."""
    with Component(PLAIN).started(PUBLISHED) as contact:
        forces = [contact.get("contact.force")]
        for begin, end in pairwise(times):
            contact.step(begin, end - begin)
            forces.append(contact.get("contact.force"))
    return forces


def record(importer: str, version: str, task: str, difference: float | None = None, result: str = "passed") -> None:
    """Write a row of the table; `difference` is the largest in the contact force from our own run, N."""
    row = {"importer": importer, "version": version, "task": task, "result": result, "difference": difference}
    FOLDER.mkdir(parents=True, exist_ok=True)
    (FOLDER / f"{importer}, {task}.json").write_text(json.dumps(row))


def missing(importer: str, tasks: list[str], error: Exception) -> NoReturn:
    """Write the rows of an importer that is not installed, and skip its tests."""
    for task in tasks:
        record(importer, "-", task, result=f"not run: {error}")
    pytest.skip(str(error), allow_module_level=True)


def compare(
    importer: str, version: str, task: str, forces: list[float], start: int = 0, expected: list[float] | None = None
) -> None:
    """Assert that forces are those expected, else of our own run, from the point `start` on, and write the row."""
    coupled = task in ("two coupled", "SSP")
    expected = (expected or column("coupled" if coupled else "run"))[start:]
    # Of numpy, as Python's `max` passes over what is no number.
    difference = float(np.abs(np.subtract(forces, expected)).max())
    assert difference <= (ROUNDING if coupled else 0.0)
    record(importer, version, task, difference)
