"""A relay against a standard: verdicts, margins and their uncertainties, on a page and in tables."""

from dataclasses import replace
from pathlib import Path

from relay_contact.component import Component, default_component
from relay_contact.files import RelayContactError, spare
from relay_contact.qualification.assessment import FEW, assess, chosen
from relay_contact.qualification.relay import Relay, check_monitor, relays
from relay_contact.qualification.results import Assessment, Finding, Tested
from relay_contact.qualification.standards import Recorded, Standard, standards
from relay_contact.scene import progress_bar

__all__ = ["FEW", "Assessment", "Finding", "Relay", "Standard", "Tested", "qualify", "relays", "standards"]

POINTS = 120
"""Frequencies of a sweep."""


def qualify(
    relay: str | Path,
    standard: str | Path | None = None,
    *,
    out: str | Path,
    tests: str | list[str] | None = None,
    history: list[str | Path] | None = None,
    unit: str = "",
    rate: float | None = None,
    quick: bool = False,
    component: Component | None = None,
    progress: bool = False,
    workers: int | None = None,
    cluster: str | None = None,
    date: str = "",
    pdf: bool = False,
) -> Assessment:
    """Test a relay as a standard asks, each by its name or its file; write page and tables; return the results.

    `tests` is a part of the names of those wanted, or several such parts; without it all. `history` are files of
    measured accelerations, each of whose channels is a further test (without a standard the only ones, with the limits
    of MIL-PRF-28776); `unit` and `rate` (samples a second) are those of files that do not tell. What an interrupted
    assessment has finished is not run again. `quick` vibrates at fewer frequencies; margins are the same. Tests run
    side by side on all cores, or by so many threads as `workers` says. `cluster` is the address of a Dask cluster whose
    workers have this package. `date` stands on the page, without which its bytes are the same for each run; `pdf`
    writes it as PDF, too.
    """
    # Workers and lists of relays import this package, too, and draw nothing.
    from relay_contact.qualification.page import FILES, write

    tests = [tests] if isinstance(tests, str) else tests
    if not (standard or history):
        raise RelayContactError("standard, history: one of them is needed, the tests of a standard or a record")
    if tests and not standard:
        raise RelayContactError(f"tests {', '.join(tests)}: not allowed without a standard, whose tests they are")
    if (unit or rate) and not history:
        raise RelayContactError("unit, rate: not allowed without a record, whose they are")
    component, out = component or default_component(), Path(out)
    spare((out / name for name in FILES), map(Path, history or []))
    described = Relay.read(relay, component)
    asked = Standard.read(standard or LIMITS)
    asked = chosen(asked, tests or []) if standard else replace(asked, title="measured records", tests=())
    for file in history or []:
        asked = replace(asked, tests=(*asked.tests, *Recorded(file=str(file), unit=unit, rate=rate).tests(Path())))
    names = [test.name for test in asked.tests]
    for name in names:
        # What is found of a test is kept by its name.
        if names.count(name) > 1:
            text = "given twice: not allowed, allowed is each name once; rename a file, or name it in a standard's"
            raise RelayContactError(f"{name}: {text}")
    asked = replace(asked, contacts=asked.contacts.monitored(described.monitor))
    check_monitor(component, described, asked.contacts)
    count = len(asked.tests) * len(described.positions) * len(described.models) * (1 + len(described.axes))
    with progress_bar(count, "{desc} |{bar}| {n_fmt} of {total_fmt} tests", progress) as bar:

        def tell(label: str) -> None:
            bar.set_description_str(label) if label else bar.update()

        found = assess(component, described, asked, out, FEW if quick else POINTS, tell, cluster, workers)
    assessment = Assessment(described, asked, found, out)
    write(assessment, component, date, pdf)
    return assessment


LIMITS = "MIL-PRF-28776"
"""The standard whose limits hold for records alone."""
