"""The package `relay_contact`: runs of scenes, and what it says about wrong names and values."""

import gc
import mmap
import os
import re
import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any
from zipfile import ZipFile

import matplotlib as mpl
import nbformat
import numpy as np
import pytest
from fmpy import simulate_fmu

from component import COMPONENT, FMU, ROOT
from relay_contact import (
    Component,
    Contact,
    RelayContactError,
    RelayContactWarning,
    Scene,
    Values,
    qualification,
    read_table,
    run,
    run_many,
)
from relay_contact.command import main
from relay_contact.component import default_component, sine


def test_a_run_has_names_and_units() -> None:
    result = run("paper-1khz", component=COMPONENT, stop=1e-3, outputs=["contact.force", "chatter.count"])
    assert result.dtype.names == ("time", "contact.force", "chatter.count")
    assert result.units == {"time": "s", "contact.force": "N", "chatter.count": ""}
    assert np.array_equal(result["time"], np.arange(101) * 1e-5)
    assert run("at-rest", component=COMPONENT, outputs="contact.force").dtype.names == ("time", "contact.force")
    # Rows keep their names and units.
    assert result[10:20].units == result.units
    assert result[10:20]["contact.force"][0] == result["contact.force"][10]
    with pytest.raises(KeyError, match=r"contact.farce.*contact.force"):
        result["contact.farce"]


def test_an_input_course_is_linear_between_its_points() -> None:
    """The published sine as an input."""
    exact = run("paper-1khz", component=COMPONENT, stop=2e-3, solver_tolerance=1e-8)["contact.force"]
    time = np.arange(0.0, 2.1e-3, 1e-5)
    course = {"time": time, "base.acceleration": 98.0 * np.sin(2 * np.pi * 1000.0 * time)}
    changes: Any = {"effects.excitation": "None", "solver.tolerance": 1e-8}
    driven = run("paper-1khz", inputs=course, component=COMPONENT, stop=2e-3, **changes)["contact.force"]
    # Chords lie (omega step)^2 / 8 below the sine at most; values held over a step would be wrong by omega step / 2.
    assert np.abs(driven - exact).max() / (np.ptp(exact) / 2) < (2 * np.pi * 1e-2) ** 2 / 8


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"excitation_amplitude": 300.0}, ["excitation.amplitude = 300.0: not used without effects.excitation = Sine"]),
        ({"excitation_amplitude": 300.0, "effects_excitation": 2.0}, []),
        ({"friction_coefficient": 0.3}, ["friction.coefficient = 0.3: not used without effects.friction = Coulomb"]),
        # Who says so knows it.
        ({"friction_coefficient": 0.3, "effects_friction": "None"}, []),
        # Of the first contact, too.
        ({"second_minimumDuration": 1e-5}, []),
        # Also of a course.
        ({"inputs": {"time": [0, 1e-3], "pusher.displacement": [0, 1e-4]}}, ["pusher.displacement: not used without"]),
        ({"inputs": {"time": [0, 1e-3], "coil.relativeCurrent": [1, 1]}}, []),
    ],
)
@pytest.mark.filterwarnings("ignore::relay_contact.RelayContactWarning")
def test_a_value_that_nothing_uses_is_told(changes: Any, told: list[str]) -> None:  # noqa: ANN401
    """An amplitude without an excitation: nothing moved, without a word."""
    found = run("at-rest", component=COMPONENT, **changes).warnings
    assert [text[: len(begin)] for text, begin in zip(found, told, strict=True)] == told


def test_an_unknown_scene_is_answered_with_those_there_are() -> None:
    with pytest.raises(
        RelayContactError, match="no scene of this name; there are armature-shock, at-rest, changeover-make"
    ):
        Scene.read("paper")


def test_a_component_for_other_machines_is_refused(tmp_path: Path) -> None:
    other = tmp_path / "other.fmu"
    with ZipFile(FMU) as archive, ZipFile(other, "w") as copy:
        copy.writestr("modelDescription.xml", archive.read("modelDescription.xml"))
        copy.writestr("binaries/win32/RelayContact.dll", b"")
    with pytest.raises(RelayContactError, match=r"has libraries for win32 only, not for this machine"):
        Component(other)
    with pytest.raises(RelayContactError, match=r"is missing: build it with"):
        Component(str(tmp_path / "none.fmu"))
    # As a download that has ended too early.
    other.write_bytes(FMU.read_bytes()[:100000])
    with pytest.raises(RelayContactError, match=r"other.fmu: no component, or not the whole of it"):
        Component(other)


def test_runs_without_a_component_have_one_until_its_file_changes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """To unpack one takes as long as thirty runs, and 2 MB stayed of each."""
    own = tmp_path / "own.fmu"
    shutil.copyfile(FMU, own)
    monkeypatch.setenv("RELAY_CONTACT_FMU", str(own))
    first = default_component()
    for _ in range(2):
        with pytest.warns(RelayContactWarning, match=r"usual is"):
            run("at-rest", tip_mass=1e-2)
    assert run_many("at-rest")["error"].item() == ""
    assert default_component() is first
    os.utime(own, (0, 0))
    assert default_component() is not first
    folder = first.folder
    del first
    gc.collect()
    assert not folder.exists()
    if sys.platform == "linux":
        assert str(folder) not in Path("/proc/self/maps").read_text(encoding="utf-8")
    # Somebody has tidied up.
    shutil.rmtree(default_component().folder)
    assert default_component().folder.is_dir()


@pytest.mark.skipif(sys.platform != "linux", reason="the memory of this process is read from /proc")
@pytest.mark.parametrize("own", [lambda: None, Component])
def test_the_memory_of_many_runs_is_that_of_some(own: Callable[[], Component | None]) -> None:
    """2 MB had stayed of each."""

    def taken(runs: int) -> float:
        for _ in range(runs):
            run("at-rest", component=own())
        gc.collect()
        return int(Path("/proc/self/statm").read_text(encoding="utf-8").split()[1]) * mmap.PAGESIZE / 2**20

    begin = taken(5)
    assert taken(10) < begin + 5.0


def test_the_command_runs_a_scene_as_asked(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    options = ["--stop", "1e-3", "--step", "1e-4", "--output", "tip.velocity", "--out", str(tmp_path)]
    assert main(["run", "paper-1khz", *options, "--set", "excitation.frequency=500"]) == 0
    table = read_table(tmp_path / "paper-1khz,excitation.frequency=500.csv")
    assert table["time"] == pytest.approx(np.linspace(0, 1e-3, 11))
    force = table["contact.force"]
    printed = capsys.readouterr().out
    assert f" {force.min():.6g} to {force.max():.6g} N\n" in printed
    assert printed.startswith("The published 1 kHz run; changed: excitation.frequency=500\n")
    assert np.ptp(table["tip.velocity"]) > 0
    # In a file's name there is no room for all that may be changed.
    sizes = {name: COMPONENT.start(name) for name in COMPONENT.variables if name.startswith(("beam.", "tip.mass"))}
    changes = [part for name, value in sizes.items() if value for part in ("--set", f"{name}={value}")]
    assert main(["run", "paper-1khz", *options, *changes]) == 0
    assert sorted(path.suffix for path in tmp_path.glob("paper-1khz,????????????????.*")) == [".csv", ".png"]


def test_the_command_passes_on_all_options_of_a_qualification(monkeypatch: pytest.MonkeyPatch) -> None:
    given: dict[str, Any] = {}

    def asked(*files: Any, **options: Any) -> None:  # noqa: ANN401
        given.update(options, files=files)
        raise RelayContactError("seen")

    monkeypatch.setattr(qualification, "qualify", asked)
    text = "paper --standard NAME --history a --history b --test sine --unit g --rate 5e4 --quick --workers 3 --pdf"
    assert main(["qualify", *text.split(), "--cluster", "tcp://host:1", "--date", "today", "--out", "folder"]) == 1
    del given["component"]
    assert given == {
        "files": ("paper", "NAME"), "history": ["a", "b"], "tests": ["sine"], "unit": "g", "rate": 5e4, "quick": True,
        "workers": 3, "pdf": True, "cluster": "tcp://host:1", "date": "today", "out": Path("folder"), "progress": True,
    }  # fmt: skip


def test_the_command_lists_variables_with_their_choices(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["list", "--variables", "contactLaw"]) == 0
    assert "effects.contactLaw (parameter Hertz) [Hertz, Linearised, Bonded, Rough]" in capsys.readouterr().out
    assert main(["list", "--variables", "contactLow"]) == 1
    assert "contactLow: no variable has this in its name" in capsys.readouterr().err


def test_a_file_that_is_not_there_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    missing = str(tmp_path / "run.csv")
    for command in (["plot", missing], ["compare", missing, missing]):
        assert main(command) == 1
        assert capsys.readouterr().err == f"relay-contact: {missing}: No such file or directory\n"


def test_the_command_takes_a_spring_file_from_where_it_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("own").mkdir()
    shutil.copy(ROOT / "scenes/springs/tapered-cube.toml", "own/tapered.toml")
    assert main(["run", "at-rest", "--set", "beam.file=own/tapered.toml"]) == 0
    assert (tmp_path / "at-rest,beam.file=tapered.toml.csv").is_file()


def test_the_command_tells_whether_a_contact_is_smooth_enough_for_hertz(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """By hand: 1/E* = 0.8911 / 86 GPa + 0.8844 / 81.92 GPa, and a^3 = 3 F R / (4 E*) with 0.152 N and 21.77 mm."""
    own = tmp_path / "own.toml"
    for roughness, said in (
        ("", "no roughness given: Hertz's law holds up to 3.2 nm rms"),
        ("[contact]\nroughness = 0.5e-6", "number 7.76 for 0.5 um rms: Hertz's law does not hold"),
        ("[contact]\nroughness = 3e-9", "number 0.0466 for 0.003 um rms: Hertz's law holds"),
        ("[parameters]\ncontact.overtravel = -1e-4", "open at rest"),
    ):
        own.write_text(roughness)
        assert main(["list", "--relay", str(own)]) == 0
        printed = capsys.readouterr().out
        assert said in printed
        assert "relays:" not in printed
        assert ("15.2 cN" in printed) == ("radius 37.4 um, indented by 64.4 nm" in printed) == ("open" not in said)
    own.write_text('[contact]\nroughness = "0.5 um"')
    assert main(["list", "--relay", str(own)]) == 1
    assert 'own.toml:2: contact.roughness = "0.5 um": not allowed' in capsys.readouterr().err


def test_the_notebook_runs(capsys: pytest.CaptureFixture[str]) -> None:
    mpl.use("Agg")
    notebook = nbformat.read(ROOT / "examples/relay_contact.ipynb", as_version=4)
    nbformat.validate(notebook)
    names: dict[str, Any] = {}
    for cell in notebook.cells:
        if cell.cell_type == "code":
            exec(cell.source, names)
    # At 1 kHz, 400 m/s2 is above the 333 m/s2 from which the contact opens.
    assert names["chatter"]["chatter.longestInterruption"][-1] > 1e-5
    assert names["shock"]["contact.resistance"].max() > 1e6
    # The blows of the shown periods set the axis, not that of the first closing before them.
    assert names["axes"].get_ylim()[1] < 1.1 * 100 * names["chatter"]["contact.force"][-300:].max()
    assert "did you mean beam.length?" in capsys.readouterr().out


def test_a_step_tells_what_the_component_warns_of() -> None:
    COMPONENT.told.clear()
    values: Values = {**sine(900.0, 900.0), "solver.tolerance": 1e-11, "solver.modes": 16}
    with COMPONENT.started(values) as contact, pytest.warns(RelayContactWarning, match="may be wrong by more than"):
        contact.step(0.0, 0.02)


def test_each_instance_has_its_own_messages_and_leaves_none_that_others_need() -> None:
    """Warnings of springs bent far: of two instances at a time, then through FMPy alone as both are gone."""
    bent = [{"contact.overtravel": overtravel} for overtravel in (3e-3, 4e-3)]
    with Contact(COMPONENT) as first, Contact(COMPONENT) as second:
        for contact, values in zip((first, second), bent, strict=True):
            contact.begin(values)
        for contact, told in ((first, "0.003 m"), (second, "0.004 m")):
            assert len(contact.warnings) == 1
            assert told in contact.warnings[0]
            assert re.search(r"\d % stiffer", contact.warnings[0])
    del first, second, contact
    gc.collect()
    result = simulate_fmu(str(FMU), stop_time=1e-4, start_values=bent[0], output=["contact.force"])
    assert result["contact.force"].min() > 0
