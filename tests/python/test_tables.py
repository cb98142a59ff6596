"""Tables as measuring programs export them: for `identify`, and as inputs of a scene."""

from pathlib import Path

import numpy as np
import pytest

from component import COMPONENT
from relay_contact import RelayContactError, Scene, comparison, run, run_many, scenes
from relay_contact.figures import GRAVITY
from relay_contact.identification.measurement import COLUMNS
from relay_contact.identification.measurement import read as read_measurement
from relay_contact.scene import INPUTS, input_table
from relay_contact.tables import read

pytestmark = pytest.mark.filterwarnings("error::RuntimeWarning")
TRAVEL, FORCE = np.array([-50e-6, 0.0, 50e-6, 100e-6, 150e-6]), np.array([0.131, 0.142, 0.1515, 0.16, 0.17])
PLAIN = "-50,13.1\n0,14.2\n50,15.15\n100,16\n150,17\n"


def by_semicolons(text: str) -> str:
    return text.replace(",", ";").replace(".", ",")


HEAD, ROWS = "travel [mm],force [cN]\n", "0,1\n1,2\n2,3\n3,4\n"
EXPORTS = {
    "plain": "travel [um],force [cN]\n" + PLAIN,
    "capitals and parentheses": "Travel (um),FORCE (cN)\n" + PLAIN,
    "units in words": "travel in um,Force / cN\n" + PLAIN,
    "grams-force": "travel [um],force [gf]\n"
    + "".join(f"{travel},{float(force) / 0.980665!r}\n" for travel, force in (row.split(",") for row in PLAIN.split())),
    "micro sign": "travel [\N{MICRO SIGN}m],force [cN]\n" + PLAIN,
    "Greek mu": "travel [\N{GREEK SMALL LETTER MU}m],force [cN]\n" + PLAIN,
    "quotients": "travel / (um),force / (cN)\n" + PLAIN,
    "row of units": "Travel,Force\n\N{MICRO SIGN}m,cN\n" + PLAIN,
    "row of units in brackets": "Travel,Force\n[um],[cN]\n" + PLAIN,
    "preamble": "Tester X;rev. 3\nOperator: A. B., travel and force\n\nDate;23.11.2026\n\nTravel [um];Force [cN]\n"
    + by_semicolons(PLAIN),
    "decimal commas": "travel [um];force [cN]\n" + by_semicolons(PLAIN),
    "decimal commas, quoted": 'travel [um],force [cN]\n-50,"13,1"\n0,"14,2"\n50,"15,15"\n100,"16,0"\n150,"17,0"\n',
    "tabs": "travel [um]\tforce [cN]\n" + PLAIN.replace(",", "\t"),
    "tabs and decimal commas": "travel [um]\tforce [cN]\n" + PLAIN.replace(",", "\t").replace(".", ","),
    "further columns": "No.,Time,Travel [um],Temperature [\N{DEGREE SIGN}C],Force [cN],Remark\n"
    + "".join(f"{n},12:00:0{n},{row.split(',')[0]},23.5,{row.split(',')[1]},\n" for n, row in enumerate(PLAIN.split())),
    "separators at the ends": "travel [um];force [cN];;\n" + by_semicolons(PLAIN).replace("\n", ";;\n"),
    "empty lines": "\n\ntravel [um],force [cN]\n\n" + PLAIN.replace("\n", "\n\n"),
    "names in a remark": "# travel [um],force [cN]\n" + PLAIN,
    "exponents": "travel [m],force [N]\n-5E-05,1.31e-1\n0,+.142\n5e-5,0.1515\n1e-4,.16\n1.5e-4,1.7E-01\n",
}


def test_units_are_those_of_their_prefixes() -> None:
    prefixes = {"k": 1e3, "c": 1e-2, "m": 1e-3, "u": 1e-6, "n": 1e-9}
    others = {"g": 9.80665, "gf": 9.80665e-3, "%": 1e-2}
    columns = [*COLUMNS.values(), *INPUTS.values(), *comparison.COLUMNS.values()]
    for name, factor in {pair for units in columns for pair in units.items()}:
        prefixed = any(name[1:] in units for units in columns)
        assert factor == pytest.approx(prefixes[name[0]] if prefixed else others.get(name, 1.0), rel=1e-15), name


@pytest.mark.parametrize("name", EXPORTS)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "cp1252", "utf-16", "utf-16-le", "utf-16-be"])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_exports_are_read_as_they_are(tmp_path: Path, name: str, encoding: str, end: str) -> None:
    if encoding == "cp1252" and name == "Greek mu":
        pytest.skip("Latin-1 has no Greek mu")
    path = tmp_path / "export.csv"
    path.write_bytes(EXPORTS[name].replace("\n", end).encode(encoding))
    measured = read_measurement(path, COMPONENT, ["a"])
    assert measured.kind == "static force"
    np.testing.assert_allclose(measured.over, TRAVEL, rtol=1e-14, atol=1e-20)
    np.testing.assert_allclose(measured.values, FORCE, rtol=1e-14)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("travel [um],force [lbf]\n" + PLAIN, r":1: column force: unit lbf: not allowed, allowed is N, cN, mN, gf"),
        ("travel,force\num,lb\n" + PLAIN, ":1: column force: unit lb: not allowed"),
        ("travel,forc [cN]\n" + PLAIN, ":1: column forc: unknown; did you mean force"),
        ("travel [um],force [cN]\n" + PLAIN.replace("15.15", "15,15"), ":4: 3 values: .* need semicolons or tabs"),
        ("travel [um];force [cN]\n1;1.000,5\n", ":2: column force: 1.000,5: not allowed, allowed is a number"),
        ("travel [um];force [cN]\n" + by_semicolons(PLAIN) + "end of data\n", ":7: 1 values: not allowed"),
        ("travel [um],force [cN],force [N]\n", ":1: column force: there twice"),
        ("travel [um],force [cN]\nmm,cN\n" + PLAIN, ":2: column travel: unit mm: not allowed, allowed is um"),
        ("time,displacement,velocity\n0,1,1\n", "columns displacement and velocity: not allowed, allowed is one"),
        ("force 12\nno table\n", "csv: no line with the names of the columns"),
        ("travel,level\n", ":1: columns travel, level: no measurement that is known; there are static force: travel"),
        (HEAD + "0,1\n1,x\n", ":3: column force: x: not allowed, allowed is a number"),
        (HEAD + "0,1\n1_0,2\n", ":3: column travel: 1_0: not allowed, allowed is a number"),
        (HEAD + "0,1\n1,nan\n", ":3: column force: nan cN: not allowed, allowed is a finite number"),
        (HEAD + "0,1\n1\n", ":3: 1 values: not allowed, allowed is 2, one in each column"),
        (HEAD + ROWS, ":5: 4 rows: not allowed, allowed is 5 or more for a static force"),
        ("frequency,level\n-3,1\n", ":2: column frequency: -3 Hz: not allowed, allowed is more than 0 Hz"),
        ("time,displacement\n0,1\n0,2\n", ":3: column time: 0 s: not allowed, allowed is more than in the row before"),
        ("# positon = a\n" + HEAD + ROWS + "4,5\n", ":1: positon: unknown; did you mean position"),
        ("# CALIBRATION = 0.01\n" + HEAD + ROWS + "4,5\n", ":1: CALIBRATION: unknown; did you mean calibration"),
        (HEAD + ROWS + "# tip.mass = 1e-5\n4,5\n# tip.mass = 2e-5\n", ":8: tip.mass = 2e-5: there twice"),
        ("# calibration = 0.1\n# calibration = 0\n" + HEAD + ROWS + "4,5\n", ":2: calibration = 0: there twice"),
        ("# CONTACT = open\n" + HEAD + ROWS + "4,5\n", ":1: CONTACT: unknown; did you mean contact"),
        ("# position = b\n" + HEAD + ROWS + "4,5\n", ":1: position = b: not allowed, allowed is a"),
        ("# calibration = 2 %\n" + HEAD + ROWS + "4,5\n", ":1: calibration = 2 %: not allowed, allowed is 0 to 1"),
        ("calibration = 2 %\n" + HEAD + ROWS + "4,5\n", ":1: calibration = 2 %: not allowed, allowed is 0 to 1"),
        ("# calibration = 2\n" + HEAD + ROWS + "4,5\n", ":1: calibration = 2: not allowed, allowed is 0 to 1"),
        ("# calibration: 0.05\n" + HEAD + ROWS + "4,5\n", ":1: calibration: 0.05: not allowed, allowed is calibration"),
        ("# contact = open\n" + HEAD + ROWS + "4,5\n", ":1: contact = open: not allowed, allowed is closed for a"),
        (HEAD + ROWS + "# Contact: open\n4,5\n", ":6: Contact: open: not allowed, allowed is contact = open"),
        ("# tip.mass: 2 = x\n" + HEAD + ROWS + "4,5\n", ":1: tip.mass: 2 = x: not allowed, allowed is tip.mass = 2"),
        ("# tip.mas = 1\n" + HEAD + ROWS + "4,5\n", ":1: tip.mas: no such variable; did you mean tip.mass"),
        ("", "csv: no line with the names of the columns"),
    ],
)
def test_errors_in_an_export_have_line_and_column(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "export.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(RelayContactError, match=message):
        read_measurement(path, COMPONENT, ["a"])


def test_any_bytes_are_read_or_refused(tmp_path: Path) -> None:
    """Chance bytes, and an export with some of its bytes changed: a table, or an error that names the file."""
    chance = np.random.default_rng(1)
    path = tmp_path / "export.csv"
    good = EXPORTS["preamble"].encode()
    for number in range(300):
        data = bytearray(good if number % 3 else chance.bytes(200))
        for place in chance.integers(0, len(data), 3):
            data[place] = int(chance.integers(0, 256))
        path.write_bytes(data)
        message, values = str(path), np.zeros(0)
        try:
            table = read(path, COLUMNS)
            values = table["force"] if "force" in table.places else values
        except RelayContactError as error:
            message = str(error)
        assert str(path) in message
        assert np.isfinite(values).all()


SCENE = """stop = 2e-3
communicationStep = 1e-5
outputs = ["contact.force"]
inputs.file = "measured.csv"
"""


@pytest.mark.parametrize(
    "text",
    ["Time [ms],coil.relativeCurrent [%]\n0,0\n1,90\n", "time;COIL.RELATIVECURRENT\nms;1\n0;0\n1;0,9\n"],
)
def test_the_current_of_a_coil_is_read_with_its_unit(tmp_path: Path, text: str) -> None:
    path = tmp_path / "coil.csv"
    path.write_text(text, encoding="utf-8")
    table = {name: column.tolist() for name, column in input_table(path).items()}
    assert table == {"time": [0.0, 1e-3], "coil.relativeCurrent": [0.0, pytest.approx(0.9, rel=1e-15)]}


def test_a_scene_takes_ones_own_measured_acceleration(tmp_path: Path) -> None:
    time, level = 1e-3 * np.array([0.0, 0.5, 1.0, 1.5]), np.array([0.0, 10.0, -10.0, 0.0])
    scene, table = tmp_path / "scene.toml", tmp_path / "measured.csv"
    scene.write_text(SCENE, encoding="utf-8")
    rows = "".join(f"{1e3 * t:g};{g:g};21,5\n" for t, g in zip(time, level, strict=True)).replace(".", ",")
    table.write_bytes(f"Recorder 7\n\nTime (ms);Base.Acceleration [g];\N{DEGREE SIGN}C\n{rows}".encode("cp1252"))
    inputs = {"time": time, "base.acceleration": GRAVITY * level}
    assert {name: column.tolist() for name, column in input_table(table).items()} == {
        name: pytest.approx(column.tolist(), rel=1e-15) for name, column in inputs.items()
    }
    taken = run(scene, component=COMPONENT)["contact.force"]
    # The same course, in SI units.
    expected = run(scene, inputs=inputs, component=COMPONENT)["contact.force"]
    assert taken.tolist() == expected.tolist()
    assert np.ptp(taken) > 0.01


@pytest.mark.parametrize(
    ("rows", "told"),
    [
        (np.arange(5.0), []),  # each row lasts until the next
        ([1.0, 1.5, 5.0], ["inputs begin at 0.001 s: before, their first values are held"]),
        ([0.0], ["inputs end at 0 s, the run at 0.005 s: their last values are held"]),
        ([-1.0, 0.0, 1.0], ["inputs end at 0.001 s, the run at 0.005 s: their last values are held"]),
        ([0.0, 1000.0], ["inputs end at 1 s, the run at 0.005 s: is their time in s?"]),
    ],
)
@pytest.mark.filterwarnings("ignore::relay_contact.RelayContactWarning")
def test_a_run_warns_of_inputs_that_do_not_cover_it(rows: list[float], told: list[str]) -> None:
    table = {"time": 1e-3 * np.array(rows), "base.acceleration": np.zeros(len(rows))}
    scene = Scene("", 5e-3, 1e-5, ["contact.force"], {}, table)
    far = Scene("", 5e-3, 1e-5, [], {}, table | {"support.displacement": np.full(len(rows), -0.05)})
    assert far.uncovered() == [*told, "inputs: support.displacement reaches 0.05 m: is it in m?"]
    assert run(scene, component=COMPONENT).warnings == told
    many = run_many([scene, (scene, {"base.acceleration": 0.0})], component=COMPONENT)
    assert many["warning"].tolist() == [" ".join(told), ""]


@pytest.mark.filterwarnings("ignore::relay_contact.RelayContactWarning")
@pytest.mark.parametrize(("step", "cut"), [(1e-3, False), (2.5e-4, False), (7e-4, True), (1e-5, False)])
def test_a_run_warns_of_a_peak_between_its_communication_points(step: float, cut: bool) -> None:
    """At 0.7 and 1.4 ms the triangle has 70 and 60 % of its peak: between them it has 65.7 % there."""
    table = {"time": 1e-3 * np.arange(4.0), "base.acceleration": np.array([0.0, 500.0, 0.0, 0.0])}
    warnings = run(Scene("", 3e-3, step, ["contact.force"], {}, table), component=COMPONENT).warnings
    told = "inputs: base.acceleration passes its row at 0.001 s by 34 % of its range: "
    assert [text.startswith(told) for text in warnings] == [True] * cut


@pytest.mark.parametrize("name", [name for name, path in scenes().items() if "file = " in path.read_text("utf-8")])
def test_inputs_of_the_scenes_included_cover_their_runs(name: str) -> None:
    assert Scene.read(name).uncovered() == []


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("time [ms],base.acceleration [mm]\n0,1\n", "column base.acceleration: unit mm: not allowed, allowed is m/s2"),
        ("time,base.aceleration [g]\n0,1\n", "column base.aceleration: unknown; did you mean base.acceleration"),
        ("time,level\n0,1\n", "columns time, level: not allowed, allowed is time and one or more of base.acceleration"),
        ("time [ms],base.acceleration [g]\n", "csv:1: no row below the names of the columns"),
        ("base.acceleration [g],x\n0,1\n", "columns base.acceleration, x: not allowed, allowed is time and"),
        ("time [ms],base.acceleration [g]\n0,1\n0.2,1\n0.1,1\n", ":4: column time: 0.1 ms: not allowed"),
    ],
)
def test_errors_in_an_input_table_have_line_and_column(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "measured.csv").write_text(text, encoding="utf-8")
    with pytest.raises(RelayContactError, match=message):
        input_table(tmp_path / "measured.csv")


def test_all_inputs_of_the_component_may_be_in_a_table() -> None:
    inputs = {name for name, variable in COMPONENT.variables.items() if variable.causality == "input"}
    assert set(INPUTS) == inputs | {"time"}


@pytest.mark.parametrize(
    ("separator", "rows"), [("\t", "0.0010\t3,801\n"), ("\t", "0,1\t2\n0.2\t3\n"), (",", '0.0010,"3,801"\n')]
)
def test_commas_between_thousands_are_not_decimal_ones(tmp_path: Path, separator: str, rows: str) -> None:
    path = tmp_path / "export.txt"
    path.write_text(f"travel [mm]{separator}force [cN]\n{rows}", encoding="utf-8")
    with pytest.raises(RelayContactError, match="allowed is one decimal sign"):
        read_measurement(path, COMPONENT, ["a"])
