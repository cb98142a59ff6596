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


def test_every_link_on_every_page_leads_to_a_file(page: Page) -> None:
    dead = []
    for path in SITE.rglob("*.html"):
        if path.name in ("404.html", "explore.html"):
            continue
        page.goto(path.as_uri(), wait_until="domcontentloaded")
        links = page.eval_on_selector_all("a[href]", "all => all.map(one => one.href.split('#')[0])")
        files = {link.removeprefix("file://") for link in links if link.startswith("file:")}
        dead += [(path.name, file) for file in files if not (ROOT / file).exists()]
    assert dead == []


def test_the_python_interface_is_there(page: Page) -> None:
    page.goto((SITE / "python.html").as_uri())
    text = str(page.locator("article").text_content())
    for name in ("run(", "qualify(", "Assessment", "compare(", "identify(", "Component"):
        assert name in text, name
