"""The report and the component's documentation in a browser: nothing fails, nothing is fetched, all of it is seen.

`cargo xtask test` writes the quick report before.
"""

import itertools
import re
import zipfile
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

import pandas as pd
import pytest
from playwright.sync_api import Browser, Page

from conftest import empty_page
from relay_contact import fmu_path
from report import accuracy
from report.files import DOCS, OUT

QUICK = OUT / "report-quick/index.html"
# Width of the window, whether it is dark, and touched. Each width and each colour once.
WINDOWS = {"desktop": (1280, False), "phone": (390, True)}


@pytest.fixture(scope="module", params=WINDOWS)
def window(request: pytest.FixtureRequest) -> str:
    return str(request.param)


def opened(browser: Browser, window: str) -> Page:
    width, phone = WINDOWS[window]
    return empty_page(browser, width, dark=phone, touch=phone)


@pytest.fixture(scope="module")
def report(browser: Browser, window: str) -> Iterator[Page]:
    page = opened(browser, window)
    heard: list[str] = []
    page.on("console", lambda message: heard.append(message.text))
    page.on("pageerror", lambda error: heard.append(str(error)))
    page.on("request", lambda request: heard.append(request.url))
    page.goto(QUICK.as_uri())
    assert heard == [QUICK.as_uri()]
    yield page
    page.close()


@pytest.fixture(scope="module")
def documentation(browser: Browser, window: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    folder: Path = tmp_path_factory.mktemp("component")
    with zipfile.ZipFile(fmu_path()) as archive:
        archive.extractall(folder)
    page = opened(browser, window)
    page.goto((folder / "documentation/index.html").as_uri())
    yield page
    page.close()


def test_text_of_the_publication_is_that_of_docs() -> None:
    written = (DOCS / "validation.md").read_text(encoding="utf-8")
    now = QUICK.with_name("validation.md").read_text(encoding="utf-8")
    different = [pair for pair in zip(now.splitlines(), written.splitlines(), strict=False) if pair[0] != pair[1]]
    assert not different[:1], "run cargo xtask report"
    assert len(now) == len(written)


def test_every_figure_is_drawn_with_all_its_curves_and_labels_inside(report: Page) -> None:
    figures = report.locator("figure[id]").all()
    assert len(figures) == 17
    for figure in figures:
        drawing = figure.locator("svg:visible")
        box, *texts = drawing.evaluate(
            """drawing => [drawing, ...drawing.querySelectorAll("text")].map(
                each => ({words: each.textContent, ...each.getBoundingClientRect().toJSON()})
            )"""
        )
        assert box["width"] > 300
        assert box["height"] > 200
        assert texts
        for text in texts:
            assert text["width"] > 0, text
            assert box["left"] - 1 <= text["left"] <= text["right"] <= box["right"] + 1, text
        # Lines of curves, or their points.
        assert drawing.locator("[id*='line2d'] path").count() > 4


def test_curves_of_a_figure_differ_without_colour(report: Page) -> None:
    for drawing in report.locator("figure[id] svg:visible").all():
        # The styles of lines and marks, and the shapes of marks.
        entries = drawing.locator("[id*='legend_1'] > g[id*='line2d']").evaluate_all(
            """entries => entries.map(entry => [...entry.querySelectorAll("path, use")].map(each => [
                each.getAttribute("style"),
                each.matches("use") && document.querySelector(each.getAttribute("xlink:href")).getAttribute("d"),
            ]))"""
        )
        looks = [re.sub(r"#\w{6}|var\(--\w+\)", "", str(entry)) for entry in entries]
        assert len(set(looks)) == len(looks), drawing.get_attribute("aria-label")


def test_figures_have_the_colours_of_the_page(report: Page) -> None:
    ink = report.evaluate("getComputedStyle(document.body).color")
    texts = "texts => texts.map(text => getComputedStyle(text).fill)"
    assert set(report.locator("figure[id] svg:visible text").evaluate_all(texts)) == {ink}
    paper = report.evaluate("getComputedStyle(document.body).backgroundColor")
    width = report.evaluate("innerWidth")
    assert (sum(map(int, re.findall(r"\d+", paper))) < 3 * 128) == (width < 500)


def test_links_lead_somewhere(report: Page) -> None:
    links = report.eval_on_selector_all("a[href]", "links => links.map(link => link.getAttribute('href'))")
    ids = report.eval_on_selector_all("[id]", "elements => elements.map(element => element.id)")
    assert len(ids) == len(set(ids))
    inside = {link[1:] for link in links if link.startswith("#")}
    assert inside
    assert inside <= set(ids)
    assert [link for link in links if not link.startswith(("#", "http:", "https:"))] == []


def test_a_table_shows_all_columns_or_says_that_there_are_more(report: Page, documentation: Page) -> None:
    for page in (report, documentation):
        tables = page.eval_on_selector_all(
            ".scroll:has(table)",
            """tables => tables.map(table => [
                table.scrollWidth > table.clientWidth,
                getComputedStyle(table, "::before").content.includes("scroll"),
            ])""",
        )
        assert tables
        assert [pair for pair in tables if pair[0] != pair[1]] == []


def test_all_columns_of_the_variables_are_seen_on_a_desktop(documentation: Page, window: str) -> None:
    wide = documentation.eval_on_selector_all(
        ".scroll", "all => all.filter(each => each.scrollWidth > each.clientWidth).length"
    )
    assert (wide > 0) == (window == "phone")


def test_a_printed_page_is_cut_off_nowhere(report: Page, documentation: Page) -> None:
    for page in (report, documentation):
        before = page.viewport_size
        assert before is not None
        # Between the margins of A4, in pixels.
        page.set_viewport_size({"width": 700, "height": 1000})
        page.emulate_media(media="print")
        cut = page.eval_on_selector_all(
            "table, pre, svg, img",
            "all => all.filter(each => each.getBoundingClientRect().right > 701).map(each => each.textContent)",
        )
        page.emulate_media(media="screen")
        page.set_viewport_size(before)
        assert cut == []


def test_no_cell_of_the_report_is_wider_than_its_column(report: Page) -> None:
    wide = "cells => cells.filter(cell => cell.scrollWidth > cell.clientWidth + 1).map(cell => cell.textContent)"
    assert report.eval_on_selector_all("td, th", wide) == []


def test_no_page_is_wider_than_its_window(report: Page, documentation: Page) -> None:
    for page in (report, documentation):
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth"), page.url


def test_the_block_shows_every_input_and_output_apart(documentation: Page) -> None:
    with zipfile.ZipFile(fmu_path()) as archive:
        description = ElementTree.fromstring(archive.read("modelDescription.xml"))
    variables = description.iter("ScalarVariable")
    pins = [variable.get("name") for variable in variables if variable.get("causality") in ("input", "output")]
    texts = documentation.locator("svg.block text").all_text_contents()
    assert pins
    assert [pin for pin in pins if texts.count(pin or "") != 1] == []
    boxes = documentation.locator("svg.block text").evaluate_all("all => all.map(each => each.getBoundingClientRect())")
    for one, other in itertools.combinations(boxes, 2):
        apart = (
            one["right"] < other["left"] or other["right"] < one["left"]
            or one["bottom"] - 3 < other["top"] or other["bottom"] - 3 < one["top"]
        )  # fmt: skip
        assert apart, (one, other)


def test_a_comparison_without_a_peer_is_not_written(monkeypatch: pytest.MonkeyPatch) -> None:
    page = (DOCS / "accuracy.md").read_text(encoding="utf-8")
    measured = pd.DataFrame({"integrator": ["CVODE BDF"], "outcome": ["skipped: it needs SUNDIALS"]})
    monkeypatch.setattr(accuracy, "read", lambda: measured)
    with pytest.raises(SystemExit, match="CVODE BDF skipped"):
        accuracy.write()
    assert (DOCS / "accuracy.md").read_text(encoding="utf-8") == page
