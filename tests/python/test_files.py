"""Files of relays, standards and scenes with one thing wrong: told with its line, or in the result; never dropped."""

import re
from collections.abc import Callable, Iterator
from copy import deepcopy
from io import BytesIO, TextIOWrapper
from pathlib import Path
from threading import Barrier
from typing import Any

import numpy as np
import pandas as pd
import pytest
import tomli_w
from matplotlib.figure import Figure

from component import COMPONENT, ROOT
from relay_contact import RelayContactError, Scene, plot, run, scenes, side_by_side
from relay_contact.command import main
from relay_contact.files import read_toml, write_at_once
from relay_contact.qualification import Relay, Standard, qualify, relays, standards
from relay_contact.qualification import relay as relay_files
from relay_contact.qualification.excitation import BAND, NARROWEST, overall
from relay_contact.qualification.response import respond
from relay_contact.schema import line

READERS: dict[str, Callable[[Path], Any]] = {
    "relay": lambda path: Relay.read(path, COMPONENT),
    "standard": Standard.read,
    "scene": lambda path: Scene.read(path, COMPONENT),
}
SHIPPED = [
    (kind, path)
    for kind, files in (("relay", relays()), ("standard", standards()), ("scene", scenes()))
    for path in files.values()
]
TEXT = ("title", "name", "clause")
NEVER: tuple[Any, ...] = ("0.6 mm", "100 g", [], {}, {"shok": 1.0}, float("nan"), float("inf"), -float("inf"), 10**400)
"""Values that a number never has."""
SOMETIMES = (-1.0, 0, 1e-300, 2**40)


def places(table: Any, *above: Any) -> Iterator[tuple[Any, ...]]:  # noqa: ANN401
    """Give where the entries of a file are, tables and their values."""
    for key in list(table) if isinstance(table, dict) else range(len(table)):
        yield (*above, key)
        if isinstance(table[key], dict | list):
            yield from places(table[key], *above, key)


def wrong(content: dict[str, Any]) -> Iterator[tuple[dict[str, Any], tuple[Any, ...], bool]]:
    """Give the contents of a file with one entry changed each, where, and whether it has to be refused."""
    for place in places(content):
        key, *_ = reversed(place)

        def changed(act: Callable[[Any, Any], object], at: tuple[Any, ...] = place) -> dict[str, Any]:
            copy = deepcopy(content)
            table: Any = copy
            for each in at[:-1]:
                table = table[each]
            act(table, at[-1])
            return copy

        def put(new: Any) -> Callable[[Any, Any], object]:  # noqa: ANN401
            return lambda table, at: table.__setitem__(at, new)

        value: Any = content
        for each in place:
            value = value[each]
        if isinstance(key, str):
            yield changed(lambda table, key: table.__setitem__(f"{key}k", table.pop(key))), place[:-1], True
            yield changed(lambda table, key: table.__setitem__(f"{key}k", table[key])), place[:-1], True
        if isinstance(value, float | int) and not isinstance(value, bool):
            for each in NEVER:
                yield changed(put(each)), place, True
            for each in SOMETIMES:
                yield changed(put(each)), place, False
        elif key not in TEXT:
            # In place of the slope of a density it is a density, which the rms refuses where it counts.
            yield changed(put(3.5)), place, "density" not in place
        if isinstance(value, list) and len(value) > 1 and not isinstance(value[0], str | dict):
            # A response may be in either order.
            yield changed(put(value[::-1])), place, "response" not in place
        if isinstance(value, list) and value and isinstance(value[0], dict):
            yield changed(put([*value, value[0]])), place, True


def written(path: Path, content: dict[str, Any]) -> Path:
    """Write a file; what is not TOML at all is left out."""
    path.write_text(tomli_w.dumps(content), encoding="utf-8")
    return path


@pytest.mark.parametrize(("kind", "shipped"), SHIPPED, ids=lambda each: getattr(each, "stem", each))
def test_every_changed_entry_of_a_file_is_refused_or_in_the_result(
    kind: str, shipped: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Parameters that do not fit together have tests of their own: the component is spared some thousand blows."""
    monkeypatch.setattr(relay_files, "blow", lambda _, values, changed=None: [{**values, **(changed or {})}])
    monkeypatch.setattr(relay_files, "check_held", lambda *_: None)
    content = read_toml(shipped)
    for tests in (each for each in content.values() if isinstance(each, list)):
        # Of many that are alike.
        del tests[1:-1]
    parameters = content.get("parameters", {})
    for table in (content.get("inputs", {}), parameters.get("beam", {}), parameters.get("fixed", {})):
        if "file" in table:
            table["file"] = str(shipped.parent / table["file"])
    read, path = READERS[kind], tmp_path / "file.toml"
    right = read(written(path, content))
    lines = len(path.read_text().splitlines())
    refused = 0
    for changed, place, never in wrong(content):
        written(path, changed)
        try:
            found = read(path)
        except RelayContactError as error:
            for each in str(error).splitlines():
                told = re.match(rf"{re.escape(str(path))}:(\d+): ", each)
                assert told, each
                assert 1 <= int(told[1]) <= lines + 10
            refused += 1
        else:
            assert not never, place
            # Nothing was dropped.
            assert repr(found) != repr(right) or changed == content, place
    assert refused > 20


NESTED = """title = "no [[table]] = 1"  # line 1
parameters.beam.stiffnessDamping = 5e-6

[[position]]
name = '''
two lines'''
[position.parameters]  # line 7
contact.overtravel = 1e-4
[[position]]
name = "b"
parameters = {tip.mass = 1e-5}
[uncertainty]
tip.mass = 0.1
list = [
  1.0,

  [2.0, 3.0]]
last = 1
"""


@pytest.mark.parametrize(
    ("place", "expected"),
    [
        ((), 1),
        (("title",), 1),
        (("parameters", "beam", "stiffnessDamping"), 2),
        (("position", 0), 4),
        (("position", 0, "name"), 5),
        (("position", 0, "parameters"), 7),
        (("position", 0, "parameters", "contact", "overtravel"), 8),
        (("position", 1), 9),
        (("position", 1, "parameters", "tip", "mass"), 11),
        (("uncertainty",), 12),
        (("uncertainty", "list", 1, 0), 14),
        (("uncertainty", "last"), 18),
        # What is missing is told where it should be.
        (("position", 1, "parameters", "tip", "inertia"), 11),
        (("position", 2, "name"), 4),
    ],
)
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_an_entry_of_a_file_is_found_on_its_line(
    tmp_path: Path, place: tuple[str | int, ...], expected: int, end: str
) -> None:
    path = tmp_path / "nested.toml"
    path.write_bytes(NESTED.replace("\n", end).encode())
    assert line(path, place) == expected
    path.write_bytes(b"\xef\xbb\xbf" + 100 * b"# before\n" + NESTED.encode())
    assert line(path, place) == (expected + 100 if place else 1)


PAPER = 'title = "own"\n'
SAMPLE = """[uncertainty]
contact.overtravel = {distribution = "data", values = [2.9e-4, 2.95e-4, 3e-4, 3.05e-4, 3.1e-4]}
"""
HELD = """[pusher]
position = 1e-2
[armature]
mass = 2e-3
stiffness = 300.0
returnForce = 0.5
unbalance = 0.2
holdForce = 40.0
gapConstant = 1.5e-4
restPosition = -3e-4
corePosition = 1e-4
"""


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[[position]]\n[[position]]\nname = 'position 1'\n", '4: position.2.name = "position 1": .*given twice'),
        ("[position]\nname = 'a'\n", "2: position = a table: not allowed, .* under \\[\\[position\\]\\]"),
        ("position = []\n", "2: position = \\[\\]: not allowed, .*at least 1 item"),
        ("[monitor]\nvolts = 6.0\n", "3: monitor.volts: no such entry, .*did you mean voltage"),
        ("[monitor]\nvoltage = 0.0\n", "3: monitor.voltage = 0.0: not allowed, allowed is greater"),
        ("uncertainty.second.gap = 0.1\n", "2: uncertainty.second.gap: not used"),
        ("uncertainty.resistance.hardness = 0.1\n", "2: uncertainty.resistance.hardness: not used"),
        ("parameters.tip.mass = 0.0\nuncertainty.tip.mass = 0.1\n", "3: uncertainty.tip.mass: not used, .*or it is 0"),
        ("uncertainty.tip.mass = -0.1\n", "2: uncertainty.tip.mass = -0.1: not allowed, allowed is a part"),
        ("uncertainty.contact.force = 0.1\n", "2: contact.force: an output, which cannot be set"),
        ("uncertainty.base.acceleration = 0.1\n", "2: base.acceleration: not a parameter"),
        ("uncertainty.effects.heating = 0.1\n", "2: uncertainty.effects.heating: not a parameter of type Real"),
        # At the end of the interval the moving contact has left the range that the component allows.
        ("parameters.contact.overtravel = 9e-3\nuncertainty.contact.overtravel = 0.2\n", "3: contact.overtravel = 0.0"),
        ("parameters.excitation.amplitude = 9.0\n", "2: parameters.excitation.amplitude = 9.0: not allowed, the tests"),
        ("parameters.chatter.minimumDuration = 1.0\n", "2: parameters.chatter.minimumDuration = 1.0: not allowed, the"),
        ("parameters.base.acceleration = 9.0\n", "2: base.acceleration: not a parameter"),
        ("parameters.beam.file = 'none.toml'\n", "2: .*none.toml: cannot be read"),
        # Parameters that are allowed, but not together.
        ("parameters.effects.secondContact = true\nposition = [{parameters.effects.contactLaw = 'Bonded'}]\n",
         "3: effects.contactLaw = Bonded: not allowed with effects.secondContact = true"),
        ("parameters.tip.mass = 1e-5\nparameters.'tip.mass' = 2e-5\n", "3: parameters.tip.mass = 2e-05: .* twice"),
        ("parameters.tip_mass = 1e-5\n", "2: tip_mass: no such variable; did you mean tip.mass"),
        ("uncertainty.tip_mass = 0.1\n", "2: tip_mass: no such variable; did you mean tip.mass"),
        ("uncertainty.tip.mass = 0.1\nuncertainty.'tip.mass' = 0.2\n", "3: uncertainty.tip.mass = 0.2: .* given twice"),
        ("[armature]\nmas = 1e-3\n[pusher]\nposition = 1e-2\n", "3: armature.mas: .*did you mean armature.mass"),
        ("[pusher]\nposition = '10 mm'\n", '3: pusher.position = "10 mm": not allowed, allowed is a finite number'),
        ("[pusher]\nposition = 3e-1\n", "3: pusher.position = 0.3"),
        ("[pusher]\nposition = 1e-2\nforce = 1.0\n", "4: pusher.force: an output, which cannot be set"),
        ("[pusher]\nstiffness = 1e5\n", "2: pusher.position: missing"),
        ("[armature]\nmass = 1e-3\n", "2: pusher: missing"),
        ("[armature]\nmass = 1e-3\n[pusher]\nposition = 1e-2\n", "2: armature.stiffness: missing"),
        ("parameters.armature.mass = 1e-3\n", "2: parameters.armature.mass = .*its place is the table .armature"),
        ("parameters.effects.pusher = 'Armature'\n", "2: parameters.effects.pusher = .*the tables .pusher., .arm"),
        (HELD + "[[position]]\nparameters.effects.pusher = 'None'\n", "14: position.1.*.effects.pusher = .*the"),
        ("[pusher]\nposition = 1e-2\n", "1: position.1.parameters.pusher.displacement: missing, allowed is where"),
        # Of a part that is not in the relay.
        ("parameters.second.gap = 1e-4\n", "2: parameters.second.gap = .*not used without effects.secondContact"),
        ("position = [{parameters.parallel.offset = 1e-5}]\n", "2: position.1.*.parallel.offset = .*not used"),
        ("parameters.fixed.massDamping = 1.0\n", "2: parameters.fixed.massDamping = .*not used without fixed.file"),
        ("parameters.friction.coefficient = 0.4\n", "2: parameters.friction.coefficient = .*friction = Coulomb"),
        ("parameters.contact.stiffness = 1e4\n", "2: parameters.contact.stiffness = .* effects.contactLaw = Rough"),
        ("parameters.beam.axialForce = 0.1\n", "2: parameters.beam.axialForce = .* effects.axialForce = Prescribed"),
        ("position = [{parameters.armature.mass = 1e-3}]\n", "2: position.1.parameters.armature.mass = .* = Armature"),
        ("position = [{parameters.coil.relativeCurrent = 0.0}]\n", "2: position.1.*.coil.relativeC.* not used"),
        (HELD + "[[position]]\nparameters.coil.relativeCurrent = 1.0\nparameters.pusher.displacement = 1e-4\n",
         "15: position.1.parameters.pusher.displacement = .*not used without effects.pusher = Prescribed"),
        ("model = [{parameters.effects.friction = 'Coulomb'}, {parameters.friction.coefficient = 0.4}]\n",
         "2: model.2.parameters.friction.coefficient = .*not used"),
        ("parameters.solver.tolerance = 0.1\n", "2: parameters.solver.tolerance = 0.1: not allowed, the tests"),
        (HELD + "[[position]]\nname = 'on'\n", "13: position.1.parameters.coil.relativeCurrent: missing, allowed is 1"),
        (HELD.replace("40.0", "0.6") + "[[position]]\nparameters.coil.relativeCurrent = 1.0\n",
         "13: coil.relativeCurrent = 1: not allowed, the magnet does not hold the armature, which rests 0.4 mm from"),
        (HELD + "[[position]]\nparameters.coil.relativeCurrent = 1.0\n[uncertainty]\narmature.holdForc = 0.1\n",
         "16: armature.holdForc: no such variable; did you mean armature.holdForce"),
        ("parameters.environment.gravity = 9.8\naxes.lateral = [1.0]\n", "3: axes.lateral = .*gravity would act"),
        ("[pusher]\nposition = 1e-2\ndisplacement = 0.0\n[axes]\nlateral = [1.0]\n", "6: axes.lateral = .*other parts"),
        ("[uncertainty]\nfixed.spring.thickness = 0.1\n", "3: uncertainty.fixed.spring.thickness: no such entry in"),
        ("uncertainty.tip.mass = {distribution = 'uniform'}", "2: uncertainty.tip.mass = .*a uniform .* has part"),
        ("uncertainty.tip.mass = {distribution = 'normal', part = 2.0}", "2: .*part: allowed is less than 1"),
        ("uncertainty.tip.mass = {distribution = 'gauss', part = 0.1}", "2: .*distribution: allowed is 'normal'"),
        ("uncertainty.tip.mass = {distribution = 'triangular', low = 0.1, mode = 0.0, high = 0.1}", "2: .*to rise"),
        ("parameters.contact.overtravel = -3e-4\n" + SAMPLE, "4: uncertainty.*: .*, position 1 has -0.0003"),
        (SAMPLE.replace("2.9", "-2.9"), "3: uncertainty.contact.overtravel: values of -0.000295 to 0.00031: .*"),
        ("position = [{parameters.contact.overtravel = 3e-4}, {name = 'B'}]\n" + SAMPLE,
         "4: uncertainty.contact.overtravel: values of 0.00029 to 0.00031: not allowed, B has 0.0002"),
        ("model = [{}, {parameters.contact.overtravel = 2e-4}]\nparameters.contact.overtravel = 3e-4\n" + SAMPLE,
         "5: uncertainty.contact.overtravel: values of 0.00029 to 0.00031: .*, position 1 by model 2 has 0.0002"),
        ("uncertainty.tip.mass = 0.1\n[correlation]\nnames = ['tip.mas']\nmatrix = [[1.0]]", "4: correlation.names.1"),
        ("[correlation]\nnames = ['a', 'b']\nmatrix = [[1.0, 2.0], [2.0, 1.0]]", "4: correlation.matrix.1.2 = 2.0"),
        ("[correlation]\nnames = ['a', 'b']\nmatrix = [[1.0, 0.5], [0.4, 1.0]]", "2: correlation = .*symmetrical"),
        ("[correlation]\nnames = ['a', 'b', 'c']\nmatrix = [[1.0, 0.9, -0.9], [0.9, 1.0, 0.9], [-0.9, 0.9, 1.0]]",
         "2: correlation = .*negative eigenvalue"),
        ("a = 1\na = 2\n", "3: not TOML: "),
        ("a = [1,\n", "3: not TOML: "),
        ("a = 0,3e-3\n", "2: not TOML: .*; decimals have a point"),
        ("a = " + 5000 * "[", " not TOML: nested too deeply"),
        ("a = '\udcff'\n", "2: not TOML: not text in UTF-8"),
    ],
)  # fmt: skip
def test_errors_in_a_relay_file_have_their_line(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "relay.toml"
    path.write_bytes((PAPER + text).encode(errors="surrogateescape"))
    with pytest.raises(RelayContactError, match=f"^{re.escape(str(path))}:{message}"):
        Relay.read(path, COMPONENT)


def test_what_is_uncertain_of_a_second_contact_is_used(tmp_path: Path) -> None:
    """The blow that tells what is used reaches it over a gap of 0.3 mm, and over 1 mm by a stiffer spring."""
    path, names = tmp_path / "relay.toml", ["second.gap", "second.curvatureRadius", "second.damping"]
    uncertain = "".join(f"uncertainty.{name} = 0.1\n" for name in names)
    for spring in ("", "parameters.second.gap = 1e-3\nparameters.beam.length = 7e-3\n"):
        path.write_text(f"parameters.effects.secondContact = true\n{spring}{uncertain}")
        assert list(Relay.read(path, COMPONENT).uncertainty) == names


def test_what_is_uncertain_of_one_model_alone_is_used(tmp_path: Path) -> None:
    path = tmp_path / "relay.toml"
    rough = "{parameters.effects.contactLaw = 'Rough', parameters.contact.stiffness = 3.8e4}"
    path.write_text(f"uncertainty.contact.stiffness = 0.1\nmodel = [{{}}, {rough}]\n")
    assert list(Relay.read(path, COMPONENT).uncertainty) == ["contact.stiffness"]


def test_a_relay_names_its_spring_where_the_component_carries_another(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    start = COMPONENT.start
    monkeypatch.setattr(COMPONENT, "start", lambda name: "own.toml" if name == "beam.file" else start(name))
    path = tmp_path / "relay.toml"
    path.write_text(PAPER)
    with pytest.raises(RelayContactError, match=r": parameters\.beam\.file: missing; the component carries a spring"):
        Relay.read(path, COMPONENT)
    path.write_text(f"{PAPER}parameters.beam.file = '{ROOT}/scenes/springs/tapered-cube.toml'\n")
    Relay.read(path, COMPONENT)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("[[shock]]", "[[shok]]", "18: shok: no such entry, .*did you mean shock"),
        (
            "opening = 10e-6",
            "opening = 10",
            "5: contacts.opening = 10: not allowed, allowed is less than or equal to 0.1",
        ),
        ("opening = 10e-6", "opening = 7e-3", "21: shock.1.duration = 0.006: not allowed, .*longest opening"),
        ("acceleration = 50.98581", "acceleration = '100 g'", '20: shock.1.acceleration = "100 g": not allowed'),
        ("rms = 2.83", "evidence = 'read'\nrms = 2.83", "14: random.1.evidence = \"read\": not allowed, .*'measured'"),
        ("rms = 2.83", "rms = 27.8", "14: random.1.rms = 27.8: not allowed, the density has 2.8.. g rms"),
        ("[10.0, 0.20797], [55.0", "[55.0, 0.20797], [10.0", "13: random.1.density = .*frequencies have to rise"),
        ("[10.0, 0.20797]", "[10.0, 0.0]", "13: random.1.density.1.2 = 0.0: not allowed, allowed is greater than 0"),
        ("[10.0, 0.20797]", "[0.0, 0.20797]", "13: random.1.density.1.1 = 0.0: not allowed, allowed is greater"),
        ("duration = 28800.0", "duration = 0.5", "15: random.1.duration = 0.5: .*10 periods of the lowest frequency"),
        ('name = "shock on the body"', 'name = "random, test IV"', "19: shock.1.name = .* given twice"),
    ],
)
def test_errors_in_a_standard_have_their_line(tmp_path: Path, old: str, new: str, message: str) -> None:
    path, text = tmp_path / "standard.toml", standards()["ISO-16750-3"].read_text()
    assert text.count(old) == 1
    path.write_text(text.replace(old, new))
    with pytest.raises(RelayContactError, match=f"(?m)^{re.escape(str(path))}:{message}"):
        Standard.read(path)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        # The published preload of 0.152 N by the power law: 7.4118e-3 Ohm / 0.152^0.9515 = 44 mOhm.
        ("[monitor]\nvoltage = 1e-3\ncurrent = 0.1\n",
         r"a monitor of .* from 0.01 Ohm on: not allowed, the contact has 0.0445 Ohm at rest"),
        ("[monitor]\nvoltage = 10.0\ncurrent = 1e-8\n",
         r"a monitor of .* from 1e\+09 Ohm on: not allowed, the contact has 1e\+09 Ohm while it is open"),
        ("[parameters]\neffects.parallelContact = true\nparallel.offset = -1e-3\n",
         r"parallel.offset = -0.001 m: .* exchange both"),
        # By one of its models alone.
        ("model = [{}, {parameters.resistance.open = 50.0}]\n",
         r"a monitor of .* from 600 Ohm on: not allowed, the contact has 50 Ohm while it is open"),
    ],
)  # fmt: skip
def test_a_relay_whose_contact_is_not_seen_to_open_is_refused(tmp_path: Path, text: str, message: str) -> None:
    """By its monitor, or as the first of twin contacts bears no force."""
    relay = tmp_path / "relay.toml"
    relay.write_text(text)
    with pytest.raises(RelayContactError, match=f"position 1( by model 2)?: {message}"):
        qualify(relay, "MIL-STD-202", out=tmp_path, tests=["213 A"], component=COMPONENT)


@pytest.mark.parametrize("frequencies", ["[500.0, 10.0]", "[100.0, 100.5]", "[0.0, 500.0]", "[10.0, 2e4]", "[10.0]"])
def test_bands_that_the_response_does_not_resolve(tmp_path: Path, frequencies: str) -> None:
    path, text = tmp_path / "standard.toml", standards()["IEC-60068-2"].read_text()
    path.write_text(text.replace("[10.0, 500.0]", frequencies))
    with pytest.raises(RelayContactError, match=r"standard.toml:16: sine.1.frequencies"):
        Standard.read(path)
    known = respond(COMPONENT, {}, 600.0).frequency
    # The widest band that is allowed is known, and the narrowest holds two lines.
    assert known[1] < BAND[0]
    assert known[-1] > BAND[1] - known[1]
    assert 2 * known[1] < NARROWEST


def test_rms_of_a_density_in_closed_form() -> None:
    corners = ((20.0, 0.01), (80.0, 0.04), (350.0, 0.04), (2000.0, 0.007), (4000.0, 0.0035))
    frequency = np.linspace(20, 4000, 1_000_000)
    lines = np.exp(np.interp(np.log(frequency), *np.log(np.transpose(corners))))
    assert overall(corners) == pytest.approx(np.trapezoid(lines, frequency) ** 0.5, rel=1e-6)
    # NAVMAT P-9492 prints 6.06 g.
    assert overall(corners[:4]) == pytest.approx(6.06, abs=0.05)


def scene_beside_a_table(folder: Path) -> Path:
    """Write a table of inputs into a folder beside a scene, whose path is returned."""
    (folder / "moved").mkdir()
    (folder / "moved/in.csv").write_text("time,support.displacement\n0,0\n1e-3,1e-6\n")
    return folder / "scene.toml"


SCENE = 'title = "own"\nstop = 1e-3\ncommunicationStep = 1e-5\noutputs = ["contact.force"]\n'


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            SCENE + "[inputs]\nsupport.displacement = 0.0\nfile = 'moved/in.csv'\n",
            "6: inputs.support.displacement = 0.0",
        ),
        (SCENE + "[inputs]\nfile = 3\n", "6: inputs.file = 3: not allowed"),
        (SCENE + "[inputs]\nfile = 'none.csv'\n", '6: inputs.file = "none.csv": not allowed, no such file beside this'),
        (SCENE + "[inputs]\ntip.mass = 1e-5\n", "6: tip.mass: not an input"),
        (SCENE + "[parameters]\nbase.acceleration = 9.0\n", "6: base.acceleration: not a parameter"),
        (SCENE + "[parameters]\nbeam.length = '15 mm'\n", '6: beam.length = "15 mm": not allowed'),
        (SCENE.replace("force", "farce"), "4: contact.farce: no such variable; did you mean contact.force"),
        (SCENE.replace("stop = 1e-3", "stop = 0"), "2: stop = 0: not allowed, allowed is greater than 0"),
        (SCENE.replace("stop = 1e-3\n", ""), "1: stop: missing"),
    ],
)
def test_errors_in_a_scene_have_their_line(tmp_path: Path, text: str, message: str) -> None:
    path = scene_beside_a_table(tmp_path)
    path.write_text(text)
    with pytest.raises(RelayContactError, match=f"^{re.escape(str(path))}:{message}"):
        run(path, component=COMPONENT)


def test_a_link_to_a_scene_has_table_and_spring_beside_the_link(tmp_path: Path) -> None:
    (tmp_path / "kept").mkdir()
    (tmp_path / "kept" / "scene").write_text(
        "stop = 1e-3\ncommunicationStep = 1e-4\noutputs = ['contact.force']\n"
        "parameters.beam.file = 'spring.toml'\ninputs.file = 'course.csv'\n"
    )
    (tmp_path / "scene.toml").symlink_to(tmp_path / "kept" / "scene")
    (tmp_path / "spring.toml").write_bytes((ROOT / "scenes/springs/tapered-cube.toml").read_bytes())
    (tmp_path / "course.csv").write_text("time,contact.current\n0,0\n1,1\n")
    assert Scene.read(tmp_path / "scene.toml", COMPONENT).values["beam.file"] == str(tmp_path / "spring.toml")


def test_a_table_in_a_folder_beside_the_scene_and_a_change_of_its_input(tmp_path: Path) -> None:
    path = scene_beside_a_table(tmp_path)
    path.write_text(SCENE + "[inputs]\nfile = 'moved/in.csv'\n")
    moved = run(path, component=COMPONENT)["contact.force"]
    path.write_text(SCENE)
    held = run(path, component=COMPONENT)["contact.force"]
    assert moved[-1] > held[-1]
    path.write_text(SCENE + "[inputs]\nfile = 'moved/in.csv'\n")
    # As in Rust: an input that is set is held.
    changes: Any = {"support.displacement": 0.0}
    assert np.array_equal(run(path, component=COMPONENT, **changes)["contact.force"], held)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"stop": 0.0}, "stop = 0.0 s: not allowed"),
        ({"stop": -1.0}, "stop = -1.0 s: not allowed"),
        ({"step": float("nan")}, "communication step = nan s: not allowed"),
        ({"stop": 1e9}, "stop = 1e.09 s with steps of 1e-05 s: not allowed"),
        ({"inputs": {"base.acceleration": [0.0]}}, '"time" is missing'),
        ({"inputs": {"time": [0.0, 2.0, 1.0], "base.acceleration": 3 * [0.0]}}, "time = 1 s after 2 s: .*have to rise"),
        ({"inputs": {"time": [0.0, 0.0], "base.acceleration": 2 * [0.0]}}, "time = 0 s after 0 s: .*have to rise"),
        ({"inputs": {"time": [0.0, 1.0], "base.acceleration": [0.0]}}, "base.acceleration: .* as many as times"),
        ({"inputs": {"time": [0.0], "base.acceleration": [float("nan")]}}, "base.acceleration: .*finite"),
        ({"inputs": {"time": [0.0], "base.acceleration": np.ma.masked_equal([9.0], 9.0)}}, "acceleration: .*finite"),
        ({"inputs": {"time": [], "base.acceleration": []}}, "finite numbers"),
        ({"inputs": {"time": ["a"], "base.acceleration": [0.0]}}, "time: not allowed, allowed are numbers"),
        ({"inputs": {"time": pd.to_timedelta([0], "s"), "base.acceleration": [0.0]}}, "time: .* allowed are numbers"),
        ({"inputs": {"time": [0.0], "base.acceleration": [1j]}}, "base.acceleration: not allowed, allowed are numbers"),
        ({"inputs": {"time": [0.0], "tip.mass": [1e-5]}}, "tip.mass: not an input"),
        ({"inputs": {"time": [9.0, 9.1], "base.acceleration": 2 * [0.0]}}, "time = 9 to 9.1 s: not allowed, .* 0 to 0"),
        ({"inputs": {"time": [-2.0, -1.0], "base.acceleration": 2 * [0.0]}}, "time = -2 to -1 s: not allowed"),
        ({"inputs": {"time": [0.0, 9e-6, 1.0], "base.acceleration": 3 * [0.0]}}, "step = 1e-05 s: .* at most 9e-06 s"),
        ({"inputs": {"time": [0.0], "base.acceleration": [0.0]}, "base.acceleration": 1.0}, "given twice"),
        ({"beam.length": 0.015, "beam_length": 0.016}, "^beam.length: given twice"),
        ({"inputs": {"time": [0.0], "base.acceleration": [0.0], "base_acceleration": [1.0]}}, "tion: given twice"),
        ({"spring.thickness": "thick"}, "no such variable"),
        ({"excitation.amplitud": 1.0}, "no such variable; did you mean excitation.amplitude"),
        ({"contact.force": 1.0}, "an output, which cannot be set"),
        ({"effects.contactLaw": "Bound"}, "allowed is Hertz, Linearised, Bonded, Rough; did you mean Bonded"),
        ({"beam.length": "long"}, "allowed is a finite number"),
        ({"beam.length": True}, "beam.length = True: not allowed, allowed is a finite number"),
        ({"solver.modes": 2.5}, "solver.modes = 2.5: not allowed, allowed is a whole number"),
        ({"effects.excitation": float("nan")}, "allowed is None, Sine"),
        ({"beam.file": 3.0}, "beam.file = 3.0: not allowed, allowed is a text"),
        ({"beam.length": -1.0}, "beam.length = -1 m: not allowed, allowed is 0.001 to 0.2"),
        ({"effects.heating": "on"}, "allowed is true, false"),
    ],
)
def test_arguments_of_a_run_that_do_not_fit_are_refused(given: Any, message: str) -> None:  # noqa: ANN401
    with pytest.raises(RelayContactError, match=message):
        run("paper-1khz", component=COMPONENT, **given)


def test_threads_write_one_file_at_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As two assessments in one folder do."""
    write, both = Path.write_text, Barrier(2, timeout=10)

    def together(path: Path, text: str, encoding: str) -> int:
        count = write(path, text, encoding)
        both.wait()
        return count

    monkeypatch.setattr(Path, "write_text", together)
    side_by_side(lambda _: write_at_once(tmp_path / "finding.json", "found"), range(2), 2)
    assert [each.read_text() for each in tmp_path.iterdir()] == ["found"]


@pytest.mark.parametrize(
    ("owner", "function", "write"),
    [(Path, "write_text", lambda path: write_at_once(path, "all of it")),
     (np, "savetxt", lambda path: run("at-rest", component=COMPONENT).write(path))],
)  # fmt: skip
def test_a_disk_that_is_full_leaves_nothing_and_names_the_file(
    owner: object, function: str, write: Callable[[Path], object], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(path: Path, *_: object, **__: object) -> None:
        Path(path).write_bytes(b"time,contact.fo")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(owner, function, full)
    with pytest.raises(OSError, match=r"No space left on device: .*found.csv"):
        write(tmp_path / "found.csv")
    assert not list(tmp_path.iterdir())
    # Where nothing is written there is nothing to delete either.
    with pytest.raises(OSError, match=r"aaa\.csv'$"):
        write(tmp_path / f"{240 * 'a'}.csv")


def test_what_was_read_is_not_written_over(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A scene beside a table of its name; a relay's file in the folder that is written; a log as the comparison."""
    scene, course = tmp_path / "road.toml", tmp_path / "road.csv"
    scene.write_text(SCENE + "[inputs]\nfile = 'road.csv'\n")
    course.write_text("time [s],base.acceleration [g]\n0,1\n1,2\n")
    relay, log = tmp_path / "relay.toml", tmp_path / "comparison.csv"
    relay.write_text("")
    log.write_text("start,duration\n")
    before = [path.read_text() for path in sorted(tmp_path.iterdir())]
    for command, read in (
        (["run", str(scene)], course),
        (["identify", str(relay), "--data", str(course)], relay),
        (["compare", str(course), str(log)], log),
    ):
        assert main([*command, "--out", str(tmp_path)]) == 1
        assert f"{read}: is read: not allowed, allowed is another folder" in capsys.readouterr().err
    assert [path.read_text() for path in sorted(tmp_path.iterdir())] == before


def test_a_run_that_is_interrupted_says_so(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("relay_contact.command.list_all", interrupted)
    assert main(["list"]) == 130
    assert capsys.readouterr().err == "\nrelay-contact: interrupted\n"


def test_signs_that_an_output_does_not_have_end_no_command(monkeypatch: pytest.MonkeyPatch) -> None:
    """As on Windows, where what is printed goes to a file in the encoding of the country."""
    printed = TextIOWrapper(BytesIO(), "cp1252")
    monkeypatch.setattr("sys.stdout", printed)
    assert main(["list", "--variables", "contact.resistance"]) == 0
    printed.flush()
    assert b"contact.resistance (output \\u03a9)" in printed.buffer.getvalue()


def test_a_choice_in_a_file_has_its_name_if_it_is_given_by_its_number(tmp_path: Path) -> None:
    path = tmp_path / "relay.toml"
    number = COMPONENT.choices("effects.contactLaw")["Rough"]
    path.write_text(f"parameters.effects.contactLaw = {number}\n")
    assert Relay.read(path, COMPONENT).positions == {"position 1": {"effects.contactLaw": "Rough"}}


def test_a_scene_made_in_python_is_changed_in_either_spelling() -> None:
    table: Any = {"time": [0.0, 1e-3], "base_acceleration": [0.0, 300.0]}
    values: dict[str, Any] = {"contact_overtravel": 1e-4, "base_acceleration": 9.0}
    scene = Scene("", 1e-4, 1e-5, ["contact.force"], values, table)
    changes: list[dict[str, Any]] = [{"contact.overtravel": 3e-4}, {"contact_overtravel": 3e-4}]
    dotted, other = (run(scene, component=COMPONENT, **each)["contact.force"] for each in changes)
    assert np.array_equal(dotted, other)
    assert dotted[0] == pytest.approx(3 * run(scene, component=COMPONENT)["contact.force"][0], rel=1e-2)


SPRING = (ROOT / "scenes/springs/tapered-cube.toml").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("spring", "given", "message"),
    [
        (SPRING, {"contact.overtravel": 1e-4, "contact_overtravel": 3e-4}, r"^contact.overtravel: given twice"),
        *(
            (SPRING, {"spring.thickness": factor}, r"spring.thickness = .*a factor greater than 0")
            for factor in ("thick", 0.0, -1.0, float("nan"))
        ),
        ("segment = 3\n", {"spring.thickness": 1.1}, r"spring.toml:1: segment"),
        ("[[segment]]\nlength = 'a'\n", {"spring.thickness": 1.1}, r"spring.toml:2: segment 1: length"),
        ("[", {"spring.thickness": 1.1}, "TOML"),
    ],
)
def test_an_instance_of_wrong_values_does_not_begin(tmp_path: Path, spring: str, given: Any, message: str) -> None:  # noqa: ANN401
    path = tmp_path / "spring.toml"
    path.write_text(spring, encoding="utf-8")
    with pytest.raises(RelayContactError, match=message):
        COMPONENT.started({"beam.file": str(path), **given})


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--stop", "-1"], "argument --stop: -1: not allowed, allowed is a number greater than 0"),
        (["--step", "0"], "argument --step: 0: not allowed, allowed is a number greater than 0"),
        (["--step", "nan"], "argument --step: nan: not allowed, allowed is a finite number"),
        (["--stop", "1 ms"], "argument --stop: 1 ms: not allowed, allowed is a finite number"),
        (["--set", "solver.modes=inf"], "relay-contact: solver.modes = inf: not allowed, allowed is a whole number"),
        (["--set", "solver.modes=3000000000"], "relay-contact: solver.modes = 3000000000.0: not allowed"),
        (
            ["--set", "tip.mass=0", "--set", "tip_mass=1e-5"],
            "relay-contact: --set tip_mass=1e-5: tip.mass is given twice",
        ),
        (["--set", "beam.lenght=1"], "relay-contact: beam.lenght: no such variable; did you mean beam.length?\n"),
        (["--set", "beam.file=none.toml"], f"relay-contact: {Path('none.toml').resolve()}: cannot be read"),
        (["--output", "beam.file"], "relay-contact: beam.file: a text, which is no output"),
        (["--out", "/dev/null/x"], "relay-contact: /dev/null/x: Not a directory"),
        (["--set", "beam.length=nan"], "relay-contact: beam.length = nan: not allowed, allowed is a finite number"),
    ],
)
def test_arguments_of_the_command_that_do_not_fit_are_refused(
    arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    try:
        code = main(["run", "paper-1khz", *arguments])
    except SystemExit as end:
        code = int(str(end.code))
    assert code in (1, 2)
    assert message in capsys.readouterr().err


@pytest.mark.filterwarnings("ignore:loadtxt")
def test_what_cannot_be_drawn_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table, head = tmp_path / "table.csv", "time,contact.force\n"
    for text in (head, f"{head}0,x\n", "\udcff\n"):
        table.write_bytes(text.encode(errors="surrogateescape"))
        assert main(["plot", str(table)]) == 1
        assert "table.csv: not a table as `relay-contact run`" in capsys.readouterr().err
    for text in ("", "time\n1\n", "s,contact.force\n0,1\n"):
        table.write_text(text)
        assert main(["plot", str(table)]) == 1
        assert "allowed is time and one or more outputs" in capsys.readouterr().err


def test_a_table_is_drawn_over_time_and_over_the_frequency_of_a_sweep(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn: list[Figure] = []

    def savefig(figure: Figure, path: Path, **_: object) -> None:
        path.touch()
        drawn.append(figure)

    monkeypatch.setattr(Figure, "savefig", savefig)
    table = tmp_path / "table.csv"
    # As a table calculation saves it.
    text = "time,contact.force\n0,1\n0.5,0.2\n0.7,0\n0.8,0\n0.9,0.3\n1,0.3\n"
    table.write_text(text, encoding="utf-8-sig")
    for sweep in (None, (10.0, 1000.0, 0.5, 0.4)):
        plot.draw(table, "title", sweep)
    with pytest.raises(RelayContactError, match=r"table.csv: no row from 5 to 6 s, in the time of the sweep"):
        plot.draw(table, "title", (10.0, 100.0, 5.0, 1.0))
    over_time, over_frequency = (figure.axes[0].lines[0].get_xydata() for figure in drawn)
    assert over_time == pytest.approx(np.array([[0, 100], [0.5, 20], [0.7, 0], [0.8, 0], [0.9, 30], [1, 30]]))
    # Logarithmic: in the middle of the duration the root of both.
    assert over_frequency == pytest.approx(np.array([[10, 20], [100, 0], [10**2.5, 0], [1000, 30]]))
    # Shaded where it is open.
    (shade,) = drawn[0].axes[0].collections
    assert np.unique(np.array(shade.get_paths()[0].vertices)[:, 0]) == pytest.approx([0.7, 0.8])


def test_what_takes_long_shows_progress(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    arguments = ["run", "at-rest", "--out", str(tmp_path), "--stop", "0.1"]
    monkeypatch.setattr("relay_contact.scene.PATIENCE", 1e6)
    assert main(arguments) == 0
    assert not capsys.readouterr().err
    monkeypatch.setattr("relay_contact.scene.PATIENCE", 1e-3)
    assert main(arguments) == 0
    assert re.search(r"simulated +\d+ %", capsys.readouterr().err)
