"""The published 1 kHz case as `cargo xtask demo` shows it."""

from pathlib import Path

from conftest import Run, is_picture
from relay_contact import read_table


def test_the_published_values_are_those_of_the_fit(run: Run, tmp_path: Path) -> None:
    rows = [line for line in run("paper_1khz").splitlines() if line.endswith("%")]
    assert len(rows) == 6
    # The first four are what the specimen was identified from, to the digits published.
    for row in rows[:4]:
        assert abs(float(row.split()[-2])) < 0.1
    assert [len(column) for column in read_table(tmp_path / "paper-1khz.csv").values()] == [2001] * 4
    assert is_picture(tmp_path / "paper-1khz.png")
