"""`identify` on measurements made by the second solution of the model: what the data tell, and what they do not."""

import re
import tomllib
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import tomlkit
from matplotlib.figure import Figure
from scipy.optimize import brentq
from scipy.stats import binom, t

import measured
from component import COMPONENT, ROOT, resting
from identification_coverage import of_all, of_record, of_rough_curves, of_rough_frequencies
from reference import Reference
from relay_contact import Array, RelayContactError, Values, identification, write_table
from relay_contact.command import main
from relay_contact.component import sine
from relay_contact.figures import save
from relay_contact.identification import Identification, report
from relay_contact.identification.fit import Fit, Set, Unknown
from relay_contact.identification.measurement import Measurement
from relay_contact.identification.prediction import Laboratory, exponentials
from relay_contact.identification.relay_file import put
from relay_contact.identification.report import silent
from relay_contact.qualification import Relay
from relay_contact.schema import leaves

pytestmark = pytest.mark.filterwarnings("error::RuntimeWarning")
SEED = 1
CLEAN = measured.exact(measured.TRUTH)


def found(*data: Path, relay: str | Path = "paper", **asked: Any) -> Identification:  # noqa: ANN401
    return identification.identify(relay, list(data), component=COMPONENT, **asked)


def holds(result: Identification, label: str, true: float) -> bool:
    low, high = result[label].interval
    return low <= true <= high


def test_what_a_laboratory_measures_gives_the_parameters(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    data = measured.files(tmp_path, measured.scattered(CLEAN, SEED))
    monkeypatch.setattr("relay_contact.scene.PATIENCE", 1e-3)
    figures: list[Figure] = []

    def kept(figure: Figure, path: Path) -> None:
        figures.append(figure)
        save(figure, path)

    monkeypatch.setattr(report, "save", kept)
    assert main(["identify", "paper", "--data", *map(str, data.values()), "--out", str(tmp_path / "found")]) == 0
    printed, progress = capsys.readouterr()
    assert re.search(r"\d\d predictions of measurements", progress)
    # Of the stiff contact, damping is not felt while it stays closed.
    assert "contact.damping: not determined: the data hardly depend on it" in printed
    assert "the model 'published force is the elastic force' of the relay's file keeps its own" in printed
    assert "the model 'with friction'" not in printed
    page = (tmp_path / "found/identification.html").read_text(encoding="utf-8")
    assert page.count("<svg") == 1
    assert (tmp_path / "found/identification.png").read_bytes().startswith(b"\x89PNG")
    # In the units of the files, but for kHz, and a ring-down from its begin on; scatters of up to 3 %.
    for axes, (name, file) in zip(np.array(figures[0].axes)[[0, 1, 4, 5]], data.items(), strict=True):
        over, *_, values = np.loadtxt(file, delimiter=",", skiprows=2).T
        over = {"ring": over - over[0], "chatter": 1e3 * over}.get(name, over)
        points, curve = (np.array(line.get_xydata()) for line in axes.lines)
        assert points == pytest.approx(np.stack((over, values), 1), rel=1e-6)
        assert np.interp(over, *curve.T) == pytest.approx(values, abs=0.1 * np.abs(values).max())
    relay = Relay.read(tmp_path / "found/paper.toml", COMPONENT)
    assert set(relay.uncertainty) == set(measured.TRUTH)
    assert relay.title.endswith(", identified but for contact.damping")
    # Its covariance, which `qualify` draws from.
    assert list(relay.correlation.names) == list(relay.uncertainty)
    assert np.abs(np.tril(relay.correlation.matrix, -1)).max() > 0.3
    for name, true in measured.TRUTH.items():
        value = float(relay.positions["contact closed"][name])
        # By the information that the data have, their scatter known, 1.1 to 1.5 %, of the rivet 10.6 %: it is a small
        # part of the moved mass; half as much again for scatters that are estimated from 6 to 9 rows.
        assert relay.parts(COMPONENT)[name] < 1.5 * (0.106 if name == "tip.mass" else 0.015)
        assert abs(np.log(value / true)) < relay.parts(COMPONENT)[name], name


def test_intervals_hold_the_true_values_as_often_as_they_say() -> None:
    """A small form of `identification_coverage.py`."""
    sets = 6
    inside = int((np.abs([of_all(seed) for seed in range(sets)]) <= 1).sum())
    # Fewer come once in a thousand times, if intervals are right and the parameters of a set independent.
    assert inside >= binom.ppf(1e-3, sets * len(measured.TRUTH), 0.95)


def test_a_measurement_of_as_few_rows_as_parameters_is_not_met_as_exact() -> None:
    """Five rows that alone tell two of five parameters; with a scatter that ends at zero 62 % of the intervals hold."""
    names, sets = "abcde", 60
    inside = np.zeros(len(names))
    for seed in range(sets):
        chance, slopes, data = np.random.default_rng(seed), {}, []
        for rows, scatter, told in ((20, 1e-2, 3), (5, 1e-3, 5)):
            values, over = np.exp(scatter * chance.standard_normal(rows)), np.arange(1.0, rows + 1)
            data.append(Set(Measurement(Path(str(rows)), "frequency response", over, "force", "N", values)))
            slopes[data[-1].measurement.path] = chance.standard_normal((rows, 5)) * (np.arange(5) < told)

        def predict(own: Measurement, at: Values, slopes: dict[Path, Array] = slopes) -> Array:
            return np.asarray(np.exp(slopes[own.path] @ np.log([float(at[name]) for name in names])))

        laboratory: Any = SimpleNamespace(predict=predict)
        fit = Fit(laboratory, {"": {}}, data, [Unknown(name, ("",), 1.0, name, -5.0, 5.0) for name in names])
        fit.run()
        inside += np.abs(fit.logarithms) < fit.halves()
    assert (inside >= binom.ppf(1e-3 / len(names), sets, 0.95)).all(), inside


TWELVE = np.linspace(0.5, 1.6, 12)


def resounding(start: dict[str, float], contacts: tuple[float, ...], rows: Array = TWELVE) -> Fit:
    """Search stiffness, mass and damping by responses with stiffnesses beside that of the spring."""
    true = {"beam.youngsModulus": 1.0, "tip.mass": 1.0, "beam.stiffnessDamping": 0.005}
    chance, data = np.random.default_rng(SEED), []

    def predict(own: Measurement, at: Values) -> Array:
        stiffness, mass, damping = (float(at.get(name, value)) for name, value in true.items())
        part = own.over * np.sqrt(mass / (stiffness + float(own.position)))
        return np.asarray(1 / np.abs(1 - part**2 + 2j * damping * part))

    for contact in contacts:
        over, noise = rows * np.sqrt(1 + contact), np.exp(0.02 * chance.standard_normal(len(rows)))
        own = Measurement(Path("a.csv"), "frequency response", over, "force", "N", noise, position=str(contact))
        data.append(replace(own, values=noise * predict(own, true)))
    laboratory: Any = SimpleNamespace(predict=predict)
    places = tuple(map(str, contacts))
    sought = [Unknown(name, places, part * true[name], name, -5.0, 5.0) for name, part in start.items()]
    fit = Fit(laboratory, {place: {} for place in places}, [Set(each) for each in data], sought)
    fit.look_around()
    fit.run()
    return fit


@pytest.mark.parametrize("start", [(0.55, 1.0), (1.2, 1.0), (0.7, 1.2, 0.7), (1.4, 1.2, 1.6)])
def test_weakly_damped_resonances_are_found_from_the_other_side_of_measured_frequencies(
    start: tuple[float, ...],
) -> None:
    names = ("beam.youngsModulus", "beam.stiffnessDamping", "tip.mass")
    fit = resounding(dict(zip(names, start, strict=False)), (0.0, 3.0)[: len(start) - 1])
    # Twelve rows of 2 % each, of which those beside the resonance tell most.
    assert np.exp(fit.logarithms[0]) * start[0] == pytest.approx(1.0, rel=0.02)
    assert not fit.rivals()


def test_another_answer_that_fits_as_well_is_told() -> None:
    """Amplitudes above a resonance are those below another one: 1.4 / E - 1 as 1 - 1.4 / E."""
    fit = resounding({"beam.youngsModulus": 1.0}, (0.0,), np.sqrt(1.4) * np.linspace(0.999, 1.001, 6))
    answers = np.exp([fit.logarithms[0], *(other[0] for other in fit.rivals())])
    assert sorted(answers) == pytest.approx([1.0, 1.4 / 0.6], rel=0.03)


def test_a_static_force_tells_the_law_of_a_soft_contact(tmp_path: Path) -> None:
    """From twenty times its stiffness, where the data determine the law hardly."""
    true = {**measured.ROUGH, "contact.stiffness": 2e3, "contact.overtravel": 2e-4}
    over = np.linspace(-1e-4, 2e-4, 20)
    force = np.array([measured.rough(2e-4 + each, true).force for each in over])
    force *= np.exp(1e-4 * np.random.default_rng(SEED).standard_normal(20))
    data = Measurement(Path("force.csv"), "static force", over, "force", "N", force)
    result = asked(tmp_path, [data], *true, guessed={**measured.ROUGH_GUESSED, "contact.overtravel": 2e-4})
    assert all(holds(result, name, value) for name, value in true.items())
    assert any("contact.stiffness is 0.05" in note for note in result.notes)


RECORDS = ((0.01, 2e3, 0.05), (0.25, 1e4, 0.01), (1.0, 5e4, 0.001))
"""Lengths (s), rates (1/s) and scatters of ring-downs, each with 13 rows of force."""


@pytest.mark.parametrize(
    ("cell", "sets", "number"),
    [*((partial(of_record, each), 16, 12) for each in RECORDS), (of_rough_frequencies, 30, 6), (of_rough_curves, 4, 6)],
    ids=[*map(str, RECORDS), "rough frequencies", "rough curves"],
)
def test_intervals_of_a_parameter_hold_the_true_value(cell: Callable[[int], Array], sets: int, number: int) -> None:
    """A small form of `identification_coverage.py`, of so many parameters in all cells like it."""
    # What is not determined has no interval that could be wrong.
    inside = (~(np.abs([cell(seed) for seed in range(sets)]) > 1)).sum(axis=0)
    # Of all parameters one has fewer once in a thousand times, if intervals are right.
    assert (inside >= binom.ppf(1e-3 / number, sets, 0.95)).all(), inside


def rough_files(folder: Path, values: Array) -> tuple[Path, Path]:
    """Write frequencies over the overtravel, and the file of a relay with a rough contact; give their paths."""
    data, relay = folder / "frequency.csv", folder / "relay.toml"
    write_table(data, "overtravel [mm],frequency [Hz]", np.column_stack([1e3 * measured.OVERTRAVELS, values]), digits=9)
    relay.write_text("\n".join(f"parameters.{name} = {value!r}" for name, value in measured.ROUGH_GUESSED.items()))
    return data, relay


def test_the_frequency_of_a_rough_contact_is_that_of_the_exact_beam() -> None:
    (record_,) = measured.rough_frequency_record(SEED)
    predicted = Laboratory(COMPONENT).predict(record_, {**measured.ROUGH_GUESSED, **measured.ROUGH})
    # Both solve the same equations; roots to 1e-14, the force by the small difference of two deflections.
    assert predicted == pytest.approx(measured.rough_frequencies(), rel=1e-10)


def test_frequencies_over_the_overtravel_tell_the_law_of_a_rough_contact(tmp_path: Path) -> None:
    (record_,) = measured.rough_frequency_record(SEED)
    data, relay = rough_files(tmp_path, record_.values)
    result = found(data, relay=relay, parameters=list(measured.ROUGH), out=str(tmp_path / "found"))
    assert not result.missing
    written = Relay.read(tmp_path / "found/relay.toml", COMPONENT)
    (values,) = written.positions.values()
    for name, true in measured.ROUGH.items():
        assert holds(result, name, true)
        assert values[name] == pytest.approx(true, rel=written.parts(COMPONENT)[name])
    # Without names the law is sought too, as the file has a rough contact; what frequencies do not tell is said.
    result = found(data, relay=relay)
    assert {"beam.stiffnessDamping", "contact.damping"} <= set(result.missing)
    labels = {each.unknown.label for each in result.found}
    assert {"contact.stiffness", "contact.stiffnessExponent"} <= labels | set(result.missing)


def test_a_search_stays_within_what_is_allowed(tmp_path: Path) -> None:
    """The frequencies of a contact with a larger exponent than the component allows; and a start at the end."""
    steeper = {**measured.ROUGH, "contact.stiffnessExponent": 0.94}
    steep = np.array([measured.rough(each, steeper).frequency() for each in measured.OVERTRAVELS])
    for start in (0.5, 0.9):
        data, relay = rough_files(tmp_path, steep)
        relay.write_text(relay.read_text().replace("stiffnessExponent = 0.5", f"stiffnessExponent = {start}"))
        names, out = ["contact.stiffness", "contact.stiffnessExponent"], tmp_path / "found"
        result = found(data, relay=relay, parameters=names, out=out)
        # The search ends a thousandth before the end.
        assert result["contact.stiffnessExponent"].value == pytest.approx(0.9, rel=2e-3)
        # No value that `qualify` draws is beyond that end.
        exponent = Relay.read(out / "relay.toml", COMPONENT).uncertainty["contact.stiffnessExponent"]
        assert float(exponent.factor(np.array([4.0]), 0.9)[0]) * result["contact.stiffnessExponent"].value <= 0.9


def test_one_overtravel_does_not_tell_the_exponent(tmp_path: Path) -> None:
    (record_,) = measured.rough_frequency_record(SEED)
    data, relay = rough_files(tmp_path, record_.values[:1] * np.linspace(0.999, 1.001, len(measured.OVERTRAVELS)))
    lines = data.read_text().splitlines()
    head, rows = lines[0], [f"0.04,{line.split(',')[1]}" for line in lines[1:]]
    data.write_text("\n".join([head, *rows]) + "\n")
    result = found(data, relay=relay, parameters=["contact.stiffness", "contact.stiffnessExponent"])
    (reason,) = result.missing.values()
    assert "the data tell it only together with contact.stiffness" in reason
    data.write_text(head.replace("mm", "m") + "\n" + "\n".join(rows) + "\n")
    with pytest.raises(RelayContactError, match=r"column overtravel: 0.04 m: not allowed, allowed is up to 0.01 m"):
        found(data, relay=relay)


def asked(
    tmp_path: Path, measurements: list[Measurement], *parameters: str, guessed: Values = measured.GUESSED
) -> Identification:
    """Identify the relay of a record from near values: all that they are of, unless parameters are named."""
    relay = tmp_path / "relay.toml"
    relay.write_text("\n".join(f"parameters.{name} = {value!r}" for name, value in guessed.items()))
    paths: list[Path] = []
    for each in measurements:
        paths.append(tmp_path / f"{len(paths)}-{each.path}")
        over = {"static force": "travel", "ring-down": "time"}[each.kind]
        head = f"# calibration = {each.calibration}\n{over},{each.quantity}"
        write_table(paths[-1], head, np.column_stack([each.over, each.values]))
    return found(*paths, relay=relay, parameters=list(parameters or measured.RINGING))


@pytest.mark.parametrize("calibration", [0.005, 0.1])
def test_a_frequency_does_not_tell_a_stiffness_that_the_mass_leaves_open(tmp_path: Path, calibration: float) -> None:
    force, ring = measured.record(0.25, 1e4, 0.01, SEED)
    force = replace(force, calibration=calibration)
    alone, both = asked(tmp_path, [force]), asked(tmp_path, [force, ring])
    name = "beam.youngsModulus"
    # The ring-down tells two numbers of two further unknowns, mass and damping: of the stiffness nothing.
    assert both[name].half == pytest.approx(alone[name].half, rel=1e-3)
    # The force is in proportion to it, as it is to the error of the gauge.
    assert both[name].half > calibration
    assert "tip.mass" in alone.missing
    assert both["tip.mass"].half > both[name].half


def test_a_response_of_the_open_spring_does_not_tell_masses_and_stiffness(tmp_path: Path) -> None:
    """The motion relative to the frame stays the same where all three are larger by the same part."""
    spring = Reference({**measured.TRUTH, **measured.AWAY})
    frequency = np.linspace(150.0, 500.0, 15)
    chance = np.random.default_rng(SEED)
    gain = np.abs([spring.compliances(2 * np.pi * f, 0.0)[1] for f in frequency])
    rows = np.column_stack((frequency, np.ones(15), gain * np.exp(0.001 * chance.standard_normal(15))))
    data = tmp_path / "response.csv"
    write_table(data, "frequency,acceleration,displacement", rows, digits=17)
    names = ["beam.youngsModulus", "beam.density", "tip.mass"]
    result = found(data, parameters=[*names, "beam.stiffnessDamping"])
    assert len(result.missing.keys() & set(names)) == 1
    assert holds(result, "beam.stiffnessDamping", measured.TRUTH["beam.stiffnessDamping"])


def pole(values: Values) -> Array:
    """Return rate of decay and angular frequency of the slowest vibration, by the second solution."""
    spring = Reference(values)
    tip = spring.modes().tip
    found = spring.eigenvalues(spring.tangent * np.outer(tip, tip))
    slowest = min(found[found.imag > 0], key=abs)
    return np.array([-slowest.real, slowest.imag])


@pytest.mark.parametrize("is_open", [True, False])
def test_poles_and_responses_are_those_of_the_second_solution(is_open: bool) -> None:
    none, laboratory = np.zeros(1), Laboratory(COMPONENT)
    ring = Measurement(Path("ring.csv"), "ring-down", none, "force", "N", none, is_open=is_open)
    quantity = "displacement" if is_open else "force"
    swept = Measurement(Path("a.csv"), "frequency response", none, quantity, "", none, np.ones(5), is_open=is_open)
    chance = np.random.default_rng(SEED)
    for _ in range(20):
        values: Values = {
            "beam.stiffnessDamping": 10 ** chance.uniform(-6.5, -3.5), "beam.massDamping": 10 * chance.uniform(),
            "tip.mass": 10 ** chance.uniform(-6, -3.3), "beam.youngsModulus": 10 ** chance.uniform(10.8, 11.5),
            "contact.damping": 10 ** chance.uniform(-7, -4),
        }  # fmt: skip
        all_values = {**values, **(measured.AWAY if is_open else {})}
        expected, spring = pole(all_values), Reference(all_values)
        # A weak damping shows as a small change over the periods simulated, with the component's tolerance of 1e-10.
        assert laboratory.predict(ring, values) == pytest.approx(expected, rel=1e-5)
        over = np.hypot(*expected) / (2 * np.pi) * np.array([0.5, 0.9, 1.0, 1.5, 3.0])
        exact = [spring.compliances(2 * np.pi * f, 0.0)[1] if is_open else spring.force_response(f) for f in over]
        left = laboratory.predict(replace(swept, over=over), values) - np.abs(exact)
        # At the resonance its frequency, right to 1e-6 or so, counts by the quality, up to a thousand.
        assert np.abs(left).max() < 1e-3 * np.abs(exact).max()


def test_rounding_after_a_knock_does_not_grow() -> None:
    instants, chance = np.arange(64), np.random.default_rng(SEED)
    motion = np.exp(-0.01 * instants) * np.cos(0.8 * instants) + 1e-8 * chance.standard_normal(64)
    assert np.abs(exponentials(motion)[0]).max() <= 1 + 1e-12


def test_levels_of_chatter_are_those_of_the_second_solution() -> None:
    laboratory, level = Laboratory(COMPONENT), CLEAN["chatter"]
    data = Measurement(Path("level.csv"), "chatter level", measured.LEVELS, "level", "m/s2", level)
    assert laboratory.predict(data, {**measured.TRUTH}) == pytest.approx(level, rel=1e-4)
    # The stiffness of a rough contact falls with the force: near its resonance it opens a fifth above the linear one.
    rough = next(model for model in Relay.read("paper", COMPONENT).models if model.name == "rough contact")
    factors = laboratory.correction(replace(data, over=np.array([1000.0, 1200.0])), rough.parameters)
    assert 1.1 < factors.max() < 1.3
    # Above 100 g, too.
    tight = {**rough.parameters, "contact.overtravel": 2e-3}
    data = replace(data, over=np.array([1200.0, 1500.0, 2000.0]))
    assert laboratory.predict(data, tight).min() > 1e3
    assert np.abs(laboratory.correction(data, tight) - 1).min() > 1e-3
    # A spring leaves its pusher long before the contact is interrupted.
    pushed: Values = {"effects.pusher": "Prescribed", "contact.overtravel": -1e-4, "pusher.position": 12e-3,
                      "pusher.displacement": 2e-4, "beam.stiffnessDamping": 1e-5}  # fmt: skip
    data = replace(data, over=np.array([800.0]))
    touch = float((laboratory.predict(data, pushed) * laboratory.correction(data, pushed))[0])
    for part, interrupted in ((0.98, False), (1.02, True)):
        with COMPONENT.started({**pushed, **sine(800.0, part * touch, 0.05)}) as contact:
            contact.step(0.0, 0.07)
            assert (contact.get("chatter.count") > 0) == interrupted


@pytest.mark.parametrize(("damping", "beside"), [(2e-6, 1.0), (2e-9, 0.999)])
def test_a_response_is_that_after_all_the_periods_that_it_takes(damping: float, beside: float) -> None:
    values: Values = {**measured.TRUTH, **measured.AWAY, "beam.stiffnessDamping": damping}
    resonance = beside * np.array([pole(values)[1] / (2 * np.pi)])
    data = Measurement(
        Path("a.csv"), "frequency response", resonance, "displacement", "m", resonance, np.ones(1), is_open=True
    )
    exact = abs(Reference(values).compliances(2 * np.pi * resonance[0], 0.0)[1])
    # A quality of some 300, or 300,000; the frequency is that of the component to 1e-6 of it.
    assert Laboratory(COMPONENT).predict(data, values) == pytest.approx(exact, rel=1e-3)


@pytest.mark.filterwarnings("ignore::relay_contact.RelayContactWarning")
def test_data_that_do_not_agree_are_told(tmp_path: Path) -> None:
    force, ring = measured.record(0.25, 1e4, 0.01, SEED)
    stiffness, damping = "beam.youngsModulus", "beam.stiffnessDamping"
    over = np.linspace(-1e-4, 2e-4, 60)
    line = np.interp(over, force.over, measured.pressed())
    drift = 0.01 * np.sin(np.linspace(0, np.pi, 60))
    gauges = [replace(force, over=over, values=factor * line) for factor in (1.0, 1.05)]
    slip = np.arange(13) == 4
    # Beyond where the contact opens there is no force.
    beyond = np.append(-4e-4, force.over), np.append(0.0, force.values)
    for data, sought, told in (
        ([replace(force, over=over, values=line + drift)], [stiffness], "neighbouring residuals are alike"),
        (
            [replace(force, over=over[::10], values=(line + drift)[::10])],
            [stiffness],
            "neighbouring residuals are alike",
        ),
        (gauges, [stiffness], r"the instrument would have to show [+-]\S+ %, more than its 0.5 %"),
        ([ring, replace(ring, over=1.01 * ring.over)], [stiffness, damping], "frequency or rate of decay do not agree"),
        ([replace(force, calibration=0.0)], [stiffness], "its instrument is taken as exact"),
        ([replace(force, over=beyond[0], values=beyond[1])], [stiffness], "rows in which the contact is open tell"),
        ([replace(force, values=force.values + 0.05 * slip)], [stiffness], "its row 5 is 3.. times the scatter"),
    ):
        assert any(re.search(told, note) for note in asked(tmp_path, data, *sought).notes), told
    assert asked(tmp_path, [force], "contact.overtravel", stiffness).notes == []
    rubs: Values = {**measured.GUESSED, "effects.friction": "Coulomb"}
    (told,) = asked(tmp_path, [force], "contact.overtravel", stiffness, guessed=rubs).notes
    assert "without the friction of the relay's file" in told
    rows = np.transpose(np.broadcast_arrays(measured.FREQUENCY, 400.0, 20 * CLEAN["response"]))
    write_table(tmp_path / "strong.csv", "frequency [Hz],acceleration [m/s2],force [N]", rows)
    # Nine rows beside a resonance that overtravel, stiffness and rivet of the relay's file put elsewhere.
    alike, _, opens, *models = found(tmp_path / "strong.csv", parameters=[damping]).notes
    assert "neighbouring residuals are alike" in alike
    assert "the contact opens, at " in opens
    assert len(models) == 2
    assert all("keeps its own" in note for note in models)


def test_wrong_units_and_coarse_ring_downs_are_refused(tmp_path: Path) -> None:
    force, ring = measured.record(0.25, 1e4, 0.01, SEED)
    # At 400 rows per second 223 Hz look like 177 Hz; at 225 like 2 Hz.
    too_coarse, enough, coarse = (measured.record(0.25, rate, 0.01, SEED) for rate in (400.0, 225.0, 500.0))
    for wrong, message in (
        (
            # Of mN for cN, a little less by the scatter.
            [replace(force, values=9.9 * force.values)],
            "columns travel, force: stiffness .* are the units of the columns",
        ),
        ([replace(force, over=1e3 * force.over)], "column travel: -0.1 m: not allowed, allowed is up to 0.02 m"),
        ([replace(ring, over=1e3 * ring.over)], "column time: rings at 0.223 Hz, by the relay's file at 2.. Hz"),
        ([replace(force, values=-force.values)], "column force: negative in most rows"),
        ([replace(force, over=-force.over)], "column travel: the force falls as it rises"),
        (too_coarse, r"rings at 177 Hz, by the relay's file at 2\d\d Hz, with 400 rows per second: too"),
        (enough, "is 225 rows per second enough"),
        (coarse, "too coarse"),
        (
            measured.record(0.005, 1e4, 0.001, SEED),
            r"a record of 0.00\d+ s: not allowed, allowed is 0.00\d+ s or more",
        ),
    ):
        with pytest.raises(RelayContactError, match=message):
            asked(tmp_path, wrong)


def test_a_ring_down_alone_tells_damping_but_not_mass_and_stiffness(tmp_path: Path) -> None:
    ring = measured.files(tmp_path, measured.scattered(CLEAN, SEED))["ring"]
    names = ["beam.youngsModulus", "tip.mass", "beam.stiffnessDamping"]
    result = found(ring, parameters=names)
    (label,) = result.missing
    assert label in names[:2]
    assert "the data tell it only together with" in result.missing[label]
    # The spring is off its contact.
    nothing = found(ring, parameters=["contact.overtravel"])
    assert "the data hardly depend on it" in nothing.missing["contact.overtravel"]
    # Nor does one without any scatter.
    exact = asked(tmp_path, measured.record(0.25, 1e4, 0.0, SEED)[1:])
    assert len(exact.missing.keys() & set(names[:2])) == 1
    # With the true mass the frequency tells the stiffness: of a beam with a rivet, by the exact solution.
    relay = tmp_path / "relay.toml"
    relay.write_text(
        f"parameters.tip.mass = {measured.TRUTH['tip.mass']}\nuncertainty.tip.mass = 0.1\n"
        "uncertainty.contact.overtravel = 0.05\n"
        "correlation = { names = ['contact.overtravel', 'tip.mass'], matrix = [[1.0, 0.6], [0.6, 1.0]] }\n",
        encoding="utf-8-sig",
    )
    result = found(ring, relay=relay, parameters=names, out=tmp_path / "found")
    assert list(result.missing) == ["tip.mass"]
    assert holds(result, "beam.youngsModulus", measured.TRUTH["beam.youngsModulus"])
    # It is uncertain by as much as the mass that moves is: frequency 293 Hz, by 10 % of the rivet.
    stiff = {"beam.youngsModulus": measured.TRUTH["beam.youngsModulus"], **measured.AWAY}
    springs = (Reference({**stiff, "tip.mass": measured.TRUTH["tip.mass"] * part}) for part in (1, 1.1))
    squares = [each.modes().omega_squared.min() for each in springs]
    moved = float(np.log(squares[0] / squares[1]))
    assert result["beam.youngsModulus"].by_others["tip.mass"] == pytest.approx(moved, rel=0.05)
    assert result["beam.youngsModulus"].half > result["beam.youngsModulus"].by_others["tip.mass"]
    assert f"beam.youngsModulus: of its interval, tip.mass {100 * moved:.2g} % comes" in " ".join(silent(result))
    # `qualify` draws both from the written file: the frequency that was measured is that of each draw.
    written = Relay.read(tmp_path / "found" / "relay.toml", COMPONENT)
    drawn = list(written.uncertainty)
    root = written.correlation.root(drawn)
    assert (root @ root)[drawn.index("contact.overtravel"), drawn.index("tip.mass")] == pytest.approx(0.6)
    (values,) = written.positions.values()
    halves = [written.parts(COMPONENT)[name] for name in drawn]
    drawings: list[Values] = [
        {name: COMPONENT.value(values, name) * part for name, part in zip(drawn, 1 + row * halves / 1.96, strict=True)}
        for row in (np.zeros(len(drawn)), *root)
    ]  # fmt: skip
    springs = (Reference({**values, **each, **measured.AWAY}) for each in drawings)
    squares = [each.modes().omega_squared.min() for each in springs]
    # To the scatter of the record; by the mass alone it would be half of what moved.
    assert squares[1:] == pytest.approx([squares[0]] * len(drawn), rel=0.1 * moved)
    # And the other way around: what is known from elsewhere is not sought.
    relay.write_text(relay.read_text().replace("tip.mass", names[0]).replace(str(measured.TRUTH["tip.mass"]), "1.2e11"))
    assert list(found(ring, relay=relay, parameters=names).missing) == [names[0]]


def test_a_search_comes_back_from_a_spring_that_does_not_ring(tmp_path: Path) -> None:
    sheet: Values = {
        "beam.length": 14e-3, "beam.width": 6e-3, "beam.thickness": 0.2e-3, "beam.density": 8800.0,
        "contact.curvatureRadius": 5e-3, "contact.damping": 4e-6,
    }  # fmt: skip
    guessed = dict(zip(measured.TRUTH, (0.25e-3, 1.2e11, 30e-6, 4e-6), strict=True))
    # The damping of the drawing is a guess.
    true = {name: value * part for (name, value), part in zip(guessed.items(), (1.0, 1.4, 0.65, 2.6), strict=True)}
    chance, travel, time = np.random.default_rng(2), np.linspace(-0.15e-3, 0.15e-3, 13), np.arange(2e-3, 52e-3, 5e-5)
    overtravel = true["contact.overtravel"]
    force = np.array([Reference({**sheet, **true, "contact.overtravel": overtravel + each}).force for each in travel])
    force += 5e-4 * chance.standard_normal(len(force))
    motion = measured.deflection({**sheet, **true}, time)
    motion += 0.004 * np.abs(motion).max() * chance.standard_normal(len(time))
    data = [
        Measurement(Path("force.csv"), "static force", travel, "force", "N", force),
        Measurement(Path("ring.csv"), "ring-down", time, "displacement", "m", motion, is_open=True),
    ]
    names = ["contact.overtravel", "beam.youngsModulus", "beam.stiffnessDamping", "contact.damping", "tip.mass"]
    result = asked(tmp_path, data, *names, guessed={**sheet, **guessed})
    assert list(result.missing) == ["contact.damping"]
    assert all(abs(np.log(result[name].value / value)) < 2 * result[name].half for name, value in true.items())


def test_a_relay_that_does_not_ring_is_refused(tmp_path: Path) -> None:
    guessed = {**measured.GUESSED, "beam.stiffnessDamping": 1e-2}
    with pytest.raises(RelayContactError, match="ring-down: with the parameters of the relay's file nothing rings"):
        asked(tmp_path, measured.record(0.1, 1e4, 0.001, SEED), guessed=guessed)


def test_bounces_tell_the_damping_of_the_contact(tmp_path: Path) -> None:
    true, speeds = 2e-6, np.array([0.03, 0.04, 0.05, 0.06, 0.08])
    lengths = []
    for speed in speeds:
        relay = Reference({"contact.damping": true, "contact.overtravel": -1e-6})
        stop = 1e-6 / speed + 6e-5
        changes = relay.course(np.array([0.0, stop]), speed=speed).changes
        lengths.append(changes["contact", "closes"][1] - changes["contact", "leaves"][0])
    noise = np.exp(0.02 * np.random.default_rng(SEED).standard_normal(len(speeds)))
    data = tmp_path / "bounce.csv"
    rows = [f"{1e3 * speed};{1e6 * length}" for speed, length in zip(speeds, lengths * noise, strict=True)]
    # Another separator, and a comma in the numbers.
    data.write_text("speed [mm/s];bounce [us]\n" + "\n".join(rows).replace(".", ",") + "\n")
    # With the damping in the file, 80 us, the contact does not bounce at all.
    result = found(data, parameters=["contact.damping"])
    assert holds(result, "contact.damping", true)
    # Five lengths with a scatter of 2 %.
    assert result["contact.damping"].half < 0.2


def test_an_instrument_that_may_be_wrong_widens_the_intervals(tmp_path: Path) -> None:
    values = measured.scattered(CLEAN, SEED)
    path = measured.files(tmp_path, {**values, "force": 1.015 * values["force"]})["force"]
    names = ["beam.youngsModulus"]
    relay = tmp_path / "relay.toml"
    relay.write_text(f"parameters.contact.overtravel = {measured.TRUTH['contact.overtravel']}\n")
    result = found(path, relay=relay, parameters=names)
    assert not holds(result, names[0], measured.TRUTH[names[0]])
    # The regression of a force in proportion to the stiffness, to the digits of the file.
    force, line = 1.015 * values["force"], CLEAN["force"]
    left = force - line * (force @ line) / (line @ line)
    half = t.ppf(0.975, len(line) - 1) * np.sqrt(left @ left / (len(line) - 1) * (line @ line)) / (force @ line)
    assert result[names[0]].half == pytest.approx(half, rel=2e-3)
    path.write_text("# calibration = 0.02\n" + path.read_text())
    result = found(path, relay=relay, parameters=names)
    assert holds(result, names[0], measured.TRUTH[names[0]])
    # The gauge is wrong by 2 % with 95 % confidence, and the force is in proportion to the stiffness; scatter adds.
    assert result[names[0]].half == pytest.approx(0.02, rel=0.15)


def test_an_uncertain_spring_of_the_fixed_contact_widens_the_interval(tmp_path: Path) -> None:
    """The force goes with Young's modulus of both springs, and with the cube of the thickness of one."""
    strip, relay, data = (tmp_path / name for name in ("strip.toml", "relay.toml", "force.csv"))
    strip.write_text("[[segment]]\nlength = 0.01\nwidth = 4e-3\nthickness = 3e-4\n")
    relay.write_text(
        "parameters.fixed.file = 'strip.toml'\nuncertainty.fixed.spring.thickness = 0.02\n"
        "[[model]]\n[[model]]\nparameters.beam.file = 'strip.toml'\n"
    )
    rows = []
    for travel in np.linspace(-1e-4, 1e-4, 5):
        values: Values = {"fixed.file": str(strip), "contact.overtravel": 2e-4 + travel}
        force, moving, fixed = resting(values, "contact.force", "tip.displacement", "fixed.displacement")
        rows.append((travel, force))
    write_table(data, "travel,force", rows)
    # Each parameter is sought once.
    out = tmp_path / "found"
    whole = found(data, relay=relay, parameters=["beam.youngsModulus", "beam_youngsModulus"], out=out)
    assert not whole.missing
    # Springs that are as they were are where they were.
    written = Relay.read(out / "relay.toml", COMPONENT)
    for own, name in ((written.positions["position 1"], "fixed.file"), (written.models[1].parameters, "beam.file")):
        assert Path(str(own[name])).resolve() == strip.resolve()
    result = whole["beam.youngsModulus"]
    assert result.value == pytest.approx(COMPONENT.value({}, "beam.youngsModulus"), rel=1e-6)
    share = fixed / (fixed - moving)
    assert result.by_others["fixed.spring.thickness"] == pytest.approx(3 * 0.02 * share, rel=0.01)
    assert not any("`qualify`" in note for note in whole.notes)
    # So uncertain that it is refused: the force goes with the cube of the length.
    relay.write_text("uncertainty.beam.length = 0.5\n" + relay.read_text())
    told = "beam.youngsModulus is known to ± 122 %, by what others leave open: `qualify` takes less than 100 %"
    assert told in found(data, relay=relay, parameters=["beam.youngsModulus"]).notes


def test_each_position_has_its_overtravel(tmp_path: Path) -> None:
    """The force of a spring on a stiff contact is in proportion to the overtravel."""
    paths, file = [], tmp_path / "relay.toml"
    text = (ROOT / "relays/cube-changeover.toml").read_text().replace("../scenes", str(ROOT / "scenes"))
    # The axial force from the deflection would soften the spring by some thousandths.
    file.write_text(text.replace("[parameters]", '[parameters]\neffects.axialForce = "None"'))
    true = {"coil without current": 8.4e-4, "coil energised": 5.8e-4}
    relay = Relay.read(file, COMPONENT)
    for number, (position, overtravel) in enumerate(true.items()):
        values = {**relay.positions[position], "contact.overtravel": 1e-3}
        force, indentation = resting(values, "preload.force", "preload.indentation")
        stiffness = force / (1e-3 - indentation)
        travel = np.linspace(-2e-4, 2e-4, 5)
        paths.append(tmp_path / f"{number}.csv")
        rows = np.column_stack([travel, stiffness * (overtravel + travel - indentation)])
        write_table(paths[-1], f"# position = {position}\ntravel,force", rows)
    out = tmp_path / "found"
    result = found(*paths, relay=file, parameters=["contact.overtravel", "spring.stiffness"], out=out)
    written = Relay.read(out / "relay.toml", COMPONENT)
    for position, overtravel in true.items():
        # The Hertz contact yields by less than the indentation at the larger preload, 0.13 um.
        assert result[f"contact.overtravel, {position}"].value == pytest.approx(overtravel, abs=2e-7)
        assert written.positions[position]["contact.overtravel"] == pytest.approx(overtravel, abs=2e-7)
        # The spring lies beside the file, as it was found.
        assert Path(str(written.positions[position]["beam.file"])).parent.resolve() == out.resolve()
    assert result["spring.stiffness"].value == pytest.approx(1.0, abs=1e-3)
    assert written.uncertainty["contact.overtravel"] != relay.uncertainty["contact.overtravel"]
    # What is known of one position is not known of the other.
    result = found(paths[1], relay=file, parameters=["contact.overtravel"], out=out)
    assert result.notes[-1].startswith("contact.overtravel: in the position coil without current it is that of the")
    written = Relay.read(out / "relay.toml", COMPONENT)
    assert written.uncertainty["contact.overtravel"] == relay.uncertainty["contact.overtravel"]
    # A model that names its spring keeps it as it was.
    other = f"[[model]]\nparameters.beam.file = '{ROOT}/scenes/springs/tapered-cube.toml'\n"
    file.write_text(f"{file.read_text()}\n{other}")
    *_, told = found(*paths, relay=file, parameters=["contact.overtravel", "spring.stiffness"], out=out).notes
    assert "the model 'model 4' of the relay's file keeps its own beam.file" in told
    paths[0].write_text(paths[0].read_text().split("\n", 1)[1])
    with pytest.raises(RelayContactError, match=r"0.csv:1: which position of the coil"):
        found(*paths, relay=file)


STRIP: Values = {
    "beam.length": 18e-3, "beam.width": 5e-3, "beam.thickness": 0.22e-3, "beam.youngsModulus": 1.1e11,
    "contact.curvatureRadius": 4e-3,
}  # fmt: skip
HERTZ = 4 / 3 / ((1 - 0.33**2) / 86e9 + (1 - 0.34**2) / 81.92e9) * 4e-3**0.5


def pressed_strip(over: Array, force: Callable[[float, float, float], float], folder: Path) -> Path:
    """Write the relay of STRIP, and a static force over travel: where `force`, by compliance and travel, vanishes."""
    compliance = 18e-3**3 / (3 * 1.15e11 * 5e-3 * 0.22e-3**3 / 12)
    rows = [(each, brentq(force, 1e-9, 100.0, args=(compliance, each), xtol=1e-15)) for each in over]
    write_table(folder / "force.csv", "# position = on\ntravel,force", np.array(rows), digits=12)
    text = "\n".join(f"parameters.{name} = {value!r}" for name, value in STRIP.items())
    (folder / "relay.toml").write_text(f"{text}\n[[position]]\nname = 'on'\n[[position]]\nname = 'off'\n")
    return folder / "force.csv"


def test_a_gauge_at_the_fixed_contact_shows_the_force_of_both_twin_contacts(tmp_path: Path) -> None:
    def vanishes(force: float, compliance: float, over: float) -> float:
        return float(4e-4 + over - force * compliance - (force / 2 / HERTZ) ** (2 / 3))

    data, relay = pressed_strip(np.linspace(-2e-4, 2e-4, 6), vanishes, tmp_path), tmp_path / "relay.toml"
    twins = ("effects.parallelContact = true", "parallel.curvatureRadius = 4e-3", "contact.overtravel = 4e-4")
    relay.write_text("".join(f"parameters.{each}\n" for each in twins) + relay.read_text())
    result = found(data, relay=relay, parameters=["beam.youngsModulus"])
    assert result["beam.youngsModulus"].value == pytest.approx(1.15e11, rel=1e-6)
    # The stiffness of a spring file whose segments have the modulus of the relay is written, too.
    (tmp_path / "strip.toml").write_text("[[segment]]\nlength = 18e-3\nwidth = 5e-3\nthickness = 0.22e-3\n")
    relay.write_text(f"parameters.beam.file = 'strip.toml'\n{relay.read_text()}")
    result = found(data, relay=relay, parameters=["spring.stiffness"], out=tmp_path / "found")
    assert result["spring.stiffness"].value == pytest.approx(1.15 / 1.1, rel=1e-6)
    written = Relay.read(tmp_path / "found/relay.toml", COMPONENT).positions["on"]
    uniform: Values = {**written, "beam.file": "", "beam.youngsModulus": 1.15e11}
    assert resting(written, "contact.force") == pytest.approx(resting(uniform, "contact.force"), rel=1e-6)


def test_a_contact_that_a_pusher_closes_is_identified_by_its_negative_overtravel(tmp_path: Path) -> None:
    part, pushed, stiffness = 12 / 18, 0.92e-3, 2e5

    def vanishes(force: float, compliance: float, over: float) -> float:
        across, own = part**2 * (3 - part) / 2 * compliance, part**3 * compliance
        pusher = (pushed + across * force) / (1 / stiffness + own)
        return float(-1.4e-3 + over - (compliance * force - across * pusher) - (force / HERTZ) ** (2 / 3))

    data = pressed_strip(np.linspace(-1e-4, 2e-4, 6), vanishes, tmp_path)
    relay, ring = tmp_path / "relay.toml", tmp_path / "ring.csv"
    text = f"parameters.contact.overtravel = -1.45e-3\n{relay.read_text()}"
    for name, place in (("on", pushed), ("off", -4e-3)):
        text = text.replace(f"'{name}'\n", f"'{name}'\nparameters.pusher.displacement = {place}\n")
    relay.write_text(f"{text}[pusher]\nposition = 12e-3\nstiffness = {stiffness}\n")
    result = found(data, relay=relay, parameters=["contact.overtravel", "beam.youngsModulus"])
    assert result["contact.overtravel"].value == pytest.approx(-1.4e-3, rel=1e-6)
    assert result["beam.youngsModulus"].value == pytest.approx(1.15e11, rel=1e-6)
    low, high = result["contact.overtravel"].interval
    assert low <= result["contact.overtravel"].value <= high
    # What the table of the pusher has stays there.
    truth = tmp_path / "truth.toml"
    text = relay.read_text().replace("1.45e-3", "1.4e-3").replace("110000000000.0", "1.15e11")
    truth.write_text(text.replace("12e-3", "12.1e-3"))
    found(data, relay=truth, parameters=["pusher.position"], out=tmp_path / "found")
    written = Relay.read(tmp_path / "found/truth.toml", COMPONENT)
    assert written.positions["on"]["pusher.position"] == pytest.approx(12e-3, rel=1e-5)
    # A pusher that touches the lifted spring changes what rings.
    write_table(ring, "time,displacement", np.column_stack([np.arange(20), np.sin(np.arange(20))]))
    with pytest.raises(RelayContactError, match=r"ring.csv:1: which position of the coil"):
        found(ring, relay=relay)
    # So do frequencies over the overtravel, and a bounce, for which the spring would come from where it is free.
    for names, own in (("overtravel,frequency", (1e-4, 1e3)), ("speed,bounce", (0.05, 1e-4))):
        write_table(ring, f"# position = on\n{names}", np.tile(own, (5, 1)))
        with pytest.raises(RelayContactError, match="in the position on a pusher or gravity closes the contact"):
            found(ring, relay=relay, parameters=["beam.youngsModulus"])


@pytest.mark.parametrize(
    "text",
    [
        "[parameters]\nbeam.width = 1.0\nbeam.thickness = 1.0  # of a sheet\nbeam.length = 1.0\ntip.mass = 1.0\n",
        "[parameters]\nbeam.width = 1.0\ntip.mass = 1.0\n# of a sheet\nbeam.length = 1.0\n",
        "parameters.beam.width = 1.0\ntitle = 'a'\nparameters.tip.mass = 1.0\n[[position]]\nname = 'a'\n",
        "[parameters.beam]\nwidth = 1.0\n[uncertainty]\ntip.mass = 0.1\n[parameters.tip]\nmass = 1.0\n",
        "parameters = { beam = { width = 1.0 }, tip = { mass = 1.0 } }\n",
        "parameters = { beam.width = 1.0, tip.mass = 1.0, beam.length = 1.0 }\n",
        "[parameters]\n'beam.width' = 1.0\n'tip.mass' = 1.0\n",
    ],
)
def test_values_are_put_into_a_file_however_its_lines_are_ordered(text: str) -> None:
    def named(text: str) -> list[tuple[str, Any]]:
        return [(name, value) for name, _, value in leaves(tomllib.loads(text))]

    content: Any = tomlkit.parse(text)
    expected = dict(named(text))
    for name, value in (("tip.mass", 2.0), ("beam.density", 3.0), ("contact.damping", 4.0), ("beam.width", 5.0)):
        put(content["parameters"], name, tomlkit.value(str(value)), "identified")
        expected[f"parameters.{name}"] = value
    written = tomlkit.dumps(content)
    # Each once, too.
    assert sorted(named(written)) == sorted(expected.items())
    assert written.count("# of") == text.count("# of")


def test_an_identification_of_unknown_parameters_is_refused(tmp_path: Path) -> None:
    data = measured.files(tmp_path, CLEAN)["force"]
    for asked, message in (
        ({"parameters": ["tip.mas"]}, "tip.mas: no such variable; did you mean tip.mass"),
        ({"parameters": ["spring.thickness"]}, "spring.thickness: no such entry in the spring file"),
        # Which would be written nowhere.
        ({"parameters": ["spring.stiffness"]}, "spring.stiffness: no such entry in the spring file.*youngsModulus"),
        ({"parameters": ["fixed.spring.stiffness"]}, "fixed.spring.stiffness: of the spring of the fixed contact: not"),
        ({"parameters": ["beam.massDamping"]}, "beam.massDamping = 0 in the relay's file: not allowed"),
        ({"relay": ROOT / "none.toml"}, "no such file, and no relay of this name"),
    ):
        with pytest.raises(RelayContactError, match=message):
            found(data, **asked)
    with pytest.raises(RelayContactError, match=r"none.csv: no such file"):
        found(tmp_path / "none.csv")
    (tmp_path / "copy.csv").write_bytes(data.read_bytes())
    for twice in (data, tmp_path / "copy.csv"):
        with pytest.raises(RelayContactError, match=f"{twice.name}: the same data as .*force.csv: not allowed"):
            found(data, twice)
    open_relay = tmp_path / "open.toml"
    text = (ROOT / "relays/paper.toml").read_text().replace("contact.overtravel = 0.2e-3", "contact.overtravel = -1e-4")
    open_relay.write_text(text)
    closed = measured.files(tmp_path, CLEAN)["response"]
    with pytest.raises(RelayContactError, match=r"the contact is open \(contact.overtravel = -0.0001 m\): not allowed"):
        found(closed, relay=open_relay, parameters=["tip.mass"])
