"""The packaged component in importers of others: what the tests in conformance/ left in out/conformance."""

import json
import time
from typing import Any

from report.files import OUT
from report.text import table

FOLDER = OUT / "conformance"
EXPECTED = {
    "FMPy": ("validation", "run", "published run", "saved states", "SSP description", "scenes"),
    "libcosim": ("run", "published run", "two coupled", "SSP"),
    "Ecos": ("run", "published run", "two coupled", "SSP"),
    "FMU container": ("run", "run as FMI 3", "two coupled"),
    "fmi (Rust)": ("run", "published run"),
    "fmi-rs (Rust)": ("run", "published run"),
}
"""Tasks that the table has to have, by importer."""
COLUMNS = ("importer", "version", "task", "result", "largest difference in contact force")


def rows() -> tuple[list[dict[str, Any]], list[str]]:
    """Return the results that are there, and the tasks without one."""
    read = [json.loads(path.read_text(encoding="utf-8")) for path in FOLDER.glob("*.json")]
    known = {(row["importer"], row["task"]): row for row in read}
    asked = [(importer, task) for importer, tasks in EXPECTED.items() for task in tasks]
    return [known[key] for key in asked if key in known], [" ".join(key) for key in asked if key not in known]


def results(found: list[dict[str, Any]]) -> str:
    """Return the table of results."""
    lines = []
    for row in found:
        apart = row["difference"]
        text = "-" if apart is None else "0 N" if apart == 0 else f"{apart:.1e} N"
        lines.append([row["importer"], row["version"], row["task"], row["result"], text])
    return table(COLUMNS, lines)


def values(quick: bool) -> dict[str, Any]:
    """Return the numbers of the section."""
    found, missing = rows()
    age = (time.time() - (FOLDER / "reference.csv").stat().st_mtime) / 60 if found else 0
    return {
        "count": len(found), "missing": missing, "table": results(found), "quick": quick, "age": age,
        "passed": sum(row["result"] == "passed" for row in found),
        "worst": max((row["difference"] or 0.0 for row in found), default=0.0),
    }  # fmt: skip


def show() -> None:
    """Print the table; an error where a result is missing, a warning where an importer did not run."""
    found, missing = rows()
    print(results(found))
    for row in found:
        if row["result"] != "passed":
            print(f"WARNING: {row['importer']}, {row['task']}: {row['result']}")
    if missing:
        raise SystemExit(f"no result of {', '.join(missing)}")
