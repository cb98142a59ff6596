"""Accuracy and cost: docs/accuracy.md, and its figures from what the package `benches` measured."""

import csv
import re
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from report.figure import Curve, Figure
from report.files import DOCS, OUT
from report.page import Section, whole

MEASURED = OUT / "accuracy/accuracy.csv"
RELAYS = DOCS / "promise.csv"
SCENES = ("paper", "linear", "chatter", "chatter 3 %", "chatter 0.3 %", "closing bounce")
COMPARED = (
    ("accuracy-instants", "chatter", True),
    ("accuracy-paper", "paper", False),
    ("accuracy-instants-3", "chatter 3 %", True),
    ("accuracy-chatter-3", "chatter 3 %", False),
    ("accuracy-chatter", "chatter", False),
    ("accuracy-instants-bounce", "closing bounce", True),
)
"""Figures of all integrators, with their scenes; of the instants of opening and closing, or of the force."""
TIME, TOLERANCE = "computing time per simulated second / s", "solver.tolerance"
FORCE, INSTANTS = (
    "error of the contact force, relative to the preload",
    "error of the instants of opening and closing / µs",
)
USELESS = {True: 10.0, False: 1.0}
"""Larger errors are not drawn, us and relative to the preload: such a run is of no use."""
VERDICT = "From tolerances of"
"""Begin of the line among the tables that says down to which one the error stays below it."""
LEAST = 1e-14
"""Smaller errors, from rounding alone, are drawn at this."""

Row = dict[str, str]


def rows(path: Path) -> list[Row]:
    """Return a table that was measured."""
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def error(row: Row, instants: bool) -> float:
    """Return the error of a run; infinite where it has none."""
    return float(row["event_error_us" if instants else "force_error"] or "inf")


def over(measured: list[Row], part: str, column: str) -> Iterator[Curve]:
    """Give the error of the force over a quantity, for each scene."""
    for colour, scene in enumerate(SCENES):
        own = [row for row in measured if (row["part"], row["scene"]) == (part, scene) and row["force_error"]]
        x, y = [float(row[column]) for row in own], [error(row, False) for row in own]
        yield Curve(scene, x, y, "marked", colour)


def cheapest(points: Iterable[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return the runs, by their time and error, that none cheaper equals."""
    found: list[tuple[float, float]] = []
    for point in sorted(points):
        if not found or point[1] < found[-1][1]:
            found.append(point)
    return found


def integrators(measured: list[Row], id: str, scene: str, instants: bool) -> Figure:  # noqa: A002
    """Draw the error over the computing time, for each integrator."""
    runs = [row for row in measured if row["scene"] == scene and row["part"] in ("delivered", "peers")]
    curves: list[Curve] = []
    ends: list[float] = []
    for colour, name in enumerate(dict.fromkeys(row["integrator"] for row in runs)):
        useful = [(float(row["seconds_per_second"]), error(row, instants)) for row in runs
                  if row["integrator"] == name and row["seconds_per_second"]]  # fmt: skip
        points = cheapest(point for point in useful if point[1] <= USELESS[instants])
        if points:
            x, y = zip(*points, strict=True)
            ends += [x[0], x[-1]]
            curves.append(Curve(name, x, y, "marked", colour))
    column = "reference_event_error_us" if instants else "reference_force_error"
    known = max(float(row[column]) for row in runs)
    curves.append(Curve("error of the reference", [min(ends), max(ends)], [known, known], "dashed", 6))
    label = INSTANTS if instants else FORCE
    title = f"{label.partition(' / ')[0].capitalize()} over computing time: {scene}"
    return Figure(id, title, TIME, label, curves, "xy")


def promise(relays: list[Row]) -> Figure:
    """Draw delivered over asked, for random relays."""
    kinds: tuple[tuple[str, int, Callable[[Row], bool]], ...] = (
        ("closed", 0, lambda row: row["opens"] == "false" and row["outcome"] != "IllConditioned"),
        ("opening", 1, lambda row: row["opens"] == "true" and row["outcome"] != "IllConditioned"),
        ("ill-conditioned", 3, lambda row: row["outcome"] == "IllConditioned"),
    )
    curves = []
    for name, colour, is_one in kinds:
        own = [row for row in relays if row["outcome"] != "NotRun" and is_one(row)]
        errors = [max(float(row["error"]), LEAST) for row in own]
        curves.append(Curve(name, [float(row["tolerance"]) for row in own], errors, "points", colour))
    curves.append(Curve("error = tolerance", [1e-8, 1e-2], [1e-8, 1e-2], "dashed", 6))
    label = "error of the contact force, relative as the tolerance"
    return Figure("accuracy-promise", "Error against tolerance, random relays", TOLERANCE, label, curves, "xy")


def figures() -> list[Figure]:
    """Return the figures of what was measured here."""
    found = []
    if MEASURED.exists():
        measured = rows(MEASURED)
        found += [integrators(measured, *each) for each in COMPARED]
        curves = list(over(measured, "delivered", "value"))
        asked = sorted({float(row["value"]) for row in measured if row["part"] == "delivered"})
        curves.append(Curve("error = tolerance", asked, asked, "dashed", 6))
        found.append(Figure("accuracy-tolerance", "Error against tolerance", TOLERANCE, FORCE, curves, "xy"))
        modes = list(over(measured, "modes", "modes"))
        found.append(Figure("accuracy-modes", "Error against number of modes", "number of modes", FORCE, modes, "y"))
    if RELAYS.exists():
        found.append(promise(rows(RELAYS)))
    return found


def delivered(page: str) -> dict[float, list[float]]:
    """Return the errors of the force in all scenes by tolerance, as a table of the page has them."""
    found = {}
    for line in page.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if len(cells) == 1 + len(SCENES) and re.fullmatch(r"1e-\d+", cells[0]):
            found[float(cells[0])] = [float(cell.partition(",")[0]) for cell in cells[1:]]
    return found


def section() -> Section:
    """Return the page as a section, led by what the tables say of themselves."""
    page = whole(DOCS / "accuracy.md")
    (lead,) = [line for line in page.text.splitlines() if line.startswith(VERDICT)]
    measured = (
        "Not measured for this page but by the last `cargo xtask accuracy`: machine and date are with the tables."
    )
    return Section(page.title, f"**{lead}** {measured}\n\n{page.text}", lead)
