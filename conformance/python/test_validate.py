"""The component is a valid FMU in FMPy's judgement, and what belongs in the package is there."""

import zipfile

import fmpy
from fmpy import read_model_description
from fmpy.validation import validate_fmu

from component import FMU, PLAIN, ROOT
from results import record


def test_fmpy_finds_no_problem() -> None:
    assert validate_fmu(str(FMU)) == []
    assert validate_fmu(str(PLAIN)) == []
    record("FMPy", fmpy.__version__, "validation")


def test_package_holds_documentation_licences_and_icon() -> None:
    with zipfile.ZipFile(FMU) as archive:
        names = set(archive.namelist())
        assert archive.testzip() is None
        page = archive.read("documentation/index.html").decode()
        icon = archive.read("model.png")
    licences = "documentation/licenses/"
    assert {f"{licences}LICENSE-MIT", f"{licences}LICENSE-APACHE"} <= names
    assert any(name.startswith(f"{licences}nalgebra-") for name in names)
    assert icon.startswith(b"\x89PNG\r\n\x1a\n")
    for variable in read_model_description(str(FMU)).modelVariables:
        assert f"<code>{variable.name}</code>" in page


def test_library_names_no_folder_of_the_machine_that_built_it() -> None:
    with zipfile.ZipFile(FMU) as archive:
        library = next(archive.read(name) for name in archive.namelist() if name.startswith("binaries/"))
    # Panic messages name the crates' files, so the test would see the folder that cargo unpacks crates into.
    assert b"nalgebra-" in library
    assert b"registry" not in library
    assert str(ROOT).encode() not in library
