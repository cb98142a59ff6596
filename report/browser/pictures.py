"""Draws each figure of the report small: docs/report/FIGURE.png."""

import io

from browser import PATIENCE, REPORT, ROOT, chromium
from PIL import Image

FOLDER = ROOT / "docs/report"
WIDTH, HEIGHT = 640, 800


def main() -> None:
    """Draw the figures of the page as it is, in light colours."""
    FOLDER.mkdir(exist_ok=True)
    with chromium() as browser:
        page = browser.new_page(viewport={"width": WIDTH + 32, "height": HEIGHT}, color_scheme="light")
        page.set_default_timeout(PATIENCE)
        page.goto(REPORT.as_uri())
        for figure in page.locator("figure:has(.plot)").all():
            path = FOLDER / f"{figure.get_attribute('id')}.png"
            picture = Image.open(io.BytesIO(figure.locator(".plot").screenshot()))
            # This method alone keeps the colours of thin lines.
            picture.convert("RGB").quantize(256, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE).save(
                path, optimize=True
            )
            print(path)


if __name__ == "__main__":
    main()
