"""The documentation site: its links, and from its folder in Chromium once `cargo xtask docs` has built it."""

import pytest
from playwright.sync_api import Page

from conftest import ROOT
from report.site import PAGES, anchor, anchors, links

SITE = ROOT / "out/site/html"
built = pytest.mark.skipif(not SITE.is_dir(), reason="the site is not built: cargo xtask docs")


def test_no_link_is_dead() -> None:
    leading = [(page, *link) for page in PAGES for link in links(page)]
    assert ("README.md", "docs/importers.md", "") in leading
    assert ("docs/importers.md", "conformance/SystemStructure.ssd", "") in leading
    assert anchor("What it is: 98 m/s²") == "what-it-is-98-ms²"
    known = {page: anchors(page) | {""} for page in PAGES}
    assert "limits-of-validity" in known["README.md"]
    assert [link for link in leading if not (ROOT / link[1]).exists() or link[2] not in known.get(link[1], {""})] == []


def test_every_page_is_in_the_menu() -> None:
    menu = (ROOT / "mkdocs.yml").read_text(encoding="utf-8")
    assert [page for page in PAGES if f": {page}\n" not in menu] == []


@built
def test_search_finds_without_server_or_network(page: Page) -> None:
    failed: list[str] = []
    page.on("requestfailed", lambda request: failed.append(request.url))
    page.on("request", lambda request: failed.extend([request.url] * request.url.startswith("http")))
    page.goto((SITE / "docs/importers.html").as_uri())
    page.get_by_role("textbox", name="Search").click()
    page.keyboard.type("identify")
    page.get_by_role("link", name="Identification").last.wait_for()
    assert failed == []


@built
def test_the_python_interface_is_there(page: Page) -> None:
    page.goto((SITE / "python.html").as_uri())
    text = str(page.locator("article").text_content())
    for name in ("run(", "qualify(", "Assessment", "compare(", "identify(", "Component"):
        assert name in text, name
