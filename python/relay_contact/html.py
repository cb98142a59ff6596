"""Pages of results: figures as pictures in them, tables, and how they look."""

import io
from collections.abc import Iterable
from html import escape

from matplotlib.figure import Figure

STYLE = {
    "font.size": 8, "axes.titlesize": 9, "legend.fontsize": 7.5, "legend.frameon": False, "axes.grid": True,
    "grid.alpha": 0.3, "svg.hashsalt": "relay-contact",
}  # fmt: skip
"""Of matplotlib's figures."""
CSS = """body{font:15px/1.45 system-ui,sans-serif;margin:0 auto;max-width:1000px;padding:1em;color:#222}
h1{font-size:1.5em;margin-bottom:.2em}h2{font-size:1.15em;margin-top:1.6em}
table{border-collapse:collapse;width:100%}th,td{border-bottom:1px solid #ccc;padding:.35em .5em;text-align:left;
vertical-align:top}th{font-weight:600}td.verdict{font-weight:600;white-space:nowrap}
td.number{white-space:nowrap}.wide,.figure{overflow-x:auto}.figure svg{width:100%;min-width:640px;height:auto}
small,.note{color:#555}.judged{border-left:4px solid #999;padding-left:.8em}tr.of td{border-bottom-style:dotted}
@page{size:A4;margin:14mm}@media print{body{font-size:9.5pt;max-width:none;padding:0}.wide,.figure{overflow:visible}
.figure svg{min-width:0}.figure,tr,pre{break-inside:avoid}h2,h3{break-after:avoid}
td.verdict{print-color-adjust:exact;-webkit-print-color-adjust:exact}}"""


def svg(figure: Figure | None) -> str:
    """Give a figure as a picture for a page."""
    if figure is None:
        return ""
    text = io.StringIO()
    figure.savefig(text, format="svg", metadata={"Date": None, "Creator": None})
    return '<div class="figure">' + text.getvalue()[text.getvalue().index("<svg") :] + "</div>"


def table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """Give a table of texts."""
    cells = "".join(f"<th>{escape(name)}</th>" for name in head)
    lines = "".join("<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    return f'<div class="wide"><table><tr>{cells}</tr>{lines}</table></div>'


def document(title: str, body: Iterable[str]) -> str:
    """Give a page."""
    head = f'<meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>{escape(title)}</title>'
    style = f"<style>{CSS}</style>"
    return f'<!doctype html><html lang="en"><head>{head}{style}</head><body>{"".join(body)}</body></html>\n'
