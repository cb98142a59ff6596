"""Which pages the documentation site has, and where they lead; the hook of `mkdocs.yml`, for `cargo xtask docs`."""

import posixpath
import re
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from markdown_it import MarkdownIt
from markdown_it.token import Token

ROOT = Path(__file__).parents[1]
# All pages, by their paths from the top folder.
PAGES = [path.relative_to(ROOT).as_posix() for folder in (ROOT, ROOT / "docs") for path in sorted(folder.glob("*.md"))]
NAMES = (
    "", ".qualification.qualify", ".qualification.Assessment", ".qualification.Tested", ".qualification.Finding",
    ".qualification.results.Margin", ".qualification.results.Chance", ".comparison.compare", ".identification.identify",
)  # fmt: skip
PYTHON = "\n\n".join(["# Python interface", *(f"::: relay_contact{name}" for name in NAMES)])


def tokens(page: str) -> list[Token]:
    """Read a page."""
    return MarkdownIt().parse((ROOT / page).read_text(encoding="utf-8"))


def links(page: str) -> Iterator[tuple[str, str]]:
    """Give the links of a page within the project: the path from the top folder, and the part of the page there."""
    for child in (child for token in tokens(page) for child in token.children or []):
        url = urlsplit(str(child.attrGet("href") or child.attrGet("src") or "//"))
        if not url.scheme and not url.netloc and (url.path or url.fragment):
            place = posixpath.join(posixpath.dirname(page), url.path) if url.path else page
            yield posixpath.normpath(place), url.fragment


def anchor(heading: str) -> str:
    """Give the part of an address that leads to a heading, as forges make it, and mkdocs.yml says."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")


def anchors(page: str) -> set[str]:
    """Give the parts of a page that others may lead to."""
    read = tokens(page)
    headings = [text for token, text in pairwise(read) if token.type == "heading_open"]
    return {anchor("".join(child.content for child in heading.children or [])) for heading in headings}


def on_files(files: Any, config: Any) -> Any:  # noqa: ANN401
    """Add the pages and all they link to, in the paths that they have in the project."""
    from mkdocs.structure.files import File

    linked = {path for page in PAGES for path, _ in links(page)}
    own = {ROOT / path for path in {*PAGES, *linked, *config.extra["polyfills"]}}
    for path in sorted(file for each in own for file in (each.rglob("*") if each.is_dir() else [each])):
        if path.is_file():
            files.append(File.generated(config, path.relative_to(ROOT).as_posix(), abs_src_path=str(path)))
    files.append(File.generated(config, "python.md", content=PYTHON))
    return files
