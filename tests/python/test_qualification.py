"""`qualify` against closed forms, the exact linear beam and finite elements; what a kill may not change."""

import re
import tomllib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from distributed import LocalCluster
from scipy.linalg import block_diag
from scipy.optimize import brentq

from component import COMPONENT, ROOT, resting
from elements import Part, assembled
from qualified import described, judged, placed
from reference import Reference
from relay_contact import Array, RelayContactError, Values, pages
from relay_contact.command import main
from relay_contact.component import sine as vibration
from relay_contact.qualification import FEW, Relay, Standard, assessment, judgement, plots, qualify, response, standards
from relay_contact.qualification.distributions import Correlation, Distribution
from relay_contact.qualification.excitation import Random, Shock, Sine
from relay_contact.qualification.page import form, springs, write
from relay_contact.qualification.response import interrupting_force, respond
from relay_contact.qualification.results import Assessment, Chance, Finding, Tested
from relay_contact.qualification.trials import Specimen, steady
from relay_contact.qualification.words import contributions, rows

G = 9.80665
PUBLISHED: Values = {"effects.axialForce": "FromPreload"}
SPECIMEN = Reference(PUBLISHED)
MODELS = {model.name: model.parameters for model in Relay.read("paper", COMPONENT).models}
ROUGH = Reference({**PUBLISHED, **MODELS["rough contact"]})
MILITARY = Standard.read("MIL-PRF-28776")
SINE = next(test for test in MILITARY.tests if isinstance(test, Sine))
RANDOM = next(test for test in MILITARY.tests if isinstance(test, Random))


def largest_dip(frequency: Array, gains: list[complex], chance: float = 0.5) -> float:
    """Return what is exceeded within 15 min of RANDOM with a chance, of gains by frequency.

    By Rice, with the clumps of E. H. Vanmarcke, Journal of Applied Mechanics 42 (1975) 215.
    """
    density = RANDOM.spectrum(frequency) * np.abs(gains) ** 2
    power, first, second = (np.trapezoid(density * frequency**order, frequency) for order in range(3))
    width = np.sqrt(1 - first**2 / (power * second))

    def expected(dip: float) -> float:
        return float(900 * np.sqrt(second / power) * np.exp(-(dip**2) / 2)
                     * (1 - np.exp(-np.sqrt(2 * np.pi) * width**1.2 * dip)))  # fmt: skip

    return float(np.sqrt(power) * brentq(lambda dip: expected(dip) + np.log1p(-chance), 1.0, 10.0))


@pytest.fixture(scope="module")
def paper(tmp_path_factory: pytest.TempPathFactory) -> Assessment:
    """Test the published relay as MIL-PRF-28776F asks."""
    out = tmp_path_factory.mktemp("paper")
    wanted = ["sine", "random", "213 A"]
    return qualify("paper", "MIL-PRF-28776", out=out, tests=wanted, quick=True, component=COMPONENT)


def test_levels_of_standards() -> None:
    """The corner of the sine sweep, and each rms as its standard prints it."""
    assert SINE.corner == pytest.approx(54.9, abs=0.05)
    frequency = np.linspace(1, 3000, 300_000)
    for name in standards():
        for test in Standard.read(name).tests:
            if isinstance(test, Random):
                power = np.trapezoid(test.spectrum(frequency), frequency)
                # Printed with three or four digits; that of NAVMAT with one.
                printed = 0.011 if name.startswith("NAVMAT") else 3e-3
                assert np.sqrt(power) / G == pytest.approx(test.rms, rel=printed), (name, test.name)
    assert np.sqrt(RANDOM.spectrum(np.array([300.0])))[0] / G == pytest.approx(0.4**0.5)


@pytest.mark.parametrize("specimen", [SPECIMEN, ROUGH], ids=["Hertz", "Rough"])
def test_the_response_is_that_of_the_exact_beam(specimen: Reference) -> None:
    found = respond(COMPONENT, {name: specimen.values[name] for name in (*PUBLISHED, *MODELS["rough contact"])}, 600.0)
    for frequency in (20.0, 300.0, 1000.0, 1250.0, 1355.0, 2000.0, 2900.0):
        at = int(np.argmin(np.abs(found.frequency - frequency)))
        exact = specimen.force_response(float(found.frequency[at]))
        # What the steps of 10 us fold back from around 100, 200, 300 kHz, relative to the spectrum of the pulse here.
        aliases = [number * 1e5 + sign * frequency for number in (1, 2, 3) for sign in (-1, 1)]
        folded = sum(abs(specimen.force_response(f)) * np.sinc(f * 1e-5) ** 2 for f in aliases)
        # The pulse changes the force by up to 3e-4 of the preload, in which the contact is linear to 1e-5 at resonance.
        assert abs(found.transfer[at] - exact) < 1.1 * folded + 1e-5 * abs(specimen.force_response(1250.0)), frequency


def test_sine_like_the_exact_beam(paper: Assessment) -> None:
    tested = paper["vibration (sine)"]
    part = tested.margin
    preload = SPECIMEN.force
    exact = min(preload / abs(SPECIMEN.force_response(f)) / G for f in np.arange(1100, 1300, 1.0))
    # A sine is below zero for 10 us where it is (10 us omega)^2 / 8 = 7e-4 higher than one that touches it; Hertz's
    # stiffness changes with the force; 1e-4 for the bisection.
    assert exact * (1 - 6e-4) < 30 * part.margin < exact * (1 + 7e-4 + 6e-4)
    assert 1150 < float(part.weakest.split()[0]) < 1230
    # The band of half of its power, and the time at each octave over that in which a vibration decays by a factor e.
    near = np.arange(500.0, 2500.0)
    gains = np.abs([SPECIMEN.force_response(f) for f in near])
    width = np.ptp(near[gains > gains.max() / np.sqrt(2)])
    words = r"resonance, (\S+) Hz wide.* crosses it in over (\S+) decay times"
    ((told, crossed),) = re.findall(words, tested.first.limits)
    assert float(told) == pytest.approx(width, rel=0.02)
    assert float(crossed) < np.log2(1 + width / 1190) / SINE.rate * 60 * np.pi * width
    curves = part.curves
    columns = curves["frequency"], curves["level"], curves["least"]["closed contact"]
    for frequency, level, least in zip(*columns, strict=True):
        expected = preload - abs(SPECIMEN.force_response(frequency)) * level
        if expected > 0.05 * preload:
            # Hertz's stiffness changes with the force; the spring feels 1/4655 of it.
            assert least == pytest.approx(expected, abs=1e-3 * preload), frequency
    # A second solution, vibrated for nine periods: of the start, 1e-9 is left.
    frequency = curves["frequency"][int(np.argmax(curves["length"]["closed contact"]))]
    stop = 9 / frequency
    shaken = Reference({**PUBLISHED, **vibration(frequency, 30 * G)})
    changes = shaken.course(np.array([0.0, stop]), limit=SPECIMEN.force_of_resistance(600.0)).changes
    opened, closed = (changes["contact", way] for way in ("falls", "rises"))
    assert part.failed["closed contact"] == pytest.approx(closed[-1] - opened[len(closed) - 1], rel=2e-3)
    # The parameters are known to some per cent: a margin that differs from 1 by less decides nothing.
    assert tested.verdict == "undecided"
    assert part.chance
    # The preload is the stiffness times the overtravel, to the indentation.
    assert part.chance.effects["contact.overtravel"] == pytest.approx(0.0033, rel=0.01)
    # The ends are known to 5 % by the number of draws.
    assert part.high - part.low == pytest.approx(2 * np.hypot(0.0033, 0.0225) * part.margin, rel=0.05)


def test_a_rough_contact_opens_where_the_second_solution_does(paper: Assessment) -> None:
    """Its stiffness falls with the force: it opens at a level 20 % above that of the linear contact."""
    part = next(each for each in paper["vibration (sine)"].models if each.model == "rough contact").margin
    assert part.linear < 0.85 * part.margin
    frequency = float(part.weakest.split()[0])
    end = 14 / frequency

    def least(factor: float) -> float:
        level = 30 * G * part.margin * factor

        def base(time: float) -> float:
            return level * min(1.0, time * frequency / 6) * float(np.sin(2 * np.pi * frequency * time))

        times = np.append(0.0, np.linspace(end - 2 / frequency, end, 1000))
        return float(ROUGH.course(times, base).forces["contact"][1:].min())

    # 1 % either way: an interruption of 10 us begins 0.1 % above the first opening, and the file rounds the frequency.
    assert least(0.99) > 1e-3 * ROUGH.force
    assert least(1.01) < 1e-6 * ROUGH.force
    # At frequencies beside it, the component stays closed at this level.
    values: Values = {**PUBLISHED, **MODELS["rough contact"]}
    limits = MILITARY.contacts
    specimen = Specimen(COMPONENT, values, limits, respond(COMPONENT, values, limits.threshold))
    for beside in (0.95, 0.975, 1.025, 1.05):
        assert not steady(specimen, beside * frequency, 0.997 * 30 * G * part.margin, True)[0]


def test_friction_hardly_changes_what_opens_a_contact_slowly(paper: Assessment) -> None:
    """It vanishes with the force, so that the contact opens at the acceleration that takes the preload without it."""
    first, *_, rubs = paper["shock, 213 A"].models
    assert rubs.model == "with friction"
    # The pulse is slow, 45 of 1355 Hz: beside it the spring's own vibration, of 3 %, is the only difference.
    assert rubs.margin.margin == pytest.approx(first.margin.margin, rel=0.01)
    page = (paper.folder / "qualification.html").read_text(encoding="utf-8")
    for text in ("Hertzian contact of smooth bodies", "the power 0.617 of the force", "friction of 0.2", "4 models"):
        assert text in page


def test_random_by_rice_on_the_exact_beam(paper: Assessment) -> None:
    tested = paper["vibration (random), 214 G"]
    part = tested.margin
    frequency = np.linspace(50.0, 2000.0, 400)
    dip = largest_dip(frequency, [SPECIMEN.force_response(f) for f in frequency])
    # Of the linear theory; the response is right to 1e-3, 10 us add (pi 1e-5 mean)^2 / 2 = 5e-4.
    assert part.linear == pytest.approx(SPECIMEN.force / dip, rel=3e-3)
    # Of the rms, which is told, by Rice for a mean frequency of 500 to 1500 Hz.
    told = float(tested.first.limits.rpartition("its rms is ")[2].split()[0])
    assert dip / SPECIMEN.force / told == pytest.approx(5.3, abs=0.1)
    # The component itself, which simulates the dips: the contact is linear until it opens.
    assert part.margin == pytest.approx(part.linear, rel=5e-3)
    assert tested.verdict == "FAIL"
    assert list(part.failed) == part.decides == ["closed contact"]


def test_shock_like_a_spring_without_vibration(paper: Assessment) -> None:
    tested = paper["shock, 213 A"]
    part = tested.margin
    # The pulse has 45 Hz, the spring 1355 Hz: its own vibration, 45/1355 of the peak at first, dies away.
    assert part.margin == pytest.approx(SPECIMEN.force / (SPECIMEN.carried_mass * 50 * G), rel=0.01)
    assert part.weakest == "opening direction"
    assert tested.verdict == "FAIL"


def by_elements(values: Any, contact: float) -> Callable[[float], complex]:  # noqa: ANN401
    """Return what gives the contact force (N) per base acceleration (m/s2) at a frequency (Hz).

    Of the spring of a file by finite elements, 0.1 mm each, with a contact of a linear stiffness (N/m).
    """
    file, size = tomllib.loads(Path(values["beam.file"]).read_text()), 1e-4
    parts: list[Part] = []
    for segment in file["segment"]:
        number = round(segment["length"] / size)
        begin, end = (segment.get(f"width_{end}", segment.get("width")) for end in ("start", "end"))
        widths = np.linspace(begin, end, number + 1)
        for area in (widths[1:] + widths[:-1]) / 2 * segment["thickness"]:
            bending = segment["youngs_modulus"] * area * segment["thickness"] ** 2 / 12
            parts.append((len(parts), len(parts) + 1, bending, segment["density"] * area, size))
    stiffness, mass = assembled(len(parts) + 1, parts)
    for each in file["mass"]:
        place = 2 * round(each["position"] / size)
        mass[place : place + 2, place : place + 2] += block_diag(each["mass"], each["rotary_inertia"])
    at = 2 * round(file["contact_position"] / size)
    mass[at, at] += values["tip.mass"]
    stiffness[1, 1] += file["clamp_stiffness"]
    carried = mass[:, ::2].sum(axis=1)

    def force(frequency: float) -> complex:
        omega = 2 * np.pi * frequency
        spring = contact * (1 + 1j * omega * values["contact.damping"])
        matrix = stiffness * (1 + 1j * omega * values["beam.stiffnessDamping"]) - omega**2 * mass
        matrix[at, at] += spring
        # The clamp holds the deflection.
        return complex(-spring * np.linalg.solve(matrix[1:, 1:], -carried[1:])[at - 1])

    return force


def test_margins_of_a_spring_of_segments_by_finite_elements(tmp_path: Path) -> None:
    relay = Relay.read("cube-changeover", COMPONENT)
    relay = replace(relay, models=relay.models[:1])
    parts = judged(relay, tmp_path, *assessment.chosen(MILITARY, ["213 C"]).tests)
    assert list(relay.positions) == ["coil without current", "coil energised"]
    assert [each.first.position for each in parts] == list(relay.positions)
    for tested, values in zip(parts, relay.positions.values(), strict=True):
        part = tested.margin
        assert part.chance
        preload, stiffness = resting(values, "preload.force", "preload.contactStiffness")
        force = by_elements(values, stiffness)
        frequency, factors = respond(COMPONENT, values, 600.0).sine(SINE, 0.0)
        near = float(frequency[factors.argmin()])
        exact = min(preload / (30 * G * abs(force(f))) for f in near + np.arange(-6.0, 6.1, 1.0))
        assert factors.min() == pytest.approx(exact, rel=5e-3)
        # A slow shock: the force that holds the spring and what it carries against the acceleration.
        slow = preload / (100 * G * abs(force(1.0)))
        assert part.margin == pytest.approx(slow, rel=0.02)
        assert tested.verdict == "pass"
        assert part.chance.effects["contact.overtravel"] == pytest.approx(0.05, rel=0.01)
        # Of a rivet that is known to 2 %, and lowers the margin.
        heavier = by_elements({**values, "tip.mass": 1.01 * COMPONENT.value(values, "tip.mass")}, stiffness)
        assert part.chance.effects["tip.mass"] == pytest.approx(2 * abs(heavier(1.0) / force(1.0)) - 2, rel=0.05)


def test_margins_over_the_overtravel(paper: Assessment) -> None:
    for tested in paper:
        part = tested.margin
        overtravel, margins = (np.array(part.wear[name]) for name in ("overtravel", "margin"))
        assert part.margin == pytest.approx(np.interp(part.overtravel, overtravel, margins), rel=1e-9)
        # The preload is in proportion to the overtravel, to the indentation of 64 nm in 0.2 mm; the stiffness of the
        # contact, which falls with it, is felt to 1/4655.
        assert margins == pytest.approx(part.margin * overtravel / part.overtravel, rel=3e-3)
        if part.passes is not None:
            assert part.passes == pytest.approx(part.overtravel / part.low, rel=5e-3)


def test_page_and_tables_show_verdict_and_margins(paper: Assessment) -> None:
    page = (paper.folder / "qualification.html").read_text(encoding="utf-8")
    assert f"{MILITARY.title}: <b>2 FAIL, 1 undecided, 2 not run</b>" in page
    assert "Tests of the standard that were not run: shock, 213 B; shock, 213 C." in page
    # Margins, sketch, sweeps, random vibration, shock, overtravel.
    assert page.count("<svg") == 6
    assert "4.8.10.2; shape of MIL-STD-202 method 214, from memory" in page
    assert "rms, duration read in the standard; density from memory" in page
    assert "its resistance exceeds 600 Ω, at which it takes half of a monitor&#39;s 6 V; an open one" in page
    assert "interrupted for 10.0 µs or more" in page
    assert "conducts better than that for 1.00 µs or more" in page
    assert f"<td>relay</td><td>{paper.relay.title}</td><td>{paper.relay.digest}</td>" in page
    for text in ("Not judged", "only the normal one is judged", "first-order Sobol", MILITARY.digest):
        assert text in page
    table = pd.read_csv(paper.folder / "qualification.csv").set_index(["test", "model"])
    run, left = table[:-2], table[-2:]
    assert run["margin"].to_dict() == {
        (part.first.test, each.model): pytest.approx(each.margin.margin, rel=1e-8)
        for part in paper
        for each in part.models
    }
    for names in (["low", "margin", "high"], ["chance low", "chance", "chance high"]):
        assert (run[names].diff(axis=1)[names[1:]] >= 0).all(axis=None)
    assert left["verdict"].droplevel("model").to_dict() == {"shock, 213 B": "not run", "shock, 213 C": "not run"}


def test_margins_that_are_all_above_the_largest_are_told_so(paper: Assessment) -> None:
    tested = paper["shock, 213 A"]
    least, *others = [replace(each, judged=replace(each.margin, margin=1000.0)) for each in tested.models]
    assert rows(replace(tested, models=[least, *others]))[0][3] == "> 1000"
    assert rows(replace(tested, models=[replace(least, judged=tested.margin), *others]))[0][3].endswith(" to > 1000")


def test_what_hardly_moves_a_margin_is_not_said_to_be_missing() -> None:
    chance = Chance(0.0, 0.0, 1e-4, {"second.gap": 1e-9}, {"second.gap": 0.0}, 0, 0.0)
    assert contributions(chance) == "nothing: what the relay's file names hardly moves it"
    assert contributions(replace(chance, effects={})) == "nothing: the relay's file names no uncertainty"


def test_figures_have_the_units_of_their_axes(paper: Assessment) -> None:
    sine = paper["vibration (sine)"].margin
    sweep, *courses, wear = plots.position_figures(list(paper), MILITARY.contacts)
    for figure, name in zip(courses, ("vibration (random), 214 G", "shock, 213 A"), strict=True):
        time, course = (np.array(paper[name].margin.curves[each]) for each in ("time", "course"))
        assert np.array(figure.axes[0].lines[0].get_xydata()) == pytest.approx(np.stack((1e3 * time, 100 * course), 1))
        # The shock in the direction that opens the contact.
        assert course.min() <= 0
    worn = sine.wear["overtravel"], sine.wear["margin"]
    assert np.array(wear.axes[0].lines[0].get_xydata()) == pytest.approx(np.transpose(worn) * (1e3, 1))
    level, left, length = (np.array(axes.lines[0].get_ydata()) for axes in sweep.axes)
    assert level.max() == pytest.approx(30)
    # Slowly shaken, nearly all of it in per cent of that at rest.
    assert 95 < left.max() < 100
    assert length.max() == pytest.approx(1e6 * sine.failed["closed contact"])
    bar, point, *_ = plots.margins([paper["vibration (sine)"]]).axes[0].lines
    assert np.array(bar.get_xdata()).tolist() == [sine.low, sine.high]
    assert np.array(point.get_xdata()).tolist() == [sine.margin]
    # A level in other units: its margin is far off the others, and still on a scale with numbers.
    first = replace(paper["vibration (sine)"].first, judged=replace(sine, margin=0.005, low=0.004))
    far = plots.margins([replace(paper["vibration (sine)"], models=[first])]).axes[0]
    assert [label.get_text() for label in far.get_xticklabels()][:3] == ["0.005", "0.01", "0.02"]


def test_names_in_figures_are_no_formulas(tmp_path: Path) -> None:
    """Also those of ticks; the marks of a logarithmic axis stay powers of ten."""
    name = r"5 $ or \frac{$"
    found = judged(described({}), tmp_path, *(Shock(each, "", "measured", 30.0, 11e-3) for each in (name, "b")))
    margins, course, *_ = plots.margins(found), *plots.position_figures(found, MILITARY.contacts)
    course.axes[0].set(xscale="log", title=name)
    drawn = (margins, course, course)
    ticks, texts, again = (re.findall("<!-- (.*) -->", pages.svg(figure)) for figure in drawn)
    assert again == texts
    assert f"{name}: pass" in ticks
    assert {name, r"$\mathdefault{10^{1}}$"} < set(texts)


def test_the_page_has_the_axial_force_and_all_springs(tmp_path: Path) -> None:
    """Springs of the same name, too, from another folder."""
    assert "force of the present deflection" in form(COMPONENT, {"effects.axialForce": "FromDeflection"})
    assert "no axial force" in form(COMPONENT, {})
    text = (ROOT / "scenes/springs/tapered-cube.toml").read_text()
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "spring.toml").write_text(f"# {folder}\n{text}")
    path = tmp_path / "relay.toml"
    path.write_text("model = [{parameters.beam.file = 'a/spring.toml'}, {parameters.beam.file = 'b/spring.toml'}]\n")
    assert [text[:3] for _, text in springs(Relay.read(path, COMPONENT))] == ["# a", "# b"]


def test_no_legend_of_a_figure_is_cut_off(paper: Assessment) -> None:
    short = [replace(each, models=[replace(each.first, test="A")]) for each in paper if each.judged][:2]
    figures = plots.position_figures(list(paper), MILITARY.contacts) + plots.position_figures(short, MILITARY.contacts)
    for figure in figures:
        figure.draw_without_rendering()
    legends = [(figure, axes.get_legend()) for figure in figures for axes in figure.axes]
    texts = [(figure, text) for figure, legend in legends if legend for text in legend.get_texts()]
    ends = [(text.get_window_extent().x1, figure.bbox.x1) for figure, text in texts]
    assert ends
    assert [pair for pair in ends if pair[0] > pair[1]] == []


def test_the_result_is_a_table_and_a_page(paper: Assessment) -> None:
    """Also in a notebook, which shows the page."""
    table, sine = paper.table, paper["vibration (sine)"]
    assert list(table["model"]) == [*len(paper) * list(MODELS), "", ""]
    assert table.attrs["units"]["closed contact least force"] == "N"
    assert table["margin"][0] == sine.margin.margin
    assert set(paper.sweeps["frequency"]) >= set(sine.margin.curves["frequency"])
    assert paper._repr_html_().startswith("<iframe srcdoc=")
    with pytest.raises(KeyError, match="there are vibration"):
        paper["shock"]


class KilledError(Exception):
    """Stands for a kill."""


SHOCKS = ["213 A", "213 C"]


@pytest.fixture(scope="module")
def two_models(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the file of the published relay by the first two of its models."""
    path = tmp_path_factory.mktemp("relay") / "paper.toml"
    first, second, third, *_ = (ROOT / "relays/paper.toml").read_text(encoding="utf-8").split("[[model]]")
    path.write_text("[[model]]".join((first, second, third)), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def whole(two_models: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give the folder of an assessment in one go."""
    out = tmp_path_factory.mktemp("whole")
    qualify(two_models, "MIL-PRF-28776", out=out, tests=SHOCKS, quick=True, component=COMPONENT)
    return out


def test_an_interrupted_assessment_continues_with_the_same_bytes(
    two_models: Path, whole: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # In a known order; the whole ran on all cores.
    wanted: Any = {"out": tmp_path, "tests": SHOCKS, "quick": True, "component": COMPONENT, "workers": 1}
    run = judgement.tested
    begun: list[str] = []
    most = [1]

    def killed(position: Any, test: Any, points: int) -> Finding:  # noqa: ANN401
        begun.append(test.name)
        if len(begun) > most[0]:
            raise KilledError
        return run(position, test, points)

    monkeypatch.setattr(assessment, "tested", killed)
    with pytest.raises(KilledError):
        qualify(two_models, "MIL-PRF-28776", **wanted)
    assert begun[:2] == ["shock, 213 A", "shock, 213 C"]
    begun.clear()
    most[0] = 3
    qualify(two_models, "MIL-PRF-28776", **wanted)
    # The first is not run again; then the other model.
    assert begun == ["shock, 213 C", "shock, 213 A", "shock, 213 C"]
    names = sorted(path.relative_to(whole) for path in whole.rglob("*") if path.is_file())
    assert len(names) == 7
    for name in names:
        assert (tmp_path / name).read_bytes() == (whole / name).read_bytes(), name


def test_a_result_is_found_again_only_by_all_that_it_depends_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    spring, text = tmp_path / "spring.toml", "[[segment]]\nlength = 0.01\nwidth = 4e-3\nthickness = 3e-4\n"
    spring.write_text(text)
    values: Values = {"beam.file": str(spring)}
    relay, shock = described(values, {"tip.mass": Distribution(part=0.1)}), Shock("a", "", "from memory", 50.0, 11e-3)
    own, one = placed(relay, shock), Correlation(names=("tip.mass",), matrix=((1.0,),))
    others: list[dict[str, Any]] = [
        {"relay": replace(relay, positions={"own": {**values, "tip.mass": 1e-5}})},
        {"relay": replace(relay, uncertainty={"tip.mass": Distribution(part=0.2)})},
        {"relay": replace(relay, correlation=one)},
        {"model": replace(own.model, uncertainty=0.1)}, {"model": replace(own.model, parameters={"tip.mass": 2e-5})},
        {"contacts": replace(own.contacts, opening=1e-3)}, {"axis": "lateral"},
    ]  # fmt: skip
    keys = [assessment.key(b"", replace(own, **each), shock, FEW) for each in ({}, *others)]
    keys.append(assessment.key(b"", own, replace(shock, acceleration=60.0), FEW))
    keys.append(assessment.key(b"", own, shock, 120))
    spring.write_text(text.replace("3e-4", "4e-4"))
    keys.append(assessment.key(b"", own, shock, FEW))
    # The programs, too.
    monkeypatch.setattr(assessment, "HERE", tmp_path)
    for number in range(2):
        (tmp_path / "level.py").write_text(f"RESOLUTION = {number}")
        judged(relay, tmp_path, shock)
    keys += [path.stem for path in (tmp_path / "parts").iterdir()]
    assert len(set(keys)) == len(keys) == 13


def test_a_cluster_gives_the_same_bytes(two_models: Path, whole: Path, tmp_path: Path) -> None:
    with LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=None) as cluster:
        address: Any = cluster.scheduler_address
        relay, standard = Relay.read(two_models, COMPONENT), assessment.chosen(MILITARY, SHOCKS)
        assessment.assess(COMPONENT, relay, standard, tmp_path, FEW, cluster=address)
    parts = list((tmp_path / "parts").glob("*"))
    assert len(parts) == 4
    for path in parts:
        assert path.read_bytes() == (whole / "parts" / path.name).read_bytes()


def test_too_little_damping_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(response, "LONGEST", 5000)
    relay = tmp_path / "relay.toml"
    relay.write_text("parameters = {beam.stiffnessDamping = 0.0, contact.damping = 1e-9}\n")
    told = "shock, 213 A, position 1: the contact still vibrates 0.05 s after a blow: too little damping, by "
    told += "beam.stiffnessDamping = 0, beam.massDamping = 0, contact.damping = 1e-09, or that of modes"
    with pytest.raises(RelayContactError, match=told):
        qualify(relay, "MIL-PRF-28776", out=tmp_path, tests="213 A", component=COMPONENT)


def test_false_makes_of_an_open_contact_like_the_exact_beam(tmp_path: Path) -> None:
    """The gap decides: where the exact free cantilever crosses it, in all kinds of tests."""
    relay, gap = tmp_path / "open.toml", 1e-4
    relay.write_text(f"uncertainty.contact.overtravel = 0.1\nposition = [{{parameters.contact.overtravel = {-gap}}}]\n")
    wanted = ["sine", "random", "213 A"]
    parts = qualify(relay, "MIL-PRF-28776", out=tmp_path, tests=wanted, quick=True, component=COMPONENT)
    beam = Reference({"contact.overtravel": -gap})
    names = "vibration (sine)", "vibration (random), 214 G", "shock, 213 A"
    sine, random, shock = (parts[name].margin for name in names)
    frequency = np.arange(30.0, 600.0, 0.5)
    motion = np.array([abs(beam.compliances(2 * np.pi * f, 0.0)[1]) for f in frequency])
    levels = SINE.amplitude(frequency)
    # 1e-4 for the bisection; 1e-3 for frequencies a quarter of a Hz apart at a resonance 40 Hz wide, and the 1 us, in
    # which the contact, of some 0.1 us of approach, has to stay closed.
    assert sine.margin == pytest.approx((gap / motion / levels).min(), rel=1.2e-3)
    slow = gap / abs(beam.compliances(1.0, 0.0)[1])
    # The pulse has 45 Hz, the cantilever 294 Hz: its own vibration is at most 45/294 of the peak.
    assert shock.margin == pytest.approx(slow / (50 * G), rel=45 / 294)
    assert shock.weakest == "closing direction"
    wide = np.arange(50.0, 2000.0, 1.0)
    dip = largest_dip(wide, [beam.compliances(2 * np.pi * f, 0.0)[1] for f in wide])
    assert random.linear == pytest.approx(gap / dip, rel=3e-3)
    assert random.margin == pytest.approx(random.linear, rel=5e-3)
    for tested in parts:
        part = tested.margin
        assert part.chance
        assert part.decides == ["open contact"]
        assert tested.verdict == ("FAIL" if part.margin < 1 else "pass")
        assert ("open contact" in part.failed) == (part.margin < 1)
        # In random vibration the chance of the largest dip changes the slope.
        assert part.chance.effects["contact.overtravel"] == pytest.approx(0.1, rel=0.02)
    page = (tmp_path / "qualification.html").read_text(encoding="utf-8")
    assert "open contact makes for" in page
    assert "gap of the open contact 0.100 mm" in page


def test_a_changeover_relay_names_the_contact_that_fails(tmp_path: Path) -> None:
    """Both contacts in one position, under a slow shock: which fails, and where the gap decides."""
    text = "parameters.effects.secondContact = true\nparameters.contact.overtravel = 2e-4\n"
    relay = tmp_path / "relay.toml"

    def shocked(gap: float, opening: float, acceleration: float, tables: bool = False) -> Tested:
        relay.write_text(f"{text}parameters.second.gap = {gap}\n")
        specimen = Relay.read(relay, COMPONENT)
        shock = Shock("slow", "", "from memory", acceleration, 0.1)
        (part,) = judged(specimen, tmp_path, shock, contacts=replace(MILITARY.contacts, opening=opening))
        if tables:
            write(Assessment(specimen, MILITARY, [part], tmp_path), COMPONENT)
        return part

    # 200 g bend the free spring by 0.9 mm: both fail, the interruption first, where the preload is taken away.
    both = shocked(3e-4, 10e-6, 200.0, tables=True).margin
    assert 200 * both.margin == pytest.approx(SPECIMEN.force / SPECIMEN.carried_mass / G, rel=0.01)
    assert both.decides == ["closed contact"]
    assert both.least["open contact"] < 0
    assert both.margin < 1
    assert set(both.failed) == {"closed contact", "open contact"}
    ((_, row),) = pd.read_csv(tmp_path / "qualification.csv").iterrows()
    assert row["fails first"] == "closed contact"
    names = ["closed contact interrupted [s]", "open contact makes [s]", "open contact least gap [m]"]
    expected = [both.failed["closed contact"], both.failed["open contact"], both.least["open contact"]]
    assert row[names].tolist() == pytest.approx(expected, rel=1e-8)
    # Where interruptions of up to 90 of the 100 ms are allowed the gap decides: the acceleration that bends the free
    # spring by overtravel and gap. The pulse has 5 Hz, the free spring 294 Hz.
    alone = shocked(3e-4, 90e-3, 200.0).margin
    assert alone.decides == list(alone.failed) == ["open contact"]
    bent = abs(Reference({"contact.overtravel": -1e-4}).compliances(1e-3, 0.0)[1])
    assert 200 * alone.margin == pytest.approx((2e-4 + 3e-4) / bent / G, rel=5 / 294)
    # Below the level at which the first opens, nothing is lost of the gap but what the contact springs back.
    whole = shocked(3e-4, 10e-6, 5.0)
    calm = whole.margin
    assert whole.verdict == "pass"
    assert not calm.failed
    assert calm.least["open contact"] == pytest.approx(3e-4, rel=1e-3)


def test_two_open_contacts_are_not_judged(tmp_path: Path) -> None:
    relay = tmp_path / "open.toml"
    relay.write_text("parameters.effects.secondContact = true\nparameters.contact.overtravel = -1e-4\n")
    (part,) = qualify(relay, "MIL-STD-202", out=tmp_path, tests=["213 A"], component=COMPONENT, pdf=True)
    assert part.verdict == "not judged"
    assert (tmp_path / "qualification.pdf").read_bytes().startswith(b"%PDF")
    assert "both contacts open" in (tmp_path / "qualification.html").read_text(encoding="utf-8")


def test_a_relay_without_uncertainties_has_no_interval(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """And no chance of failing, however near the limit; a noise has that of its largest dip."""
    relay = tmp_path / "relay.toml"
    relay.write_text("parameters.contact.overtravel = 2.04e-4\n")
    wanted = ["--test", "random", "--test", "213 B", "--out", str(tmp_path), "--quick"]
    assert main(["qualify", str(relay), "--standard", "MIL-PRF-28776", *wanted]) == 0
    printed = capsys.readouterr().out
    assert printed.count("none stated") == 1
    assert f"{MILITARY.title}: 2 FAIL, 3 not run: vibration (sine); shock, 213 A; shock, 213 C\n" in printed
    page = (tmp_path / "qualification.html").read_text(encoding="utf-8")
    assert page.count("<td>none stated</td>") == 2
    assert "states neither uncertain parameters nor an allowance" in page
    (_, noise), (_, shock), *_ = pd.read_csv(tmp_path / "qualification.csv").iterrows()
    assert shock[["low", "high", "chance", "chance low", "chance high"]].isna().all()
    # By the chance of the largest dip alone.
    frequency = np.linspace(50.0, 2000.0, 400)
    gains = [SPECIMEN.force_response(f) for f in frequency]
    low, middle, high = (largest_dip(frequency, gains, chance) for chance in (0.025, 0.5, 0.975))
    assert noise[["low", "high"]].tolist() == pytest.approx(noise["margin"] * middle / np.array((low, high)), rel=3e-3)


@pytest.mark.parametrize("resistance", ["PowerLaw", "Holm", "Barber"])
@pytest.mark.parametrize("law", ["Hertz", "Rough"])
def test_the_force_of_an_interruption_is_that_of_any_law_of_the_resistance(law: str, resistance: str) -> None:
    """At the resistance that the component has at another preload, with a film and beside the open resistance."""
    values: dict[str, Any] = {
        "effects.contactLaw": law, "effects.resistance": resistance, "resistance.film": 2e-3, "resistance.open": 100.0,
    }  # fmt: skip
    force, threshold = resting({**values, "contact.overtravel": 3e-5}, "contact.force", "contact.resistance")
    with COMPONENT.started(values) as contact:
        assert interrupting_force(contact, values, threshold) == pytest.approx(force, rel=1e-6)
        # More than the film alone no force makes it less.
        assert interrupting_force(contact, values, 1.9e-3) == np.inf


def test_a_contact_is_interrupted_by_its_own_law_of_the_resistance(tmp_path: Path) -> None:
    """By Holm it has 1.4 mOhm at rest, 30 times less than by the power law, and is not interrupted at rest.

    Of a film of 50 mOhm linear theory says of a monitor that sees 120 mOhm what the component finds.
    """
    holm = described({"effects.resistance": "Holm"})
    film = described({"resistance.film": 0.05}, {"resistance.film": Distribution(part=0.2)})
    for relay, threshold in ((holm, 0.04), (film, 0.12)):
        contacts = replace(MILITARY.contacts, voltage=threshold, current=1.0)
        (tested,) = judged(relay, tmp_path, Shock("a", "", "measured", 30.0, 11e-3), contacts=contacts)
        assert tested.margin.linear == pytest.approx(tested.margin.margin, rel=1e-3)
        # What is told of it at rest is all of its force, not what may be lost.
        assert tested.margin.rest == {"closed contact": resting(relay.positions["own"], "contact.force")[0]}
    # A fifth of it is a fifth of what the force may lose.
    assert tested.margin.low < 0.8 * tested.margin.margin
    assert tested.margin.high > 1.1 * tested.margin.margin


def test_a_test_that_no_standard_has_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    wanted = ["--test", "204", "--test", "none", "--out", str(tmp_path)]
    assert main(["qualify", "paper", "--standard", "MIL-STD-202", *wanted]) == 1
    assert "none: no test named so; there are 201A, 204 A" in capsys.readouterr().err
    with pytest.raises(RelayContactError, match=r"^none: no test named so"):
        qualify("paper", "MIL-STD-202", tests="none", out=tmp_path, component=COMPONENT)
    assert main(["qualify", "paper", "--history", "record.csv", "--test", "204"]) == 1
    assert "tests 204: not allowed without a standard" in capsys.readouterr().err
    with pytest.raises(RelayContactError, match=r"standard, history: one of them is needed"):
        qualify("paper", out=tmp_path, component=COMPONENT)
    for option in (["--unit", "g"], ["--rate", "1000"]):
        assert main(["qualify", "paper", "--standard", "MIL-STD-202", *option, *wanted[-2:]]) == 1
        assert "unit, rate: not allowed without a record" in capsys.readouterr().err


def test_a_slope_begins_at_a_density_with_or_without_a_decimal_point(tmp_path: Path) -> None:
    path = tmp_path / "slope.toml"
    text = """[contacts]
opening = 10e-6
false_make = 1e-6
voltage = 6.0
current = 10e-3
clause = ""
evidence = "measured"
[[random]]
name = "noise"
density = [[20, "6 dB/oct"], [40, 1], [80, 1.0], [160, "-6 dB/octave"]]
rms = 9.8
duration = 60
clause = ""
evidence = "measured"
"""
    path.write_text(text)
    (test,) = Standard.read(path).tests
    assert isinstance(test, Random)
    (_, first), *_, (_, last) = test.density
    assert (first, last) == pytest.approx((10**-0.6, 10**-0.6))
