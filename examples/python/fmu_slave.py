"""Real variables with units, for the FMU that PythonFMU makes of an example: it packs this file with it."""

from functools import partial
from typing import Any
from xml.etree.ElementTree import Element, SubElement

from pythonfmu import Fmi2Causality, Fmi2Initial, Fmi2Slave, Fmi2Variability, Real

UNITS = {
    "V": {"kg": 1, "m": 2, "s": -3, "A": -1},
    "A": {"A": 1},
    "Ohm": {"kg": 1, "m": 2, "s": -3, "A": -2},
    "H": {"kg": 1, "m": 2, "s": -2, "A": -2},
    "s": {"s": 1},
    "m": {"m": 1},
    "kg": {"kg": 1},
    "m/s": {"m": 1, "s": -1},
    "N": {"kg": 1, "m": 1, "s": -2},
    "N/m": {"kg": 1, "s": -2},
    "N.s/m": {"kg": 1, "s": -1},
}
Variables = list[tuple[str, str, float, str]]
"""Name, unit, start value, meaning of each."""


class Slave(Fmi2Slave):  # type: ignore[misc]
    """An FMU of real variables that are known by name."""

    author = "The relay-contact developers"

    def declare(self, parameters: Variables, inputs: Variables, outputs: Variables) -> None:
        """Declare all variables; their values are in `values` from now on."""
        self.values: dict[str, float] = {}
        self.units: dict[str, str] = {}
        continuous, fixed = Fmi2Variability.continuous, Fmi2Variability.fixed
        self._add(parameters, causality=Fmi2Causality.parameter, variability=fixed)
        self._add(inputs, causality=Fmi2Causality.input, variability=continuous)
        calculated = Fmi2Initial.calculated
        self._add(outputs, causality=Fmi2Causality.output, variability=continuous, initial=calculated)

    def _add(self, variables: Variables, **kwargs: Any) -> None:  # noqa: ANN401
        for name, unit, start, description in variables:
            self.values[name], self.units[name] = start, unit
            get, put = partial(self.values.__getitem__, name), partial(self.values.__setitem__, name)
            self.register_variable(Real(name, description=description, getter=get, setter=put, **kwargs))

    def to_xml(self, *options: Any) -> Element:  # noqa: ANN401
        """Add what PythonFMU omits from the model description: the units and the initial unknowns."""
        root: Element = super().to_xml(*options)
        definitions = Element("UnitDefinitions")
        for name in sorted(set(self.units.values())):
            base = {each: str(exponent) for each, exponent in UNITS[name].items()}
            SubElement(SubElement(definitions, "Unit", name=name), "BaseUnit", base)
        root.insert(1, definitions)
        for variable in root.iter("ScalarVariable"):
            variable[0].set("unit", self.units[variable.attrib["name"]])
        structure = next(root.iter("ModelStructure"))
        unknowns = SubElement(structure, "InitialUnknowns")
        unknowns.extend(list(structure[0]))
        return root
