"""The contact and its test bench (two_fmus.py) wired together, and as one file of SSP 1.0."""

import zipfile
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement, indent, register_namespace, tostring

from fmpy.ssp.ssd import read_ssd

from two_fmus_bench import UNITS

# From instance and output to instance and input, with the unit. The first is the vibration.
WIRES = [
    ("bench", "table.acceleration", "contact", "base.acceleration", "m/s2"),
    ("contact", "contact.conductance", "bench", "contact.conductance", "S"),
    ("bench", "contact.current", "contact", "contact.current", "A"),
]
SSP = {
    "ssd": "http://ssp-standard.org/SSP1/SystemStructureDescription",
    "ssc": "http://ssp-standard.org/SSP1/SystemStructureCommon",
    "ssv": "http://ssp-standard.org/SSP1/SystemStructureParameterValues",
}

Fmus = dict[str, Path]  # the file of each instance
Starts = dict[str, dict[str, float]]  # start values of each instance


def write_system(path: Path, fmus: Fmus, starts: Starts) -> None:
    """Write the FMUs, their wires and their start values as one file, and check it by the schema."""
    for prefix, uri in SSP.items():
        register_namespace(prefix, uri)

    def add(parent: Element, tag: str, **attributes: str) -> Element:
        prefix, name = tag.split(":")
        return SubElement(parent, f"{{{SSP[prefix]}}}{name}", attributes)

    root = Element(f"{{{SSP['ssd']}}}SystemStructureDescription", version="1.0", name="ContactOnTestBench")
    system, units = add(root, "ssd:System", name="system"), add(root, "ssd:Units")
    elements, connections = add(system, "ssd:Elements"), add(system, "ssd:Connections")
    connectors, files = {}, {"SystemStructure.ssd": root}
    kind = "application/x-fmu-sharedlibrary"
    for name, fmu in fmus.items():
        component = add(elements, "ssd:Component", name=name, type=kind, source=f"resources/{fmu.name}")
        connectors[name] = add(component, "ssd:Connectors")
        values = f"resources/{name}.ssv"
        add(add(component, "ssd:ParameterBindings"), "ssd:ParameterBinding", source=values)
        files[values] = Element(f"{{{SSP['ssv']}}}ParameterSet", version="1.0", name=name)
        parameters = add(files[values], "ssv:Parameters")
        for variable, start in starts[name].items():
            add(add(parameters, "ssv:Parameter", name=variable), "ssv:Real", value=repr(start))
    for source, output, sink, target, unit in WIRES:
        add(add(connectors[source], "ssd:Connector", name=output, kind="output"), "ssc:Real", unit=unit)
        add(add(connectors[sink], "ssd:Connector", name=target, kind="input"), "ssc:Real", unit=unit)
        ends = {"startElement": source, "startConnector": output, "endElement": sink, "endConnector": target}
        add(connections, "ssd:Connection", **ends)
    for name, base in UNITS.items():
        powers = {each: str(power) for each, power in base.items()}
        add(add(units, "ssc:Unit", name=name), "ssc:BaseUnit", **powers)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for file, element in files.items():
            indent(element)
            archive.writestr(file, tostring(element, encoding="UTF-8", xml_declaration=True))
        for fmu in fmus.values():
            archive.write(fmu, f"resources/{fmu.name}")
    read_ssd(str(path), validate=True)
