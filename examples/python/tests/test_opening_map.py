"""The opening map and the tolerances: closed form, another master, and what kills may not change."""

import math
import os
import re
import runpy
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import psutil
import pyarrow.parquet as pq
import pytest
from fmpy import simulate_fmu

from conftest import FMU, FOLDER, is_picture, table
from reference import Reference

OVERTRAVEL, DEVIATION = 2e-4, 1e-5
SPECIMEN = Reference({"effects.axialForce": "None"})
# Of the closed form, as parts: 5.1e-4 for the force at 60 Ohm, which interrupts, beside the preload; 3.0e-4 for the
# axial force; 4.4e-4 for twice the square of 20 Hz over 1354 Hz, the lowest frequency of the closed contact.
CLOSED_FORM = 1.3e-3
# A study of some seconds, so that it can be killed in its middle.
CHUNK, CHUNKS = 3, 40
LONG = ["--study", "tolerances", "--samples", "60", "--accelerations", "294", "353", "--chunk", str(CHUNK)]

Study = Callable[..., str]
"""Runs a study with arguments; gives what it printed."""


def opening(overtravel: float) -> float:
    """Give the constant acceleration that takes all force off the contact, m/s2.

    The inertia of the spring (3/8 of its mass, at the tip) and of the rivet then bend it by the overtravel.
    """
    return SPECIMEN.tip_stiffness * overtravel / SPECIMEN.carried_mass


def numbers(path: Path) -> list[dict[str, float]]:
    """Read a table without its messages."""
    return [{name: float(text) for name, text in row.items() if name != "message"} for row in table(path)]


def files(folder: Path) -> tuple[bytes, bytes]:
    """Give the bytes of both tables of the long study."""
    stem = folder / "opening-map-tolerances"
    return stem.with_suffix(".parquet").read_bytes(), stem.with_suffix(".csv").read_bytes()


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Start a cluster as on other machines, which have neither the files nor the folder; give its address."""
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        address = f"tcp://127.0.0.1:{free.getsockname()[1]}"
    dask = [sys.executable, "-m", "dask"]
    place = {"cwd": elsewhere, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    place["env"] = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    scheduler = subprocess.Popen([*dask, "scheduler", "--host", address, "--no-dashboard"], **place)  # type: ignore[call-overload]
    # Two threads share the instance of the process.
    options = [address, "--no-nanny", "--no-dashboard", "--nthreads", "2", "--local-directory", str(elsewhere)]
    worker = subprocess.Popen([*dask, "worker", *options], **place)  # type: ignore[call-overload]
    yield address
    for process in (worker, scheduler):
        process.terminate()
        process.wait()


@pytest.fixture
def study(cluster: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Study:
    """Run a study on the cluster, in this process, its files in the test's folder; fail where it fails."""

    def printed(*arguments: str) -> str:
        given = ["--quick", "--fmu", str(FMU), "--out", str(tmp_path), "--scheduler", cluster, *arguments]
        monkeypatch.setattr(sys, "argv", ["opening_map.py", *given])
        with pytest.raises(SystemExit) as end:
            runpy.run_path(str(FOLDER / "opening_map.py"), run_name="__main__")
        assert end.value.code == 0
        return capsys.readouterr().out

    return printed


def test_short_form_draws_and_tells(study: Study, tmp_path: Path) -> None:
    printed = study()
    assert is_picture(tmp_path / "opening-map.png")
    rows = numbers(tmp_path / "opening-map.csv")
    assert len(rows) == pq.read_table(tmp_path / "opening-map.parquet").num_rows == 3 * 12 * 13
    assert all(row["periods_to_settle"] > 0 for row in rows)
    # The most sensitive frequency is near the lowest natural frequency of the closed contact, 1354 Hz; the damping of
    # a third of the critical one puts it lower, and neighbours on the axis are a factor of 1.58 apart.
    for frequency in re.findall(r"g\) at ([\d.]+) Hz, from", printed):
        assert 1354 / 1.58 < float(frequency) < 1354
    assert len(re.findall("opens from", printed)) == 3


def test_low_frequencies_open_at_the_closed_form(study: Study, tmp_path: Path) -> None:
    overtravels = [1.5e-4, OVERTRAVEL]
    levels = [round(opening(s)) + k for s in overtravels for k in range(-3, 4)]
    study("--frequencies", "20", "--accelerations", *map(str, levels), "--values", *map(str, overtravels))
    rows = numbers(tmp_path / "opening-map.csv")
    for overtravel in overtravels:
        mine = [row for row in rows if row["contact.overtravel"] == overtravel]
        exact = opening(overtravel)
        # One level, 1 m/s2, lies between the last that is closed and the first that opens.
        closed = max((row["excitation.amplitude"] for row in mine if row["longest_interruption"] == 0), default=0.0)
        opens = min((row["excitation.amplitude"] for row in mine if row["longest_interruption"] > 0), default=0.0)
        assert 0 < opens - closed < 1.5
        assert closed < exact * (1 + CLOSED_FORM)
        assert opens > exact * (1 - CLOSED_FORM)
        # Below it the least force falls in proportion.
        near = next(row for row in mine if row["excitation.amplitude"] == closed)
        preload = SPECIMEN.tip_stiffness * overtravel
        assert near["least_force"] == pytest.approx(preload * (1 - closed / exact), abs=CLOSED_FORM * preload)


def test_another_master_finds_the_same_interruptions(study: Study, tmp_path: Path) -> None:
    """One a period, two a period after a bounce, none."""
    study("--frequencies", "100", "1250", "--accelerations", "320", "1400", "--values", "2e-4")
    rows = {
        (row["excitation.frequency"], row["excitation.amplitude"]): row for row in numbers(tmp_path / "opening-map.csv")
    }
    for (frequency, acceleration), each_period in {(1250.0, 320.0): 1, (100.0, 1400.0): 2, (100.0, 320.0): 0}.items():
        row = rows[frequency, acceleration]
        period, pieces, periods = 1 / frequency, 2000, 25
        vibration = {"excitation.frequency": frequency, "excitation.amplitude": acceleration}
        result = simulate_fmu(
            str(FMU),
            stop_time=periods * period,
            output_interval=period / pieces,
            start_values={"effects.excitation": 2} | vibration,
            output=["contact.resistance"],
        )
        last = result["contact.resistance"][-2 * pieces - 1 :] > 60
        turns = np.flatnonzero(np.diff(last.astype(int)))
        starts = turns[~last[turns]]
        stretches = [end - start for start in starts for end in turns[turns > start][:1]]
        # Both instants are known to one of the 2000 samples of a period; the motions repeat to 1e-4 of the period.
        longest = period * max(stretches, default=0) / pieces
        assert row["longest_interruption"] == pytest.approx(longest, abs=period * (2 / pieces + 1e-4))
        assert row["interruptions_per_period"] == each_period == len(starts) / 2


def test_above_the_resonance_a_sudden_start_opens_what_steady_vibration_leaves_closed(
    study: Study, tmp_path: Path
) -> None:
    frequency, specimen = 2000.0, Reference({})
    # Steady: where the linear force is as large as the preload. The Hertz contact is linear to 1e-3 (the spring feels
    # 1/4655 of it); a sine below zero for 10 us exceeds that by (10 us omega)^2 / 8 = 2e-3.
    steady = specimen.force / abs(specimen.force_response(frequency))
    assert steady / 9.80665 == pytest.approx(65, abs=0.5)
    # A sudden start adds free vibration of up to 2000 / 1355 times the forced one, which the damping lowers.
    levels = [round(part * steady, 3) for part in (0.7, 0.85, 0.997, 1.004)]
    study("--frequencies", str(frequency), "--accelerations", *map(str, levels), "--values", "2e-4")
    rows = numbers(tmp_path / "opening-map.csv")
    assert [row["longest_interruption"] > 0 for row in rows] == [False, False, False, True]
    assert [row["longest_after_sudden_start"] > 10e-6 for row in rows] == [False, True, True, True]


def test_each_contact_opens_as_its_overtravel_says(study: Study, tmp_path: Path) -> None:
    level, contacts = opening(OVERTRAVEL - DEVIATION), 200
    asked = ["--study", "tolerances", "--frequencies", "20", "--accelerations", str(level), "--samples", str(contacts)]
    printed = study(*asked)
    assert is_picture(tmp_path / "opening-map-tolerances.png")
    rows = numbers(tmp_path / "opening-map-tolerances.csv")
    clear = [row for row in rows if abs(opening(row["contact.overtravel"]) / level - 1) > CLOSED_FORM]
    assert len(clear) > 0.95 * contacts
    for row in clear:
        assert (row["longest_interruption"] > 1e-5) == (opening(row["contact.overtravel"]) < level)
    # Mean and spread of the sample: within four standard errors, s / sqrt(n) and s / sqrt(2 n).
    drawn = np.array([row["contact.overtravel"] for row in rows])
    assert drawn.mean() == pytest.approx(OVERTRAVEL, abs=4 * DEVIATION / math.sqrt(contacts))
    assert drawn.std() == pytest.approx(DEVIATION, abs=4 * DEVIATION / math.sqrt(2 * contacts))
    # One standard deviation below the mean, so the share is that below -1 of the normal distribution.
    found = re.search(r": (\d+) of 200 contacts .* confidence ([\d.]+) to ([\d.]+) %", printed)
    assert found
    count, low, high = int(found[1]), float(found[2]) / 100, float(found[3]) / 100
    assert count == sum(row["longest_interruption"] > 1e-5 for row in rows)
    assert low < math.erfc(1 / math.sqrt(2)) / 2 < high
    # Clopper and Pearson: at either bound, a count as far off as this one has a probability of 2.5 %. The bounds are
    # printed to 1e-4, which moves that by up to the density there, sqrt(n / (2 pi p q)) / 2 of it.
    for share, counts in ((low, range(count, contacts + 1)), (high, range(count + 1))):
        tail = sum(math.comb(contacts, k) * share**k * (1 - share) ** (contacts - k) for k in counts)
        assert tail == pytest.approx(0.025, abs=1e-3)


def test_a_refused_simulation_is_told_and_ends_nothing(study: Study, tmp_path: Path) -> None:
    values = ["--parameter", "contact.curvatureRadius", "--values", "0.02177", "20", "--chunk", "2"]
    printed = study("--frequencies", "1000", "--accelerations", "200", "300", "400", *values)
    rows = table(tmp_path / "opening-map.csv")
    assert [row["longest_interruption"] == "nan" for row in rows] == [False] * 3 + [True] * 3
    assert all("contact.curvatureRadius" in row["message"] and "20" in row["message"] for row in rows[3:])
    assert not any(row["message"] for row in rows[:3])
    assert "3 of 6 simulations were rejected" in printed


@pytest.fixture(scope="module")
def undisturbed(cluster: str, tmp_path_factory: pytest.TempPathFactory) -> tuple[bytes, bytes]:
    """Give the tables of the long study in one go on the cluster elsewhere, in chunks of another size."""
    folder = tmp_path_factory.mktemp("undisturbed")
    subprocess.run(command(folder, "--chunk", "13", "--scheduler", cluster), check=True, capture_output=True)
    return files(folder)


def command(folder: Path, *arguments: str) -> list[str]:
    """Give the command of the long study."""
    return [sys.executable, str(FOLDER / "opening_map.py"), "--fmu", str(FMU), "--out", str(folder), *LONG, *arguments]


@pytest.fixture
def started(tmp_path: Path) -> Iterator[subprocess.Popen[str]]:
    """Start the long study on one worker, and leave nothing of it behind."""
    process = subprocess.Popen(
        command(tmp_path, "--workers", "1"),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    yield process
    for left in psutil.process_iter():
        if left.pid != process.pid and os.getpgid(left.pid) == process.pid:
            left.kill()
    process.kill()
    process.communicate()


def chunks(folder: Path, least: int) -> list[Path]:
    """Wait until so many chunks are finished; give their files."""
    end = time.monotonic() + 600
    while time.monotonic() < end:
        found = sorted(folder.glob("opening-tolerances-*/chunk-*.parquet"))
        if len(found) >= least:
            return found
        time.sleep(0.005)
    raise TimeoutError(f"no {least} chunks in {folder}")


def test_a_killed_worker_loses_nothing_and_a_cluster_elsewhere_gives_the_same_bytes(
    started: subprocess.Popen[str], tmp_path: Path, undisturbed: tuple[bytes, bytes]
) -> None:
    finished = chunks(tmp_path, 3)
    assert len(finished) < CHUNKS - 5
    workers = [
        child
        for child in psutil.Process(started.pid).children()
        if any("spawn_main" in word for word in child.cmdline())
    ]
    assert len(workers) == 1
    workers[0].kill()
    printed, errors = started.communicate(timeout=1200)
    assert started.returncode == 0, printed + errors
    assert "Restarting worker" in errors
    assert files(tmp_path) == undisturbed


def test_a_killed_study_goes_on(
    started: subprocess.Popen[str], tmp_path: Path, undisturbed: tuple[bytes, bytes]
) -> None:
    chunks(tmp_path, 4)
    started.kill()
    started.wait()
    finished = chunks(tmp_path, 4)
    assert len(finished) < CHUNKS - 5
    # A file that the disk has not kept whole, and one whose writing was cut off.
    broken, *whole = finished
    broken.write_bytes(broken.read_bytes()[:-100])
    broken.with_name("chunk-000039.parquet.1.part").write_bytes(b"PAR1")
    before = {path: path.stat().st_mtime_ns for path in whole}
    result = subprocess.run(command(tmp_path, "--workers", "2"), check=True, capture_output=True, text=True)
    left = CHUNKS - len(whole)
    assert f"{CHUNKS} chunks, {len(whole)} finished before, {left} to do" in result.stdout
    simulated = re.search(r"^(\d+) simulations in", result.stdout, re.MULTILINE)
    assert simulated
    assert int(simulated[1]) == CHUNK * left
    assert {path: path.stat().st_mtime_ns for path in whole} == before
    assert files(tmp_path) == undisturbed
