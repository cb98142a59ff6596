"""Headless Chromium for the tests of all pages: the report, the component's documentation, the simulation, the site."""

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, sync_playwright

ROOT = Path(__file__).parent
# Of a machine however busy, ms.
PATIENCE = 300_000


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """Start the machine's own Chromium."""
    names = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
    path = next(filter(None, map(shutil.which, names)), None)
    assert path, "Chromium is missing (on Debian: apt-get install chromium)"
    with sync_playwright() as playwright:
        # Root cannot have Chromium's sandbox.
        started = playwright.chromium.launch(executable_path=path, args=["--no-sandbox"], timeout=PATIENCE)
        yield started
        started.close()


def empty_page(browser: Browser, width: int = 1280, *, dark: bool = False, touch: bool = False) -> Page:
    """Open a page of this width, colour and device that waits for a busy machine."""
    page = browser.new_page(
        viewport={"width": width, "height": 900}, color_scheme="dark" if dark else "light",
        has_touch=touch, is_mobile=touch,
    )  # fmt: skip
    page.set_default_timeout(PATIENCE)
    return page


@pytest.fixture
def page(browser: Browser) -> Iterator[Page]:
    """Open an empty page."""
    page = empty_page(browser)
    yield page
    page.close()
