"""Accuracy and cost: docs/accuracy.md, its tables and figures from what the package `benches` measured."""

import re
from collections.abc import Iterable, Iterator
from pathlib import Path

from report import many
from report.figure import Curve, Figure
from report.files import DOCS, OUT, PICTURES, Row, rewrite, rows
from report.page import Section, whole
from report.text import number, rendered, short, table, two_digits

MEASURED = OUT / "accuracy/accuracy.csv"
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
OK = "ok"
TIMES = "\N{MULTIPLICATION SIGN}"


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


def figures(measured: list[Row]) -> list[Figure]:
    """Return the figures of what was measured."""
    found = [integrators(measured, *each) for each in COMPARED]
    curves = list(over(measured, "delivered", "tolerance"))
    asked = sorted({float(row["tolerance"]) for row in measured if row["part"] == "delivered"})
    curves.append(Curve("error = tolerance", asked, asked, "dashed", 6))
    found.append(Figure("accuracy-tolerance", "Error against tolerance", TOLERANCE, FORCE, curves, "xy"))
    modes = list(over(measured, "modes", "modes"))
    found.append(Figure("accuracy-modes", "Error against number of modes", "number of modes", FORCE, modes, "y"))
    return found


def time(seconds: float) -> str:
    """Return a time in s or ms."""
    return f"{two_digits(seconds)} s" if seconds >= 1 else f"{two_digits(1e3 * seconds)} ms"


def envelope(measured: list[Row], scene: str, levels: tuple[float, ...], instants: bool, started: bool = False) -> str:
    """Return a table: of each integrator the cheapest run whose error is at most each level (s, or relative).

    Its time is that of a simulated second, or of the whole run with its start.
    """
    column = "total_seconds" if started else "seconds_per_second"
    own = [row for row in measured if row["scene"] == scene and row["part"] in ("delivered", "peers") and row["events"]]
    names = list(dict.fromkeys(row["integrator"] for row in own))
    scale, unit = (1e-6, " s") if instants else (1.0, "")
    lines = []
    for level in levels:
        cells, least = [f"{short(level)}{unit}"], 0.0
        for name in names:
            good = [row for row in own if row["integrator"] == name and scale * error(row, instants) <= level]
            if not good:
                cells.append("not reached")
                continue
            run = min(good, key=lambda row: float(row[column]))
            cost, tolerance = float(run[column]), short(float(run["tolerance"]))
            spent = time(cost) + (f" (start {time(float(run['start_seconds']))})" if started else "")
            if run["part"] == "delivered":
                least = cost
                cells.append(f"{spent}, {tolerance}, delivers {short(scale * error(run, instants))}{unit}")
            else:
                cells.append(f"**{two_digits(cost / least)}{TIMES}** {spent}, {run['modes']} modes, {tolerance}")
        lines.append(cells)
    return table(["allowed", *names], lines)


def delivered_table(measured: list[Row]) -> str:
    """Return what the component delivers: error of the force, of opening durations, modes, computing time."""
    own = [row for row in measured if row["part"] == "delivered"]
    lines = []
    for tolerance in dict.fromkeys(row["tolerance"] for row in own):
        cells = [short(float(tolerance))]
        for scene in SCENES:
            (row,) = [row for row in own if (row["scene"], row["tolerance"]) == (scene, tolerance)]
            duration = (
                f"{short(float(row['opening_duration_error_us']))} µs, " if row["events"] not in ("", "0") else ""
            )
            cost = time(float(row["seconds_per_second"]))
            cells.append(f"{short(float(row['force_error']))}, {duration}{row['modes']} modes, {cost}")
        lines.append(cells)
    return table(["tolerance", *SCENES], lines)


def verdict(measured: list[Row]) -> str:
    """Return down to which tolerance the error of the contact force stays below it."""
    worst: dict[float, float] = {}
    for row in measured:
        if row["part"] == "delivered":
            tolerance = float(row["tolerance"])
            worst[tolerance] = max(worst.get(tolerance, 0.0), error(row, False))
    limit = max((tolerance for tolerance, most in worst.items() if most > tolerance), default=0.0)
    kept = {tolerance: most / tolerance for tolerance, most in worst.items() if tolerance > limit}
    text = (f"{VERDICT} {short(max(kept))} to {short(min(kept))} the error of the contact force is at most "
            f"{number(100 * max(kept.values()), 0)} % of `solver.tolerance`")  # fmt: skip
    if limit:
        most = max(most for tolerance, most in worst.items() if tolerance <= limit)
        text += f". From {short(limit)} on rounding shows, and the error is up to {short(most)}"
    return f"{text}."


def write() -> Path:
    """Write the tables of docs/accuracy.md, and the figures of what was measured."""
    page, measured = DOCS / "accuracy.md", rows(MEASURED)
    missing = {f"{row['integrator']} {row['outcome']}" for row in measured if row["outcome"].startswith("skipped")}
    if missing:
        raise SystemExit(f"{page.name} is left as it is, as it compares with all peers: {'; '.join(sorted(missing))}")
    for figure in figures(measured):
        figure.write(PICTURES)
    timed = [row for row in measured if row["part"] != "modes" and row["seconds_per_second"]]
    parts = [float(row["seconds_per_second"]) / float(row["least_seconds_per_second"]) for row in timed]
    costs = {(row["scene"], short(float(row["tolerance"]))): float(row["seconds_per_second"])
             for row in timed if row["part"] == "delivered"}  # fmt: skip
    fine, coarse = (1e-6, 1e-7, 1e-8, 1e-9), (1e-2, 1e-4, 1e-6, 1e-8)
    text, _ = rendered("accuracy.md", [], {
        "verdict": verdict(measured), "spread": max(parts) / min(parts) - 1, "delivered": delivered_table(measured),
        "growth": [costs[scene, "1e-10"] / costs[scene, "1e-2"] for scene in SCENES],
        "tables": [
            ("chatter", True, False, envelope(measured, "chatter", fine, True)),
            ("chatter", True, True, envelope(measured, "chatter", fine, True, started=True)),
            ("paper", False, False, envelope(measured, "paper", (1e-2, 1e-4, 1e-6, 1e-10), False)),
            ("chatter 3 %", True, False, envelope(measured, "chatter 3 %", fine, True)),
            ("chatter 3 %", False, False, envelope(measured, "chatter 3 %", coarse, False)),
            ("chatter", False, False, envelope(measured, "chatter", coarse, False)),
            ("closing bounce", True, False, envelope(measured, "closing bounce", fine, True)),
        ],
        "machine": MEASURED.with_name("machine.txt").read_text(encoding="utf-8"),
        "failed": [
            f"{row['scene']}, {row['integrator']}: {row['outcome']}" for row in measured if row["outcome"] != OK
        ],
    })  # fmt: skip
    rewrite(page, "tables", text)
    rewrite(page, "many", f"{many.rates()}\n\n{many.instances()}\n")
    return page


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
