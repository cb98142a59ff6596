"""Opening of the contact under vibration, as a study for many cores or machines: Dask distributes the simulations.

`--study map`: longest interruption over frequency, acceleration and one parameter of the component.
`--study tolerances`: the same at a few accelerations for contacts as production makes them, and the share of those that
open for longer than 10 us (MIL-STD-202 method 310). Overtravel, radius and damping are normally distributed about their
start values. The standard deviations are assumptions that show the method: replace them by those of your production.

Steady vibration: the sine rises to its level as half a period of a cosine, within 5 ms or one period, whichever is
longer, until minimum force, maximum force and interrupted time repeat from period to period; the following two periods
are measured. The generator vibrates at full level from time zero; base.acceleration cancels what the rise withholds.
A sudden start at full level is simulated too: above the resonance it opens the contact at lower levels than steady
vibration does, and the contact may then keep opening. An interruption is a stretch with a resistance above
chatter.resistanceThreshold; one that does not end counts with the two periods. A simulation that the component rejects
has NaN and the component's message in its row.

The workers receive the component and the code; they need Dask and FMPy, but neither this file nor a common file system:

    dask scheduler                                          # on one machine, prints its ADDRESS
    dask worker ADDRESS --nworkers 8 --nthreads 1           # on each machine
    python opening_map.py --scheduler ADDRESS               # the only one that writes files

Each finished chunk is a Parquet file in a folder named by the hash of component and settings: an interrupted study
continues, and two studies never mix. Results do not depend on the number of workers, the order or interruptions, on
processors of one kind and with the same versions of NumPy and pyarrow.
"""

import argparse
import difflib
import hashlib
import inspect
import math
import os
import sys
import threading
import time
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Any

import cloudpickle
import dask
import numpy as np
from distributed import Client, KilledWorker, WorkerPlugin, as_completed, get_worker
from fmpy.fmi1 import FMICallException
from tqdm import tqdm

import relay_contact
from opening_map_study import TOLERANCES, Point, Row, Study
from relay_contact import Component, Contact, units

# The processes of a local cluster import this file, too, and need nothing that draws: it takes long to import.
if __name__ != "__mp_main__":
    from common import parser, read_arguments
    from opening_map_figures import draw_map, draw_tolerances
    from relay_contact.figures import GRAVITY

CHANGE = 1e-4  # relative difference below which two periods count as equal
PATIENCE = 200  # periods after which the motion counts as not periodic
WATCHED = 2  # periods measured, so that an interruption across the end of one is seen whole
PIECES = 32  # of a measured period: two interruptions separated by less than a piece count as one
RISE = 5e-3  # s; the slowest vibration of the specimen has then decayed by a factor of 1e6
RISE_PIECES = 16  # of a period of the rise, over each of which base.acceleration is linear


class Shaker(WorkerPlugin):
    """The component on a worker. The scheduler sends it to every worker, also to one that replaces a failed one."""

    idempotent = True  # kept where an earlier study has sent the same one

    def __init__(self, fmu: bytes) -> None:
        """Take the contents of the component; the name is a hash of them and of the method."""
        self.fmu = fmu
        constants = repr((CHANGE, PATIENCE, WATCHED, PIECES, RISE, RISE_PIECES))
        method = inspect.getsource(Shaker) + inspect.getsource(Contact.rise)
        self.name = hashlib.sha256(fmu + constants.encode() + method.encode()).hexdigest()[:16]

    def setup(self, worker: Any) -> None:  # noqa: ANN401
        """Unpack the component into the worker's own temporary folder, which Dask clears, and instantiate it."""
        folder = Path(worker.local_directory) / self.name
        folder.mkdir()
        path = folder / "component.fmu"
        path.write_bytes(self.fmu)
        self.lock = threading.Lock()  # an instance serves one thread at a time
        self.messages: list[str] = []
        self.contact = Contact(Component(path, folder), self.messages)

    def teardown(self, worker: Any) -> None:  # noqa: ANN401, ARG002
        """Free the instance."""
        with self.lock:
            self.contact.fmu.freeInstance()

    def row(self, point: Point) -> Row:
        """Simulate; if the component rejects the point, give its message."""
        self.messages.clear()
        try:
            return *self.steady(point), self.sudden(point), ""
        except FMICallException as error:
            return math.nan, math.nan, math.nan, 0, math.nan, " ".join(self.messages) or str(error)

    def start(self, point: Point) -> None:
        """Initialise the contact at rest; the generator vibrates at full level."""
        self.contact.fmu.reset()
        values: dict[str, Any] = {"effects.excitation": "Sine", "chatter.minimumDuration": 0.0}
        for name, value in (values | point).items():
            self.contact.set(name, value)
        self.contact.initialise()

    def rise(self, point: Point) -> int:
        """Start the vibration gently; give the periods this takes."""
        self.start(point)
        frequency, amplitude = point["excitation.frequency"], point["excitation.amplitude"]
        periods = math.ceil(RISE * frequency)
        self.contact.rise(frequency, amplitude, periods, RISE_PIECES)
        return periods

    def settle(self, point: Point, begin: int) -> tuple[int, bool, float, bool]:
        """Wait, from a period on, until the motion repeats; give the last period, whether it repeats, its minimum force
        and whether it is interrupted.
        """  # noqa: D205
        period, last = 1 / point["excitation.frequency"], np.full(3, np.inf)
        (preload,) = self.contact.real("preload.force")
        (total,) = self.contact.real("chatter.totalInterruption")
        for number in range(begin, begin + PATIENCE):
            self.contact.step(number * period, period)
            least, greatest, now = self.contact.real(
                "step.minimumForce", "step.maximumForce", "chatter.totalInterruption"
            )
            this, total = np.array([least, greatest, now - total]), now
            if np.all(np.abs(this - last) <= CHANGE * np.array([preload, max(preload, greatest), period])):
                return number + 1, True, least, bool(this[2] > 0)
            last = this
        return begin + PATIENCE, False, least, bool(this[2] > 0)

    def steady(self, point: Point) -> tuple[float, float, float, int]:
        """Raise the vibration to its level, and measure."""
        rise = self.rise(point)
        number, repeats, least, interrupted = self.settle(point, rise)
        step = 1 / point["excitation.frequency"] / PIECES
        threshold, total = self.contact.real("chatter.resistanceThreshold", "chatter.totalInterruption")
        begun, current, longest = self.contact.get("chatter.count"), 0.0, 0.0
        # Motion that is periodic and never interrupted needs no further periods.
        for piece in range(0 if repeats and not interrupted else WATCHED * PIECES):
            self.contact.step((number * PIECES + piece) * step, step)
            resistance, force, now = self.contact.real(
                "contact.resistance", "step.minimumForce", "chatter.totalInterruption"
            )
            current, total, least = current + now - total, now, min(least, force)
            longest = max(longest, current)
            if resistance <= threshold:
                current = 0.0
        per_period = (self.contact.get("chatter.count") - begun) / WATCHED
        return longest, least, per_period, number - rise if repeats else 0

    def sudden(self, point: Point) -> float:
        """Start at full level; give the longest interruption until the motion repeats."""
        self.start(point)
        self.settle(point, 0)
        return self.contact.get("chatter.longestInterruption")


def simulate(name: str, number: int, points: list[Point]) -> tuple[int, list[Row], float]:
    """Simulate a chunk, on a worker; give its number, the results and the processor time [s]."""
    plugin: Any = get_worker().plugins[name]
    with plugin.lock:
        start = time.thread_time()
        return number, [plugin.row(point) for point in points], time.thread_time() - start


def run(client: Client, name: str, study: Study, chunks: list[int]) -> Iterator[Any]:
    """Simulate chunks; give (number, rows, seconds) of each that is finished. Few are queued at a time."""

    def submit(chunk: int) -> Any:  # noqa: ANN401
        points = [{key: point[key] for key in study.names if key != "sample"} for point in study.points(chunk)]
        return client.submit(simulate, name, chunk, points, pure=False)

    waiting = iter(chunks)
    futures = as_completed([submit(chunk) for chunk in islice(waiting, 4 * max(1, sum(client.nthreads().values())))])
    for future in futures:
        yield future.result()
        for chunk in islice(waiting, 1):
            futures.add(submit(chunk))


def work(client: Client, name: str, study: Study, todo: list[int]) -> None:
    """Simulate what is not finished, with a progress bar, and print the throughput."""
    start, busy, count, cores = time.perf_counter(), 0.0, 0, 1
    before = study.count - sum(len(study.places(chunk)) for chunk in todo)
    with tqdm(total=study.count, initial=before, unit="simulation") as bar:
        for chunk, rows, seconds in run(client, name, study, todo):
            study.write(chunk, rows)
            busy, count, cores = busy + seconds, count + len(rows), max(cores, sum(client.nthreads().values()))
            bar.update(len(rows))
    elapsed = time.perf_counter() - start
    print(f"{count} simulations in {elapsed:.1f} s on {cores} workers: {count / elapsed:.0f} per second,", end=" ")
    print(
        f"{count / busy:.0f} per second and core; the cores were busy {100 * busy / elapsed / cores:.0f} % of the time"
    )


def arguments() -> argparse.Namespace:
    """Read the command line."""
    line = parser(__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = line.add_argument
    add("--study", choices=["map", "tolerances"], default="map", help="default: map")
    add("--quick", action="store_true", help="fewer points: 10 s instead of two minutes on two cores")
    add("--workers", type=int, default=os.cpu_count(), help="processes of the local cluster")
    add("--scheduler", metavar="ADDRESS", help="of a running Dask cluster, instead of a local one")
    add("--chunk", type=int, default=50, help="simulations per chunk: what an interruption loses")
    add("--frequencies", type=float, nargs="+", help="map: Hz; tolerances: one, default 1250 Hz")
    add("--accelerations", type=float, nargs="+", help="m/s2, increasing")
    add("--parameter", default="contact.overtravel", help="map: any real parameter of the component")
    add("--values", type=float, nargs="+", default=[1.5e-4, 2e-4, 2.5e-4], help="map: its values, SI")
    add("--samples", type=int, help="tolerances: number of contacts")
    add("--seed", type=int, default=1, help="tolerances: of the random numbers")
    shown = ("OVERTRAVEL", "RADIUS", "DAMPING")
    text = "tolerances: standard deviations in m, m and s; default: %(default)s"
    add("--deviations", type=float, nargs=3, default=[*TOLERANCES.values()], metavar=shown, help=text)
    given = read_arguments(line)
    if min(given.workers, given.chunk, 1 if given.samples is None else given.samples) < 1:
        line.error("--workers, --chunk and --samples: 1 or more")
    if given.seed < 0 or min(given.deviations) < 0:
        line.error("--seed and --deviations: 0 or more")
    for name in ("frequencies", "accelerations"):
        axis = getattr(given, name)
        if axis and not (min(axis) > 0 and sorted(set(axis)) == axis):
            line.error(f"--{name}: positive and increasing")
    if given.study == "tolerances" and len(given.frequencies or [0]) > 1:
        line.error("--frequencies: one for the tolerances")
    return given


def settings(given: argparse.Namespace, name: str, component: Component) -> dict[str, Any]:
    """Give all that the results depend on."""
    same = {"study": given.study, "contact": name, "guid": component.description.guid, "chunk": given.chunk}
    few = given.quick
    if given.study == "map":
        frequencies = given.frequencies or np.geomspace(20, 3000, 12 if few else 60).round(1).tolist()
        accelerations = given.accelerations or np.linspace(100, 1000, 13 if few else 61).tolist()
        axes = {"values": given.values, "frequencies": frequencies, "accelerations": accelerations}
        return same | axes | {"parameter": given.parameter}
    means = [component.start(each) for each in TOLERANCES]
    return same | {
        "tolerances": dict(zip(TOLERANCES, zip(means, given.deviations, strict=True), strict=True)),
        "frequency": (given.frequencies or [1250.0])[0],
        "accelerations": given.accelerations or [round(g * GRAVITY, 1) for g in (26, 28, 29, 30, 31, 32, 34)],
        "samples": given.samples or (60 if few else 2000),
        "seed": given.seed,
    }


def main() -> int:
    """Run the study, or what is left of it."""
    given = arguments()
    component = Component(given.fmu)
    real = [v.name for v in component.variables.values() if v.causality == "parameter" and v.type == "Real"]
    if given.parameter not in real or given.parameter in ("excitation.frequency", "excitation.amplitude"):
        near = " or ".join(difflib.get_close_matches(given.parameter, real)) or "for example contact.overtravel"
        print(f"--parameter {given.parameter}: not a real parameter of the component to vary; {near}?", file=sys.stderr)
        return 2
    # Workers elsewhere do not have the module.
    cloudpickle.register_pickle_by_value(relay_contact)
    shaker = Shaker(given.fmu.read_bytes())
    study = Study(settings(given, shaker.name, component), given.out)
    todo = [chunk for chunk in range(study.chunks) if not study.finished(chunk)]
    print(
        f"{study.folder}: {study.chunks} chunks, {study.chunks - len(todo)} finished before, {len(todo)} to do",
        flush=True,
    )
    if todo:
        # A worker that fails says nothing about its chunk, unless many fail at the same one.
        dask.config.set({"distributed.scheduler.allowed-failures": 10})
        local = {"n_workers": given.workers, "threads_per_worker": 1, "dashboard_address": None}
        try:
            with Client(**({"address": given.scheduler} if given.scheduler else local)) as client:
                client.register_plugin(shaker)
                work(client, shaker.name, study, todo)
        except (KilledWorker, OSError) as error:
            print(f"aborted; finished chunks are kept in {study.folder}: {error}", file=sys.stderr)
            return 1
    stem = given.out / ("opening-map" if given.study == "map" else "opening-map-tolerances")
    table = study.combine(stem)
    failed = [row for row in table.to_pylist() if row["message"]]
    for row in failed[:5]:
        point = ", ".join(f"{name} = {row[name]:g}" for name in study.names)
        print(f"rejected by the component: {point}: {row['message']}")
    if failed:
        print(f"{len(failed)} of {study.count} simulations were rejected; their rows have NaN and the message")
    wild = sum(settled == 0 for settled in table["periods_to_settle"].to_pylist()) - len(failed)
    if wild:
        print(f"{wild} of {study.count} motions did not repeat within {PATIENCE} periods and were measured then")
    if given.study == "map":
        labels = [f"{given.parameter} = {units(component.description)[given.parameter].text(v)}" for v in given.values]
        draw_map(table, labels, study.axes, stem.with_suffix(".png"))
    else:
        draw_tolerances(table, study.settings, stem.with_suffix(".png"))
    print(*(stem.with_suffix(suffix) for suffix in (".parquet", ".csv", ".png")), sep="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
