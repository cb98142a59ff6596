"""What an assessment showed: a finding for each test, position and model, and all of them as tables."""

import csv
from dataclasses import field
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, get_args

from pydantic import TypeAdapter
from pydantic.dataclasses import dataclass

from relay_contact.files import at_once
from relay_contact.qualification.parts import CLOSED, CONTACT, CORE, OPEN, PUSHER, STOP
from relay_contact.qualification.relay import NORMAL, Relay
from relay_contact.qualification.standards import Standard

if TYPE_CHECKING:
    from collections.abc import Iterator

    import pandas as pd

Verdict = Literal["pass", "FAIL", "undecided", "not judged"]
NOT_RUN = "not run"
"""Instead of the verdict, of tests of the standard that are not wanted."""
TIMES = {CLOSED: "closed contact interrupted", OPEN: "open contact makes"}
LEAST = {OPEN: "open contact least gap"} | {name: f"{name} least force" for name in (CLOSED, CORE, STOP, PUSHER)}
UNITS = dict.fromkeys(LEAST, "N") | {OPEN: "m"}
MARGINS = {name: f"{name} margin" for name in (CONTACT, CORE, STOP, PUSHER)}
"""Columns of tables, by what may fail."""
CONTACTS = [LEAST[CLOSED], LEAST[OPEN]]
"""Those that are there for every relay."""


@dataclass(frozen=True)
class Chance:
    """What the uncertain parameters make of a margin."""

    failing: float
    """Share of the draws that fail."""
    low: float
    """Ends of the interval of that chance, of 95 %."""
    high: float
    effects: dict[str, float]
    """What each uncertainty does to the margin, as a part of it, with 95 % confidence."""
    indices: dict[str, float]
    """First-order Sobol indices: by which share the variance of the margin falls once a parameter is known."""
    confirmed: int
    """Draws in which the component sought the level itself."""
    error: float
    """Largest part by which it was found to be another than drawn."""


@dataclass(frozen=True)
class PartMargin:
    """The level that fails a part of the relay relative to that of the test."""

    margin: float
    low: float
    high: float
    weakest: str
    limits: str
    """What limits it."""


@dataclass(frozen=True)
class Margin:
    """The level that fails the relay relative to that of the test, and what happens at that of the test."""

    margin: float
    linear: float
    """By linear theory."""
    decides: list[str]
    """What fails at the margin."""
    weakest: str
    failed: dict[str, float]
    """Longest failure (s) at the level of the test, by what fails."""
    where: dict[str, str]
    least: dict[str, float]
    """What is left at least of force (N) or gap (m), by what may fail."""
    rest: dict[str, float]
    """The same at rest."""
    natural: float
    """First resonance, Hz."""
    curves: dict[str, Any]
    """What the figures show."""
    overtravel: float
    wear: dict[str, list[float]] = field(default_factory=dict)
    """Margins over the overtravel (m), or the gap of a contact that is open alone."""
    passes: float | None = None
    """From which overtravel or gap (m) on the test is passed."""
    low: float = 0.0
    high: float = 0.0
    chance: Chance | None = None
    """None of a record that leaves too much open for it."""
    parts: dict[str, PartMargin] = field(default_factory=dict)
    """The margins of each part, of a relay that has others than its contacts; the least is that of the relay."""
    tolerance: tuple[float, float] | None = None
    """Margins by linear theory at the ends of the tolerance of a pulse."""

    @property
    def stated(self) -> bool:
        """Whether something makes an interval: an uncertain parameter, an allowance, a noise or a record."""
        return self.chance is None or len(self.chance.effects) > 0


@dataclass(frozen=True)
class Finding:
    """What a test showed in a position of the coil, by one of the models."""

    position: str
    test: str
    axis: str
    kind: str
    level: str
    clause: str
    evidence: str
    model: str
    verdict: Verdict
    limits: str
    """What limits the margin, or why there is none."""
    judged: Margin | None = None
    notes: list[str] = field(default_factory=list)
    """What has to be said of the test itself."""
    warnings: list[str] = field(default_factory=list)
    """Of the component."""

    @property
    def named(self) -> str:
        """Return the name of the test, with the axis of the vibration where it is not the normal one."""
        return self.test if self.axis == NORMAL else f"{self.test}, {self.axis} axis"

    @property
    def margin(self) -> Margin:
        """Return the margin of a test that was judged."""
        if self.judged is None:
            raise ValueError(f"{self.test}, {self.position}: {self.verdict}: {self.limits}")
        return self.judged


FINDING = TypeAdapter(Finding)
"""For their files."""


Rows = tuple[list[str], list[dict[str, Any]], dict[str, str]]
"""Columns of a table, its rows, and the units of its columns."""


@dataclass(frozen=True)
class Tested:
    """A test in a position of the coil, by all models."""

    verdict: Verdict
    models: list[Finding]

    @property
    def first(self) -> Finding:
        """Return the finding by the first model, which figures show."""
        return self.models[0]

    @property
    def notes(self) -> list[str]:
        """Return what has to be said of the test, by each model."""
        return [*dict.fromkeys(f"{each.named}: {note}" for each in self.models for note in each.notes)]

    @property
    def judged(self) -> Margin | None:
        """Return the margin by the first model."""
        return self.first.judged

    @property
    def margin(self) -> Margin:
        """Return the margin by the first model of a test that was judged."""
        return self.first.margin


class Assessment:
    """A relay against a standard: a list of tests, tables of results, and a page, which a notebook shows."""

    def __init__(self, relay: Relay, standard: Standard, tests: list[Tested], folder: Path) -> None:
        """Keep what was found, and the folder that it was written to."""
        self.relay, self.standard, self.tests, self.folder = relay, standard, tests, folder

    def __iter__(self) -> "Iterator[Tested]":
        """Return the tests one after another."""
        return iter(self.tests)

    def __len__(self) -> int:
        """Return the number of tests."""
        return len(self.tests)

    def __getitem__(self, name: str) -> Tested:
        """Return a test by its name, in the first position that has it."""
        for each in self.tests:
            if each.first.test == name:
                return each
        raise KeyError(f"{name}: there are {', '.join(dict.fromkeys(each.first.test for each in self.tests))}")

    @property
    def counts(self) -> str:
        """How many tests have which verdict, and how many of the standard were not run."""
        counts = {verdict: sum(tested.verdict == verdict for tested in self) for verdict in get_args(Verdict)}
        counts[NOT_RUN] = len(self.standard.left)
        return ", ".join(f"{count} {verdict}" for verdict, count in counts.items() if count)

    @property
    def table(self) -> "pd.DataFrame":
        """A row for each test, position and model, and for each test not run; `attrs["units"]` has the units."""
        return frame(*self.verdicts())

    @property
    def sweeps(self) -> "pd.DataFrame":
        """A row for each frequency of each sine, at the level of the test; `attrs["units"]` has the units."""
        return frame(*self.vibrations())

    def verdicts(self) -> Rows:
        """Return what is in `table`."""
        rows: list[dict[str, Any]] = []
        units: dict[str, str] = {}
        for tested in self.tests:
            for each in tested.models:
                row = {name: getattr(each, name) for name in (*FIELDS, "limits")}
                row |= {"verdict of all models": tested.verdict}
                row |= {"notes": "; ".join(each.notes)} if each.notes else {}
                if (judged := each.judged) is not None:
                    row |= {"margin": judged.margin, "weakest": judged.weakest}
                    row |= {"low": judged.low, "high": judged.high} if judged.stated else {}
                    if judged.stated and (chance := judged.chance):
                        row |= {"chance": chance.failing, "chance low": chance.low, "chance high": chance.high}
                    row |= {"fails first": " and ".join(judged.decides), "resonance": judged.natural}
                    row |= {TIMES[name]: value for name, value in judged.failed.items() if name in TIMES}
                    row |= {MARGINS[name]: own.margin for name, own in judged.parts.items()}
                    row |= {LEAST[name]: value for name, value in judged.least.items()}
                    units |= {LEAST[name]: UNITS[name] for name in judged.least}
                rows.append(row)
        for test in self.standard.left:
            told = {"test": test.name, "clause": test.clause, "level": str(test), "verdict": NOT_RUN}
            rows.append(dict.fromkeys(FIELDS, "") | told)
        # Columns of parts that no relay here has, and of notes, would be empty.
        known = *MARGINS.values(), *LEAST.values(), "notes"
        others = [name for name in known if any(name in row for row in rows)]
        columns = [*FIELDS, *NUMBERS, *(name for name in others if name not in NUMBERS)]
        return columns, rows, units | dict.fromkeys(TIMES.values(), "s") | {"resonance": "Hz"}

    def vibrations(self) -> Rows:
        """Return what is in `sweeps`."""
        rows: list[dict[str, Any]] = []
        for each in (each for tested in self.tests for each in tested.models):
            if each.kind == "sine" and each.judged:
                curves = each.judged.curves
                columns = {"frequency": curves["frequency"], "acceleration": curves["level"]}
                for key, names in (("length", TIMES), ("least", LEAST)):
                    columns |= {names[name]: values for name, values in curves[key].items() if name in names}
                own = {"position": each.position, "test": each.test, "model": each.model}
                rows += [own | dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
        others = [name for name in LEAST.values() if name not in CONTACTS and any(name in row for row in rows)]
        keys = ["position", "test", "model", "frequency", "acceleration", *TIMES.values(), *CONTACTS, *others]
        units = {"frequency": "Hz", "acceleration": "m/s2", **dict.fromkeys(TIMES.values(), "s"),
                 **{LEAST[name]: UNITS[name] for name in LEAST}}  # fmt: skip
        return keys, rows, units

    def write(self) -> None:
        """Write both tables as CSV, with the units in the names of their columns."""
        for name, (columns, rows, units) in (
            ("qualification.csv", self.verdicts()), ("sweeps.csv", self.vibrations()),
        ):  # fmt: skip
            with at_once(self.folder / name) as part, part.open("w", encoding="utf-8", newline="") as file:
                # Not by pandas, which takes longer to import than a short qualification to compute.
                lines = csv.writer(file, lineterminator="\n")
                lines.writerow(f"{column} [{units[column]}]" if column in units else column for column in columns)
                for row in rows:
                    cells = (row.get(column, "") for column in columns)
                    lines.writerow(f"{cell:.9g}" if isinstance(cell, float) else cell for cell in cells)

    def _repr_html_(self) -> str:
        """Return the page for a notebook, apart from the notebook's own style."""
        page = (self.folder / "qualification.html").read_text(encoding="utf-8")
        return f'<iframe srcdoc="{escape(page)}" style="width:100%;height:50em;border:1px solid #ccc"></iframe>'


def frame(columns: list[str], rows: list[dict[str, Any]], units: dict[str, str]) -> "pd.DataFrame":
    """Return a table of rows."""
    # It takes long to import, and only who asks for a table needs it.
    import pandas as pd

    table = pd.DataFrame(rows, columns=columns)
    table.attrs["units"] = units
    return table


FIELDS = ["position", "test", "axis", "model", "clause", "evidence", "level", "verdict"]
NUMBERS = ["margin", "low", "high", "chance", "chance low", "chance high", "weakest", "limits", "verdict of all models",
           "fails first", "resonance", *TIMES.values(), *CONTACTS]  # fmt: skip
"""Columns of the table of results."""
