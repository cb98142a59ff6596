"""The documentation site: its links, and from its folder in Chromium once `cargo xtask docs` has built it."""

import argparse
import re
from collections.abc import Iterator
from xml.etree import ElementTree

import pytest
from playwright.sync_api import Page

from conftest import ROOT
from relay_contact.command import line
from report.site import PAGES, anchor, anchors, links, tokens

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


def code() -> Iterator[tuple[str, str]]:
    """Give the code of all pages, but what programs print, with the page."""
    for page in PAGES:
        for token in tokens(page):
            if token.type in ("fence", "code_block") and token.info != "text":
                yield page, token.content
            yield from ((page, child.content) for child in token.children or [] if child.type == "code_inline")


def test_every_variable_on_a_page_is_one_of_the_component() -> None:
    description = ElementTree.parse(ROOT / "modelDescription.xml")
    known = {str(variable.get("name")) for variable in description.iter("ScalarVariable")}
    groups = "|".join({name.partition(".")[0] for name in known})
    named = re.compile(rf"(?<![\w./-])(?:{groups})(?:\.[a-z]\w*)+(?![\w(*/.-])")
    found = [(page, name) for page, text in code() for name in named.findall(text)]
    assert ("docs/variables.md", "contact.force") in found
    assert [pair for pair in found if pair[1] not in known] == []


def test_every_file_on_a_page_is_there() -> None:
    folders = "|".join(path.name for path in ROOT.iterdir() if path.is_dir() and path.name not in ("dist", "out"))
    named = re.compile(rf"(?<![\w./-])(?:{folders})/[\w./-]*(?![\w{{*])")
    found = [(page, name) for page, text in code() for name in named.findall(text)]
    assert ("CONTRIBUTING.md", "src/integrator/") in found
    assert [pair for pair in found if "NAME" not in pair[1] and not (ROOT / pair[1]).exists()] == []


def test_every_command_on_a_page_is_there() -> None:
    (commands,) = (each for each in line()._actions if isinstance(each, argparse._SubParsersAction))
    tasks = re.findall(r"(?m)^    ([A-Z]\w+)", (ROOT / "xtask/src/main.rs").read_text(encoding="utf-8"))
    texts = [(page, text) for page, whole in code() for text in whole.splitlines()]
    assert ("docs/importers.md", "cargo xtask importers") in texts
    for page, text in texts:
        for task in re.findall(r"cargo xtask (\w+)", text):
            assert task.capitalize() in tasks, (page, text)
        for command, rest in re.findall(r"(?:^|-m )relay[-_]contact ([a-z]+)([^#]*)", text):
            known = commands.choices[command]._option_string_actions
            assert [option for option in re.findall(r"--[\w-]+", rest) if option not in known] == [], (page, text)


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
