"""Folders of the project."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs"
PICTURES = DOCS / "report"
OUT = ROOT / "out"


def rewrite(page: Path, part: str, text: str) -> None:
    """Replace what a page has between the comments that begin and end a part."""
    whole = page.read_text(encoding="utf-8")
    marks = re.compile(rf"(<!-- {part}: [^>]*-->\n).*?(<!-- end of {part} -->)", re.DOTALL)
    new, count = marks.subn(lambda found: f"{found[1]}\n{text}\n{found[2]}", whole)
    if count != 1:
        raise ValueError(f"{page}: {part} is not marked once")
    page.write_text(new, encoding="utf-8")
