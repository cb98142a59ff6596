"""Distributions, correlations, chances and indices: against closed forms; a relay file that identification wrote."""

import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.spatial.distance import cdist
from scipy.stats import norm, qmc

from qualified import described, placed
from relay_contact import Values
from relay_contact.qualification import position as positions
from relay_contact.qualification.distributions import LIMITS, Correlation, Distribution
from relay_contact.qualification.excitation import Shock
from relay_contact.qualification.excitation import Test as Asked
from relay_contact.qualification.position import Position
from relay_contact.qualification.relay import Model
from relay_contact.qualification.results import Chance
from relay_contact.qualification.statistics import MANY, Surface, chance, distances, drawn, first_order
from relay_contact.qualification.words import chance_text

SLOW = Shock("slow", "", "from memory", 20.0, 0.1)


@pytest.mark.parametrize(
    ("entries", "ends"),
    [
        ({"part": 0.1}, (0.9, 1.1)),
        ({"distribution": "uniform", "part": 0.1}, (0.905, 1.095)),
        # Triangles: of their area 2.5 % lies below low + sqrt(0.025 (high - low) (mode - low)).
        ({"distribution": "triangular", "low": -0.1, "mode": 0.0, "high": 0.1},
         (0.9 + np.sqrt(0.025 * 0.2 * 0.1), 1.1 - np.sqrt(0.025 * 0.2 * 0.1))),
        ({"distribution": "data", "values": tuple(np.linspace(1.8, 2.2, 4001))}, (0.905, 1.095)),
    ],
)  # fmt: skip
def test_distributions_by_name(entries: Any, ends: tuple[float, float]) -> None:  # noqa: ANN401
    found = Distribution(**entries)
    assert found.factor(norm.ppf(LIMITS), 2.0) == pytest.approx(ends, abs=2e-4)
    assert found.half(2.0) == pytest.approx((ends[1] - ends[0]) / 2, abs=2e-4)
    told = [float(each) / 100 for each in re.findall(r"[+-]?\d+\.?\d*", found.told(2.0))]
    # Of a normal one the half on either side.
    one = "part" in entries and len(entries) == 1
    assert told == pytest.approx([ends[1] - 1] if one else np.array(ends) - 1, abs=3e-4)
    # None changes its sign.
    assert Distribution(part=0.9).factor(np.array(-9.0), 2.0) == 0.01


def test_a_sample_is_in_the_unit_of_its_parameter_and_of_an_entry_has_factors() -> None:
    parts = (0.8, 0.9, 1.1, 1.2, 1.3)
    samples = {"contact.overtravel": tuple(2e-4 * part for part in parts), "spring.stiffness": parts}
    uncertain = {name: Distribution(distribution="data", values=values) for name, values in samples.items()}
    median = placed(described({}, uncertain), SLOW).drawn(np.zeros(2))
    assert median == {name: pytest.approx(values[2]) for name, values in samples.items()}


def slow_shock(names: tuple[str, ...], coefficient: float = 0.0) -> tuple[Position, float]:
    """Return a position of a relay with correlated uncertainties under a slow shock, and the margin, linear."""
    rows = tuple(tuple(1.0 if one == other else coefficient for other in names) for one in names)
    relay = described({}, dict.fromkeys(names, Distribution(part=0.05)), Correlation(names=names[::-1], matrix=rows))
    position = placed(relay, SLOW)
    return position, position.linear(position.specimen.response, SLOW)


def test_a_correlation_changes_the_interval_as_it_should(monkeypatch: pytest.MonkeyPatch) -> None:
    """Preload over mass: goes with Young's modulus and overtravel, whose errors add up, or cancel."""
    monkeypatch.setattr(positions, "DRAWS", 64)
    for coefficient in (-0.9, 0.0, 0.9):
        position, margin = slow_shock(("beam.youngsModulus", "contact.overtravel"), coefficient)
        drawn = position.margins(SLOW, margin)
        margins, told = drawn.margins, position.chance(SLOW, drawn, margin)
        # Of 10,000 draws the deviation is known to 0.7 %.
        part = 0.05 * np.sqrt(2 + 2 * coefficient) / 1.96
        assert np.std(margins) / margin == pytest.approx(part, rel=0.03)
        # Of each: its own and what it tells of the other.
        index = (1 + coefficient) / 2
        assert told.indices["contact.overtravel"] == pytest.approx(index, abs=0.03)
        assert told.confirmed >= 2
        # The component was where the polynomial had told.
        assert told.error < 2e-3


def test_what_the_component_finds_beside_linear_theory_is_where_it_found_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """As if its levels went with the scores of three parameters, the last of which hardly matters; 1 % off in draws."""
    slopes = 0.02 * np.array([1.0, 2.0, 3.0])

    def turn(own: Position, test: Asked, number: int, expected: float) -> float:
        return expected + float(own.surfaces[test.name].scores[number] @ slopes if number < 7 else 0.01)

    position, margin = slow_shock(("contact.overtravel", "beam.youngsModulus", "contact.curvatureRadius"))
    test = replace(SLOW, acceleration=1.1 * margin * SLOW.acceleration)
    position = replace(position, tests=(test,))
    monkeypatch.setattr(Position, "turn", turn)
    # By linear theory it fails at 1/1.1 of the level, in the component at the level: draws next to that are confirmed.
    linear, found = (position.margins(test, 1.0, confirmed) for confirmed in (False, True))
    scores = position.independent[:, :3]
    inside = (np.abs(scores) < 1.95).all(axis=1)
    assert np.log(found.margins / linear.margins)[inside] == pytest.approx((scores @ slopes)[inside], abs=1e-9)
    assert found.confirmed == 3 * 2 + 2
    assert found.error == pytest.approx(-np.expm1(-0.01))
    # What the model leaves out is a part of the margin, with 95 % confidence.
    allowed = replace(position, model=Model("one", {}, 0.1)).margins(test, 1.0, False).margins / linear.margins
    assert np.quantile(allowed, LIMITS) == pytest.approx((0.9, 1.1), abs=4e-3)


def test_an_interval_is_the_same_part_of_any_margin() -> None:
    """Of 4e-4, too: draws had counted as 1e-3 at least."""
    position, margin = slow_shock(("contact.overtravel",))
    hard = replace(position, tests=(replace(SLOW, acceleration=1e5),))
    part = SLOW.acceleration / 1e5
    drawn = hard.margins(hard.tests[0], part * margin).margins
    assert drawn == pytest.approx(part * position.margins(SLOW, margin).margins, rel=1e-3)


def test_a_parameter_matters_beside_one_whose_end_fails_at_rest(monkeypatch: pytest.MonkeyPatch) -> None:
    """The first does as much as the second up to where that ends: the component tells of both."""
    values: Values = {"effects.pusher": "Prescribed", "pusher.position": 9e-3, "pusher.displacement": 2.86e-4,
                      "contact.overtravel": -5e-4}  # fmt: skip
    uncertain = {"pusher.position": Distribution(part=0.1), "pusher.displacement": Distribution(part=0.5)}
    position = placed(described(values, uncertain), SLOW)
    sought: set[int] = set()

    def turn(_: Position, _test: Asked, number: int, expected: float) -> float:
        sought.add(number)
        return expected

    monkeypatch.setattr(Position, "turn", turn)
    position.margins(SLOW, position.linear(position.specimen.response, SLOW))
    left = position.surfaces[SLOW.name].left
    assert list(left[1:5] > 0) == [True, True, True, False]
    assert sought >= {1, 2, 3, 4}


def test_a_chance_in_ppm_with_its_interval(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(positions, "DRAWS", 64)
    position, margin = slow_shock(("contact.overtravel",))
    for sigmas in (0.0, 2.0, 3.0):
        own = 1 + sigmas * 0.05 / 1.96
        test = replace(SLOW, acceleration=SLOW.acceleration * margin / own)
        position = replace(position, tests=(test,))
        told = position.chance(test, position.margins(test, own), own)
        expected = norm.cdf(-sigmas / own)
        assert told.low <= expected <= told.high, sigmas
        assert told.low <= told.failing <= told.high, sigmas
        # By the number of draws, and an error of the margin of up to 0.05 %.
        assert told.high - told.low < 5 * np.sqrt(expected / MANY) + 0.04 * expected + 1e-3


def test_intervals_of_a_chance() -> None:
    margins = np.full(MANY, 2.0)

    def told() -> str:
        return chance_text(Chance(*chance(margins, 0.0), {"tip.mass": 0.1}, {}, 0, 0.0))

    # The rule of three, two-sided: ln(40) / n.
    assert chance(margins, 0.0) == pytest.approx((0.0, 0.0, np.log(40) / MANY), rel=1e-3)
    assert told() == "< 369 ppm"
    margins[:100] = 0.5
    assert chance(margins, 0.0) == pytest.approx((0.01, 0.00814, 0.01215), abs=1e-5)
    assert told() == "10000 ppm (8140 ppm to 12100 ppm)"
    margins[:200] = 0.995
    assert chance(margins, 0.01)[1:] == pytest.approx((0.0, 0.0229), abs=1e-4)
    margins[:] = 0.5
    assert told() == "all but < 369 ppm"


def test_a_surface_follows_margins_and_tells_its_error() -> None:
    scores = norm.ppf(qmc.Sobol(4, scramble=False).random(256) + 0.5 / 256)

    def margin(at: Any) -> Any:  # noqa: ANN401
        return np.log(1.2 * (1 + 0.05 * at[:, 0]) * np.sqrt(1 + 0.03 * at[:, 1]) + 0.02 * at[:, 0] * at[:, 2])

    surface, others = Surface(scores, margin(scores), np.ones(256)), drawn(4)
    assert distances(others[:5], scores) == pytest.approx(cdist(others[:5], scores))
    left = surface(others) - margin(others)
    # Terms of third order: 0.05 times 0.02 / 1.2, in scores of 1.
    assert np.std(left) < 2 * 0.05 * 0.02 / 1.2
    assert 0.3 < surface.error / np.std(left) < 6
    found = first_order(others, np.exp(margin(others)), ["a", "b", "c", "d"])
    # By the slopes: 0.06 and 0.018 of 1.2.
    assert found["a"] == pytest.approx(0.06**2 / (0.06**2 + 0.018**2), abs=0.1)
    assert found["d"] < 0.02
