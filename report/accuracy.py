"""Accuracy and cost: docs/accuracy.md, its tables and figures from what the package `benches` measured."""

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd

from report import many
from report.figure import Curve, Figure
from report.files import DOCS, OUT, PICTURES, rewrite
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
ERRORS = ("force_error", "event_error_us")
"""Columns of errors: of the force, and of instants."""
USELESS = {True: 10.0, False: 1.0}
"""Larger errors are not drawn, us and relative to the preload: such a run is of no use."""
Levels = dict[str, tuple[float, ...]]
INSTANTS_WITHIN: Levels = dict.fromkeys(("chatter", "chatter 3 %", "closing bounce"), (1e-6, 1e-7, 1e-8, 1e-9))
FORCE_WITHIN: Levels = {
    "paper": (1e-2, 1e-4, 1e-6, 1e-10), "chatter": (1e-2, 1e-4, 1e-6, 1e-8), "chatter 3 %": (1e-2, 1e-4, 1e-6, 1e-8),
}  # fmt: skip
"""Errors by scene for which integrators are compared: of the instants, s, and of the force."""
VERDICT = "From tolerances of"
"""Begin of the line among the tables that says down to which one the error stays below it."""
OK = "ok"
TIMES = "\N{MULTIPLICATION SIGN}"


def read() -> pd.DataFrame:
    """Return what was measured; a run that has no error has an infinite one."""
    found = pd.read_csv(MEASURED, dtype={"modes": str})
    return found.fillna(dict.fromkeys(ERRORS, np.inf))


def over(measured: pd.DataFrame, part: str, column: str) -> Iterator[Curve]:
    """Give the error of the force over a quantity, for each scene."""
    for colour, scene in enumerate(SCENES):
        own = measured[(measured.part == part) & (measured.scene == scene) & np.isfinite(measured.force_error)]
        yield Curve(scene, own[column], own.force_error, "marked", colour)


def compared(measured: pd.DataFrame, scene: str) -> pd.DataFrame:
    """Return the runs of a scene by all integrators."""
    return measured[(measured.scene == scene) & measured.part.isin(["delivered", "peers"])]


def integrators(measured: pd.DataFrame, id: str, scene: str, instants: bool) -> Figure:  # noqa: A002
    """Draw the error over the computing time, for each integrator: of the runs that none cheaper equals."""
    runs, error = compared(measured, scene), ERRORS[instants]
    useful = runs[runs.seconds_per_second.notna() & (runs[error] <= USELESS[instants])]
    curves: list[Curve] = []
    ends: list[float] = []
    for colour, name in enumerate(runs.integrator.unique()):
        own = useful[useful.integrator == name].sort_values(["seconds_per_second", error])
        own = own[own[error] < own[error].cummin().shift(fill_value=np.inf)]
        if len(own):
            ends += [own.seconds_per_second.min(), own.seconds_per_second.max()]
            curves.append(Curve(name, own.seconds_per_second, own[error], "marked", colour))
    known = runs[f"reference_{error}"].max()
    curves.append(Curve("error of the reference", [min(ends), max(ends)], [known, known], "dashed", 6))
    label = INSTANTS if instants else FORCE
    title = f"{label.partition(' / ')[0].capitalize()} over computing time: {scene}"
    return Figure(id, title, TIME, label, curves, "xy")


def figures(measured: pd.DataFrame) -> list[Figure]:
    """Return the figures of what was measured."""
    found = [integrators(measured, *each) for each in COMPARED]
    curves = list(over(measured, "delivered", "tolerance"))
    asked = np.unique(measured.tolerance[measured.part == "delivered"])
    curves.append(Curve("error = tolerance", asked, asked, "dashed", 6))
    found.append(Figure("accuracy-tolerance", "Error against tolerance", TOLERANCE, FORCE, curves, "xy"))
    modes = list(over(measured, "modes", "modes"))
    found.append(Figure("accuracy-modes", "Error against number of modes", "number of modes", FORCE, modes, "y"))
    return found


def time(seconds: float) -> str:
    """Return a time in s or ms."""
    return f"{two_digits(seconds)} s" if seconds >= 1 else f"{two_digits(1e3 * seconds)} ms"


def cheapest(measured: pd.DataFrame, scenes: Levels, instants: bool, started: bool = False) -> str:
    """Return a table of the cheapest run of each integrator whose error is at most a level (s, or relative).

    Its time is that of a simulated second, or of the whole run with its start.
    """
    column = "total_seconds" if started else "seconds_per_second"
    scale, unit = (1e-6, " s") if instants else (1.0, "")
    names, lines = compared(measured, "chatter").integrator.unique(), []
    for scene, level in ((scene, level) for scene, levels in scenes.items() for level in levels):
        own = compared(measured, scene)
        own = own[own.events.notna()]
        errors = scale * own[ERRORS[instants]]
        cells, least = [f"*{scene}*", f"{short(level)}{unit}"], 0.0
        for name in names:
            good = own[(own.integrator == name) & (errors <= level)]
            if not len(good):
                cells.append("not reached")
                continue
            run = good.loc[good[column].idxmin()]
            cost, tolerance = run[column], short(run.tolerance)
            spent = time(cost) + (f" (start {time(run.start_seconds)})" if started else "")
            if run.part == "delivered":
                least = cost
                cells.append(f"{spent}, {tolerance}, delivers {short(errors[run.name])}{unit}")
            else:
                cells.append(f"**{two_digits(cost / least)}{TIMES}** {spent}, {run.modes} modes, {tolerance}")
        lines.append(cells)
    return table(["scene", "allowed", *names], lines)


def delivered_table(measured: pd.DataFrame) -> str:
    """Return what the component delivers: error of the force, of opening durations, modes, computing time."""
    lines = []
    for _, own in measured[measured.part == "delivered"].groupby("tolerance", sort=False):
        cells = [short(own.tolerance.iloc[0])]
        for _, row in own.set_index("scene").loc[list(SCENES)].iterrows():
            duration = f"{short(row.opening_duration_error_us)} µs, " if row.events > 0 else ""
            cells.append(f"{short(row.force_error)}, {duration}{row.modes} modes, {time(row.seconds_per_second)}")
        lines.append(cells)
    return table(["tolerance", *SCENES], lines)


def verdict(measured: pd.DataFrame) -> str:
    """Return down to which tolerance the error of the contact force stays below it."""
    worst = measured[measured.part == "delivered"].groupby("tolerance").force_error.max()
    limit = max(worst.index[worst > worst.index], default=0.0)
    kept, beyond = worst[worst.index > limit], worst[worst.index <= limit]
    text = (f"{VERDICT} {short(kept.index.max())} to {short(kept.index.min())} the error of the contact force is at "
            f"most {number(100 * (kept / kept.index).max(), 0)} % of `solver.tolerance`")  # fmt: skip
    if len(beyond):
        text += f". From {short(limit)} on rounding shows, and the error is up to {short(beyond.max())}"
    return f"{text}."


def write() -> Path:
    """Write the tables of docs/accuracy.md, and the figures of what was measured."""
    page, measured = DOCS / "accuracy.md", read()
    skipped = measured[measured.outcome.str.startswith("skipped")]
    missing = set(skipped.integrator + " " + skipped.outcome)
    if missing:
        raise SystemExit(f"{page.name} is left as it is, as it compares with all peers: {'; '.join(sorted(missing))}")
    for figure in figures(measured):
        figure.write(PICTURES)
    timed = measured[(measured.part != "modes") & measured.seconds_per_second.notna()]
    parts = timed.median_seconds_per_second / timed.seconds_per_second
    costs = timed[timed.part == "delivered"].set_index(["scene", "tolerance"]).seconds_per_second
    failed = measured[measured.outcome != OK]
    text, _ = rendered("accuracy.md", [], {
        "verdict": verdict(measured), "spread": parts.max() / parts.min() - 1, "delivered": delivered_table(measured),
        "growth": [costs[scene, 1e-10] / costs[scene, 1e-2] for scene in SCENES],
        "instants": cheapest(measured, INSTANTS_WITHIN, True),
        "started": cheapest(measured, {"chatter": INSTANTS_WITHIN["chatter"]}, True, started=True),
        "forces": cheapest(measured, FORCE_WITHIN, False),
        "machine": MEASURED.with_name("machine.txt").read_text(encoding="utf-8"),
        "failed": list(failed.scene + ", " + failed.integrator + ": " + failed.outcome),
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
    told = "Not measured for this page but by the last `cargo xtask accuracy`: machine and date are with the tables."
    return Section(page.title, f"**{lead}** {told}\n\n{page.text}", lead)
