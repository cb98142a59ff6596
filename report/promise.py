"""What the promise of the tolerance is worth: tables and figure of docs/accuracy.md, of the relays judged."""

from pathlib import Path

import pandas as pd

from report.figure import Curve, Figure
from report.files import DOCS, OUT, PICTURES, rewrite
from report.text import rendered, short, table

RELAYS = OUT / "accuracy/promise.csv"
CLASSES = ((0.1, 0.4), (0.4, 2.0), (2.0, 10.0), (10.0, 34.0))
"""Damping of the first mode, %."""
LEAST = 1e-14
"""Smaller errors, from rounding alone, are drawn at this."""
ROUNDING = 1e-7
"""Smaller errors, relative to the tolerance, are rounding."""


def judged() -> pd.DataFrame:
    """Return the relays, with what is asked of them."""
    relays = pd.read_csv(RELAYS)
    relays["ran"] = relays.outcome != "NotRun"
    relays["bad"] = relays.outcome == "IllConditioned"
    relays["kept"] = relays.outcome == "Kept"
    relays["above"] = relays.ran & ~relays.kept
    relays["announced"] = relays.estimate > relays.tolerance
    relays["share"] = relays.error / relays.tolerance
    return relays


def by_damping(ran: pd.DataFrame) -> str:
    """Return a table of the relays by whether they open, and by their damping."""
    lines = []
    for opens, name in ((False, "closed"), (True, "opening")):
        for least, most in CLASSES:
            of = ran[(ran.opens == opens) & (100 * ran.damping).between(least, most, inclusive="left")]
            counts = [of.above.sum(), of.bad.sum(), (of.above & ~of.announced).sum()]
            shares = [short(float(of.share.quantile(part, "higher"))) for part in (0.5, 0.95)]
            lines.append([f"{name}, {least:g} to {most:g} %", f"{len(of)}", *shares, *map(str, counts)])
    return table(["damping of the first mode", "relays", "error / tolerance, median", "95 %", "above",
                  "of these ill-conditioned", "above, not announced"], lines)  # fmt: skip


def by_kind(ran: pd.DataFrame) -> str:
    """Return a table of the relays by their kind: how many keep their tolerance, and whether the others say so."""
    lines = []
    for kind, of in ran.groupby("kind"):
        counts = [len(of), of.kept.sum(), (of.above & of.announced).sum(), (of.above & ~of.announced).sum(),
                  (of.kept & of.announced).sum()]  # fmt: skip
        lines.append([str(kind), *map(str, counts)])
    columns = ["kind", "relays", "kept", "above, announced", "above, not announced", "kept, announced as above"]
    return table(columns, lines)


def figure(relays: pd.DataFrame) -> Figure:
    """Draw delivered over asked."""
    groups = (("closed", 0, ~relays.opens & ~relays.bad), ("opening", 1, relays.opens & ~relays.bad),
              ("ill-conditioned", 3, relays.bad))  # fmt: skip
    curves = []
    for name, colour, chosen in groups:
        of = relays[relays.ran & chosen]
        curves.append(Curve(name, list(of.tolerance), list(of.error.clip(lower=LEAST)), "points", colour))
    curves.append(Curve("error = tolerance", [1e-8, 1e-2], [1e-8, 1e-2], "dashed", 6))
    label = "error of the contact force, relative as the tolerance"
    return Figure("accuracy-promise", "Error against tolerance, random relays", "solver.tolerance", label, curves, "xy")


def write() -> Path:
    """Write tables and figure."""
    relays = judged()
    ran, page = relays[relays.ran], DOCS / "accuracy.md"
    opening = ran[ran.opens & ran.kept]
    least = ran.error.clip(lower=ROUNDING * ran.tolerance)
    instants = 1e9 * opening.instants.quantile([0.5, 0.95], "higher")
    text, _ = rendered("promise.md", [], {
        "by_damping": by_damping(ran), "by_kind": by_kind(ran), "relays": len(relays), "failed": len(relays) - len(ran),
        "opening": len(opening), "right": opening.instants.count(), "instants": instants,
        "covered": 100 * (ran.error <= ran.estimate).mean(), "close": 100 * (ran.estimate <= 30 * least).mean(),
        "wrong": 100 * (ran.kept & ran.announced).mean(),
    })  # fmt: skip
    rewrite(page, "promise", text)
    figure(relays).write(PICTURES)
    return page
