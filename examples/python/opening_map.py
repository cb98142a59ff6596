"""Steady vibration that opens the contact: the longest interruption over frequency and acceleration.

A program to start from for studies of one's own: each point is run on the next free core, by threads of this process
(`side_by_side`; scenes alone have `run_many`). The uncertainty of a relay's parameters, what it is worth against a
standard, and many machines: `relay-contact qualify`, docs/qualification.md.
"""

import time
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LogNorm
from tqdm import tqdm

from common import parser, read_arguments, save
from relay_contact import Array, Component, side_by_side, write_table
from relay_contact.figures import GRAVITY
from relay_contact.qualification.response import respond
from relay_contact.qualification.standards import Contacts
from relay_contact.qualification.trials import Specimen, steady

MONITOR = Contacts(opening=0.0, false_make=0.0, voltage=6.0, current=10e-3, clause="", evidence={})


def interruption(specimen: Specimen, point: tuple[float, float]) -> float:
    """Give the longest interruption (s) in steady vibration at a frequency (Hz) and an acceleration (m/s2)."""
    lengths, _ = steady(specimen, *point, gently=True)
    return max(lengths.values(), default=0.0)


def draw(path: Path, frequencies: Array, accelerations: Array, lengths: Array) -> None:
    """Draw the map."""
    figure, axes = plt.subplots(figsize=(8, 5), layout="constrained")
    axes.set_facecolor("#E5E5E5")
    shown = np.ma.masked_equal(1e6 * lengths, 0)
    mesh = axes.pcolormesh(frequencies, accelerations / GRAVITY, shown.T, cmap="cividis", norm=LogNorm())
    figure.colorbar(mesh, label="longest interruption [µs] (grey: none)")
    axes.set(xscale="log", xlabel="frequency [Hz]", ylabel="base acceleration [g]")
    axes.xaxis.set_major_formatter("{x:g}")
    axes.set_title("Interruption of the contact in steady vibration", fontsize="medium")
    save(figure, path)


def main() -> None:
    """Run the map."""
    line = parser(__doc__, "fewer points", "about half a minute on two cores")
    line.add_argument("--workers", type=int, help="threads (one for each core)")
    line.add_argument("--tolerance", type=float, default=0.0, help="solver.tolerance (the component's)")
    given = read_arguments(line)
    frequencies = np.geomspace(100, 3000, 8 if given.quick else 40)
    accelerations = np.linspace(100, 1000, 5 if given.quick else 31)
    points = [(float(f), float(a)) for f in frequencies for a in accelerations]
    component = Component(given.fmu)
    values = {"solver.tolerance": given.tolerance}
    specimen = Specimen(component, values, MONITOR, respond(component, values, MONITOR.threshold))
    begun = time.perf_counter()
    with tqdm(total=len(points)) as bar:
        found = side_by_side(lambda point: interruption(specimen, point), points, given.workers, bar.update)
    print(f"{len(points) / (time.perf_counter() - begun):.0f} simulations a second")
    lengths = np.array(found).reshape(len(frequencies), len(accelerations))
    table, picture = given.out / "opening-map.csv", given.out / "opening-map.png"
    write_table(table, "frequency [Hz],acceleration [m/s2],longest interruption [s]", np.column_stack([points, found]))
    draw(picture, frequencies, accelerations, lengths)
    print(f"opens from {min(a for (_, a), each in zip(points, found, strict=True) if each):.0f} m/s² on")
    print(table, picture, sep="\n")


if __name__ == "__main__":
    main()
