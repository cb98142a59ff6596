"""Hard cases: what makes each hard, the properties that it keeps, and with which margin; from `out/hard-cases.json`."""

import json
from typing import Any

from report.files import OUT
from report.text import short, table

COLUMNS = ("case", "what makes it hard", "property kept", "measured", "allowed", "reason", "margin")


def values() -> dict[str, Any]:
    """Return the numbers of the section."""
    cases = json.loads((OUT / "hard-cases.json").read_text(encoding="utf-8"))
    rows, margins = [], []
    for case in cases:
        head = [case["name"], case["difficulty"]]
        for check in case["checks"]:
            margin = check["margin"]
            margins.append(float("inf") if margin is None else margin)
            shown = "exact" if margin is None else short(margin, 1)
            rows.append([*head, check["property"], check["measured"], check["allowed"], check["reason"], shown])
            # Name and difficulty are in the first row only.
            head = ["", ""]
    return {"count": len(margins), "cases": len(cases), "least": min(margins), "table": table(COLUMNS, rows)}
