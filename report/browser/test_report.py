"""The report in a browser: nothing fails, nothing is fetched, every figure is drawn, every link leads somewhere."""

import json
from collections.abc import Iterator

import pytest
from browser import PATIENCE, QUICK, chromium
from playwright.sync_api import Browser, Page, expect

# Width of the window, its colours, whether it is touched; and the name of the picture of it. Each width and each colour
# once, as places do not depend on colours.
WINDOWS = {
    "desktop": (1280, "light", False),
    "phone": (390, "dark", True),
}


class Visit:
    """The page in one window, with what it complained about and fetched while it loaded."""

    def __init__(self, browser: Browser, window: str) -> None:
        """Open the page."""
        width, colours, touch = WINDOWS[window]
        self.window = window
        self.complaints: list[str] = []
        self.requests: list[str] = []
        self.page: Page = browser.new_page(
            viewport={"width": width, "height": 900},
            color_scheme="dark" if colours == "dark" else "light",
            has_touch=touch,
            is_mobile=touch,
        )
        self.page.set_default_timeout(PATIENCE)
        self.page.on("console", lambda message: self.complaints.append(message.text))
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.page.goto(QUICK.as_uri())


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with chromium() as browser:
        yield browser


@pytest.fixture(scope="module", params=WINDOWS)
def visit(browser: Browser, request: pytest.FixtureRequest) -> Iterator[Visit]:
    visit = Visit(browser, request.param)
    yield visit
    visit.page.close()


def test_loads_without_complaint_and_without_anything_else(visit: Visit) -> None:
    assert visit.complaints == []
    assert visit.requests == [QUICK.as_uri()]


def test_every_figure_is_drawn(visit: Visit) -> None:
    described = json.loads(visit.page.locator("#figures").text_content() or "")
    assert described
    assert [figure["id"] for figure in described] == visit.page.eval_on_selector_all(
        "figure:has(.plot)", "figures => figures.map(figure => figure.id)"
    )
    for figure in described:
        plot = visit.page.locator(f"#{figure['id']} .plot")
        box = plot.locator(".nsewdrag").bounding_box()
        assert box is not None, figure["id"]
        assert box["width"] > 150, figure["id"]
        # The legend is beside it, not instead of it.
        assert box["height"] > (200 if visit.window == "phone" else 280), figure["id"]
        for curve in figure["data"]:
            numbers = [pair for pair in zip(curve["x"], curve["y"], strict=True) if None not in pair]
            assert numbers, f"{figure['id']}: {curve['name']}"
        # A trace's line, or else its points, as plotly.js has drawn them.
        traces = plot.locator(".scatterlayer .trace").all()
        assert len(traces) == len(figure["data"]), figure["id"]
        for trace, curve in zip(traces, figure["data"], strict=True):
            drawn = trace.locator("path.js-line, path.point")
            assert drawn.count() > 0, f"{figure['id']}: {curve['name']}"
            assert all(drawn.evaluate_all("paths => paths.map(path => (path.getAttribute('d') ?? '').length > 4)"))


def test_curves_of_a_figure_differ_without_colour(visit: Visit) -> None:
    for figure in json.loads(visit.page.locator("#figures").text_content() or ""):
        looks = [
            (
                "lines" in curve["mode"] and curve["line"]["dash"],
                "markers" in curve["mode"] and curve["marker"]["symbol"],
            )
            for curve in figure["data"]
        ]
        assert len(set(looks)) == len(looks), figure["id"]


def test_axes_of_every_figure_have_titles_that_are_seen_whole(visit: Visit) -> None:
    for plot in visit.page.locator("figure .plot").all():
        around = plot.bounding_box()
        assert around is not None
        for title in (".g-xtitle text", ".g-ytitle text"):
            box = plot.locator(title).bounding_box()
            assert box is not None, title
            assert box["width"] > 5
            assert box["x"] >= around["x"] - 1
            assert box["x"] + box["width"] <= around["x"] + around["width"] + 1
            assert box["y"] >= around["y"] - 1
            assert box["y"] + box["height"] <= around["y"] + around["height"] + 1


def test_legends_do_not_reach_into_the_axes(visit: Visit) -> None:
    for plot in visit.page.locator("figure .plot:has(.legend)").all():
        legend, title = plot.locator(".legend").bounding_box(), plot.locator(".g-xtitle text").bounding_box()
        around = plot.bounding_box()
        assert legend is not None
        assert title is not None
        assert around is not None
        assert legend["y"] >= title["y"] + title["height"]
        assert legend["x"] + legend["width"] <= around["x"] + around["width"] + 1


def test_links_within_the_page_lead_somewhere(visit: Visit) -> None:
    links = visit.page.eval_on_selector_all("a[href^='#']", "links => links.map(link => link.getAttribute('href'))")
    assert links
    ids = visit.page.eval_on_selector_all("[id]", "elements => elements.map(element => element.id)")
    assert len(ids) == len(set(ids))
    assert {link[1:] for link in links} <= set(ids)


def test_links_to_files_lead_to_files(visit: Visit) -> None:
    links = visit.page.eval_on_selector_all("a[href]", "links => links.map(link => link.getAttribute('href'))")
    files = [link.split("#")[0] for link in links if not link.startswith(("#", "http:", "https:"))]
    assert [file for file in files if not (QUICK.parent / file).exists()] == []


def test_page_is_no_wider_than_its_window(visit: Visit) -> None:
    assert visit.page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    wider = "boxes => boxes.filter(box => box.getBoundingClientRect().right > innerWidth).map(box => box.outerHTML)"
    assert visit.page.eval_on_selector_all("main > section > *, figure > *", wider) == []


def test_a_table_shows_all_columns_or_says_that_there_are_more(visit: Visit) -> None:
    tables = visit.page.eval_on_selector_all(
        ".scroll",
        """tables => tables.map(table =>
            [table.scrollWidth > table.clientWidth, getComputedStyle(table, "::before").content.includes("scroll")])""",
    )
    assert tables
    assert [pair for pair in tables if pair[0] != pair[1]] == []
    assert visit.window != "phone" or any(wider for wider, _ in tables)


def test_cells_of_tables_do_not_overlap(visit: Visit) -> None:
    wide = "cells => cells.filter(cell => cell.scrollWidth > cell.clientWidth + 1).map(cell => cell.textContent)"
    assert visit.page.eval_on_selector_all("td, th", wide) == []


def test_figures_have_the_colours_of_the_page(visit: Visit) -> None:
    paper = visit.page.evaluate("getComputedStyle(document.body).backgroundColor")
    papers = "plots => plots.map(plot => getComputedStyle(plot.querySelector('.main-svg')).backgroundColor)"
    assert set(visit.page.eval_on_selector_all("figure .plot", papers)) == {paper}
    dark = sum(int(part) for part in paper.strip("rgb()").split(",")) < 3 * 128
    assert dark == (WINDOWS[visit.window][1] == "dark")


def test_pictures_of_the_page_are_kept(visit: Visit) -> None:
    path = QUICK.parent / f"{visit.window}.png"
    visit.page.screenshot(path=path, full_page=True)
    assert path.stat().st_size > 20_000


def test_colours_change_with_those_of_the_machine(browser: Browser) -> None:
    visit = Visit(browser, "desktop")
    drawing = visit.page.locator("figure .plot .main-svg").first
    before = drawing.evaluate("svg => getComputedStyle(svg).backgroundColor")
    visit.page.emulate_media(color_scheme="dark")
    expect(drawing).not_to_have_css("background-color", before, timeout=PATIENCE)
    assert visit.complaints == []


def test_a_click_in_the_legend_hides_a_curve(browser: Browser) -> None:
    visit = Visit(browser, "desktop")
    plot = visit.page.locator("figure .plot:has(.legend)").first
    curves = plot.locator(".scatterlayer .trace")
    before = curves.count()
    plot.locator(".legendtoggle").first.click()
    # A second click soon after would be a double click, so plotly.js waits a moment before it hides the curve.
    expect(curves).to_have_count(before - 1, timeout=PATIENCE)


def test_hovering_reads_a_value_with_its_unit(browser: Browser) -> None:
    visit = Visit(browser, "desktop")
    described = json.loads(visit.page.locator("#figures").text_content() or "")
    units = {figure["id"]: figure["data"][0]["hovertemplate"] for figure in described}
    figure = next(name for name, template in units.items() if not template.endswith(" "))
    plot = visit.page.locator(f"#{figure} .plot")
    plot.scroll_into_view_if_needed()
    plot.evaluate("plot => Plotly.Fx.hover(plot, [{ curveNumber: 0, pointNumber: 1 }])")
    text = plot.locator(".hoverlayer .hovertext").first.text_content() or ""
    assert units[figure].rsplit(" ", 1)[1] in text
