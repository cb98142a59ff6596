"""The command line: what `cargo xtask` starts."""

import argparse
from collections.abc import Callable
from pathlib import Path

from report import accuracy, callgrind, effects, hard_cases, importers, opening, promise, validation
from report.figure import Figure
from report.files import DOCS, PICTURES
from report.page import Section, folder, sections, whole, write
from report.publication import Publication
from report.text import rendered

VALIDATION = "validation.md"


def section(template: str, numbers: dict[str, object], figures: list[Figure] | None = None) -> Section:
    """Return a section by its template."""
    (found,) = sections(*rendered(template, figures or [], numbers), figures or [])
    return found


def report(quick: bool) -> Path:
    """Run what the report shows; write the page, and, unless quick, docs/validation.md and the pictures of docs/."""
    publication = Publication(quick)
    drawn = validation.figures(publication)
    text, leads = validation.page(publication, drawn)
    maps, numbers = opening.values(quick)
    (folder(quick) if quick else DOCS).joinpath(VALIDATION).write_text(text, encoding="utf-8")
    if not quick:
        for figure in maps + drawn:
            figure.write(PICTURES)
    main = [
        section("opening.md", numbers, maps), accuracy.section(), whole(effects.PAGE),
        section("importers.md", importers.values(quick)),
    ]  # fmt: skip
    appendix = [*sections(text, leads, drawn), section("hard-cases.md", hard_cases.values())]
    return write(main, appendix, quick)


def main() -> None:
    """Run a task."""
    line = argparse.ArgumentParser(prog="cargo xtask", description=__doc__)
    add = line.add_subparsers(dest="task", required=True).add_parser
    one = add("report", help="run everything that the report shows; write out/report, docs/validation.md, docs/report")
    text = "fewer points and runs, all into out/report-quick: to see that everything works"
    one.add_argument("--quick", action="store_true", help=text)
    one.add_argument("--fit", action="store_true", help="before, fit the contact to the published numbers anew")
    tasks: dict[str, Callable[[], object]] = {
        "effects": effects.write,
        "accuracy": accuracy.write,
        "promise": promise.write,
        "instructions": callgrind.show,
        "importers": importers.show,
    }
    for name in tasks:
        add(name)
    given = line.parse_args()
    if given.task != "report":
        print(tasks[given.task]() or "")
        return
    if given.fit:
        from report import fit

        print(*fit.run(), sep="\n")
    print(report(given.quick))


if __name__ == "__main__":
    main()
