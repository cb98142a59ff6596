"""How often the 95 % intervals of `identify` hold the true values, over data sets that differ in their scatter alone.

    .venv/bin/python tests/python/identification_coverage.py --sets 200 --workers 2

The data are those of `measured.py`, by the second solution of the model. A share of 0.95 has a standard deviation of
1.5 % over 200 sets. docs/identification.md quotes what this prints; some minutes.
"""

import argparse
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from tqdm import tqdm

from component import COMPONENT
from measured import TRUTH, exact, files, scattered
from relay_contact import Array
from relay_contact.files import named
from relay_contact.identification.measurement import read
from relay_contact.identification.prediction import Laboratory
from relay_contact.identification.result import conclude, sought, unknowns
from relay_contact.qualification import Relay, relays

laboratory = cache(lambda: Laboratory(COMPONENT))
clean = cache(lambda: exact(TRUTH))


def errors(seed: int) -> Array:
    """Identify with a data set; give for each parameter the error of its logarithm over half of its interval."""
    path = named("relay", "paper", relays())
    relay = Relay.read(path, COMPONENT)
    # The file's own uncertainty of the overtravel, and what cannot be told, have no part in this.
    with TemporaryDirectory() as folder:
        paths = files(Path(folder), scattered(clean(), seed))
        measurements = [read(each, COMPONENT, list(relay.positions)) for each in paths.values()]
    asked = unknowns(COMPONENT, relay, path, measurements, list(TRUTH))
    # The data are those of a linear contact.
    fit, missing = sought(laboratory(), relay, measurements, asked, opens=False)
    assert not missing, missing
    result = conclude(fit, missing, relay, path)
    return np.array([np.log(result[name].value / true) / result[name].half for name, true in TRUTH.items()])


def main() -> None:
    """Count."""
    line = argparse.ArgumentParser(description=str(__doc__).splitlines()[0])
    line.add_argument("--sets", type=int, default=200, help="number of data sets (%(default)s)")
    line.add_argument("--workers", type=int, default=2, help="processes (%(default)s)")
    given = line.parse_args()
    with ProcessPoolExecutor(given.workers) as pool:
        rows = np.array(list(tqdm(pool.map(errors, range(given.sets)), total=given.sets)))
    held = np.abs(rows) <= 1
    for name, share, spread in zip(TRUTH, held.mean(axis=0), rows.std(axis=0), strict=True):
        # Of a normal distribution 1.96 standard deviations are half of the interval.
        print(f"{name:24}{100 * share:6.1f} % inside, standard deviation {1.96 * spread:.3f} of what it should be")
    print(f"{'all':24}{100 * held.mean():6.1f} %")


if __name__ == "__main__":
    main()
