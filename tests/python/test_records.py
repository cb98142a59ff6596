"""Records of acceleration in the files of measuring programs: their time and units, and what is wrong with them."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.io import savemat

from relay_contact import RelayContactError
from relay_contact.records import read

G = 9.80665
TIME = 12.5 + 2e-5 * np.arange(400)
VALUES = 3 * np.sin(1e3 * TIME)
MORE = "".join(f"{time},1\n" for time in range(5, 13))


def test_text_with_several_channels_and_an_offset_of_time(tmp_path: Path) -> None:
    path = tmp_path / "road.csv"
    rows = "\n".join(f"{t:.6f};{a:.6f};21,5;{2 * a:.6f}".replace(".", ",") for t, a in zip(TIME, VALUES, strict=True))
    path.write_text(f"Logger 7\n# anything\nTime;X;Temp;Y\ns;g;degC;m/s²\n{rows}\n", encoding="utf-8")
    first, second = read(path)
    assert (first.channel, second.channel) == ("x", "y")
    assert first.time == pytest.approx(TIME, abs=1e-9)
    assert first.acceleration == pytest.approx(G * VALUES, abs=1e-5)
    assert second.acceleration == pytest.approx(2 * VALUES, abs=1e-6)
    (asked,) = read(path, "Y")
    assert asked.channel == "y"
    # What is left out is told, unless one channel is asked for.
    assert ["temp (degC)" in " ".join(each.notes) for each in (first, second, asked)] == [True, True, False]
    # The units of the file count, which is told.
    both = read(path, unit="g")
    assert np.array_equal(both[1].acceleration, second.acceleration)
    assert [each.overruled for each in both] == ["", "in m/s2, as the file says, not in g"]
    assert both[1].overruled in both[1].notes
    assert [note for note in first.notes if "12.5 s" in note]
    assert not [note for note in first.notes if "unequal" in note]
    with pytest.raises(RelayContactError, match=r"no channel z; there are x, temp, y"):
        read(path, "z")
    with pytest.raises(RelayContactError, match=r"channel temp: unit degC: not allowed, allowed is m/s2, g"):
        read(path, "temp")


def test_text_without_time_has_a_rate(tmp_path: Path) -> None:
    path = tmp_path / "bare.csv"
    path.write_text("acceleration [g]\n" + "\n".join(map(str, VALUES)))
    with pytest.raises(RelayContactError, match=r"no time, a column named time or t; give the rate"):
        read(path)
    (record,) = read(path, rate=50e3)
    assert record.time == pytest.approx(TIME - 12.5, abs=1e-12)
    rows = "\n".join(f"{t},{a}" for t, a in zip(TIME, VALUES, strict=True))
    # The first line is the time of day.
    path.write_text(f"Time,12:30:00\ntime [s],acceleration\n{rows}")
    with pytest.raises(
        RelayContactError, match=r"no channel with an acceleration in g or m/s2; there are acceleration \(no"
    ):
        read(path)
    assert read(path, unit="g")[0].acceleration == pytest.approx(G * VALUES)
    path.write_text(path.read_text().replace("time [s]", "time"))
    assert read(path, unit="g")[0].notes[0] == "time without a unit, taken as s"
    with pytest.raises(RelayContactError, match="a rate is given, and the file has a time"):
        read(path, unit="g", rate=1.0)


def test_unequal_steps_are_told_and_times_have_to_rise(tmp_path: Path) -> None:
    path = tmp_path / "steps.csv"
    path.write_text("time [ms],a [g]\n0,0\n1,1\n3,2\n4,3\n" + MORE)
    (record,) = read(path)
    assert [note for note in record.notes if "unequal, 1000 to 2000 µs" in note]
    assert record.time[:4] == pytest.approx([0, 1e-3, 3e-3, 4e-3])
    short = tmp_path / "short.csv"
    short.write_text("time [us],a [g]\n" + "\n".join(f"{0.1 * n},{n % 2}" for n in range(20)))
    assert read(short)[0].notes == ["steps of time of 0.100 µs: is it in s?"]
    short.write_text("time [s],a [g]\n")
    with pytest.raises(RelayContactError, match=r"short.csv:1: no row below the names of the columns"):
        read(short)
    # Straight lines take off what they do in the longest step.
    assert record.kept(100.0) == pytest.approx(np.sinc(0.2) ** 2)
    path.write_text("time [ms],a [g]\n0,0\n1,1\n1,2\n" + MORE)
    with pytest.raises(
        RelayContactError, match=r"steps.csv:4: column time: 1 ms: not allowed, allowed is more than in the row"
    ):
        read(path)


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        (MORE, r"channel a: 8 values for 8 times: not allowed, allowed are as many, 9 or more"),
        (MORE.replace(",1", ",2") + "13,2\n", r"channel a: 2 m/s2 all the time: not allowed, allowed are values that"),
    ],
)
def test_records_that_tell_nothing_are_refused(tmp_path: Path, rows: str, message: str) -> None:
    path = tmp_path / "few.csv"
    path.write_text("time [ms],a [m/s2]\n" + rows)
    with pytest.raises(RelayContactError, match=message):
        read(path)


def test_a_record_is_the_same_in_quotes_and_one_wrong_row_is_named(tmp_path: Path) -> None:
    path = tmp_path / "long.csv"
    rows = "\n".join(f"{t:.6f};{a:.6f}".replace(".", ",") for t, a in zip(TIME, VALUES, strict=True))
    path.write_text(f"some\n\ntime;a\ns;g\n{rows}\n")
    (plain,) = read(path)
    path.write_text(f'some\n\ntime;a\ns;g\n{rows}\n"50,0";0\n')
    (quoted,) = read(path)
    assert np.array_equal(quoted.time, [*plain.time, 50.0])
    assert np.array_equal(quoted.acceleration, [*plain.acceleration, 0.0])
    for names in ('"time";"a"\n"s";"g"', '"time [s]";"a [g]"'):
        path.write_text(f"some\n\n{names}\n{rows}\n")
        (named,) = read(path)
        assert np.array_equal(named.acceleration, plain.acceleration)
    path.write_text(f"some\n\ntime;a\ns;g\n{rows}\n50;x\n")
    with pytest.raises(RelayContactError, match=r"long.csv:405: column a: x: not allowed, allowed is a number"):
        read(path)


def test_files_of_measuring_programs(tmp_path: Path) -> None:
    asammdf, pyuff, nptdms = (pytest.importorskip(name) for name in ("asammdf", "pyuff", "nptdms"))
    with asammdf.MDF(version="4.10") as file:
        file.append([asammdf.Signal(VALUES, TIME, unit=unit, name=name) for unit, name in (("g", "Z"), ("V", "U"))])
        file.save(tmp_path / "road.mf4")
    for clock, scale in (("", 1.0), ("ms", 1e3), ("min", 1.0)):
        blank: dict[str, Any] = {
            "type": 58, "func_type": 1, "rsp_node": 1, "rsp_dir": 3, "ref_node": 1, "ref_dir": 3, "data": VALUES,
            "x": scale * TIME, "id1": "Z", "ordinate_axis_units_lab": "m/s2", "orddenom_spec_data_type": 0,
            "abscissa_spacing": 1, "abscissa_axis_units_lab": clock,
        }  # fmt: skip
        pyuff.UFF(str(tmp_path / f"road{clock}.uff")).write_sets(blank, "overwrite")
        with nptdms.TdmsWriter(tmp_path / f"road{clock}.tdms") as writer:
            properties = {"unit_string": "g", "wf_increment": 2e-5 * scale, "wf_start_offset": 12.5 * scale}
            properties |= {"wf_xunit_string": clock} if clock else {}
            writer.write_segment([nptdms.ChannelObject("group", "Z", VALUES, properties=properties)])
    savemat(tmp_path / "road.mat", {"t": TIME, "Z": VALUES})
    for name, unit, factor in (("road.mf4", "", G), ("road.uff", "", 1.0), ("roadms.uff", "", 1.0),
                               ("road.tdms", "", G), ("roadms.tdms", "", G), ("road.mat", "g", G)):  # fmt: skip
        (record,) = read(tmp_path / name, unit=unit)
        assert record.channel == "Z", name
        assert record.time == pytest.approx(TIME, abs=1e-9), name
        assert record.acceleration == pytest.approx(factor * VALUES, rel=1e-6, abs=1e-9), name
        assert ("time without a unit, taken as s" in record.notes) == (name == "road.mat"), name
    pyuff.UFF(str(tmp_path / "road.uff")).write_sets({**blank, "func_type": 4, "data": VALUES + 0j}, "add")
    assert read(tmp_path / "road.uff")[0].others == ("set 2 (function type 4)",)
    names = {"names": ["x", "y"], "units": np.array(["g", "m/s2"], dtype=object)}
    savemat(tmp_path / "matrix.mat", {"t": TIME, "Z": VALUES, "axes": np.ones((400, 3)), **names})
    assert read(tmp_path / "matrix.mat", unit="g")[0].others == ("axes (a matrix)",)
    with nptdms.TdmsWriter(tmp_path / "begin.tdms") as writer:
        # Without the time of its first value.
        given = {"unit_string": "g", "wf_increment": 2e-5}
        writer.write_segment([nptdms.ChannelObject("group", "Z", VALUES, properties=given)])
    assert read(tmp_path / "begin.tdms")[0].time == pytest.approx(TIME - 12.5, abs=1e-9)
    # As a copy that has ended too early.
    (tmp_path / "part.mat").write_bytes((tmp_path / "road.mat").read_bytes()[:50])
    with pytest.raises(RelayContactError, match=r"part.mat: cannot be read: "):
        read(tmp_path / "part.mat")
    savemat(tmp_path / "complex.mat", {"t": TIME, "Z": VALUES + 1j * (TIME > 12.5059)})
    with pytest.raises(RelayContactError, match=r"channel Z: value 297: .*first of 104: .* is a real"):
        read(tmp_path / "complex.mat", unit="g")
    for suffix in ("uff", "tdms"):
        with pytest.raises(RelayContactError, match=r"channel Z: time in min: not allowed, allowed is s, ms, us"):
            read(tmp_path / f"roadmin.{suffix}")


def test_samples_that_a_file_marks_as_invalid_and_other_masters_than_time_are_refused(tmp_path: Path) -> None:
    asammdf, path = pytest.importorskip("asammdf"), tmp_path / "road.mf4"
    wrong: tuple[tuple[dict[str, Any], str], ...] = (
        ({"invalidation_bits": TIME > 12.5059}, r"value 297: .* at 12.50592 s, the first of 104: .* mark as invalid"),
        ({"master_metadata": ("index", 4)}, r"channel Z: time in index: not allowed, allowed is s, ms, us"),
    )
    for marked, message in wrong:
        with asammdf.MDF(version="4.10") as file:
            file.append([asammdf.Signal(VALUES, TIME, unit="g", name="Z", **marked)])
            file.save(path, overwrite=True)
        with pytest.raises(RelayContactError, match=message):
            read(path)


def test_a_mass_in_grams_is_no_acceleration(tmp_path: Path) -> None:
    path = tmp_path / "shaker.csv"
    path.write_text("time [ms],mass [g],acceleration of the mass [g]\n" + MORE.replace("\n", ",0\n") + "13,2,2\n")
    (record,) = read(path)
    assert (record.channel, record.others) == ("acceleration of the mass", ("mass (g)",))
    assert read(path, "mass")[0].acceleration[-1] == pytest.approx(2 * G)


def test_words_beside_a_record_are_not_read(tmp_path: Path) -> None:
    path = tmp_path / "told.csv"
    path.write_text("time [ms],a [g],note\n" + MORE.replace("\n", ",calm\n") + "13,2,rough\n")
    (record,) = read(path)
    assert record.others == ("note (no unit)",)


def test_packages_are_asked_for_only_where_they_are_needed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "road.tdms").write_bytes(b"")
    monkeypatch.setitem(__import__("sys").modules, "nptdms", None)
    with pytest.raises(RelayContactError, match=r"needs the package nptdms: pip install 'relay-contact\[records\]'"):
        read(tmp_path / "road.tdms")
