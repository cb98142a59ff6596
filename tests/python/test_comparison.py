"""A run beside a chatter log, and beside a measured resistance."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure

from relay_contact import Array, RelayContactError, comparison, write_table
from relay_contact.command import main
from relay_contact.comparison import compare

TIME = np.linspace(0, 10e-3, 10_001)
STARTS, LENGTHS = np.array([1e-3, 3e-3, 6.5e-3]), np.array([100e-6, 40e-6, 250e-6])


def resistance(shift: float, factor: float) -> Array:
    """Return a resistance that is high in the interruptions."""
    found = np.full(len(TIME), 0.05)
    for start, length in zip(STARTS + shift, factor * LENGTHS, strict=True):
        found[(start < TIME) & (start + length >= TIME)] = 1e9
    return found


@pytest.fixture
def run(tmp_path: Path) -> Path:
    """Write the table of a run."""
    path = tmp_path / "run.csv"
    write_table(path, "time,contact.resistance", np.column_stack((TIME, resistance(0.0, 1.0))))
    return path


def test_a_chatter_log(run: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = tmp_path / "log.csv"
    # The last one is late.
    starts = STARTS + np.array([0.0, 0.0, 2e-4])
    rows = "\n".join(f"{1e3 * (start + 5)};{1.1e6 * length}" for start, length in zip(starts, LENGTHS, strict=True))
    log.write_text(f"start [ms];duration [us]\n{rows}\n")
    assert main(["compare", str(run), str(log), "--out", str(tmp_path)]) == 0
    printed = capsys.readouterr().out.splitlines()
    assert printed[1].split() == ["count", "3", "3", "1.00"]
    # Between values 1 us apart.
    assert float(printed[2].split()[-1]) == pytest.approx(1 / 1.1, rel=0.01)
    found = compare(run, log)
    # Between values 1 us apart.
    assert found.simulated.duration == pytest.approx(LENGTHS, abs=2e-6)
    assert found.measured.start == pytest.approx(starts, abs=2e-6)
    assert found.measured.figures["median"] == pytest.approx(110e-6, rel=1e-9)
    assert len(found.table) == 6
    assert (tmp_path / "comparison.png").stat().st_size > 10_000
    assert len((tmp_path / "comparison.csv").read_text().splitlines()) == 7
    # By a shift that is known.
    moved = compare(run, log, shift=-4.0)
    assert moved.measured.start == pytest.approx(starts + 1, abs=1e-9)
    assert any("3 are outside the time of the run" in note for note in moved.notes)
    assert not any("outside" in note for note in found.notes)
    # A log of less time than the run.
    log.write_text("start [ms],duration [us]\n1,100\n3,40\n")
    assert any("Of the simulated interruptions 1 are outside" in note for note in compare(run, log).notes)
    log.write_text("start [ms],duration [us]\n")
    assert compare(run, log).rows[0] == ["count", "3", "0", ""]


def test_a_measured_resistance(run: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    log, figures = tmp_path / "scope.csv", list[Figure]()
    write_table(log, "time [ms],resistance [mOhm]", np.column_stack((1e3 * TIME, 1e3 * resistance(2e-4, 0.9))))
    monkeypatch.setattr(comparison, "save", lambda figure, _: figures.append(figure))
    found = compare(run, log, out=tmp_path, shift=0.0)
    assert found.measured.start == pytest.approx(STARTS + 2e-4, abs=2e-6)
    assert found.rows[3][3] == "1.11"
    # In ms and us.
    course, durations = figures[0].axes
    assert course.get_xlim() == pytest.approx((0, 10))
    for number, own in enumerate((found.simulated, found.measured)):
        assert np.array(course.lines[number].get_xydata()) == pytest.approx(np.stack((1e3 * TIME, own.resistance), 1))
        drawn = np.stack((1e3 * own.start, 1e6 * own.duration), 1)
        assert np.array(durations.lines[number].get_xydata()) == pytest.approx(drawn)


def test_interruptions_between_the_values_of_a_run(tmp_path: Path) -> None:
    """Every 0.5 ms one sees none of the three, which the component counts."""
    table, log = tmp_path / "run.csv", tmp_path / "log.csv"
    coarse, whole = slice(375, None, 500), np.interp(TIME, STARTS, [1, 2, 3], left=0).astype(int)
    columns = np.column_stack((TIME, resistance(0.0, 1.0), whole))[coarse]
    log.write_text("start [ms],duration [us]\n1,100\n3,40\n6.5,250\n")
    for count in (2, 3):
        names = ("time", "contact.resistance", "chatter.count")[:count]
        write_table(table, ",".join(names), columns[:, :count])
        found = compare(table, log)
        assert found.notes[0] == "The run has a value every 500 µs: shorter steps tell interruptions better."
        assert found.rows[0] == ["count", *(("0", "3", "0") if count == 2 else ("3", "3", "1.00"))]
        assert found.rows[1][1:] == (["0 µs", "250 µs", "0"] if count == 2 else ["unknown", "250 µs", ""])
    own = "interruptions by its own chatter.resistanceThreshold and chatter.minimumDuration, the resistance shows"
    assert found.notes[1] == f"The component counted 3 {own} 0."
    # Those that are shorter than what the component counts are in the resistance, and in the comparison.
    fine = tmp_path / "fine.csv"
    write_table(fine, ",".join(names), np.column_stack((TIME, resistance(0.0, 1.0), np.minimum(whole, 2))))
    short = compare(fine, log)
    assert short.rows[0] == ["count", "3", "3", "1.00"]
    assert f"The component counted 2 {own} 3." in short.notes
    # The other way around, and where neither has any.
    log.write_text("time [ms],resistance [Ohm]\n0,0.05\n10,0.05\n")
    assert [compare(table, log).notes[at] for at in (0, 1)] == [
        f"The {name} has a value every {step} µs: shorter steps tell interruptions better."
        for name, step in (("run", 500), ("measurement", 10000))
    ]


def test_a_record_may_begin_and_end_interrupted(run: Path, tmp_path: Path) -> None:
    """By straight lines of the logarithm: from 1e9 to 0.05 Ohm in 1 ms a threshold of 5 is crossed after 0.8058 ms."""
    log = tmp_path / "log.csv"
    log.write_text("time [ms],resistance [Ohm]\n0,1e9\n1,1e9\n2,0.05\n9,0.05\n10,1e9\n")
    options = ["--threshold", "5", "--shift", "0", "--out", str(tmp_path)]
    assert main(["compare", str(run), str(log), *options]) == 0
    table = pd.read_csv(tmp_path / "comparison.csv", index_col="by").loc["measured"]
    assert table["start [s]"].tolist() == pytest.approx([0, 9.1942e-3], abs=1e-7)
    assert table["duration [s]"].tolist() == pytest.approx([1.8058e-3, 0.8058e-3], abs=1e-7)


def test_a_comparison_without_its_columns_is_refused(run: Path, tmp_path: Path) -> None:
    log = tmp_path / "log.csv"
    log.write_text("start [ms],length [us]\n1,2\n")
    with pytest.raises(RelayContactError, match=r"log.csv:1: columns: not allowed, allowed are start and duration"):
        compare(run, log)
    for text, message in (
        # Two at once; microseconds that say they are milliseconds.
        ("start [ms],duration [us]\n1,400\n1.2,400\n", ":2: column duration: 400 us: not allowed, allowed is up to"),
        ("start [ms],duration [ms]\n1,400\n2,400\n", ":2: column duration: 400 ms: not allowed, allowed is up to"),
        ("start [ms],duration [us]\n1,0\n2,400\n", ":2: column duration: 0 us: not allowed, allowed is greater than 0"),
        # Leads of the meter that are exchanged: it never opens.
        ("time [ms],resistance [Ohm]\n0,-0.1\n1,-1e6\n2,-0.1\n", ":3: column resistance: -1e6 Ohm: not allowed"),
    ):
        log.write_text(text)
        with pytest.raises(RelayContactError, match=message):
            compare(run, log)
    log.write_text("start [ms],duration [us]\n1,1003\n2,400\n")
    assert len(compare(run, log).measured.start) == 2
    other = tmp_path / "other.csv"
    other.write_text("time,contact.force\n0,1\n1,1\n")
    with pytest.raises(RelayContactError, match=r"no columns time and contact.resistance: run it with --output"):
        compare(other, log)
    other.write_text("time,contact.force\n0,x\n")
    with pytest.raises(RelayContactError, match=r"other.csv: not a table as `relay-contact run` writes it"):
        compare(other, log)
