"""The page: a single file with everything in it, made of sections in Markdown and their figures."""

import base64
import re
from dataclasses import dataclass, field
from pathlib import Path

from jinja2 import Environment, FileSystemLoader
from markdown_it import MarkdownIt

from relay_contact import Component
from report.figure import NARROW, WIDE, Figure
from report.files import DOCS, OUT
from report.text import TEMPLATES

MARKDOWN = MarkdownIt("commonmark", {"html": True}).enable("table")
PICTURE = re.compile(r'<p><img src="(?P<file>[^"]+)" alt="(?P<title>[^"]*)" /></p>')


@dataclass(frozen=True)
class Section:
    """A section of the page, in Markdown."""

    title: str
    text: str
    lead: str = ""
    """What it says, in a sentence, for the head of the page."""
    figures: list[Figure] = field(default_factory=list)

    @property
    def id(self) -> str:
        """Its anchor."""
        return re.sub(r"\W+", "-", self.title.lower()).strip("-")

    def html(self) -> str:
        """Return its text with tables that may scroll, figures drawn, pictures in it."""
        known = {f"report/{each.id}.png": each for each in self.figures}

        def picture(found: re.Match[str]) -> str:
            figure = known.get(found["file"])
            if figure:
                widths = {"wide": WIDE, "narrow": NARROW}
                drawn = (f'<div class="{name}">{figure.svg(width)}</div>' for name, width in widths.items())
                return f'<figure id="{figure.id}">{"".join(drawn)}</figure>'
            data = base64.b64encode((DOCS / found["file"]).read_bytes()).decode()
            title = found["title"]
            return f'<figure><h3>{title}</h3><img src="data:image/png;base64,{data}" alt="{title}"></figure>'

        text = PICTURE.sub(picture, MARKDOWN.render(self.text))
        text = text.replace(' style="text-align:right"', ' class="number"')
        text = text.replace("<th", '<th scope="col"').replace('<th scope="col"ead', "<thead")
        box = '<div class="scroll" role="region" tabindex="0" aria-label="Table"><table>'
        return text.replace("<table>", box).replace("</table>", "</table></div>")


def sections(page: str, leads: dict[str, str], figures: list[Figure]) -> list[Section]:
    """Return the sections of a page, whose titles are those of level 2."""
    found = []
    for part in re.split(r"^## ", page, flags=re.MULTILINE)[1:]:
        title, _, text = part.partition("\n")
        found.append(Section(title, text, leads.get(title, ""), figures))
    return found


def whole(path: Path) -> Section:
    """Return a page of docs/ as one section."""
    title, _, text = path.read_text(encoding="utf-8").partition("# ")[2].partition("\n")
    return Section(title, re.sub(r"^## ", "### ", text, flags=re.MULTILINE))


def folder(quick: bool) -> Path:
    """Return the folder of the page."""
    found = OUT / ("report-quick" if quick else "report")
    found.mkdir(parents=True, exist_ok=True)
    return found


def write(main: list[Section], appendix: list[Section], quick: bool) -> Path:
    """Write `out/report/index.html`, or, if quick, `out/report-quick/index.html`."""
    description = Component().description
    environment = Environment(loader=FileSystemLoader(TEMPLATES), autoescape=True)
    environment.filters["markdown"] = MARKDOWN.renderInline
    style, script = (Path(__file__).with_name(name).read_text(encoding="utf-8") for name in ("style.css", "wider.js"))
    page = environment.get_template("page.html").render(
        description=description, main=main, appendix=appendix, quick=quick, style=style, script=script
    )
    path = folder(quick) / "index.html"
    path.write_text(page, encoding="utf-8")
    return path
