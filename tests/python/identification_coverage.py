"""How often the 95 % intervals of `identify` hold the true values, over data sets that differ in their scatter alone.

    .venv/bin/python tests/python/identification_coverage.py --sets 400 --workers 2

The data are those of `measured.py`, by the second solution of the model: ring-downs of many lengths, rates and scatters
with a static force, then all kinds of measurements. A share of 0.95 has a standard deviation of 1.1 % over 400 sets.
Prints the tables of docs/identification.md.
"""

import argparse
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import cache, partial
from itertools import product
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from tqdm import tqdm

import measured
from component import COMPONENT
from relay_contact import Array, Values
from relay_contact.identification.measurement import Measurement, read
from relay_contact.identification.prediction import Laboratory
from relay_contact.identification.result import conclude, sought, unknowns
from relay_contact.qualification import Relay, relays

CELLS = [(0.25, 1e4, 0.01), (0.1, 1e4, 0.01), *product((0.01, 1.0), (2e3, 5e4), (0.001, 0.05))]
"""Length (s), rows per second and scatter of ring-downs: two in the middle, then the ends of all three."""

laboratory = cache(lambda: Laboratory(COMPONENT))
clean = cache(lambda: measured.exact(measured.TRUTH))


def errors(measurements: list[Measurement], true: dict[str, float], start: Values | None = None) -> Array:
    """Return for each parameter the error of its logarithm over half of its interval; NaN if it is not determined."""
    path = relays()["paper"]
    # The file's own uncertainty of the overtravel has no part in this: it is sought.
    relay = Relay.read(path, COMPONENT)
    relay = replace(relay, positions={name: {**values, **(start or {})} for name, values in relay.positions.items()})
    asked = unknowns(COMPONENT, relay, path, measurements, list(true))
    # The data are those of a linear contact.
    fit, missing = sought(laboratory(), relay, measurements, asked, opens=False)
    result = conclude(fit, missing, relay, path)
    return np.array([
        np.nan if name in missing else np.log(result[name].value / value) / result[name].half
        for name, value in true.items()
    ])  # fmt: skip


def of_record(cell: tuple[float, float, float], seed: int) -> Array:
    """Return the errors by a static force and a ring-down of a length (s), rate (1/s) and scatter."""
    return errors(measured.record(*cell, seed), measured.RINGING, measured.GUESSED)


def of_all(seed: int) -> Array:
    """Return the errors by measurements of all kinds."""
    with TemporaryDirectory() as folder:
        paths = measured.files(Path(folder), measured.scattered(clean(), seed))
        return errors([read(each, COMPONENT, ["contact closed"]) for each in paths.values()], measured.TRUTH)


def of_rough_frequencies(seed: int) -> Array:
    """Return the errors by frequencies of a rough contact over the overtravel."""
    return errors(measured.rough_frequency_record(seed), measured.ROUGH, measured.ROUGH_GUESSED)


def of_rough_curves(seed: int) -> Array:
    """Return the errors by response curves of a rough contact at several overtravels."""
    return errors(measured.rough_curve_records(seed), measured.ROUGH, measured.ROUGH_GUESSED)


def shares(rows: Array) -> list[str]:
    """Return for each parameter in how many of the sets the interval holds the true value, in %.

    What is not determined has an interval without ends; where that happens, the number of sets that determine it.
    """
    determined = np.isfinite(rows).sum(axis=0)
    held = 100 * (~(np.abs(rows) > 1)).mean(axis=0)
    told = zip(held, determined, strict=True)
    return [f"{share:.1f}" + (f" ({number})" if number < len(rows) else "") for share, number in told]


def main() -> None:
    """Count."""
    line = argparse.ArgumentParser(description=str(__doc__).splitlines()[0])
    line.add_argument("--sets", type=int, default=400, help="number of data sets in each row (%(default)s)")
    line.add_argument("--workers", type=int, default=2, help="processes (%(default)s)")
    given = line.parse_args()
    print(f"| record | rows per second | scatter | {' | '.join(measured.RINGING)} |\n|---|---|---|---|---|---|---|")
    with ProcessPoolExecutor(given.workers) as pool:
        for length, rate, noise in tqdm(CELLS):
            work = pool.map(partial(of_record, (length, rate, noise)), range(given.sets), chunksize=10)
            told = " | ".join(shares(np.array(list(work))))
            print(f"| {1e3 * length:g} ms | {rate:g} | {100 * noise:g} % | {told} |", flush=True)
        all_kinds = np.array(list(tqdm(pool.map(of_all, range(given.sets)), total=given.sets)))
        print(f"| all kinds | | | {' | '.join(shares(all_kinds))} |")
        print(f"\n| rough contact | {' | '.join(measured.ROUGH)} |\n|---|---|---|---|")
        for of_rough, name in ((of_rough_frequencies, "frequencies"), (of_rough_curves, "response curves")):
            work = pool.map(of_rough, range(given.sets), chunksize=10)
            print(f"| {name} | {' | '.join(shares(np.array(list(tqdm(work, total=given.sets)))))} |", flush=True)


if __name__ == "__main__":
    main()
