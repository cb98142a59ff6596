"""Random opening relays keep their tolerance against a second solution that shares no code with the component."""

import pytest

from random_relays import compare


# Of closed and open contacts at rest, Hertz and rough, with and without friction, damped by 1.5 to 30 %, under
# vibrations that rise or start at once; `random_relays.py` compares more.
@pytest.mark.parametrize("number", [2, 3, 4, 5, 10, 15])
def test_the_force_of_a_random_relay_is_within_its_tolerance(number: int) -> None:
    found = compare(number)
    assert found is not None
    assert found.events > 4
    assert found.resolved
    assert found.deviation < found.relay.tolerance
