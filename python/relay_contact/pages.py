"""Pages of results: by templates, with figures as pictures in them, in HTML and PDF."""

import io
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from matplotlib.figure import Figure

from relay_contact.figures import verbatim
from relay_contact.files import RelayContactError

STYLE: Any = {
    "font.size": 8, "axes.titlesize": 9, "legend.fontsize": 7.5, "legend.frameon": False, "axes.grid": True,
    "grid.alpha": 0.3, "svg.hashsalt": "relay-contact",
}  # fmt: skip
"""Of matplotlib's figures."""
TEMPLATES = Environment(
    loader=PackageLoader("relay_contact"), autoescape=True, undefined=StrictUndefined, trim_blocks=True,
    lstrip_blocks=True,
)  # fmt: skip

Table = tuple[Sequence[str], Iterable[Sequence[str]]]
"""Head and rows of a table."""


def svg(figure: Figure) -> str:
    """Return a figure as a picture for a page."""
    verbatim(figure)
    if engine := figure.get_layout_engine():
        # Alone: matplotlib draws a figure with a layout twice, the first time for nothing else.
        engine.execute(figure)
        figure.set_layout_engine(None)
    text = io.StringIO()
    figure.savefig(text, format="svg", metadata={"Date": None, "Creator": None})
    return text.getvalue()[text.getvalue().index("<svg") :]


def render(template: str, **context: Any) -> str:  # noqa: ANN401
    """Return a page by its template."""
    return TEMPLATES.get_template(template).render(**context)


def write_pdf(page: str, path: Path) -> None:
    """Write a page as PDF, which needs WeasyPrint and the library Pango."""
    try:
        from weasyprint import HTML
    except (ImportError, OSError) as error:
        needs = "pip install 'relay-contact[pdf]', and the library Pango (Debian: libpango-1.0-0, libpangoft2-1.0-0)"
        raise RelayContactError(f"{path}: a PDF needs WeasyPrint: {needs}") from error
    HTML(string=page).write_pdf(path)
