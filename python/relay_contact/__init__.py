"""A closed relay contact under vibration and shock: its force, its resistance, and whether and for how long it opens.

    import relay_contact

    result = relay_contact.run("chatter-41g", excitation_amplitude=300.0, progress=True)
    print(result["contact.force"].min(), result.units["contact.force"])

`scenes()` gives the scenes that come along, `run` runs one with changes, `run_many` many on all cores, with a row of a
table for each; `side_by_side` does so with work of your own. `qualify` tests a relay as a standard asks,
`compare` puts a run beside a measurement, `identify` finds parameters of a relay by measurements.
`fmu_path()` is the component itself, a file for any tool that imports FMI 2.0 for co-simulation. `Component` and
`Contact` step it by hand.
"""

import importlib
from typing import Any

from relay_contact.component import Array, Component, Contact, Unit, Value, Values, units
from relay_contact.files import RelayContactError, RelayContactWarning, fmu_path, scenes
from relay_contact.many import run_many, side_by_side
from relay_contact.scene import Result, Scene, read_table, run, write_table

LATER = {
    "qualify": "qualification", "relays": "qualification", "standards": "qualification", "compare": "comparison",
    "identify": "identification",
}  # fmt: skip
"""What needs matplotlib, with its module: loaded only when it is asked for."""


def __getattr__(name: str) -> Any:  # noqa: ANN401
    """Return what is loaded later."""
    if name not in LATER:
        raise AttributeError(name)
    return getattr(importlib.import_module(f"relay_contact.{LATER[name]}"), name)


__all__ = [
    "Array", "Component", "Contact", "RelayContactError", "RelayContactWarning", "Result", "Scene", "Unit", "Value",
    "Values", "fmu_path", "read_table", "run", "run_many", "scenes", "side_by_side", "units", "write_table",
]  # fmt: skip
