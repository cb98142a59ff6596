"""The runs that importers are to reproduce, and the rows of the table of what they did.

`cargo xtask test` writes the runs before these tests and prints the rows after them.
"""

import json

from relay_contact import ROOT, read_table

FOLDER = ROOT / "out" / "conformance"
# Two instances, wired together, with their parameters.
SYSTEM = FOLDER / "two-contacts.ssp"

STEP = 1e-5
TOLERANCE = 1e-7
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


def record(importer: str, version: str, task: str, difference: float | None = None, result: str = "passed") -> None:
    """Write a row of the table; `difference` is the largest in the contact force from our own run, N."""
    row = {"importer": importer, "version": version, "task": task, "result": result, "difference": difference}
    FOLDER.mkdir(parents=True, exist_ok=True)
    (FOLDER / f"{importer}, {task}.json").write_text(json.dumps(row))


def compare(importer: str, version: str, task: str, forces: list[float], start: int = 0) -> None:
    """Assert that forces are those of our own run from the communication point `start` on, and write the row."""
    expected = column("run" if task == "run" else "coupled")[start:]
    difference = max(abs(force - own) for force, own in zip(forces, expected, strict=True))
    assert difference <= (0.0 if task == "run" else ROUNDING)
    record(importer, version, task, difference)
