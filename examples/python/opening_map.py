"""Opening of the contact under vibration, as a study too large for one machine: Dask runs it on many cores or machines.

`--study map`: longest interruption over frequency, acceleration and one parameter of the component.
`--study tolerances`: the same at a few accelerations for contacts as a production makes them, and the share of those
that open for longer than 10 us (MIL-STD-202 method 310). Overtravel, radius and damping are normally distributed about
their start values. The standard deviations are assumptions to show the method: put in those of your production.

Each simulation shakes the contact from rest with a sine until least and greatest force and interrupted time repeat from
period to period, and measures the two periods that follow. An interruption is a stretch above 60 Ohm
(chatter.resistanceThreshold); one that does not end counts with the two periods. A simulation that the component
refuses, for a parameter out of range say, does not end a study of perhaps hours: its row has NaN and the component's
message, and the summary tells of it.

The component travels with the work: its bytes go to every worker, also to one that starts later, and are unpacked and
instantiated once per process. A worker needs Dask and FMPy, neither this file nor a common file system. Real cluster:

    dask scheduler                                          # on one machine, prints its ADDRESS
    dask worker ADDRESS --nworkers 8 --nthreads 1           # on each machine
    python opening_map.py --scheduler ADDRESS               # the only one that writes files

Each finished chunk is a Parquet file in a folder named by the hash of component and settings. A study that was killed
goes on where it was, and two studies never mix. The same study gives the same bytes whatever the number of workers, the
order or the kills, on processors of one kind and with the same versions of NumPy and pyarrow.

Instances are reset, not made anew. FMU states are not used: a state holds its parameters, the level among them, so the
settled motion at one level cannot be where the next begins. Where base.acceleration shakes instead, in 64 linear pieces
a period, it can, but that took 8 to 16 ms a level of ten periods; reset and twelve generated ones take 0.5 to 5 ms.
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
from io import BytesIO
from itertools import islice
from pathlib import Path
from typing import Any

import dask
import numpy as np
from distributed import Client, KilledWorker, WorkerPlugin, as_completed, get_worker
from fmpy import extract, instantiate_fmu, read_model_description
from fmpy.fmi1 import FMICallException
from tqdm import tqdm

from common import GRAVITY, parser, read_arguments
from opening_map_figures import draw_map, draw_tolerances
from opening_map_study import TOLERANCES, Point, Row, Study

SINE = 2  # of effects.excitation
CHANGE = 1e-4  # part by which two periods may differ and count as the same
PATIENCE = 200  # periods after which the motion counts as not periodic
WATCHED = 2  # periods, so that an interruption over the end of one is seen whole
PIECES = 32  # of a watched period: two interruptions with less of a period between them count as one


class Contact(WorkerPlugin):
    """The component on a worker. The scheduler gives it to each worker, also to one that replaces a dead one."""

    idempotent = True  # where another study has brought the same one, it stays

    def __init__(self, fmu: bytes) -> None:
        """Take the bytes of the component; the name stands for them and for what is done with them."""
        self.fmu = fmu
        constants = repr((CHANGE, PATIENCE, WATCHED, PIECES))
        self.name = hashlib.sha256(fmu + constants.encode() + inspect.getsource(Contact).encode()).hexdigest()[:16]

    def setup(self, worker: Any) -> None:  # noqa: ANN401
        """Unpack it into the worker's own temporary folder, which Dask clears, and instantiate it."""
        folder = extract(BytesIO(self.fmu), Path(worker.local_directory) / self.name)
        description = read_model_description(folder)
        self.lock = threading.Lock()  # an instance serves one thread at a time
        self.messages: list[str] = []
        self.reference = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.instance = instantiate_fmu(folder, description, "CoSimulation", logger=self.log)

    def teardown(self, worker: Any) -> None:  # noqa: ANN401, ARG002
        """Free the instance."""
        with self.lock:
            self.instance.freeInstance()

    def log(self, _component: int, _instance: bytes, _status: int, _category: bytes, message: bytes) -> None:
        """Keep what the component says."""
        self.messages.append(message.decode())

    def row(self, point: Point) -> Row:
        """Simulate; where the component refuses, tell why."""
        self.messages.clear()
        try:
            return self.simulate(point)
        except FMICallException as error:
            return math.nan, math.nan, math.nan, 0, " ".join(self.messages) or str(error)

    def get(self, *names: str) -> list[float]:
        """Read real variables."""
        return list(self.instance.getReal([self.reference[name] for name in names]))

    def simulate(self, point: Point) -> Row:
        """Shake the contact until its motion repeats, then measure."""
        fmu, period = self.instance, 1 / point["excitation.frequency"]
        fmu.reset()
        fmu.setupExperiment(startTime=0.0)
        fmu.setInteger([self.reference["effects.excitation"]], [SINE])
        values = {"chatter.minimumDuration": 0.0} | point
        fmu.setReal([self.reference[name] for name in values], list(values.values()))
        fmu.enterInitializationMode()
        fmu.exitInitializationMode()
        threshold, preload = self.get("chatter.resistanceThreshold", "preload.force")
        last, total, settled = np.full(3, np.inf), 0.0, 0
        for number in range(PATIENCE):
            fmu.doStep(number * period, period)
            least, greatest, now = self.get("step.minimumForce", "step.maximumForce", "chatter.totalInterruption")
            this, total = np.array([least, greatest, now - total]), now
            if np.all(np.abs(this - last) <= CHANGE * np.array([preload, max(preload, greatest), period])):
                settled = number + 1
                break
            last = this
        begun, start, step, current, longest = self.begun(), (number + 1) * period, period / PIECES, 0.0, 0.0
        for piece in range(WATCHED * PIECES):
            if settled and this[2] == 0.0:
                break  # periodic and never interrupted
            fmu.doStep(start + piece * step, step)
            resistance, force, now = self.get("contact.resistance", "step.minimumForce", "chatter.totalInterruption")
            current, total, least = current + now - total, now, min(least, force)
            longest = max(longest, current)
            if resistance <= threshold:
                current = 0.0
        return longest, least, (self.begun() - begun) / WATCHED, settled, ""

    def begun(self) -> int:
        """Count the interruptions that have begun."""
        return int(self.instance.getInteger([self.reference["chatter.count"]])[0])


def simulate(contact: str, number: int, points: list[Point]) -> tuple[int, list[Row], float]:
    """Simulate a chunk, on a worker; give its number, the results and the seconds of a core it took."""
    plugin: Any = get_worker().plugins[contact]
    with plugin.lock:
        start = time.thread_time()
        return number, [plugin.row(point) for point in points], time.thread_time() - start


def run(
    client: Client, contact: str, study: Study, chunks: list[int], workers: list[str] | None = None
) -> Iterator[Any]:
    """Simulate chunks; give (number, rows, seconds) of each that is finished. Few wait at a time."""

    def submit(chunk: int) -> Any:  # noqa: ANN401
        points = [{name: point[name] for name in study.names if name != "sample"} for point in study.points(chunk)]
        return client.submit(simulate, contact, chunk, points, pure=False, workers=workers)

    waiting = iter(chunks)
    at_once = 4 * (len(workers) if workers else max(1, sum(client.nthreads().values())))
    futures = as_completed([submit(chunk) for chunk in islice(waiting, at_once)])
    for future in futures:
        yield future.result()
        for chunk in islice(waiting, 1):
            futures.add(submit(chunk))


def work(client: Client, contact: str, study: Study, todo: list[int]) -> None:
    """Simulate what is not finished, with a progress bar, and tell the throughput."""
    start, busy, count, cores = time.perf_counter(), 0.0, 0, 1
    before = study.count - sum(len(study.places(chunk)) for chunk in todo)
    with tqdm(total=study.count, initial=before, unit="simulation") as bar:
        for chunk, rows, seconds in run(client, contact, study, todo):
            study.write(chunk, rows)
            busy, count, cores = busy + seconds, count + len(rows), max(cores, sum(client.nthreads().values()))
            bar.update(len(rows))
    elapsed = time.perf_counter() - start
    print(f"{count} simulations in {elapsed:.1f} s on {cores} workers: {count / elapsed:.0f} per second,", end=" ")
    print(f"{count / busy:.0f} per second of a core; they simulated {100 * busy / elapsed / cores:.0f} % of the time")


def scaling(client: Client, contact: str, study: Study, pieces: int) -> None:
    """Simulate the same piece of the study on 1, 2, ... workers and print the throughput; nothing is kept.

    Where the efficiency falls and what a second of a core does stays, the machine has no more free cores.
    """
    chunks = sorted({round(i) for i in np.linspace(0, study.chunks - 1, pieces)})
    addresses, first = sorted(client.nthreads()), 0.0
    print("workers  simulations/s  /s and worker  efficiency  /s of a core")
    for number in range(1, len(addresses) + 1):
        start, count, busy = time.perf_counter(), 0, 0.0
        for _, rows, seconds in run(client, contact, study, chunks, addresses[:number]):
            count, busy = count + len(rows), busy + seconds
        rate = count / (time.perf_counter() - start)
        first = first or rate
        print(
            f"{number:7} {rate:14.0f} {rate / number:14.0f} {100 * rate / number / first:9.0f} % {count / busy:13.0f}"
        )


def arguments() -> argparse.Namespace:
    """Read the command line."""
    line = parser(__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = line.add_argument
    add("--study", choices=["map", "tolerances"], default="map", help="default: map")
    add("--quick", action="store_true", help="fewer points: 10 s, not a minute, on two cores")
    add("--workers", type=int, default=os.cpu_count(), help="processes of the local cluster")
    add("--scheduler", metavar="ADDRESS", help="of a running Dask cluster, instead of a local one")
    add("--chunk", type=int, default=50, help="simulations of a chunk, the piece a kill loses")
    add("--scaling", action="store_true", help="only time a piece on 1, 2, ... workers")
    add("--frequencies", type=float, nargs="+", help="map: Hz; tolerances: one, default 1250 Hz")
    add("--accelerations", type=float, nargs="+", help="m/s2, rising")
    add("--parameter", default="contact.overtravel", help="map: any real parameter of the component")
    add("--values", type=float, nargs="+", default=[1.5e-4, 2e-4, 2.5e-4], help="map: its values, SI")
    add("--samples", type=int, help="tolerances: contacts")
    add("--seed", type=int, default=1, help="tolerances: of the random numbers")
    shown = ("OVERTRAVEL", "RADIUS", "DAMPING")
    text = "tolerances: standard deviations in m, m and s; default: %(default)s"
    add("--deviations", type=float, nargs=3, default=[*TOLERANCES.values()], metavar=shown, help=text)
    given = read_arguments(line)
    if min(given.workers, given.chunk, 1 if given.samples is None else given.samples) < 1:
        line.error("--workers, --chunk and --samples are 1 or more")
    if given.seed < 0 or min(given.deviations) < 0:
        line.error("--seed and --deviations are 0 or more")
    for name in ("frequencies", "accelerations"):
        axis = getattr(given, name)
        if axis and not (min(axis) > 0 and sorted(set(axis)) == axis):
            line.error(f"--{name} are positive and rising")
    if given.study == "tolerances" and len(given.frequencies or [0]) > 1:
        line.error("--frequencies: the tolerances take one")
    return given


def settings(given: argparse.Namespace, contact: str, description: Any) -> dict[str, Any]:  # noqa: ANN401
    """Give all that the results depend on."""
    same = {"study": given.study, "contact": contact, "guid": description.guid, "chunk": given.chunk}
    few = given.quick
    if given.study == "map":
        frequencies = given.frequencies or np.geomspace(20, 3000, 12 if few else 80).round(1).tolist()
        accelerations = given.accelerations or np.linspace(100, 1000, 13 if few else 91).tolist()
        axes = {"values": given.values, "frequencies": frequencies, "accelerations": accelerations}
        return same | axes | {"parameter": given.parameter}
    start = {variable.name: variable.start for variable in description.modelVariables}
    means = [float(start[name]) for name in TOLERANCES]
    return same | {
        "tolerances": dict(zip(TOLERANCES, zip(means, given.deviations, strict=True), strict=True)),
        "frequency": (given.frequencies or [1250.0])[0],
        "accelerations": given.accelerations or [round(g * GRAVITY, 1) for g in (26, 28, 29, 30, 31, 32, 34)],
        "samples": given.samples or (60 if few else 3000),
        "seed": given.seed,
    }


def main() -> int:
    """Run the study, or what is left of it."""
    given = arguments()
    fmu = given.fmu.read_bytes()
    description = read_model_description(BytesIO(fmu))
    real = [v for v in description.modelVariables if v.causality == "parameter" and v.type == "Real"]
    units = {variable.name: variable.declaredType.unit or "" for variable in real}
    if given.parameter not in units or given.parameter in ("excitation.frequency", "excitation.amplitude"):
        near = " or ".join(difflib.get_close_matches(given.parameter, units)) or "for example contact.overtravel"
        print(f"--parameter {given.parameter}: not a real parameter of the component to vary; {near}?", file=sys.stderr)
        return 2
    contact = Contact(fmu)
    study = Study(settings(given, contact.name, description), given.out)
    todo = [chunk for chunk in range(study.chunks) if not study.finished(chunk)]
    if todo or given.scaling:
        # A chunk is not to blame for the workers that die under it, unless there are many.
        dask.config.set({"distributed.scheduler.allowed-failures": 10})
        local = {"n_workers": given.workers, "threads_per_worker": 1, "dashboard_address": None}
        try:
            with Client(**({"address": given.scheduler} if given.scheduler else local)) as client:
                client.register_plugin(contact)
                if given.scaling:
                    scaling(client, contact.name, study, 8 if given.quick else 40)
                    return 0
                before = study.chunks - len(todo)
                print(f"{study.folder}: {study.chunks} chunks, {before} finished before, {len(todo)} to do", flush=True)
                work(client, contact.name, study, todo)
        except (KilledWorker, OSError) as error:
            print(f"given up, what is finished is kept in {study.folder}: {error}", file=sys.stderr)
            return 1
    else:
        print(f"{study.folder}: {study.chunks} chunks, all finished before")
    stem = given.out / ("opening-map" if given.study == "map" else "opening-map-tolerances")
    table = study.combine(stem)
    failed = [row for row in table.to_pylist() if row["message"]] if any(table["message"].to_pylist()) else []
    for row in failed[:5]:
        point = ", ".join(f"{name} = {row[name]:g}" for name in study.names)
        print(f"refused by the component: {point}: {row['message']}")
    if failed:
        print(f"{len(failed)} of {study.count} simulations were refused; their rows have NaN and the message")
    wild = sum(settled == 0 for settled in table["periods_to_settle"].to_pylist()) - len(failed)
    if wild:
        print(f"{wild} of {study.count} motions did not repeat within {PATIENCE} periods: measured as they were then")
    if given.study == "map":
        draw_map(table, study.names[0], study.axes, units[given.parameter], stem.with_suffix(".png"))
    else:
        draw_tolerances(table, study.settings, stem.with_suffix(".png"))
    print(*(stem.with_suffix(suffix) for suffix in (".parquet", ".csv", ".png")), sep="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
