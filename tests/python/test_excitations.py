"""Courses, spectra, noise and records as tests: against closed forms, a second solution, and the whole record."""

import re
from dataclasses import replace
from itertools import permutations
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from component import COMPONENT
from qualified import CONTACTS, described, judged
from reference import Reference
from relay_contact import Array, RelayContactError, Values, write_table
from relay_contact.command import main
from relay_contact.figures import three
from relay_contact.files import read_toml
from relay_contact.qualification import Relay, Standard, judgement, plots, qualify, synthesis, trials
from relay_contact.qualification.courses import Piece, eased, middle_dip, noise, pieces
from relay_contact.qualification.excitation import STEP, Course, Random, Shock, Sine, Spectrum
from relay_contact.qualification.page import UNKNOWN
from relay_contact.qualification.response import Response, respond
from relay_contact.qualification.standards import Recorded
from relay_contact.qualification.trials import Specimen, Weakest, sine_near
from relay_contact.qualification.words import COARSE, limits

G = 9.80665
READ: Any = "from memory"
PUBLISHED: Values = {"effects.axialForce": "FromPreload"}
SPECIMEN = Reference(PUBLISHED)
LASTING = CONTACTS.opening
CALM = Specimen(COMPONENT, PUBLISHED, CONTACTS, respond(COMPONENT, PUBLISHED, CONTACTS.threshold))


def history(path: Path, **entries: Any) -> Any:  # noqa: ANN401
    """Return the test of a record."""
    (test,) = Recorded(file=path.name, **entries).tests(path.parent)
    return test


@pytest.mark.parametrize("shape", ["terminal-peak sawtooth", "initial-peak sawtooth", "trapezoid"])
def test_pulses_open_the_contact_where_the_second_solution_does(shape: Any) -> None:  # noqa: ANN401
    """Of 3 ms, four periods of the contact: its own vibration counts."""
    test = Shock("a", "", READ, 50.0, 3e-3, shape)
    course = test.course()
    (piece,) = pieces(CALM, course, -1.0)
    level, failed = piece.threshold(CALM, -1.0)
    assert failed == ["closed contact"]
    # Hertz's stiffness changes with the force: linear theory is right to 1 %.
    assert level == pytest.approx(piece.guess, rel=0.01)

    def acceleration(time: float) -> float:
        # Jumps take 1 ns.
        steep = course.time + 1e-9 * np.arange(len(course.time))
        return -float(np.interp(time, steep, course.acceleration, left=0.0, right=0.0))

    def least(factor: float) -> float:
        course = SPECIMEN.course(np.linspace(0, 3.8e-3, 3800), lambda time: factor * level * acceleration(time))
        return float(course.forces["contact"].min())

    # An interruption of 10 us begins above the first opening: of a period of 0.74 ms by (pi 10 us / 0.74 ms)^2 / 2.
    assert least(0.99) > 1e-3 * SPECIMEN.force
    assert least(1.01) < 1e-6 * SPECIMEN.force


@pytest.mark.parametrize("where", [{"frequencies": (10.0, 12.3), "sweep_time": 60.0}, {"steps": (10.0, 12.3)}])
def test_a_sine_ends_at_its_last_frequency(tmp_path: Path, where: Any) -> None:  # noqa: ANN401
    """What the double amplitude limits grows with the square of the frequency, between those of the response too."""
    test = Sine("low", "", READ, double_amplitude=1e-2, **where)
    (tested,) = judged(described(PUBLISHED), tmp_path, test)
    amplitude = 5e-3 * (2 * np.pi * 12.3) ** 2
    expected = SPECIMEN.force / (abs(SPECIMEN.force_response(12.3)) * amplitude)
    # The level is sought to 1e-4; the indentation, which linear theory has otherwise, is 3e-4 of the overtravel.
    assert tested.margin.margin == pytest.approx(expected, rel=4e-4)
    assert tested.margin.weakest == "12.3 Hz"


def test_the_tolerance_of_a_pulse_moves_the_margin(tmp_path: Path) -> None:
    """A slow pulse by its peak alone."""
    entries: Any = {"peak": 0.2, "duration": 0.1}
    test = Shock("slow", "", READ, 50.0, 11e-3, tolerance=entries)
    (tested,) = judged(described(PUBLISHED), tmp_path, test)
    assert tested.margin.tolerance
    low, high = tested.margin.tolerance
    assert limits(tested.first).endswith(f"; {three(low)} to {three(high)} by the pulses within the tolerance")
    assert low == pytest.approx(tested.margin.margin / 1.2, rel=0.02)
    assert high == pytest.approx(tested.margin.margin / 0.8, rel=0.02)
    corners = [(each.acceleration, each.duration) for each in test.corners]
    assert corners == [pytest.approx((peak, length)) for peak in (40.0, 60.0) for length in (9.9e-3, 12.1e-3)]


def test_a_recorded_pulse_is_that_of_the_generator(tmp_path: Path) -> None:
    """With an offset of time, in g, in the direction that opens the contact, and reversed."""
    time = np.linspace(0, 3e-3, 151)
    path = tmp_path / "pulse.csv"
    rows = "\n".join(f"{t + 7:.9f},{-50 * np.sin(np.pi * t / 3e-3):.9f}" for t in time)
    path.write_text(f"Time [s],Z [g]\n{rows}\n")
    test = history(path)
    assert any("begins at 7 s" in note for note in test.record.notes)
    (own,) = pieces(CALM, Shock("a", "", READ, 50.0, 3e-3).course(), -1.0)
    (piece,) = pieces(CALM, test.course(), 1.0)
    # Chords of 20 us lie (pi 20 us / 3 ms)^2 / 8 below the sine.
    assert piece.threshold(CALM, 1.0)[0] == pytest.approx(own.threshold(CALM, -1.0)[0], rel=2e-4)
    assert history(path, reversed=True).directions == {"as recorded": 1.0, "reversed": -1.0}


def test_the_margin_of_a_record_is_that_of_the_whole(tmp_path: Path) -> None:
    """Noise with unequal steps and an offset: the pieces around its dips fail where the whole record does."""
    generator = np.random.default_rng(5)
    count = 30_000
    frequency = np.fft.rfftfreq(count, 2e-5)
    band = (frequency > 50) & (frequency < 2000)
    real, imaginary = generator.standard_normal((2, len(frequency)))
    course = np.fft.irfft(band * (real + 1j * imaginary))
    time = 2e-5 * (np.arange(count) + generator.uniform(-0.2, 0.2, count))
    path = tmp_path / "road.csv"
    values = 3.0 * course / course.std() + 1.0
    write_table(path, "time [s],a [g]", np.column_stack((time - time[0], values)), digits=17)
    test = history(path)
    assert [each for each in test.record.notes if "unequal" in each]
    assert [each for each in test.record.notes if "before the record" in each]
    around, course = pieces(CALM, test.course(), 1.0), test.course()
    for piece in around:
        # At its place in the record.
        last = np.interp(piece.begin + piece.course.end, course.time, course.acceleration)
        assert piece.course.acceleration[-1] == pytest.approx(last)
    found = [piece.threshold(CALM, 1.0)[0] for piece in around]
    whole = Piece(course.padded(CALM.response.settling), 1.0, 0.0)
    assert not whole.follow(CALM, 0.9985 * min(found))[0]
    assert whole.follow(CALM, 1.0015 * min(found))[0]


@pytest.mark.parametrize(("step", "gap"), [(1e-2, 0.0), (5e-3, 0.0), (1e-2, 0.5)])
def test_the_margin_of_a_record_of_long_steps_is_that_of_the_whole(step: float, gap: float) -> None:
    """Longer than what is around a dip: what rises from 0 there had taken away what makes it. Also before a gap."""
    values = 50 * np.random.default_rng(1).standard_normal(100)
    course = Course(step * np.arange(100) + gap * (np.arange(100) > values.argmin()), values)
    level = min(piece.threshold(CALM, 1.0)[0] for piece in pieces(CALM, course, 1.0))
    whole = Piece(course.padded(CALM.response.settling), level, 0.0)
    assert level == pytest.approx(whole.threshold(CALM, 1.0)[0], rel=2e-4)


def test_a_record_alone_is_a_test(tmp_path: Path) -> None:
    relay = tmp_path / "relay.toml"
    relay.write_text("parameters.effects.axialForce = 'FromPreload'\n")
    time = np.linspace(0, 4e-3, 201)
    pulse = -30 * np.sin(np.pi * time / 4e-3)
    time += 7
    (tmp_path / "two.csv").write_text(
        "time [ms];x [g];temperature [degC];y [m/s2]\n"
        + "\n".join(f"{1e3 * t:.9g};{a};20;{9.80665 * a / 2}" for t, a in zip(time, pulse, strict=True))
    )
    found = qualify(relay, history=[tmp_path / "two.csv"], out=tmp_path, component=COMPONENT)
    first, second = found["two.csv, x"], found["two.csv, y"]
    assert second.margin.margin == pytest.approx(2 * first.margin.margin, rel=2e-4)
    # What is drawn is the failure itself, at the level of the margin: just longer than allowed, without force.
    for each in (first, second):
        curves = each.margin.curves
        assert 10e-6 <= curves["failing"]["closed contact"] < 60e-6
        assert min(curves["course"]) <= 0
        # At the times of the record: the pulse bends the spring most at its middle.
        assert curves["whole"][0][0] == 7
        failing = float(each.margin.weakest.split()[-2])
        assert failing == pytest.approx(7.002, abs=1e-3)
        assert curves["time"][int(np.argmin(curves["course"]))] == pytest.approx(failing, abs=2e-4)
    # Sketch, margins, wear, and a figure of each record.
    assert (tmp_path / "qualification.html").read_text(encoding="utf-8").count("<svg") == 5


def test_records_of_one_name_are_refused(tmp_path: Path) -> None:
    """What is found of a test is kept by its name: the second record would have the margin of the first."""
    time = 2e-5 * np.arange(500)
    for folder, level in (("calm", 1.0), ("rough", 10.0)):
        (tmp_path / folder).mkdir()
        rows = np.column_stack((time, level * np.sin(2e3 * time)))
        write_table(tmp_path / folder / "road.csv", "time [s],a [g]", rows)
    files: list[str | Path] = [tmp_path / "calm" / "road.csv", tmp_path / "rough" / "road.csv"]
    with pytest.raises(RelayContactError, match=r"road.csv: given twice: not allowed"):
        qualify("paper", history=files, out=tmp_path, component=COMPONENT)


def test_a_record_of_coarse_steps_does_not_pass(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """One motion at several rates: no interval is above the margin of the finest; what is said of them is everywhere.

    Also a record that hardly shakes anything, and one that is shorter than the figures' spectra.
    """
    relay = tmp_path / "relay.toml"
    relay.write_text("parameters.effects.axialForce = 'FromPreload'\n")
    written = {"rate 48000": (48e3, 36.0, 0.25), "rate 6000": (6e3, 36.0, 0.25), "rate 3000": (3e3, 36.0, 0.25),
               "rate 1000": (1e3, 36.0, 0.25), "rate 11": (11.0, 36.0, 1.2), "calm": (48e3, 1e-10, 0.25),
               "brief": (1e6, 36.0, 5e-5)}  # fmt: skip
    for name, (rate, level, end) in written.items():
        time = np.arange(round(rate * end)) / rate
        values = level * np.minimum(time / 0.05, 1) * np.sin(2 * np.pi * 1190 * time) * (time < 0.2)
        write_table(tmp_path / f"{name}.csv", "time,a [g]", np.column_stack((time, values)), digits=17)
    asked = [text for name in written for text in ("--history", str(tmp_path / f"{name}.csv"))]
    assert main(["qualify", str(relay), *asked, "--quick", "--out", str(tmp_path), "--fmu", str(COMPONENT.path)]) == 0
    printed, page = capsys.readouterr().out, (tmp_path / "qualification.html").read_text(encoding="utf-8")
    found = pd.read_csv(tmp_path / "qualification.csv", index_col="test").rename(lambda name: name.removesuffix(".csv"))
    assert found["verdict"].tolist() == ["FAIL", "FAIL", *3 * ["undecided"], "pass", "pass"]
    exact, resonance = (float(found[name]["rate 48000"]) for name in ("margin", "resonance [Hz]"))
    # The Fourier transform of a triangle, by which straight lines are between samples.
    lost = 100 * (1 - np.sinc(resonance / 6e3) ** 2)
    for name, told in (("rate 6000", f"{lost:.3g} % off a vibration there"), ("calm", "taken as s"),
                       ("rate 3000", "up to 333 µs, 2.21 in a period of the resonance"),
                       ("rate 1000", "fewer than 4 do not show what excites it")):  # fmt: skip
        (note,) = [note for note in found["notes"][name].split("; ") if told in note]
        assert f"{name}.csv: {note}\n" in printed
        assert f"{name}.csv: {note}</li>" in page
        # Of a relay without uncertainties only a record makes an interval.
        assert (found["low"][name] < exact) == (name != "calm")
    assert found["low"].isna()["calm"]
    assert [found["low"][name] == 0 for name in ("rate 6000", "rate 3000", "rate 1000", "rate 11")] == [
        False,
        *3 * [True],
    ]
    assert "period" not in str(found["notes"]["rate 48000"])
    assert UNKNOWN in printed
    # In place of contributions and chance.
    assert page.count(COARSE) == 4
    assert "> 1000 " in printed
    assert found["margin"]["calm"] == 1000


@pytest.mark.parametrize("required", [((20.0, 10.0), (80.0, 40.0), (2000.0, 40.0)), ((100.0, 20.0), (1000.0, 500.0))])
def test_a_pulse_of_damped_sines_meets_its_spectrum(required: Any) -> None:  # noqa: ANN401
    time, acceleration = synthesis.pulse(required, 10.0)
    corners, levels = np.array(required).T
    # Also between its sines: a tenth of a dB below at most, 1.2 dB above.
    frequencies = np.geomspace(corners[0], corners[-1], 100)
    wanted = G * np.exp(np.interp(np.log(frequencies), np.log(corners), np.log(levels)))
    spectrum = synthesis.response(acceleration, time[1], frequencies, 10.0)
    assert ((spectrum / wanted > 0.988) & (spectrum / wanted < 1.149)).all()
    # By oscillators that are integrated.
    for frequency, found in list(zip(frequencies, spectrum, strict=True))[1:50:24]:
        omega = 2 * np.pi * frequency

        def motion(now: float, state: Array, omega: float = omega) -> list[float]:
            base = float(np.interp(now, time, acceleration, right=0.0))
            return [state[1], -base - omega * state[1] / 10 - omega**2 * state[0]]

        own = solve_ivp(motion, (0, time[-1]), [0, 0], max_step=0.05 / frequency, rtol=1e-6)
        absolute = np.abs(omega * own.y[1] / 10 + omega**2 * own.y[0]).max()
        assert found == pytest.approx(absolute, rel=0.01)
    # At its end there is nothing, for which the contact is watched until it is calm.
    assert acceleration[-1] == 0
    # No change of velocity is left, beside that of the pulse.
    assert abs(np.trapezoid(acceleration, time)) < 1e-2 * np.abs(acceleration).max() / (2 * np.pi * corners[0])


def test_the_response_to_a_blow_comes_after_it() -> None:
    """Of an oscillator without damping: its angular frequency times the change of velocity, 100 m/s2 in 0.1 ms."""
    found = synthesis.response(np.full(10, 100.0), 1e-5, np.array([100.0]), 1e6)
    assert found == pytest.approx(2 * np.pi * 100 * 1e-2, rel=0.01)


def test_a_density_is_one_sided() -> None:
    """Of white noise of 3 m/s2 rms up to half of the rate, 1 / STEP: twice its mean square times the step."""
    noise_ = np.random.default_rng(1).normal(0.0, 3.0, 2**17)
    found = judgement.density(noise_, np.array([5e3, 1e4, 2e4]), 2 ** (1 / 3))
    assert found == pytest.approx([2 * 9.0 * STEP] * 3, rel=0.1)


def test_the_figure_of_a_spectrum_shows_that_it_is_met(tmp_path: Path) -> None:
    test = Spectrum("spectrum", "", READ, ((100.0, 20.0), (1000.0, 500.0)))
    (tested,) = judged(described(PUBLISHED), tmp_path, test)
    whole, power, _, srs = plots.record(tested.first).axes
    reached, required, density = (np.array(line.get_ydata()) for line in (*srs.lines[:2], power.lines[0]))
    assert (required[0], required[-1]) == pytest.approx((20.0, 500.0))
    assert reached[-1] == pytest.approx(500.0, rel=0.09)
    decibels = 20 * np.log10(reached / required)
    told = [float(each) for each in re.findall(r"-?[\d.]+", str(srs.lines[2].get_label()))]
    assert told == pytest.approx([decibels.min(), decibels.max()], abs=0.01)
    assert -0.3 < told[0] < told[1] < 0.71
    # In g: its peak; and its rms in the range of the spectrum, in which most of it is, by the density.
    acceleration = test.course().acceleration / G
    assert whole.dataLim.y1 == pytest.approx(acceleration.max())
    rms = np.trapezoid(density, np.array(power.lines[0].get_xdata())) ** 0.5
    assert 0.7 < rms / np.sqrt(np.mean(acceleration**2)) < 1.05


def test_densities_by_slopes() -> None:
    (screen,) = Standard.read("NAVMAT-P-9492").tests
    assert isinstance(screen, Random)
    assert screen.density[0][1] == pytest.approx(0.04 * 10 ** (-0.3 * 2), rel=1e-12)
    assert screen.density[-1][1] == pytest.approx(0.04 * 10 ** (-0.3 * np.log2(2000 / 350)), rel=1e-12)
    (spectrum,) = (test for test in Standard.read("MIL-STD-810").tests if isinstance(test, Spectrum))
    assert spectrum.course().end < 3.0


def oscillator(natural: float, quality: float, stiff: bool = False) -> Response:
    """Return the response of an oscillator, or of a contact that follows the acceleration."""
    time = STEP * np.arange(8000)
    omega = 2 * np.pi * natural
    answer = -omega * np.exp(-omega * time / 2 / quality) * np.sin(omega * time)
    if stiff:
        answer = np.zeros(2000)
        answer[0] = -1 / STEP
    frequency = np.arange(2, 10_000) * 0.5
    turn = np.exp(-2j * np.pi * np.outer(frequency[::40], STEP * np.arange(len(answer))))
    transfer = np.interp(frequency, frequency[::40], turn @ answer * STEP)
    known: Array = np.concatenate(([0.0, 0.5], frequency))
    return Response(100.0, natural, known, np.concatenate((transfer[[0, 0]], transfer)), answer)


def test_crossings_of_noise_with_sines_are_those_of_a_record() -> None:
    response = oscillator(300.0, 5.0)
    test = Random("a", "", READ, ((50.0, 0.01), (1000.0, 0.01)), 3.08, 60.0, sines=((330.0, 1.0), (900.0, 60.0)))
    change = response.change(noise(test)[0].sampled())
    peaks = np.sort(-change[1:-1][(change[1:-1] < change[:-2]) & (change[1:-1] < change[2:])])
    for crossed in (280, 100):
        # The level that is crossed so often: in this time once, by expectation.
        own = replace(test, duration=60.0 / crossed)
        largest = response.reserve / response.random(own, 0.0, float(-np.expm1(-1.0)))
        # Peaks come in clusters of some: an uncertainty of the number by a fifth is one of the level by 2 %.
        assert largest == pytest.approx(peaks[-crossed], rel=0.03)
    # The largest of them is the first of those that are simulated.
    deepest, *_ = pieces(replace(CALM, response=response), noise(test)[0], 1.0)
    assert deepest.guess == pytest.approx(response.reserve / peaks[-1], rel=0.01)
    bare, tiny = replace(test, sines=()), replace(test, sines=((200.0, 1e-6),))
    assert response.random(tiny, 0.0) == pytest.approx(response.random(bare, 0.0), rel=1e-4)
    # Of a tone that is much faster than the noise: the largest of both.
    slow = replace(test, density=((5.0, 0.01), (10.0, 0.01)), rms=0.2236, duration=2.0, sines=((900.0, 60.0),))
    alone, both = (response.reserve / response.random(each, 0.0, 0.999) for each in (replace(slow, sines=()), slow))
    tone = 60 * G * np.interp(900.0, response.frequency, response.gain)
    assert both == pytest.approx(alone + tone, rel=1e-9)
    # Of a narrow band in the shortest test: not even one crossing may be expected.
    short = replace(test, density=((300.0, 0.01), (302.0, 0.01)), rms=0.1414, duration=10 / 300)
    least, middle, most = (response.random(short, 0.0, chance) for chance in (1e-6, 0.5, 1 - 1e-6))
    assert 0 < least < middle < most < np.inf
    # Of a band of three lines of the response, which are half a Hz apart.
    narrow = replace(short, density=((300.0, 0.01), (301.0, 0.01)), rms=0.1)
    rms, mean, width = response.moments(narrow)
    assert (rms, mean) == pytest.approx((0.1 * G * response.gain[601], 300.5), rel=0.01)
    # Of an even band: its length over the root of 12.
    assert width == pytest.approx(1 / 300.5 / 12**0.5, rel=0.01)


@pytest.mark.parametrize("quality", [3.0, 30.0, 100.0])
def test_the_largest_of_noise_that_resonates_is_that_of_records(quality: float) -> None:
    """By Rice's rate of single crossings it would be 4 and 9 % larger where it resonates."""
    test = Random("a", "", READ, ((50.0, 0.01), (1000.0, 0.01)), 3.08, 20.0)

    def transfer(frequency: Array) -> NDArray[np.complex128]:
        return np.asarray(1 / (1 - (frequency / 300) ** 2 + 1j * frequency / 300 / quality))

    known, lines = np.arange(0, 1000, 0.25), np.arange(1000 * test.duration) / test.duration
    response = Response(1.0, 300.0, known, transfer(known), np.zeros(1))
    amplitude = np.sqrt(test.spectrum(lines) / 4 / test.duration) * transfer(lines)
    generator = np.random.default_rng(1)
    turned = ((generator.standard_normal((2, len(lines))) * [[1], [1j]]).sum(axis=0) for _ in range(400))
    largest = [np.fft.irfft(amplitude * each, round(8000 * test.duration), norm="forward").max() for each in turned]
    assert 1 / response.random(test, 0.0) == pytest.approx(np.median(largest), rel=0.025)


def test_an_overdamped_contact_is_weakest_where_the_displacement_no_longer_limits() -> None:
    test = Sine("a", "", READ, acceleration=1.0, double_amplitude=2.6e-3, frequencies=(2.0, 100.0), sweep_rate=1.0)
    known = np.arange(0, 1000, 0.25)
    transfer = np.asarray(1 / (1 + 1j * known / 0.5), np.complex128)
    response = Response(1.0, 300.0, known, transfer, np.zeros(1))
    frequency, factors = response.sine(test, 0.0)
    # Between two frequencies of the response, whose level is 0.6 % higher.
    assert np.all(np.diff(frequency) > 0)
    corner = (2 * G / 2.6e-3) ** 0.5 / (2 * np.pi)
    assert factors.min() == pytest.approx(abs(1 + 1j * corner / 0.5) / G, rel=1e-4)
    assert "displacement" in judgement.bound(response, test, response.weakest(test, 0.0))


@pytest.mark.parametrize("parts", [*permutations((0.9, 1.0, 1.1))])
def test_of_three_dips_the_middle_one_counts(parts: tuple[float, ...]) -> None:
    class Dip(Piece):
        """Fails from its part of the level on."""

        def tried(self, *_: object) -> Any:  # noqa: ANN401
            return lambda level: ({"contact": 1e-5} if level >= self.longer else {}, 0.0)

    still = Course(np.zeros(2), np.zeros(2))
    dips: list[Piece] = [Dip(still, 1.0, begin, part) for begin, part in enumerate(parts)]
    test = Random("a", "", READ, ((50.0, 0.01), (1000.0, 0.01)), 3.08, 900.0)
    assert middle_dip(CALM, test, dips)[0] == pytest.approx(1.0, rel=1e-4)


def test_clipping_bounds_what_follows_the_acceleration_and_hardly_what_resonates() -> None:
    test = Random("a", "", READ, ((50.0, 0.01), (1000.0, 0.01)), 3.08, 900.0, clipping=3.0)
    free, clipped = noise(test)
    assert np.abs(clipped.acceleration).max() == pytest.approx(3 * 3.082 * G, rel=1e-3)
    factors = {}
    for name, response in (("stiff", oscillator(0.0, 1.0, stiff=True)), ("resonant", oscillator(300.0, 30.0))):
        specimen = replace(CALM, response=response)
        factors[name] = eased(specimen, test, free, clipped)
    stiff = oscillator(0.0, 1.0, stiff=True)
    bound = stiff.reserve / (3 * 3.082 * G)
    assert factors["stiff"] * stiff.random(test, 0.0) == pytest.approx(bound, rel=0.02)
    assert 1 <= factors["resonant"] < 1.05


def test_a_sweep_finds_what_no_vibration_raised_at_the_resonance_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each level is swept once, where it fails included."""
    run: list[float] = []

    def swept(*given: Any, **_: int) -> Any:  # noqa: ANN401
        run.append(given[-1])
        return {"closed contact": 1e-5} if given[-1] >= 2.0 else {}, 0.0, 280.0

    monkeypatch.setattr(trials, "vibrated", lambda *_: ({}, [], 0.0))
    monkeypatch.setattr(trials, "swept", swept)
    test = Sine("a", "", READ, 1.0, frequencies=(50.0, 1000.0), sweep_rate=1.0)
    found = sine_near(replace(CALM, response=oscillator(300.0, 30.0)), test, 300.0, 2.5)
    assert found == Weakest(280.0, found.factor, ["closed contact"], 1)
    assert found.factor == pytest.approx(2.0, rel=1e-4)
    assert len(run) == len(set(run))


def test_a_dwell_at_resonance_and_steps_have_the_margins_of_the_sweep() -> None:
    response = CALM.response
    sweep = Sine("a", "", READ, 30.0, None, (100.0, 3000.0), 60.0)
    dwell = Sine("a", "", READ, 30.0, None, (100.0, 3000.0), dwell=True)
    _, factors = response.sine(sweep, LASTING)
    own, factor = response.sine(dwell, LASTING)
    # The interruption of 10 us moves the weakest frequency by less than a line of the response.
    assert len(own) == 1
    assert factor[0] == pytest.approx(factors.min(), rel=1e-4)
    steps = Sine("a", "", READ, 30.0, None, steps=(200.0, float(own[0]), 2000.0))
    assert response.sine(steps, LASTING)[1].min() == pytest.approx(factor[0], rel=1e-3)
    assert sweep.rate == pytest.approx(2 * np.log2(30), rel=1e-12)
    fast, width = replace(sweep, sweep_time=None, sweep_rate=1000.0), response.bandwidth(float(own[0]))
    assert fast.rate == 1000.0
    # In this time a vibration decays by so many factors e.
    crossed = f" {three(0.06 * np.log2(1 + width / own[0]) * np.pi * width)} decay times"
    assert judgement.bound(response, fast, float(own[0])).endswith(crossed)


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        ({"steps": (100.0,)}, "either frequencies or steps"),
        ({"sweep_rate": 1.0}, "one of sweep_time and sweep_rate"),
        ({"acceleration": None}, "acceleration or double_amplitude: missing"),
        ({"double_amplitude": 1.5}, "allowed is 0.5 m or less; is it meant in mm?"),
        ({"acceleration": None, "double_amplitude": 0.5}, r"9.06e\+06 g at 3000 Hz: not allowed, allowed are 100000 g"),
        ({"evidence": {"duration": "from memory"}}, "evidence.duration: not an entry of this test"),
    ],
)
def test_sines_that_do_not_fit_together(entries: dict[str, Any], message: str) -> None:
    sweep = Sine("a", "", READ, 30.0, None, (100.0, 3000.0), 60.0)
    with pytest.raises(ValueError, match=message):
        replace(sweep, **entries)
    with pytest.raises(ValueError, match=r"the pulse has 3\.43"):
        Shock("a", "", READ, 50.0, 11e-3, velocity_change=4.0)


def test_another_axis_by_its_participations(tmp_path: Path) -> None:
    """Half of the normal ones, reversed: twice the margin, in the other direction."""
    spring = Relay.read("finite-elements", COMPONENT).positions["contact closed"]["beam.file"]
    parts = [mode["participation"] for mode in read_toml(Path(str(spring)))["mode"]]
    relay = tmp_path / "relay.toml"
    text = f"parameters.beam.file = '{spring}'\nparameters.contact.overtravel = 8e-4\n"
    text += "parameters.beam.stiffnessDamping = 5e-6\nparameters.contact.damping = 2e-6\n"
    text += "uncertainty.spring.mode.1.participation = 0.1\n"
    relay.write_text(f"{text}axes.lateral = {[-part / 2 for part in parts]}\n")
    test = Shock("shock", "", READ, 500.0, 3e-3)
    own = Relay.read(relay, COMPONENT)
    normal, lateral, other = judged(own, tmp_path, test, replace(test, name="z", axis="z"))
    assert (lateral.first.named, lateral.first.axis) == ("shock, lateral axis", "lateral")
    assert lateral.margin.margin == pytest.approx(2 * normal.margin.margin, rel=3e-4)
    # So is the interval, which comes from the participation itself.
    assert lateral.margin.low == pytest.approx(2 * normal.margin.low, rel=1e-3)
    assert lateral.margin.high == pytest.approx(2 * normal.margin.high, rel=1e-3)
    assert normal.margin.high > 1.1 * normal.margin.low
    assert {normal.margin.weakest, lateral.margin.weakest} == {"opening direction", "closing direction"}
    assert other.verdict == "not judged"
    relay.write_text(f"{text}axes.lateral = [0.1]\n")
    with pytest.raises(RelayContactError, match=r"relay.toml:6: axes.lateral = .*one participation for each of the"):
        Relay.read(relay, COMPONENT)
    still = tmp_path / "still.toml"
    still.write_text(Path(str(spring)).read_text().replace(f"participation = {parts[1]}", "participation = 0.0"))
    relay.write_text(f"{text.replace(str(spring), str(still))}axes.lateral = {parts}\n")
    with pytest.raises(RelayContactError, match=r"relay.toml:6: axes.lateral.2 = .*mode 2 has none in the spring file"):
        Relay.read(relay, COMPONENT)
    relay.write_text(f"{text}axes.lateral = {parts}\nmodel = [{{}}, {{parameters.environment.gravity = 9.8}}]\n")
    with pytest.raises(RelayContactError, match=r"relay.toml:6: axes.lateral = .*gravity would act along this axis"):
        Relay.read(relay, COMPONENT)
    still.write_text(Path(str(spring)).read_text().replace(f"participation = {parts[1]}", "participation = 0.01"))
    relay.write_text(f"{text}axes.lateral = {parts}\nmodel = [{{}}, {{parameters.beam.file = '{still}'}}]\n")
    with pytest.raises(RelayContactError, match=r"relay.toml:6: axes.lateral.2 = .*mode 2 has another participation"):
        Relay.read(relay, COMPONENT)


def test_a_number_that_no_verdict_depends_on_is_no_evidence() -> None:
    sine = Standard.read("MIL-PRF-28776").tests[0]
    # The time of the sweep is from memory, but no verdict depends on it.
    assert sine.weakest_evidence == "read in the standard"
    # The density of the noise is from memory, too.
    assert Standard.read("MIL-PRF-28776").tests[1].weakest_evidence == "from memory"
    # None is stated.
    other = Standard.read("MIL-STD-810")
    assert other.tests[0].evidence == other.contacts.evidence == "from memory"


def test_a_course_begins_gently_where_it_does_not_begin_at_rest() -> None:
    course = Course(np.array([0.0, 1.0]), np.array([2.0, 2.0]))
    padded = course.padded(0.1)
    assert padded.acceleration[:3].tolist() == [0, 2, 2]
    assert padded.time[:3] == pytest.approx([0, 0.2, 0.3])
    assert padded.end == pytest.approx(1.3)
