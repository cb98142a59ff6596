"""The example on friction against the reference of the tests."""

from pathlib import Path

import numpy as np

from conftest import Run, is_picture
from frictional import Frictional
from relay_contact import Values, read_table


def test_its_frequencies_and_its_motion_are_those_of_a_second_solution(run: Run, tmp_path: Path) -> None:
    printed = run("friction")
    assert "  without friction: 5.08 cN at 1250 Hz" in printed
    assert "  with: 4.91 cN at 1250 Hz" in printed
    assert is_picture(tmp_path / "friction.png")
    rows = np.column_stack(list(read_table(tmp_path / "friction-frequencies.csv").values()))
    assert len(rows) == 6
    for length, overtravel, *frequencies in rows:
        for height, found in zip((0.0, 1e-4, 3e-4, 1e-3), frequencies, strict=True):
            values: Values = {
                "effects.axialForce": "None",
                "beam.length": length,
                "contact.overtravel": overtravel,
                "tip.contactHeight": height,
            }
            # Both from the characteristic equation; 12 digits are written.
            assert np.isclose(found, Frictional(values).sticking_frequency(), rtol=1e-10)

    loop = read_table(tmp_path / "friction-loop.csv")
    travel, force, without = loop.values()
    # Closing and opening the contact slips all the way but at the turns: T = -+ mu F is a moment h T, which adds
    # 3 h mu / 2 L to the compliance of the spring.
    share = 3 * 1e-3 * 0.2 / (2 * 15.5e-3)
    third = len(travel) // 3
    for place, sign in ((0, 1), (third, -1)):
        assert abs(travel[place]) < 1e-9
        assert np.isclose(force[place] / without[place], 1 / (1 - sign * share), rtol=2e-4)
