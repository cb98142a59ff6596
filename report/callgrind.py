"""Instructions, counted by valgrind's callgrind: they do not depend on what else the machine does."""

import os
import subprocess
from pathlib import Path

from report.files import ROOT

LENGTH, STEP = 0.1, 1e-5
"""Simulated in a run of the minimal scene, and its communication step, s."""
STEPS = 5000
"""Communication steps of the shorter of two runs whose instructions are compared."""


def build(*which: str) -> Path:
    """Build a program for any processor, as valgrind does not know all instructions of this one; return its folder.

    In a target folder of its own: the file of the library has the same name in all builds.
    """
    folder = ROOT / "target/portable"
    cargo = os.environ.get("CARGO", "cargo")
    command = [cargo, "build", "--release", "--features=portable", f"--target-dir={folder}", *which]
    subprocess.run(command, cwd=ROOT, check=True)
    return folder / "release"


def count(program: Path, *arguments: str) -> float:
    """Return the instructions of a whole run of a program."""
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", str(program), *arguments]
    try:
        run = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True)
    except FileNotFoundError as error:
        raise SystemExit("valgrind is missing (on Debian: apt-get install valgrind)") from error
    return float(run.stderr.partition("Collected : ")[2].split()[0])


class Minimal:
    """The minimal scene, run by the example `run_scene`."""

    def __init__(self) -> None:
        """Build it."""
        self.program = build("--package=relay-contact", "--example=run_scene") / "examples/run_scene"

    def per_millisecond(self, changes: dict[str, str]) -> float:
        """Return the instructions per simulated millisecond with changes; what is done before the steps drops out."""
        given = ["scenes/minimal.toml", *(f"{name}={value}" for name, value in changes.items())]
        long, short = (count(self.program, *given, f"stop={stop}") for stop in (LENGTH, STEP))
        return (long - short) / (1e3 * (LENGTH - STEP))


def show() -> None:
    """Print the instructions of communication steps through C and in the library, and ratios of some scenes."""
    program = build("--package=campaign", "--bin=steps") / "steps"
    for scene in ("1us", "10us", "shaken", "sampled", "random"):
        through_c, alone = (
            (count(program, scene, way, str(2 * STEPS)) - count(program, scene, way, str(STEPS))) / STEPS
            for way in ("fmi2DoStep", "library")
        )
        print(f"{scene}: {through_c:.0f} instructions per fmi2DoStep, {alone:.0f} per Simulation::step: "
              f"{100 * (through_c / alone - 1):+.2f} %")  # fmt: skip
    minimal = Minimal()
    random = {"effects.excitation": "Random", "excitation.frequency": "20", "excitation.endFrequency": "2000",
              "excitation.spectralDensity": "1"}  # fmt: skip
    for step in ("1e-6", "1e-5", "1e-4", "1e-3"):
        always = {"communicationStep": step, "effects.contactDamping": "true"}
        hertz, *others = (
            minimal.per_millisecond(always | changes)
            for changes in ({}, {"effects.contactLaw": "Linearised"}, {"effects.contactLaw": "Bonded"}, random)
        )
        linearised, bonded, shaken = (each / hertz for each in others)
        print(f"step {step} s, over the Hertz contact under a sine: linearised {linearised:.2f}, bonded {bonded:.2f}, "
              f"random excitation {shaken:.2f}")  # fmt: skip
