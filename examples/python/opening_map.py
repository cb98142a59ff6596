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
import json
import math
import os
import sys
import threading
import time
from collections.abc import Callable, Iterator
from io import BytesIO
from itertools import islice
from pathlib import Path
from typing import Any

import dask
import matplotlib as mpl
import numpy as np
import pyarrow as pa
import pyarrow.csv
import pyarrow.parquet as pq
from distributed import Client, KilledWorker, WorkerPlugin, as_completed, get_worker
from fmpy import extract, instantiate_fmu, read_model_description
from fmpy.fmi1 import FMICallException
from numpy.typing import NDArray
from scipy.stats import binomtest
from tqdm import tqdm

mpl.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.colors import LogNorm

ROOT = Path(__file__).resolve().parents[2]
GRAVITY = 9.80665  # m/s2
STANDARD = 30 * GRAVITY  # m/s2, vibration of relays after MIL-PRF-28776
LIMIT = 10e-6  # s, MIL-STD-202 method 310
SINE = 2  # of effects.excitation
CHANGE = 1e-4  # part by which two periods may differ and count as the same
PATIENCE = 200  # periods after which the motion counts as not periodic
WATCHED = 2  # periods, so that an interruption over the end of one is seen whole
PIECES = 32  # of a watched period: two interruptions with less of a period between them count as one
TOLERANCES = {"contact.overtravel": 10e-6, "contact.curvatureRadius": 1.1e-3, "contact.damping": 12e-6}
# Colours of Okabe and Ito, told apart also by the colour-blind.
COLOURS = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#D55E00", "#56B4E9", "#000000")

Point = dict[str, float]
Row = tuple[float, float, float, int, str]
RESULTS = [
    ("longest_interruption", pa.float64()),
    ("least_force", pa.float64()),
    ("interruptions_per_period", pa.float64()),
    ("periods_to_settle", pa.int64()),
    ("message", pa.string()),
]


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


class Study:
    """What is simulated: points in a fixed order, cut into chunks, and the files of what is finished."""

    def __init__(self, settings: dict[str, Any], out: Path) -> None:
        """Lay out the points."""
        self.settings = settings
        text = json.dumps(settings, sort_keys=True)
        self.folder = out / f"opening-{settings['study']}-{hashlib.sha256(text.encode()).hexdigest()[:16]}"
        if settings["study"] == "map":
            axes = [settings["values"], settings["frequencies"], settings["accelerations"]]
            self.names = [settings["parameter"], "excitation.frequency", "excitation.amplitude"]
        else:
            axes = [range(settings["samples"]), settings["accelerations"]]
            self.names = ["sample", *settings["tolerances"], "excitation.frequency", "excitation.amplitude"]
        self.axes, self.count = axes, math.prod(len(axis) for axis in axes)
        self.chunks = math.ceil(self.count / settings["chunk"])
        # The size of a chunk is no part of the result.
        note = json.dumps({key: value for key, value in settings.items() if key != "chunk"}, sort_keys=True)
        versions = f"numpy {np.__version__}, pyarrow {pa.__version__}"
        fields = [(name, pa.int64() if name == "sample" else pa.float64()) for name in self.names]
        self.schema = pa.schema(fields + RESULTS, metadata={"study": note, "versions": versions})

    def point(self, index: int) -> Point:
        """Give a point by its place in the order: the same whatever the chunks are."""
        place = np.unravel_index(index, [len(axis) for axis in self.axes])
        values = [float(axis[i]) for axis, i in zip(self.axes, place, strict=True)]
        if self.settings["study"] == "map":
            return dict(zip(self.names, values, strict=True))
        sample, acceleration = values
        deviates = np.random.default_rng([self.settings["seed"], int(sample)]).standard_normal(len(TOLERANCES))
        drawn = {
            name: mean + deviation * float(deviate)
            for (name, (mean, deviation)), deviate in zip(self.settings["tolerances"].items(), deviates, strict=True)
        }
        fixed = {"excitation.frequency": self.settings["frequency"], "excitation.amplitude": acceleration}
        return {"sample": sample} | drawn | fixed

    def points(self, chunk: int) -> list[Point]:
        """Give the points of a chunk."""
        return [self.point(index) for index in self.places(chunk)]

    def places(self, chunk: int) -> range:
        """Tell which points a chunk has."""
        size: int = self.settings["chunk"]
        return range(self.count)[chunk * size : (chunk + 1) * size]

    def path(self, chunk: int) -> Path:
        """Tell where a chunk's results are."""
        return self.folder / f"chunk-{chunk:06}.parquet"

    def finished(self, chunk: int) -> bool:
        """Tell whether a chunk is there, whole and readable."""
        try:
            return bool(pq.read_table(self.path(chunk)).schema.equals(self.schema, check_metadata=True))
        except (OSError, pa.ArrowException):
            return False

    def write(self, chunk: int, rows: list[Row]) -> None:
        """Write the results of a chunk."""
        whole = [tuple(point.values()) + row for point, row in zip(self.points(chunk), rows, strict=True)]
        columns = [
            pa.array(column, field.type) for column, field in zip(zip(*whole, strict=True), self.schema, strict=True)
        ]
        replace(self.path(chunk), lambda path: pq.write_table(pa.table(columns, schema=self.schema), path))

    def combine(self, stem: Path) -> pa.Table:
        """Join all chunks to one table, as Parquet and CSV."""
        table = pa.concat_tables([pq.read_table(self.path(chunk)) for chunk in range(self.chunks)]).combine_chunks()
        replace(stem.with_suffix(".parquet"), lambda path: pq.write_table(table, path))
        plain = pyarrow.csv.WriteOptions(quoting_header="none")
        replace(stem.with_suffix(".csv"), lambda path: pyarrow.csv.write_csv(table, path, plain))
        return table


def replace(path: Path, write: Callable[[Path], object]) -> None:
    """Write a file under another name first: it is whole or not there."""
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f"{path.name}.{os.getpid()}.part")
    write(part)
    part.replace(path)


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


def boundary(accelerations: NDArray[np.float64], longest: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give, for each row, the middle of the step in acceleration at which interruptions come to exceed the limit."""
    opens = longest > LIMIT
    index = np.where(opens.any(axis=1), opens.argmax(axis=1), -1)
    middle = (accelerations[index] + accelerations[np.maximum(index - 1, 0)]) / 2
    return np.where(index > 0, middle, np.nan)


def draw_map(table: pa.Table, study: Study, unit: str, path: Path) -> None:
    """Draw a map for each value of the parameter, and the boundaries together; print where they are lowest."""
    values, frequencies, accelerations = (np.array(axis, dtype=float) for axis in study.axes)
    longest = table["longest_interruption"].to_numpy().reshape(len(values), len(frequencies), len(accelerations))
    columns = 2 if len(values) < 4 else 3
    figure, panels = plt.subplots(
        math.ceil((len(values) + 1) / columns),
        columns,
        figsize=(5.2 * columns, 7.6),
        layout="constrained",
        squeeze=False,
    )
    last = panels.flat[len(values)]
    shades = LogNorm(10, 1e4)
    for i, (value, axes) in enumerate(zip(values, panels.flat, strict=False)):
        label, colour = f"{study.names[0]} = {value:g} {unit}", COLOURS[i % len(COLOURS)]
        edge = boundary(accelerations, longest[i])
        interrupted = np.ma.masked_less_equal(1e6 * longest[i].T, 0)
        mesh = axes.pcolormesh(frequencies, accelerations, interrupted, norm=shades, cmap="viridis", shading="nearest")
        axes.plot(frequencies, edge, color="black", linewidth=1.6, label="opens for 10 µs")
        axes.set_title(label, fontsize="medium")
        last.plot(frequencies, edge, color=colour, linewidth=1.6, label=label)
        if not np.isfinite(edge).any():
            print(f"{label}: no step from closed to open between {accelerations[0]:g} and {accelerations[-1]:g} m/s2")
            continue
        least = int(np.nanargmin(edge))
        lowest, slowest = (f"{a:.1f} m/s2 ({a / GRAVITY:.1f} g)" for a in (edge[least], edge[0]))
        print(f"{label}: opens from {lowest} at {frequencies[least]:g} Hz, from {slowest} at {frequencies[0]:g} Hz")
    figure.colorbar(mesh, ax=panels, label="longest interruption [µs]; white: none", shrink=0.6, extend="both")
    last.set_title("opens for 10 µs, together", fontsize="medium")
    for axes in panels.flat[: len(values) + 1]:
        axes.axhline(STANDARD, color="#D55E00", linestyle="--", linewidth=1.2, label="30 g, MIL-PRF-28776")
        axes.set(xscale="log", xlim=frequencies[[0, -1]], ylim=accelerations[[0, -1]])
        axes.set(xlabel="frequency [Hz]", ylabel="base acceleration [m/s²]")
        axes.xaxis.set_major_formatter("{x:g}")
        axes.legend(fontsize="small", loc="upper left")
        in_g = axes.secondary_yaxis("right", functions=(lambda a: a / GRAVITY, lambda a: a * GRAVITY))
        in_g.set_ylabel("base acceleration [g]")
    for axes in panels.flat[len(values) + 1 :]:
        axes.axis("off")
    figure.suptitle("Vibration that opens the contact")
    figure.savefig(path, dpi=130)
    plt.close(figure)


def draw_tolerances(table: pa.Table, study: Study, path: Path) -> None:
    """Draw the distribution of the longest interruption, and the share beyond the limit; print the latter."""
    accelerations = np.array(study.settings["accelerations"])
    longest = table["longest_interruption"].to_numpy().reshape(-1, len(accelerations)).T
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.8), layout="constrained")
    shares = []
    for i, (acceleration, all_values) in enumerate(zip(accelerations, longest, strict=True)):
        values = np.sort(all_values[np.isfinite(all_values)])
        test = binomtest(int(np.sum(values > LIMIT)), max(1, len(values)))
        interval = test.proportion_ci(0.95, method="exact")
        shares.append((test.statistic, interval.low, interval.high))
        bounds = f"{100 * interval.low:.2f} to {100 * interval.high:.2f} %"
        print(
            f"{acceleration:.1f} m/s2 ({acceleration / GRAVITY:.1f} g): {test.k} of {len(values)} contacts open",
            end=" ",
        )
        print(f"for longer than 10 us, {100 * test.statistic:.2f} %, with 95 % confidence {bounds}")
        label = f"{acceleration / GRAVITY:.3g} g"
        # From zero at the left, where the contacts without interruption are, to all at the right.
        across = np.concatenate(([1e-7], np.maximum(values, 1e-7), [1.0]))
        below = np.concatenate(([0.0], np.arange(1, len(values) + 1) / max(1, len(values)), [1.0]))
        left.step(1e6 * across, 100 * below, where="post", color=COLOURS[i % len(COLOURS)], label=label)
    left.axvline(1e6 * LIMIT, color="#666666", linestyle=":", label="10 µs")
    left.set(xscale="log", xlim=(0.5, 1e7 * max(LIMIT, np.nanmax(longest, initial=0.0))), ylim=(-2, 102))
    left.set(xlabel="longest interruption [µs]; left of the scale: none", ylabel="contacts with at most this [%]")
    left.set_title(f"Longest interruption at {study.settings['frequency']:g} Hz", fontsize="medium")
    share, low, high = 100 * np.array(shares).T
    right.errorbar(accelerations, share, [share - low, high - share], color=COLOURS[0], marker="o", capsize=4)
    right.set(xlabel="base acceleration [m/s²]", ylabel="contacts that open for longer than 10 µs [%]", ylim=(-2, 102))
    right.axvline(STANDARD, color="#D55E00", linestyle="--", label="30 g, MIL-PRF-28776")
    in_g = right.secondary_xaxis("top", functions=(lambda a: a / GRAVITY, lambda a: a * GRAVITY))
    in_g.set_xlabel("base acceleration [g]")
    right.set_title(f"Share of {study.settings['samples']} contacts, 95 % confidence", fontsize="medium")
    for axes in (left, right):
        axes.grid(alpha=0.3)
    left.legend(fontsize="small", loc="center right")
    right.legend(fontsize="small", loc="upper left")
    figure.savefig(path, dpi=130)
    plt.close(figure)


def arguments() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--study", choices=["map", "tolerances"], default="map", help="default: map")
    parser.add_argument("--fmu", type=Path, default=ROOT / "dist" / "RelayContact.fmu", help="the component")
    parser.add_argument("--out", type=Path, default=ROOT / "out", help="folder for results")
    parser.add_argument("--quick", action="store_true", help="fewer points: 10 s, not a minute, on two cores")
    parser.add_argument("--workers", type=int, default=os.cpu_count(), help="processes of the local cluster")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="of a running Dask cluster, instead of a local one")
    parser.add_argument("--chunk", type=int, default=50, help="simulations of a chunk, the piece a kill loses")
    parser.add_argument("--scaling", action="store_true", help="only time a piece on 1, 2, ... workers")
    parser.add_argument("--frequencies", type=float, nargs="+", help="map: Hz; tolerances: one, default 1250 Hz")
    parser.add_argument("--accelerations", type=float, nargs="+", help="m/s2, rising")
    parser.add_argument("--parameter", default="contact.overtravel", help="map: any real parameter of the component")
    parser.add_argument("--values", type=float, nargs="+", default=[1.5e-4, 2e-4, 2.5e-4], help="map: its values, SI")
    parser.add_argument("--samples", type=int, help="tolerances: contacts")
    parser.add_argument("--seed", type=int, default=1, help="tolerances: of the random numbers")
    shown = ("OVERTRAVEL", "RADIUS", "DAMPING")
    text = "tolerances: standard deviations in m, m and s; default: %(default)s"
    parser.add_argument("--deviations", type=float, nargs=3, default=[*TOLERANCES.values()], metavar=shown, help=text)
    given = parser.parse_args()
    if min(given.workers, given.chunk, 1 if given.samples is None else given.samples) < 1:
        parser.error("--workers, --chunk and --samples are 1 or more")
    if given.seed < 0 or min(given.deviations) < 0:
        parser.error("--seed and --deviations are 0 or more")
    for name in ("frequencies", "accelerations"):
        axis = getattr(given, name)
        if axis and not (min(axis) > 0 and sorted(set(axis)) == axis):
            parser.error(f"--{name} are positive and rising")
    if given.study == "tolerances" and len(given.frequencies or [0]) > 1:
        parser.error("--frequencies: the tolerances take one")
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
    if not given.fmu.is_file():
        print(f"{given.fmu} is missing: build it with `cargo xtask fmu`", file=sys.stderr)
        return 1
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
        draw_map(table, study, units[given.parameter], stem.with_suffix(".png"))
    else:
        draw_tolerances(table, study, stem.with_suffix(".png"))
    print(*(stem.with_suffix(suffix) for suffix in (".parquet", ".csv", ".png")), sep="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
