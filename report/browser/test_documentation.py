"""The page documentation/index.html of the component in a browser."""

import itertools
import zipfile
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

import pytest
from browser import COMPONENT, PATIENCE, QUICK, chromium
from playwright.sync_api import Page


@pytest.fixture(scope="module", params=[1280, 390])
def page(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    folder: Path = tmp_path_factory.mktemp("component")
    with zipfile.ZipFile(COMPONENT) as archive:
        archive.extractall(folder)
    with chromium() as browser:
        page = browser.new_page(viewport={"width": request.param, "height": 900})
        page.set_default_timeout(PATIENCE)
        page.goto((folder / "documentation/index.html").as_uri())
        page.screenshot(path=QUICK.parent / f"documentation-{request.param}.png", full_page=True)
        yield page


def test_page_is_no_wider_than_its_window(page: Page) -> None:
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")


def test_block_shows_every_input_and_output(page: Page) -> None:
    with zipfile.ZipFile(COMPONENT) as archive:
        description = ElementTree.fromstring(archive.read("modelDescription.xml"))
    variables = description.iter("ScalarVariable")
    pins = [variable.get("name") for variable in variables if variable.get("causality") in ("input", "output")]
    assert pins
    texts = page.locator("svg.block text").all_text_contents()
    assert [pin for pin in pins if texts.count(pin or "") != 1] == []


def test_texts_of_the_block_do_not_touch(page: Page) -> None:
    boxes = page.locator("svg.block text").evaluate_all("texts => texts.map(text => text.getBoundingClientRect())")
    for one, other in itertools.combinations(boxes, 2):
        apart = (
            one["right"] < other["left"]
            or other["right"] < one["left"]
            or one["bottom"] - 3 < other["top"]
            or other["bottom"] - 3 < one["top"]
        )
        assert apart, (one, other)


def test_links_lead_somewhere(page: Page) -> None:
    links = page.eval_on_selector_all("a[href]", "links => links.map(link => link.href)")
    files = [link.removeprefix("file://") for link in links if link.startswith("file:")]
    assert files
    assert [file for file in files if not Path(file).exists()] == []
