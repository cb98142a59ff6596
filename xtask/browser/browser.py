"""Headless Chromium, and what is looked at in it."""

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from playwright.sync_api import Browser, sync_playwright

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "out/report"
PAGE = FOLDER / "index.html"
COMPONENT = ROOT / "dist/RelayContact.fmu"


@contextmanager
def chromium() -> Iterator[Browser]:
    """Start the machine's own Chromium, which RELAY_CONTACT_CHROMIUM names."""
    path = shutil.which(os.environ["RELAY_CONTACT_CHROMIUM"])
    with sync_playwright() as playwright:
        # Root cannot have Chromium's sandbox.
        browser = playwright.chromium.launch(executable_path=path, args=["--no-sandbox"])
        yield browser
        browser.close()
