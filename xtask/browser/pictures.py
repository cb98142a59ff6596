"""Draws each figure of the report small: docs/report/FIGURE.png."""

import io
from pathlib import Path

from browser import PAGE, chromium
from PIL import Image

FOLDER = Path(__file__).parents[2] / "docs/report"
WIDTH, HEIGHT = 640, 800


def main() -> None:
    """Draw the figures of the page as it is, in light colours."""
    FOLDER.mkdir(exist_ok=True)
    with chromium() as browser:
        page = browser.new_page(viewport={"width": WIDTH + 32, "height": HEIGHT}, color_scheme="light")
        page.goto(PAGE.as_uri())
        for figure in page.locator("figure:has(.plot)").all():
            picture = Image.open(io.BytesIO(figure.locator(".plot").screenshot(animations="disabled")))
            path = FOLDER / f"{figure.get_attribute('id')}.png"
            picture.convert("RGB").quantize(64).save(path, optimize=True)
            print(path)


if __name__ == "__main__":
    main()
