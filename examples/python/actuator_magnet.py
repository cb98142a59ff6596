"""The partner of the contact in actuator.py: a magnet whose coil is switched on and off, made an FMU by PythonFMU.

The tool that loads the FMU runs this file, which PythonFMU packs together with magnet.py and fmu_slave.py. They need
only Python itself; a file that also imported FMPy, libcosim and matplotlib would make every user of the FMU install
them.
"""

import math
from itertools import pairwise
from typing import Any

from fmu_slave import Slave
from magnet import Magnet

# Name, unit, start value, meaning; the first eleven in the order of `Magnet`.
PARAMETERS = [
    ("coil.resistance", "Ohm", Magnet.resistance, "Resistance of the coil"),
    ("coil.inductance", "H", Magnet.inductance, "Inductance of the coil with the armature at the core"),
    ("magnet.gapConstant", "m", Magnet.constant, "Gap at which half of the inductance is left"),
    ("armature.mass", "kg", Magnet.mass, "Mass of the armature, reduced to the pusher"),
    ("armature.stiffness", "N/m", Magnet.stiffness, "Stiffness of the return spring"),
    ("armature.returnForce", "N", Magnet.return_force, "Force of the return spring at the rest position"),
    ("armature.damping", "N.s/m", Magnet.damping, "Damping coefficient of the armature"),
    ("armature.restPosition", "m", Magnet.rest, "Position of the pusher where the armature meets its rest stop"),
    ("armature.corePosition", "m", Magnet.core, "Position of the pusher where the armature meets its core"),
    ("armature.stopStiffness", "N/m", Magnet.stop_stiffness, "Stiffness of both stops"),
    ("armature.stopDamping", "N.s/m", Magnet.stop_damping, "Damping coefficient of both stops"),
    ("supply.voltage", "V", 12.0, "Voltage of the source while it is on; off, it is a short circuit"),
    ("supply.onTime", "s", 1e-3, "Instant at which the source is switched on"),
    ("supply.offTime", "s", 21e-3, "Instant at which it is switched off"),
]
INPUTS = [("pusher.force", "N", 0.0, "Force of the contact spring on the pusher, constant during a communication step")]
OUTPUTS = [
    ("pusher.displacement", "m", 0.0, "Position of the pusher"),
    ("pusher.velocity", "m/s", 0.0, "Its derivative"),
    ("coil.current", "A", 0.0, "Current of the coil"),
    ("magnet.force", "N", 0.0, "Force of the magnet"),
]


class Actuator(Slave):
    """A magnet with its armature and a switched source."""

    description = "Electromagnet with coil, armature between two stops, and a source that is switched on and off"

    def __init__(self, **kwargs: Any) -> None:  # noqa: ANN401
        """Declare the variables."""
        super().__init__(**kwargs)
        self.declare(PARAMETERS, INPUTS, OUTPUTS)

    def exit_initialization_mode(self) -> None:
        """Start at rest without current."""
        parameters = {name: self.values[name] for name, *_ in PARAMETERS}
        for name, value in parameters.items():
            if not (math.isfinite(value) if "Position" in name else 0 < value < math.inf):
                raise ValueError(f"{name} is {value}: it must be above 0")
        *constants, self.voltage, self.on, self.off = parameters.values()
        self.magnet = Magnet(*constants)
        if self.magnet.core <= self.magnet.rest:
            raise ValueError(f"armature.corePosition is {self.magnet.core}: it must be above armature.restPosition")
        self.state = self.magnet.at_rest()
        self._update()

    def do_step(self, current_time: float, step_size: float) -> bool:
        """Advance the magnet, through the instants at which the source is switched."""
        end = current_time + step_size
        points = [current_time, *(each for each in (self.on, self.off) if current_time < each < end), end]
        for begin, until in pairwise(points):
            middle = (begin + until) / 2
            voltage = self.voltage if self.on < middle < self.off else 0.0
            self.state = self.magnet.after(self.state, voltage, self.values["pusher.force"], until - begin)
        self._update()
        return True

    def _update(self) -> None:
        """Set the outputs."""
        _, place, velocity = self.state
        self.values["pusher.displacement"], self.values["pusher.velocity"] = place, velocity
        self.values["coil.current"] = self.magnet.current(self.state)
        self.values["magnet.force"] = self.magnet.pull(self.state)
