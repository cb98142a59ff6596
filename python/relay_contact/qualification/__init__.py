"""A relay against a standard: verdicts, margins and their uncertainties, on a page and in tables."""

from dataclasses import replace
from pathlib import Path

from relay_contact.component import Component
from relay_contact.qualification.assessment import Part, assess, chosen
from relay_contact.qualification.relay import Relay, check_monitor, relays
from relay_contact.qualification.standards import Standard, standards
from relay_contact.scene import progress_bar

__all__ = ["Part", "Relay", "Standard", "qualify", "relays", "standards"]

POINTS, FEW = 120, 24
"""Frequencies of a sweep, and in the short form."""


def qualify(
    relay: str | Path,
    standard: str | Path,
    *,
    out: str | Path,
    tests: list[str] | None = None,
    quick: bool = False,
    component: Component | None = None,
    progress: bool = False,
    cluster: str | None = None,
    date: str = "",
) -> list[Part]:
    """Test a relay as a standard asks, each by its name or its file; write page and tables; return the results.

    `tests` are parts of the names of those wanted, without it all. What an interrupted assessment has finished is not
    run again. `quick` vibrates at fewer frequencies; margins are the same. `cluster` is the address of a Dask
    cluster whose workers have this package. `date` stands on the page, without which its bytes are
    the same for each run.
    """
    # Workers and lists of relays import this package, too, and draw nothing.
    from relay_contact.qualification.page import write

    component, out = component or Component(), Path(out)
    described = Relay.read(relay, component)
    asked = chosen(Standard.read(standard), tests or [])
    asked = replace(asked, contacts=asked.contacts.monitored(described.monitor))
    check_monitor(component, described, asked.contacts)
    count = len(asked.tests) * len(described.positions) * len(described.models)
    with progress_bar(count, "{desc} |{bar}| {n_fmt} of {total_fmt} tests", progress) as bar:

        def tell(label: str) -> None:
            bar.set_description_str(label) if label else bar.update()

        parts = assess(component, described, asked, out, FEW if quick else POINTS, tell, cluster)
    write(out, described, asked, parts, component, date)
    return parts
