"""The documentation site, from its folder in Chromium; `cargo xtask docs` builds it."""

import pytest
from playwright.sync_api import Page

from conftest import ROOT

SITE = ROOT / "out/site/html"
if not SITE.is_dir():
    pytest.skip("the site is not built: cargo xtask docs", allow_module_level=True)


def test_search_finds_without_server_or_network(page: Page) -> None:
    failed: list[str] = []
    page.on("requestfailed", lambda request: failed.append(request.url))
    page.on("request", lambda request: failed.extend([request.url] * request.url.startswith("http")))
    page.goto((SITE / "docs/importers.html").as_uri())
    page.get_by_role("textbox", name="Search").click()
    page.keyboard.type("identify")
    page.get_by_role("link", name="Identification").last.wait_for()
    assert failed == []


def test_the_python_interface_is_there(page: Page) -> None:
    page.goto((SITE / "python.html").as_uri())
    text = str(page.locator("article").text_content())
    for name in ("run(", "qualify(", "Assessment", "compare(", "identify(", "Component"):
        assert name in text, name
