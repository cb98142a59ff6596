"""The examples in their short forms, run as their users run them, against second solutions and closed forms."""

import ctypes
import math
import re
import subprocess
import sys
import tomllib
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.integrate import solve_ivp

from closing_bounce import Relay as Switched
from own_spring_elements import CUBE, Drawing, Elements, missing, segments
from reference import Reference
from relay_contact import Array, Component, Scene, Values, fmu_path, read_table
from whole_relay import Coil, Relay

FOLDER, FMU = Path(__file__).parent, fmu_path()
# Accuracy of an instant in the component, s.
LOCATED = 1e-9
# The circuit of the examples once more: V, Ohm, H, Ohm, F.
SOURCE, LOAD, COIL, QUENCH, CAPACITOR = 6.0, 60.0, 1e-3, 47.0, 220e-9
# Instants of opening and closing at 400 m/s2 and 1 kHz from rest, converged by two other methods; the component locates
# to 1 ns.
OPENS, CLOSES = 708.827593e-6, 1089.427605e-6

Run = Callable[..., str]
"""Runs an example by its name with arguments; gives what it printed."""


def ran(folder: Path, name: str, *arguments: str, code: str = "run()") -> subprocess.CompletedProcess[str]:
    """Run an example with its files in a folder, within code that calls it by `run()`."""
    quick = [] if name == "paper_1khz" else ["--quick"]
    path = (FOLDER / f"{name}.py").as_posix()
    given = [path, *quick, "--fmu", str(FMU), "--out", str(folder), *arguments]
    start = f"""import runpy, sys
def run():
    sys.argv = {given!r}
    sys.path.insert(0, {FOLDER.as_posix()!r})
    runpy.run_path({path!r}, run_name="__main__")
"""
    program = [sys.executable, path, *given[1:]] if code == "run()" else [sys.executable, "-c", start + code]
    return subprocess.run(program, capture_output=True, text=True, check=False)


def printed(folder: Path, name: str, *arguments: str) -> str:
    """Run an example; give what it printed, fail where it fails."""
    result = ran(folder, name, *arguments)
    assert result.returncode == 0, result.stdout + result.stderr
    for picture in folder.glob("*.png"):
        assert picture.read_bytes().startswith(b"\x89PNG")
        assert picture.stat().st_size > 10_000
    return result.stdout


@pytest.fixture
def run(tmp_path: Path) -> Run:
    """Run examples with their files in the test's folder."""
    return partial(printed, tmp_path)


def order(steps: Array, errors: Array) -> float:
    """Return the order of convergence."""
    return float(np.polyfit(np.log(steps), np.log(errors), 1)[0])


def slopes(_time: float, state: Array, conductance: float) -> list[float]:
    """Return the slopes of load current, capacitor voltage and heat in the contact, by Kirchhoff's laws."""
    current, capacitor, _ = state
    voltage = (current + capacitor / QUENCH) / (conductance + 1 / QUENCH)
    charging = current - conductance * voltage
    return [(SOURCE - LOAD * current - voltage) / COIL, charging / CAPACITOR, conductance * voltage**2]


def advanced(state: Array, conductance: float, length: float, tolerance: float) -> Array:
    """Step the circuit by a Runge-Kutta method of order 8."""
    solved = solve_ivp(slopes, (0, length), state, "DOP853", args=(conductance,), rtol=tolerance, atol=1e-4 * tolerance)
    after: Array = solved.y[:, -1]
    return after


def test_the_published_case_has_the_values_that_the_specimen_was_identified_from(run: Run, tmp_path: Path) -> None:
    rows = [line for line in run("paper_1khz").splitlines() if line.endswith("%")]
    assert len(rows) == 6
    for row in rows[:4]:
        assert abs(float(row.split()[-2])) < 0.1
    assert [len(column) for column in read_table(tmp_path / "paper-1khz.csv").values()] == [2001] * 4


def test_the_map_opens_first_where_linear_theory_says(run: Run, tmp_path: Path) -> None:
    run("opening_map")
    reference = Reference({"effects.axialForce": "None"})
    for frequency, acceleration, longest in zip(*read_table(tmp_path / "opening-map.csv").values(), strict=True):
        part = acceleration * abs(reference.force_response(frequency)) / reference.force
        # The force is a per cent from linear at its opening, and hysteretic where it opens for long.
        if not 0.97 < part < 1.1:
            assert (longest > 0) == (part > 1), (frequency, acceleration)


def circuits() -> list[str]:
    try:
        ctypes.CDLL("libngspice.so.0")
    except OSError:
        return ["built-in"]
    return ["built-in", "ngspice"]


@pytest.mark.parametrize("circuit", circuits())
def test_current_voltage_and_heat_in_a_circuit_obey_kirchhoffs_laws(run: Run, tmp_path: Path, circuit: str) -> None:
    said = run("circuit_rl", "--circuit", circuit)
    got = read_table(tmp_path / "circuit-rl.csv")
    assert np.unique(got["contact.lastOpening"])[1] == pytest.approx(OPENS, abs=1e-9)
    assert np.unique(got["contact.lastClosing"])[1] == pytest.approx(CLOSES, abs=1e-9)

    # The conductances of the table held.
    conductance = got["contact.conductance"]
    rest = SOURCE / (LOAD + 1 / conductance[0])
    states = [np.array([rest, rest / conductance[0], 0.0])]
    for held in conductance[:-1]:
        states.append(advanced(states[-1], held, 2e-6, 1e-10))
    current, capacitor, heat = np.array(states).T
    # ngspice steps by 0.1 us; the fastest the circuit does is 1 / (Rq Cq) = 1e5 1/s. The trapezoidal rule then misses a
    # twelfth of the square of their product, of 0.1 A and of 6.7 V. The closed form misses nothing: 1e-9 of a thousand
    # steps at 1e-10, damped; 1e-11 are the digits of the table.
    slack = 1e-9 if circuit == "built-in" else (1e5 * 1e-7) ** 2 / 12
    assert np.abs(got["load.current"] - current).max() < 0.1 * slack + 1e-11
    assert np.abs(got["capacitor.voltage"] - capacitor).max() < 6.7 * slack + 1e-11
    # The fastest the power does is twice as fast as the circuit, over the points of at most 0.25 us of a step.
    told = re.search(r"heat in the contact: (\S+) uJ", said)
    assert told
    assert float(told[1]) == pytest.approx(1e6 * heat[-1], rel=(2 * 1e5 * 0.25e-6) ** 2 / 12, abs=5e-4)
    assert "inside the range without arcs" in said
    assert 6 < np.abs(got["circuit.voltage"]).max() < 12


def test_without_ngspice_the_circuit_is_that_in_closed_form(tmp_path: Path) -> None:
    hidden = """
import ctypes
class Hidden(ctypes.CDLL):
    def __init__(self, name, *arguments, **named):
        if "ngspice" in str(name):
            raise OSError(name)
        super().__init__(name, *arguments, **named)
ctypes.CDLL = Hidden
run()
"""
    free = ran(tmp_path, "circuit_rl", code=hidden)
    assert free.returncode == 0, free.stderr
    assert "libngspice0" in free.stdout.splitlines()[0]
    wanted = ran(tmp_path, "circuit_rl", "--circuit", "ngspice", code=hidden)
    assert wanted.returncode == 1
    assert "libngspice0" in wanted.stderr


def test_steps_taken_back_leave_no_trace_and_the_error_falls_with_the_tolerance(run: Run, tmp_path: Path) -> None:
    assert "the same bits" in run("rollback")
    time, length, current, voltage, mean = read_table(tmp_path / "rollback-steps.csv").values()
    assert time[1:] == pytest.approx(time[:-1] + length[:-1], abs=1e-15)

    # The component gives the very same bits where nobody ever goes back. (The table holds all digits.)
    with Component(FMU).started(Scene.read("chatter-41g").values) as contact:
        values = [contact.get("contact.conductance")]
        for start, step in zip(time, length, strict=True):
            contact.step(start, step)
            values.append(contact.get("contact.conductance"))
    assert np.array_equal((np.array(values[:-1]) + values[1:]) / 2, mean)
    # And the circuit follows from them.
    for n in range(len(time) - 1):
        after = advanced(np.array([current[n], voltage[n], 0.0]), mean[n], length[n], 1e-13)[:2]
        assert after == pytest.approx([current[n + 1], voltage[n + 1]], rel=1e-11, abs=1e-11)
    for instant in (OPENS, CLOSES):
        assert np.abs(time - instant).min() < 1e-9

    runs = pd.read_csv(tmp_path / "rollback.csv", index_col="master")[["setting", "steps.done", "error.load.current"]]
    # Late by half a step as by a whole one, at a slope changed by 6 V / 1 mH at most; the largest of four delays
    # scatters by a sixth, and a line through six such points by 0.05: five times that.
    fixed = runs.loc["fixed"].to_numpy()
    assert np.all(fixed[:, 2] < fixed[:, 0] * SOURCE / COIL)
    assert order(fixed[:, 0], fixed[:, 2]) == pytest.approx(1, abs=0.25)
    # The error of a step, h^3, is kept at the tolerance, and the sum goes with h^2: the tolerance to the power 2/3.
    # Each error scatters by a fifth, the slope over four decades by 0.04: three times that.
    events = runs[runs.setting <= 1e-4].loc["adaptive with events"].to_numpy()
    assert order(events[:, 0], events[:, 2]) == pytest.approx(2 / 3, abs=0.12)
    # What the events are worth: a tenth of the calls of the best fixed master, for a fiftieth of its error.
    assert events[0, 1] < fixed[-1, 1] / 10
    assert events[0, 2] < fixed[-1, 2] / 50


def test_a_coil_makes_and_breaks_the_contact_as_in_one_solution_of_both(run: Run, tmp_path: Path) -> None:
    run("coil")
    coupled = read_table(tmp_path / "coil.csv")
    time, place = coupled["time"], coupled["armature.displacement"]
    on, off = 1e-3, 21e-3
    contact: Values = {"effects.pusher": "Armature", "contact.overtravel": -5e-5, "contact.damping": 1e-6}
    relay = Relay(contact, coil=Coil(12.0, on, off, 240.0, 1.92, 3e-4))
    course = relay.solve(time)
    force, away = course.forces["contact"], place - course.overlaps["core"] - relay.get("armature.corePosition")
    made, left = (course.changes["contact", what] for what in ("closes", "leaves"))
    assert (len(made), len(left)) == (2, 2)
    steps, *found = read_table(tmp_path / "coil-steps.csv").values()
    for own, exact in zip(found, (made[0] - on, made[1] - made[0], left[1] - off, 0.0), strict=True):
        # Of second order in the step, over the milliseconds in which flux and armature change.
        errors = np.abs(own - exact)
        assert np.all(errors < steps**2 / 0.5e-3 + LOCATED)
        assert errors[0] < 0.3 * errors[1] + LOCATED
    assert np.abs(away).max() < steps[0] ** 2 / 0.5e-3 * np.abs(np.gradient(place, time)).max()
    # While it is held, nothing moves fast.
    held = (time > on + 12e-3) & (time < off)
    assert np.abs(coupled["contact.force"] - force)[held].max() < 1e-7
    assert force[held].min() > 0.7


def test_the_bounce_of_a_closing_contact_is_that_of_a_second_solution(run: Run, tmp_path: Path) -> None:
    gap, overtravel, speed, damping = 20e-6, 200e-6, 0.06, 1e-6
    run("closing_bounce")
    shown, *grid = pd.read_csv(tmp_path / "closing-bounce.csv").to_dict("records")
    assert (shown["speed [m/s]"], shown["contact.damping [s]"]) == (speed, damping)
    course = np.column_stack(list(read_table(tmp_path / "closing-bounce-course.csv").values()))
    # The spring is at rest before: it is touched when the gap is travelled.
    assert abs(shown["first touch [s]"] - gap / speed) < 1e-9
    after = course[:, 0] - gap / speed
    near = (after > 0) & (after < 300e-6)
    # From the touch on, so with a gap of nothing.
    values: Values = {"contact.overtravel": 0.0, "contact.damping": damping, "effects.axialForce": "None"}
    reference = Reference(values)
    times, limit = np.array([0.0, *after[near], 300e-6]), reference.force_of_resistance(60.0)
    bounce = reference.course(times, speed=speed, limit=limit)
    force, opened = bounce.forces["contact"][1:-1], np.array(bounce.changes["contact", "falls"])
    closed = np.array(bounce.changes["contact", "rises"])
    # The blow is of the high modes, of which both have a limited number: 1e-3 of it.
    assert np.max(np.abs(course[near, 1] - force)) < 2e-3 * force.max()
    assert len(opened) == shown["bounces on make"] == 1
    assert np.isclose(shown["bounce time [s]"], closed[-1], rtol=1e-3)
    assert np.isclose(shown["open while bouncing [s]"], np.sum(closed[-1:] - opened), rtol=1e-3)
    # A stop at v2/s opens where it exceeds what the preload can slow down; a sudden one shakes twice as much.
    for row in grid:
        stop = row["speed [m/s]"] ** 2 / overtravel * reference.carried_mass / 0.152
        if row["contact.damping [s]"] > 5e-6 and not 0.5 < stop < 1:
            assert (row["bounces on make"] > 0) == (stop > 1), row


def test_a_gap_too_short_for_an_interruption_leaves_the_bounces() -> None:
    relays = [Switched(Component(FMU), gap, 200e-6, 100e-6) for gap in (20e-6, 60e-6)]
    short, long = (relay.run(0.4, 1e-7)[0] for relay in relays)
    assert short["first touch [s]"] < 100e-6 < long["first touch [s]"]
    for name in ("bounces on make", "bounce time [s]", "open while bouncing [s]"):
        assert short[name] == pytest.approx(long[name], rel=1e-3)
        assert short[name] > 0


def test_frequencies_and_hysteresis_with_friction_are_those_of_a_second_solution(run: Run, tmp_path: Path) -> None:
    said = run("friction")
    assert "  without friction: 5.08 cN at 1250 Hz" in said
    assert "  with: 4.91 cN at 1250 Hz" in said
    rubbing: Values = {"effects.axialForce": "None", "effects.friction": "Coulomb"}
    columns = read_table(tmp_path / "friction-frequencies.csv").values()
    for length, overtravel, *frequencies in zip(*columns, strict=True):
        spring: Values = {**rubbing, "beam.length": length, "contact.overtravel": overtravel}
        for height, found in zip((0.0, 1e-4, 3e-4, 1e-3), frequencies, strict=True):
            # Both from the characteristic equation; 12 digits are written.
            exact = Reference({**spring, "tip.contactHeight": height}).frequency(sticks=True)
            assert np.isclose(found, exact, rtol=1e-10)
    travel, force, without = read_table(tmp_path / "friction-loop.csv").values()
    # Closing and opening the contact slips all the way but at the turns: T = -+ mu F is a moment h T, which adds
    # 3 h mu / 2 L to the compliance of the spring.
    share = 3 * 1e-3 * 0.2 / (2 * 15.5e-3)
    for place, sign in ((0, 1), (len(travel) // 3, -1)):
        assert np.isclose(force[place] / without[place], 1 / (1 - sign * share), rtol=2e-4)


LACKING = missing()
needs_programs = pytest.mark.skipif(bool(LACKING), reason=LACKING or "nothing")
# A narrow strip, 100 times as long as thick, without hole; its rivet is nearly nothing and at the very end.
STRIP = Drawing(
    length=20.2e-3, width=0.8e-3, taper_start=10e-3, end_width=0.8e-3, thickness=0.2e-3,
    hole=(5e-3, 0.0), rivet=(20e-3, 0.2e-3), head=1e-5, tail=1e-5, rivet_material=CUBE,
)  # fmt: skip


@needs_programs
def test_a_strip_of_finite_elements_deflects_and_vibrates_as_a_beam_does(tmp_path: Path) -> None:
    strip = Elements(STRIP, tmp_path, 0.4e-3)
    stiffness = CUBE.youngs_modulus * STRIP.width * STRIP.thickness**3 / 12
    # A plate bends less than a beam, by 1 - nu^2. The strip is one near its clamp alone, over less than half of its
    # width: three times that share of the length in the compliance, four times in the strain energy of any mode. Shear
    # makes 3 E / (kappa G) r^2 / l^2 of the compliance, with the radius of gyration r.
    plate, clamp = CUBE.poissons_ratio**2, STRIP.width / 2 / STRIP.length
    theory = STRIP.rivet[0] ** 3 / (3 * stiffness)
    shear = 3 * 1.2 * 2.6 / 12 * (STRIP.thickness / STRIP.rivet[0]) ** 2
    assert 1 - 3 * plate * clamp * STRIP.length / STRIP.rivet[0] < strip.compliance / theory < 1 + shear
    basis, whole = strip.basis(20), strip.frequencies(12)
    mass = CUBE.density * STRIP.width * STRIP.thickness
    for number, root in enumerate([1.8751041, 4.6940911, 7.8547574]):
        theory = (root / STRIP.length) ** 2 / (2 * math.pi) * math.sqrt(stiffness / mass)
        found = float(whole[np.argmin(np.abs(whole - basis.frequencies[number]))])
        # Shear and rotary inertia (Timoshenko), and the rivet: the end moves twice the mean.
        above = 0.5 * plate / (1 - plate) * 4 * clamp
        below = (root * STRIP.thickness / STRIP.length) ** 2 * (1 + 1.2 * 2.6) / 24
        below += 2 * STRIP.rivet_load[0] / (mass * STRIP.length)
        assert -below < found / theory - 1 < above, (number, found / theory)
        # CalculiX seeks its eigenvalues to a tolerance of its own, which leaves some 1e-6.
        assert basis.frequencies[number] == pytest.approx(found, rel=1e-5)
    assert basis.compliance == pytest.approx(strip.compliance, rel=1e-5)


def test_segments_have_the_area_of_the_drawing(tmp_path: Path) -> None:
    drawing = Drawing(20e-3, 4e-3, 10e-3, 2.4e-3, 0.2e-3, (9.7e-3, 1.5e-3), (18e-3, 1.6e-3), 0.6e-3, 0.3e-3)
    path = tmp_path / "segments.toml"
    path.write_text(segments(drawing, "test"), encoding="utf-8")
    parts = tomllib.loads(path.read_text(encoding="utf-8"))["segment"]
    area = sum(part["length"] * (part["width_start"] + part["width_end"]) / 2 for part in parts)
    assert area == pytest.approx(4e-3 * 10e-3 + 3.2e-3 * 10e-3 - math.pi * 1.5e-3**2 / 4, rel=1e-8)
    assert sum(part["length"] for part in parts) == pytest.approx(20e-3, rel=1e-8)


@needs_programs
def test_modes_in_the_component_are_the_whole_mesh(run: Run, tmp_path: Path) -> None:
    run("own_spring")
    rows = pd.read_csv(tmp_path / "own-spring.csv", index_col="quantity")
    assert len(rows) == 8
    for name, whole, modes, parts in rows[["finite_elements", "modes", "segments"]].itertuples():
        # The same structure: what differs is the peak between the samples of a spectrum (5 Hz), the Hertz contact
        # instead of a linear one, and the frequencies at which the program prints its response.
        assert modes == pytest.approx(whole, rel=5e-3 if "opening" in name else 2e-4), name
        # A plate bends less by nu^2, 9 %; hole and rivet, half as much in frequency.
        assert parts == pytest.approx(whole, rel=0.05), name


def test_what_cannot_be_used_is_said_in_a_line(tmp_path: Path) -> None:
    for option, value in (("--fmu", __file__), ("--out", __file__)):
        result = ran(tmp_path, "paper_1khz", option, value)
        assert result.returncode == 1
        assert len(result.stderr.splitlines()) == 1
        assert value in result.stderr


def test_missing_programs_are_named(tmp_path: Path) -> None:
    result = ran(tmp_path, "own_spring", code="import os\nos.environ['PATH'] = ''\nrun()")
    assert result.returncode == 1
    assert result.stderr.strip() == "gmsh and ccx not found: apt-get install --no-install-recommends gmsh calculix-ccx"
