"""The partner of the contact in two_fmus.py: a circuit and a vibration table, made an FMU by PythonFMU.

The tool that loads the FMU runs this file, which PythonFMU packs together with circuit.py. Both need only Python
itself; a file that also imported FMPy, libcosim and matplotlib would make every user of the FMU install them.
"""

import math
from functools import partial
from typing import Any
from xml.etree.ElementTree import Element, SubElement

from pythonfmu import Fmi2Causality, Fmi2Initial, Fmi2Slave, Fmi2Variability, Real

from circuit import Circuit

UNITS = {
    "V": {"kg": 1, "m": 2, "s": -3, "A": -1},
    "A": {"A": 1},
    "Ohm": {"kg": 1, "m": 2, "s": -3, "A": -2},
    "S": {"kg": -1, "m": -2, "s": 3, "A": 2},
    "H": {"kg": 1, "m": 2, "s": -2, "A": -2},
    "F": {"kg": -1, "m": -2, "s": 4, "A": 2},
    "m/s2": {"m": 1, "s": -2},
    "Hz": {"s": -1},
}
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


class TestBench(Fmi2Slave):  # type: ignore[misc]
    """A source, a load and a quench around a contact, and a table that vibrates it."""

    author = "The relay-contact developers"
    description = "Inductive circuit with an RC quench around a contact, and a vibration table"

    def __init__(self, **kwargs: Any) -> None:  # noqa: ANN401
        """Declare the variables."""
        super().__init__(**kwargs)
        self.values: dict[str, float] = {}
        self.units: dict[str, str] = {}
        continuous, fixed = Fmi2Variability.continuous, Fmi2Variability.fixed
        self._declare(PARAMETERS, causality=Fmi2Causality.parameter, variability=fixed)
        self._declare(INPUTS, causality=Fmi2Causality.input, variability=continuous)
        calculated = Fmi2Initial.calculated
        self._declare(OUTPUTS, causality=Fmi2Causality.output, variability=continuous, initial=calculated)

    def _declare(self, variables: list[tuple[str, str, float, str]], **kwargs: Any) -> None:  # noqa: ANN401
        for name, unit, start, description in variables:
            self.values[name], self.units[name] = start, unit
            get, put = partial(self.values.__getitem__, name), partial(self.values.__setitem__, name)
            self.register_variable(Real(name, description=description, getter=get, setter=put, **kwargs))

    def to_xml(self, *options: Any) -> Element:  # noqa: ANN401
        """Add what PythonFMU omits from the model description: the units and the initial unknowns."""
        root: Element = super().to_xml(*options)
        definitions = Element("UnitDefinitions")
        for name, exponents in UNITS.items():
            base = {each: str(exponent) for each, exponent in exponents.items()}
            SubElement(SubElement(definitions, "Unit", name=name), "BaseUnit", base)
        root.insert(1, definitions)
        for variable in root.iter("ScalarVariable"):
            variable[0].set("unit", self.units[variable.attrib["name"]])
        structure = next(root.iter("ModelStructure"))
        unknowns = SubElement(structure, "InitialUnknowns")
        unknowns.extend(list(structure[0]))
        return root

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
