"""Many at once, and what an instance costs: tables of docs/accuracy.md."""

import re
import subprocess
import sys
from collections.abc import Callable
from time import perf_counter

import numpy as np
import pandas as pd

from relay_contact import Component, run_many
from report.files import OUT, ROOT
from report.text import number, short, table, two_digits

FOLDER = OUT / "accuracy"
TOLERANCE, LEVELS = 1e-2, np.linspace(100, 3000, 1000)
"""Of the scenes that the package `benches` runs in Rust: they differ in their frequency, Hz."""
ROUNDS = 3


def package(component: Component, workers: int) -> float:
    """Return the simulations a second of the Python package, of the scenes that are run in Rust."""
    changes = [{"solver.tolerance": TOLERANCE, "excitation.frequency": float(level)} for level in LEVELS]
    begun = perf_counter()
    run_many([("chatter-41g", each) for each in changes], workers=workers, component=component)
    return len(changes) / (perf_counter() - begun)


def opening_map(workers: int) -> float:
    """Return the simulations a second that the example says."""
    program = ["examples/python/opening_map.py", f"--tolerance={TOLERANCE}", f"--workers={workers}", f"--out={FOLDER}"]
    run = subprocess.run([sys.executable, *program], cwd=ROOT, check=True, capture_output=True, text=True)
    found = re.search(r"(\d+) simulations a second", run.stdout)
    assert found, run.stdout
    return float(found[1])


def rates() -> str:
    """Measure the runs a second in Python; return them as a table, with those of Rust."""
    measured = pd.read_csv(FOLDER / "many.csv")
    rust = dict(zip(measured.workers.tolist(), measured.simulations_per_second.tolist(), strict=True))
    component = Component()
    kinds: dict[str, Callable[[int], float]] = {
        "*chatter-41g* at 100 to 3000 Hz, 10 ms of 1000 steps, Rust": rust.__getitem__,
        "the same, Python": lambda workers: package(component, workers),
        "opening map, gently raised until steady, then ten periods, Python": opening_map,
    }
    lines = []
    for name, rate in kinds.items():
        best = np.max([[rate(workers) for workers in rust] for _ in range(ROUNDS)], axis=0)
        share = best[-1] / best[0] / list(rust)[-1]
        lines.append([name, *(f"{float(f'{each:.2g}'):.0f}" for each in best), f"{number(100 * share, 0)} %"])
    heads = [f"{workers} worker{'s' * (workers > 1)}" for workers in rust]
    return table([f"simulations a second, tolerance {short(TOLERANCE)}", *heads, "for each core"], lines)


def instances() -> str:
    """Return what an instance costs, as a table."""
    lines = []
    for row in pd.read_csv(FOLDER / "instances.csv", dtype=str).to_dict("records"):
        times = [two_digits(1e6 * float(row[f"{name}_seconds"])) for name in ("first", "later", "end")]
        lines.append([f"*{row['scene']}*", row["tolerance"], *times, row["started_kb"], row["run_kb"]])
    columns = ["scene", "tolerance", "start, µs", "start beside another one, µs", "end, µs",
               "memory after the start, kB", "after the run, kB"]  # fmt: skip
    return table(columns, lines)
