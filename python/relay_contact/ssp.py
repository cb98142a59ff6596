"""Scenes as parameter sets for tools that read SSP 1.0 (`SystemStructureParameterValues`)."""

from pathlib import Path
from xml.etree.ElementTree import Element, SubElement, indent, register_namespace, tostring

import numpy as np

from relay_contact.component import Component
from relay_contact.scene import Scene

NAMESPACE = "http://ssp-standard.org/SSP1/SystemStructureParameterValues"


def parameter_set(name: str, scene: Scene, component: Component, plain: bool = False) -> bytes:
    """Return what a scene changes: parameters, and its inputs at the start, in SI units.

    `plain`: for the component in which all numbers are Reals. A spring file is one in the resources of the component,
    where one that carries it has it.
    """
    register_namespace("ssv", NAMESPACE)
    root = Element(f"{{{NAMESPACE}}}ParameterSet", version="1.0", name=name, description=scene.title)
    parameters = SubElement(root, f"{{{NAMESPACE}}}Parameters")
    values = scene.values | {each: float(course[0]) for each, course in scene.inputs(np.zeros(1)).items()}
    for each, variable in component.variables.items():
        if each not in values or values[each] == component.start(each):
            continue
        value = values[each]
        parameter = SubElement(parameters, f"{{{NAMESPACE}}}Parameter", name=each)
        if variable.type == "String":
            kind, text = "String", Path(str(value)).name
        elif plain or variable.type == "Real":
            kind, text = "Real", repr(float(component.number(each, value)))
        elif variable.type == "Enumeration":
            kind, text = "Enumeration", str(value)
        elif variable.type == "Boolean":
            kind, text = "Boolean", str(bool(value)).lower()
        else:
            kind, text = variable.type, str(int(component.number(each, value)))
        SubElement(parameter, f"{{{NAMESPACE}}}{kind}", value=text)
    indent(root)
    written: bytes = tostring(root, encoding="UTF-8", xml_declaration=True)
    return written + b"\n"
