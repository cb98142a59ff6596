"""Points of a study of opening_map.py in a fixed order, divided into chunks, and the files of finished chunks."""

import hashlib
import json
import math
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.csv
import pyarrow.parquet as pq

TOLERANCES = {"contact.overtravel": 10e-6, "contact.curvatureRadius": 1.1e-3, "contact.damping": 12e-6}

Point = dict[str, float]
Row = tuple[float, float, float, int, float, str]
RESULTS = [
    ("longest_interruption", pa.float64()),
    ("least_force", pa.float64()),
    ("interruptions_per_period", pa.float64()),
    ("periods_to_settle", pa.int64()),
    ("longest_after_sudden_start", pa.float64()),
    ("message", pa.string()),
]


class Study:
    """Points in a fixed order, divided into chunks."""

    def __init__(self, settings: dict[str, Any], out: Path) -> None:
        """Arrange the points."""
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
        # The result does not depend on the size of a chunk.
        note = json.dumps({key: value for key, value in settings.items() if key != "chunk"}, sort_keys=True)
        versions = f"numpy {np.__version__}, pyarrow {pa.__version__}"
        fields = [(name, pa.int64() if name == "sample" else pa.float64()) for name in self.names]
        self.schema = pa.schema(fields + RESULTS, metadata={"study": note, "versions": versions})

    def point(self, index: int) -> Point:
        """Give a point by its index, which does not depend on the chunks."""
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
        """Give the indices of the points of a chunk."""
        size: int = self.settings["chunk"]
        return range(self.count)[chunk * size : (chunk + 1) * size]

    def path(self, chunk: int) -> Path:
        """Give the file of a chunk."""
        return self.folder / f"chunk-{chunk:06}.parquet"

    def finished(self, chunk: int) -> bool:
        """Tell whether the file of a chunk is complete."""
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
    """Write a file under another name first, so that it is complete or missing."""
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f"{path.name}.{os.getpid()}.part")
    write(part)
    part.replace(path)
