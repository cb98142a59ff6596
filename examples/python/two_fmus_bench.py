"""The partner of the contact in two_fmus.py: a circuit and a vibration table, made an FMU by PythonFMU.

It is a file of its own because PythonFMU packs the file, and the tool that loads the FMU runs it whole: a file that
also imported FMPy, libcosim and matplotlib would make every user of the FMU install them. This one needs nothing but
Python itself, which two_fmus.py describes together with the equations.
"""

import cmath
import math
from functools import partial
from typing import Any
from xml.etree.ElementTree import Element, SubElement

from pythonfmu import Fmi2Causality, Fmi2Initial, Fmi2Slave, Fmi2Variability, Real

UNITS = {
    "V": {"kg": 1, "m": 2, "s": -3, "A": -1},
    "A": {"A": 1},
    "Ohm": {"kg": 1, "m": 2, "s": -3, "A": -2},
    "H": {"kg": 1, "m": 2, "s": -2, "A": -2},
    "F": {"kg": -1, "m": -2, "s": 4, "A": 2},
    "m/s2": {"m": 1, "s": -2},
    "Hz": {"s": -1},
}
# Name, unit, start value, meaning.
PARAMETERS = [
    ("supply.voltage", "V", 6.0, "Voltage of the source"),
    ("load.resistance", "Ohm", 60.0, "Resistance of the load"),
    ("load.inductance", "H", 1e-3, "Inductance of the load"),
    ("quench.resistance", "Ohm", 47.0, "Resistance of the quench across the contact"),
    ("quench.capacitance", "F", 220e-9, "Capacitance of the quench across the contact"),
    ("table.amplitude", "m/s2", 400.0, "Amplitude of the table's sine"),
    ("table.frequency", "Hz", 1000.0, "Frequency of the table's sine"),
]
INPUTS = [("contact.resistance", "Ohm", 0.05, "Resistance of the contact, held over a communication step")]
OUTPUTS = [
    ("contact.current", "A", 0.0, "Current through the contact, of the resistance held over the step before"),
    ("contact.voltage", "V", 0.0, "Voltage across the contact, of the resistance held over the step before"),
    ("table.acceleration", "m/s2", 0.0, "Acceleration of the table"),
]


class TestBench(Fmi2Slave):  # type: ignore[misc]
    """A source, a load and a quench around a contact, and a table that shakes it."""

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
        """Add what PythonFMU leaves out of its description of the model: the units and the initial unknowns."""
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
        """Start at rest: the current that the contact, closed for long, lets through."""
        wrong = [name for name, *_ in PARAMETERS[:5] if not 0 < self.values[name] < math.inf]
        if wrong:
            raise ValueError(f"{wrong[0]} is {self.values[wrong[0]]}: it must be above 0")
        self.current, self.charged = self._rest()
        self._show(0.0)

    def do_step(self, current_time: float, step_size: float) -> bool:
        """Advance the circuit by the closed form of its two linear equations."""
        load, inductance, quench, capacitance, conductance = self._circuit()
        a = -(load + 1 / conductance) / inductance
        b = -1 / (quench * conductance * inductance)
        c = 1 / (conductance * quench * capacitance)
        d = (1 / (quench * conductance) - 1) / (quench * capacitance)
        mean, half = (a + d) / 2, cmath.sqrt((a - d) ** 2 / 4 + b * c)
        first, second = cmath.exp((mean + half) * step_size), cmath.exp((mean - half) * step_size)
        even = ((first + second) / 2).real
        odd = ((first - second) / (2 * half)).real if half else step_size * first.real
        current, voltage = self._rest()
        i, v = self.current - current, self.charged - voltage
        self.current = current + even * i + odd * ((a - mean) * i + b * v)
        self.charged = voltage + even * v + odd * (c * i + (d - mean) * v)
        self._show(current_time + step_size)
        return True

    def _circuit(self) -> tuple[float, float, float, float, float]:
        """Give load, inductance, quench and capacitance, and the conductance of contact and quench together."""
        load, inductance, quench, capacitance = (self.values[name] for name, *_ in PARAMETERS[1:5])
        return load, inductance, quench, capacitance, 1 / self.values["contact.resistance"] + 1 / quench

    def _rest(self) -> tuple[float, float]:
        """Give current and voltage of the quench where both stand still."""
        contact = self.values["contact.resistance"]
        current = self.values["supply.voltage"] / (self.values["load.resistance"] + contact)
        return current, current * contact

    def _show(self, time: float) -> None:
        """Set the outputs."""
        _, _, quench, _, conductance = self._circuit()
        voltage = (self.current + self.charged / quench) / conductance
        self.values["contact.voltage"] = voltage
        self.values["contact.current"] = voltage / self.values["contact.resistance"]
        phase = 2 * math.pi * self.values["table.frequency"] * time
        self.values["table.acceleration"] = self.values["table.amplitude"] * math.sin(phase)
