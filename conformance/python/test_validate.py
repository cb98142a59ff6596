"""The component is a valid FMU in FMPy's judgement, and what belongs in the package is there."""

import zipfile
from pathlib import Path
from xml.etree import ElementTree

import fmpy
import pytest
from fmpy import read_model_description
from fmpy.validation import validate_fmu
from xmlschema import XMLSchema

from component import FMU, PLAIN, ROOT, SPRUNG
from relay_contact import Component, RelayContactError, run
from results import record


@pytest.mark.parametrize("fmu", [FMU, PLAIN, SPRUNG], ids=["own", "plain", "sprung"])
def test_fmpy_finds_no_problem(fmu: Path) -> None:
    assert validate_fmu(str(fmu)) == []
    record("FMPy", fmpy.__version__, "validation")


def test_the_python_package_refuses_a_component_without_names_of_choices() -> None:
    with pytest.raises(RelayContactError, match=r"RelayContact-plain.fmu: a variant for other tools, "):
        run("at-rest", component=Component(PLAIN), friction_coefficient=0.3)
    # As those of scenes.
    for effect in ("Linearised", True):
        with pytest.raises(RelayContactError, match=r"RelayContact-plain.fmu: a variant for other tools, "):
            Component(PLAIN).number("effects.contactLaw", effect)


def test_package_holds_documentation_licences_and_icon() -> None:
    with zipfile.ZipFile(FMU) as archive:
        names = set(archive.namelist())
        assert archive.testzip() is None
        icon = archive.read("model.png")
        text = archive.read("documentation/licenses/license.txt").decode()
        library = next(each for each in archive.infolist() if each.filename.startswith("binaries/"))
    licences = "documentation/licenses/"
    assert {f"{licences}{name}" for name in ("license.txt", "LICENSE-MIT", "LICENSE-APACHE")} <= names
    assert "documentation/index.html" in names
    listed = {f"{licences}{line}" for line in text.split("\n\n")[1].split()}
    assert listed | {f"{licences}license.txt"} == {name for name in names if name.startswith(licences)}
    assert any(name.startswith(f"{licences}nalgebra-") for name in names)
    assert text.startswith("RelayContact is licensed under MIT OR Apache-2.0")
    assert icon.startswith(b"\x89PNG\r\n\x1a\n")
    assert library.external_attr >> 16 & 0o777 == 0o755


@pytest.mark.parametrize("fmu", [FMU, PLAIN], ids=["own", "plain"])
def test_terminals_are_of_the_standard_and_of_this_component(fmu: Path) -> None:
    folder = "terminalsAndIcons/"
    with zipfile.ZipFile(fmu) as archive:
        names = {name for name in archive.namelist() if name.startswith(folder)}
        description = ElementTree.fromstring(archive.read(f"{folder}terminalsAndIcons.xml"))
        pictures = {name: archive.read(name) for name in names - {f"{folder}terminalsAndIcons.xml"}}
    schema = Path(fmpy.__file__).parent / "schema/fmi3/fmi3TerminalsAndIcons.xsd"
    XMLSchema(schema).validate(description)
    causalities = {v.name: v.causality for v in read_model_description(str(fmu)).modelVariables}
    members = [member.get("variableName") for member in description.iter("TerminalMemberVariable")]
    assert len(members) == len(set(members))
    assert {causalities[str(member)] for member in members} == {"input", "output"}
    bases = {each.get("iconBaseName") for each in description.iter("TerminalGraphicalRepresentation")} | {"icon"}
    assert pictures.keys() == {f"{folder}{base}.{kind}" for base in bases for kind in ("png", "svg")}
    for name, picture in pictures.items():
        if name.endswith("svg"):
            assert ElementTree.fromstring(picture).tag == "{http://www.w3.org/2000/svg}svg"
        else:
            assert picture.startswith(b"\x89PNG\r\n\x1a\n")


def test_a_component_that_carries_a_spring_holds_its_file() -> None:
    with zipfile.ZipFile(SPRUNG) as archive:
        spring = archive.read("resources/tapered-cube.toml")
    assert spring == (ROOT / "scenes" / "springs" / "tapered-cube.toml").read_bytes()


def test_library_names_no_folder_of_the_machine_that_built_it() -> None:
    with zipfile.ZipFile(FMU) as archive:
        library = next(archive.read(name) for name in archive.namelist() if name.startswith("binaries/"))
    # Panic messages name the crates' files, so the test would see the folder that cargo unpacks crates into.
    assert b"nalgebra-" in library
    assert b"registry" not in library
    assert str(ROOT).encode() not in library
