"""Headless Chromium, and what is looked at in it."""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from playwright.sync_api import Browser, sync_playwright

ROOT = Path(__file__).parents[2]
# The report in full, whose figures are drawn for docs/; and the quick one, which is tested.
REPORT = ROOT / "out/report/index.html"
QUICK = ROOT / "out/report-quick/index.html"
# Of a machine however busy, ms.
PATIENCE = 300_000
NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
COMPONENT = ROOT / "dist/RelayContact.fmu"


@contextmanager
def chromium() -> Iterator[Browser]:
    """Start the machine's own Chromium."""
    path = next(filter(None, map(shutil.which, NAMES)), None)
    assert path, "Chromium is missing (on Debian: apt-get install chromium)"
    with sync_playwright() as playwright:
        # Root cannot have Chromium's sandbox.
        browser = playwright.chromium.launch(executable_path=path, args=["--no-sandbox"], timeout=PATIENCE)
        yield browser
        browser.close()
