"""The partner of the contact in two_fmus.py: a circuit and a vibration table, made an FMU by PythonFMU.

The tool that loads the FMU runs this file, which PythonFMU packs together with circuit.py and fmu_slave.py. They need
only Python itself; a file that also imported FMPy, libcosim and matplotlib would make every user of the FMU install
them.
"""

import math
from typing import Any

from circuit import Circuit
from fmu_slave import Slave

# Name, unit, start value, meaning; the first five in the order of `Circuit`.
PARAMETERS = [
    ("supply.voltage", "V", Circuit.supply, "Voltage of the source"),
    ("load.resistance", "Ohm", Circuit.load, "Resistance of the load"),
    ("load.inductance", "H", Circuit.inductance, "Inductance of the load"),
    ("quench.resistance", "Ohm", Circuit.quench, "Resistance of the quench across the contact"),
    ("quench.capacitance", "F", Circuit.capacitance, "Capacitance of the quench across the contact"),
    ("table.amplitude", "m/s2", 400.0, "Amplitude of the table's sine"),
    ("table.frequency", "Hz", 1000.0, "Frequency of the table's sine"),
]
INPUTS = [("contact.conductance", "S", 20.0, "Conductance of the contact, constant during a communication step")]
OUTPUTS = [
    ("contact.current", "A", 0.0, "Current through the contact, with its conductance during the last step"),
    ("contact.voltage", "V", 0.0, "Voltage across the contact, with its conductance during the last step"),
    ("table.acceleration", "m/s2", 0.0, "Acceleration of the table"),
]


class TestBench(Slave):
    """A source, a load and a quench around a contact, and a table that vibrates it."""

    description = "Inductive circuit with an RC quench around a contact, and a vibration table"

    def __init__(self, **kwargs: Any) -> None:  # noqa: ANN401
        """Declare the variables."""
        super().__init__(**kwargs)
        self.declare(PARAMETERS, INPUTS, OUTPUTS)

    def exit_initialization_mode(self) -> None:
        """Start in the steady state of the closed contact."""
        parameters = {name: self.values[name] for name, *_ in PARAMETERS[:5]}
        for name, value in parameters.items():
            if not 0 < value < math.inf:
                raise ValueError(f"{name} is {value}: it must be above 0")
        self.circuit = Circuit(*parameters.values())
        self.state = self.circuit.at_rest(self.values["contact.conductance"])
        self._update(0.0)

    def do_step(self, current_time: float, step_size: float) -> bool:
        """Advance the circuit."""
        self.state = self.circuit.after(self.state, self.values["contact.conductance"], step_size)
        self._update(current_time + step_size)
        return True

    def _update(self, time: float) -> None:
        """Set the outputs."""
        conductance = self.values["contact.conductance"]
        voltage = self.circuit.voltage(*self.state, conductance)
        self.values["contact.voltage"], self.values["contact.current"] = voltage, voltage * conductance
        phase = 2 * math.pi * self.values["table.frequency"] * time
        self.values["table.acceleration"] = self.values["table.amplitude"] * math.sin(phase)
