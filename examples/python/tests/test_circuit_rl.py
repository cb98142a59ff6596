"""The contact in the RL circuit: waveforms, heat, convergence, and the run without ngspice."""

import ctypes
import re
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from conftest import CAPACITOR, COIL, FMU, LOAD, SOURCE, advanced, contact_voltage, is_picture, run_example, run_inside
from relay_contact import Array, Component, Scene, read_table, scenes
from relay_contact import run as simulate

STEP = 2e-6
CIRCUITS = ["built-in", "ngspice"]
# ngspice steps by 0.1 us at most; the fastest the circuit does is 1 / (Rq Cq) = 1e5 1/s. The trapezoidal rule then
# misses a twelfth of the square of their product, of 0.1 A and of 6.7 V. The closed form misses nothing.
TRAPEZOID = (1e5 * 1e-7) ** 2 / 12


def load_ngspice() -> bool:
    try:
        ctypes.CDLL("libngspice.so.0")
    except OSError:
        return False
    return True


@dataclass
class Shown:
    """What the example showed with a circuit."""

    circuit: str
    said: str
    folder: Path


@pytest.fixture(scope="module", params=CIRCUITS)
def shown(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Shown:
    """Run the example with either circuit."""
    if request.param == "ngspice" and not load_ngspice():
        pytest.skip("libngspice.so.0 is not installed")
    circuit, folder = str(request.param), tmp_path_factory.mktemp("circuit")
    return Shown(circuit, run_example(folder, "circuit_rl", "--circuit", circuit), folder)


def slopes(state: Array, conductance: float) -> list[float]:
    """Give the change of current, capacitor voltage and heat in the contact; by Kirchhoff's laws, node by node."""
    voltage = contact_voltage(state, conductance)
    charging = state[0] - conductance * voltage
    return [(SOURCE - LOAD * state[0] - voltage) / COIL, charging / CAPACITOR, conductance * voltage**2]


def test_waveforms_and_heat(shown: Shown) -> None:
    got = read_table(shown.folder / "circuit-rl.csv")
    assert is_picture(shown.folder / "circuit-rl.png")

    # The instants of the opening at 400 m/s2 and 1 kHz from rest, converged by two other methods; the component locates
    # to 1 ns.
    assert np.unique(got["contact.lastOpening"])[1] == pytest.approx(708.827593e-6, abs=1e-9)
    assert np.unique(got["contact.lastClosing"])[1] == pytest.approx(1089.427605e-6, abs=1e-9)

    # The circuit with the conductances of the table held, by a Runge-Kutta method of order 8.
    conductance = got["contact.conductance"]
    rest = SOURCE / (LOAD + 1 / conductance[0])
    states = [np.array([rest, rest / conductance[0], 0.0])]
    for held in conductance[:-1]:
        solution = solve_ivp(
            lambda _, y, g: slopes(y, g), (0, STEP), states[-1], "DOP853", args=(held,), rtol=1e-10, atol=1e-14
        )
        states.append(solution.y[:, -1])
    current, capacitor, heat = np.array(states).T
    # 1e-9: a thousand steps at 1e-10, damped; 1e-11: the digits of the table.
    slack = 1e-9 if shown.circuit == "built-in" else TRAPEZOID
    assert np.abs(got["load.current"] - current).max() < 0.1 * slack + 1e-11
    assert np.abs(got["capacitor.voltage"] - capacitor).max() < 6.7 * slack + 1e-11
    # The fastest the power does is twice as fast as the circuit, over the points of at most 0.25 us of a step.
    told = re.search(r"heat in the contact: (\S+) uJ", shown.said)
    assert told
    assert float(told[1]) == pytest.approx(1e6 * heat[-1], rel=(2 * 1e5 * 0.25e-6) ** 2 / 12, abs=5e-4)

    # The circuit's own current: closed that of the load, open hardly any; never beyond the range without arcs.
    assert got["circuit.current"] == pytest.approx(got["circuit.voltage"] * conductance, rel=1e-9)
    assert "inside the range without arcs" in shown.said
    assert 6 < np.abs(got["circuit.voltage"]).max() < 12
    assert np.abs(got["circuit.current"]).max() < 0.4


@cache
def solved() -> tuple[Array, Array]:
    """Give times and the load current by another solution: the mean conductance of steps of 0.1 us, cut at events."""
    scene = Scene.read(scenes()["chatter-41g"])
    names = ["contact.conductance", "contact.lastOpening", "contact.lastClosing"]
    fine = simulate(replace(scene, stop=2.5e-3, step=1e-7, outputs=names), component=Component(FMU))
    events = np.concatenate([np.unique(fine[f"contact.last{name}"])[1:] for name in ("Opening", "Closing")])
    times, conductances = np.append(fine["time"], events), np.append(fine["contact.conductance"], 0 * events + 1e-9)
    ordered = np.argsort(times)
    times, conductances = times[ordered], conductances[ordered]
    rest = SOURCE / (LOAD + 1 / conductances[0])
    states = [np.array([rest, rest / conductances[0]])]
    for conductance, length in zip((conductances[:-1] + conductances[1:]) / 2, np.diff(times), strict=True):
        states.append(advanced(states[-1], conductance, length))
    return times, np.array(states)[:, 0]


def test_error_falls_with_the_first_power_of_the_step(shown: Shown) -> None:
    study = read_table(shown.folder / "circuit-rl-convergence.csv")
    step, root, largest = study.values()
    # Four events, each late by a part of the step that is as good as random: a root mean square scatters by a quarter,
    # and a line through six of them, over steps of 1 to 40, by 0.08 in its slope. Three times that.
    order = np.polyfit(np.log(step), np.log(root), 1)[0]
    assert order == pytest.approx(1, abs=0.25)
    # A step late at most, at a slope changed by 6 V / 1 mH at most.
    assert np.all(largest < step * SOURCE / COIL)

    # The error of 2 us against another solution.
    got = read_table(shown.folder / "circuit-rl.csv")
    errors = got["load.current"] - np.interp(got["time"], *solved())
    # Second order in 0.1 us: 1e5 1/s times 0.1 us, squared, of 0.1 A.
    row = np.argmin(np.abs(step - STEP))
    assert np.sqrt(np.mean(errors**2)) == pytest.approx(root[row], abs=1e-5)
    assert np.abs(errors).max() == pytest.approx(largest[row], abs=1e-5)


WITHOUT_NGSPICE = """
import ctypes
class Hidden(ctypes.CDLL):
    def __init__(self, name, *arguments, **named):
        if "ngspice" in str(name):
            raise OSError(name)
        super().__init__(name, *arguments, **named)
ctypes.CDLL = Hidden
run()
"""


def test_without_ngspice_it_says_so_and_uses_the_closed_form(tmp_path: Path) -> None:
    free = run_inside(WITHOUT_NGSPICE, "circuit_rl", "--out", str(tmp_path))
    assert free.returncode == 0, free.stderr
    assert "libngspice0" in free.stdout.splitlines()[0]
    assert "built-in, communication step" in free.stdout
    assert (tmp_path / "circuit-rl.csv").is_file()

    wanted = run_inside(WITHOUT_NGSPICE, "circuit_rl", "--out", str(tmp_path), "--circuit", "ngspice")
    assert wanted.returncode == 1
    assert "libngspice0" in wanted.stderr
    assert "Traceback" not in wanted.stderr
