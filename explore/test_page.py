"""The page that runs the simulation, from its file in Chromium; `cargo xtask explore` builds it."""

import re
from pathlib import Path
from typing import Literal

import numpy as np
import pytest
from playwright.sync_api import Page

from conftest import ROOT
from relay_contact import Component, run
from relay_contact.component import sine

COMPONENT = ROOT / "dist/RelayContact.fmu"
Scheme = Literal["light", "dark"]
PAGE = ROOT / "dist/explore.html"
if not PAGE.is_file():
    pytest.skip("dist/explore.html is not built: cargo xtask explore", allow_module_level=True)
PICTURES = ROOT / "out/explore"
# Of the force scale. The page rounds otherwise: without fused multiply-add, with functions of another C library.
# What it rounds by, 1e-16, grows at each closing; after those of the hardest scene here it is still less than this.
ROUNDING = 1e-9
SCENES = [
    "",
    "excitation.amplitude=400",
    "excitation.amplitude=600&excitation.frequency=1400",
    "effects.contactLaw=Rough&contact.overtravel=0.0001&excitation.amplitude=300",
    "effects.contactLaw=Linearised&excitation.frequency=250&beam.length=0.02",
    "effects.excitation=HalfSine&excitation.amplitude=-600&excitation.duration=0.001",
    "contact.damping=0&tip.mass=0.00008&excitation.frequency=3000&excitation.amplitude=250",
]


def opened(page: Page, hash_: str = "") -> Page:
    """Open the page from its file, and wait for the curves."""
    page.goto("about:blank")
    page.goto(f"{PAGE.as_uri()}{'#' * bool(hash_)}{hash_}")
    page.wait_for_function("run !== null && !busy")
    assert page.evaluate("run.error ?? null") is None
    return page


@pytest.mark.parametrize("hash_", SCENES)
def test_the_saved_scene_has_the_same_forces_in_the_component(page: Page, tmp_path: Path, hash_: str) -> None:
    opened(page, hash_)
    with page.expect_download() as saved:
        page.get_by_role("button", name="Save scene.toml").click()
    saved.value.save_as(tmp_path / "scene.toml")
    result = run(tmp_path / "scene.toml", outputs=["contact.force", "preload.force"], component=Component(COMPONENT))
    shown = page.evaluate("({time: Array.from(run.time), force: Array.from(run.force), count: run.count})")
    assert np.array_equal(shown["time"], result["time"])
    scale = float(result["preload.force"][0])
    assert np.abs(np.array(shown["force"]) - result["contact.force"]).max() <= ROUNDING * scale
    given = dict(pair.split("=") for pair in hash_.split("&") if pair)
    text = (tmp_path / "scene.toml").read_text()
    for name, value in given.items():
        assert re.search(rf'^{name} = "?{value}"?$', text, re.MULTILINE), text


def test_twenty_periods_take_less_than_50_ms(page: Page) -> None:
    opened(page, "excitation.amplitude=400")
    taken = []
    for amplitude in range(401, 411):
        page.get_by_label("Amplitude; negative pulls", exact=True).fill(str(amplitude / 10))
        page.wait_for_function("!busy && waiting === null")
        taken.append(page.evaluate("run.taken"))
    # The least, as other programs run beside this one.
    assert min(taken) < 50


def test_level_is_that_of_the_component(page: Page) -> None:
    opened(page)
    page.wait_for_function("levels.size >= 6")
    found = [each for each in page.evaluate("[...levels.values()]") if 400 < each["frequency"] < 3000]
    assert len(found) >= 2
    assert page.locator("#progress").evaluate("bar => bar.value") > 0
    component = Component(COMPONENT)
    for each in found:
        for factor, opens in ((0.995, False), (1.005, True)):
            amplitude, frequency = factor * each["level"], each["frequency"]
            with component.started(sine(frequency, amplitude, 40 / frequency)) as contact:
                contact.step(0.0, 60 / frequency)
                contact.step(60 / frequency, 4 / frequency)
                assert (contact.get("contact.lastOpening") > 60 / frequency) == opens, (each, factor)


def test_page_asks_nothing_of_the_network_and_reports_no_error(page: Page) -> None:
    asked: list[str] = []
    wrong: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    page.on("console", lambda message: wrong.extend([message.text] * (message.type == "error")))
    page.on("pageerror", lambda error: wrong.append(str(error)))
    opened(page)
    assert [url for url in asked if not url.startswith((PAGE.as_uri(), "blob:", "data:", "about:"))] == []
    assert wrong == []


def test_keys_change_a_value_and_the_link_brings_it_back(page: Page) -> None:
    opened(page)
    page.get_by_label("Overtravel, slider").focus()
    for _ in range(40):
        page.keyboard.press("ArrowRight")
    link = page.get_by_label("Link to these values").input_value()
    scene = page.locator("#scene").text_content()
    assert "contact.overtravel=" in link
    assert "contact.overtravel = 0.0002" not in str(scene).splitlines()
    opened(page, link.partition("#")[2])
    assert page.locator("#scene").text_content() == scene


def test_each_position_of_a_slider_is_another_value(page: Page) -> None:
    opened(page)
    same = page.evaluate(
        "CONTROLS.filter((one) => !one.choices && new Set(Array.from({ length: positions(one) + 1 },"
        " (_, n) => fromSlider(one, n / positions(one)))).size <= positions(one)).map(({ name }) => name)"
    )
    assert same == []


def test_a_number_that_is_not_allowed_gives_way_to_the_one_simulated(page: Page) -> None:
    opened(page)
    box = page.get_by_label("Overtravel", exact=True)
    for wrong in ("3000", ""):
        box.fill(wrong)
        box.press("Tab")
        assert box.input_value() == "0.2"
    assert box.get_attribute("title") == "0.02 to 0.6 mm"
    box.fill("0.30")
    box.press("Tab")
    assert box.input_value() == "0.3"


@pytest.mark.parametrize("hash_", ["beam.length=1e9", "beam.length=", "beam.length=NaN", "effects.contactLaw=<b>", "x"])
def test_a_wrong_link_leaves_the_start_values(page: Page, hash_: str) -> None:
    opened(page)
    scene = page.locator("#scene").text_content()
    opened(page, hash_)
    assert page.locator("#scene").text_content() == scene


def test_what_cannot_be_simulated_is_said_in_the_library_s_words(page: Page) -> None:
    opened(page)
    page.evaluate("send('stop = -1\\noutputs = []')")
    page.wait_for_function("!busy && waiting === null && run.error")
    assert "stop = -1" in str(page.get_by_role("status").text_content())


def test_what_cannot_be_loaded_is_said(page: Page, tmp_path: Path) -> None:
    """A browser that is too old; what then fails for want of the library is not said in its place."""
    (tmp_path / "page.html").write_text(PAGE.read_text().replace("DecompressionStream", "TooNewStream"))
    page.goto((tmp_path / "page.html").as_uri())
    page.wait_for_function("run !== null && broken !== ''")
    page.get_by_label("Overtravel, slider").press("End")
    page.wait_for_timeout(500)
    assert page.get_by_role("status").text_content() == "TooNewStream is not defined"
    assert "Ended: TooNewStream is not defined" in str(page.locator("#level-caption").text_content())


def test_a_dragged_slider_is_followed_where_the_browser_refuses_quick_changes_of_the_address(page: Page) -> None:
    opened(page)
    page.evaluate("void (history.replaceState = () => { throw new Error('too often'); })")
    page.get_by_label("Overtravel, slider").press("End")
    page.wait_for_function("!busy && waiting === null")
    link = page.get_by_label("Link to these values").input_value()
    shown = page.evaluate("run.preload")
    opened(page, link.partition("#")[2])
    assert "contact.overtravel=" in link
    assert page.evaluate("run.preload") == shown


@pytest.mark.parametrize(
    "hash_",
    ["excitation.amplitude=1470&beam.length=0.03", "beam.length=0.03&beam.thickness=6e-5&contact.overtravel=2e-5"],
)
def test_levels_and_vibration_are_inside_the_axes(page: Page, hash_: str) -> None:
    """150 g beside levels below 60 g; and levels of 0.01 g."""
    opened(page, hash_)
    page.wait_for_function("levels.size === FREQUENCIES.length")
    ends = page.locator("#level .frame").evaluate(
        "box => [box.y.baseVal.value, box.y.baseVal.value + box.height.baseVal.value]"
    )
    heights = page.evaluate(
        "[...document.querySelectorAll('#level .curve, #level .here')].flatMap(one => one.tagName === 'circle'"
        " ? one.cy.baseVal.value : one.getAttribute('d').slice(1).split('L').map(each => Number(each.split(' ')[1])))"
    )
    assert len(heights) >= 41
    assert ends[0] <= min(heights) <= max(heights) <= ends[1]


def test_every_control_has_a_label_and_is_reached_by_tab(page: Page) -> None:
    opened(page)
    controls = page.locator("input:visible, select:visible, button:visible, pre")
    unnamed = controls.evaluate_all(
        "all => all.filter(one => !one.ariaLabel && !(one.labels ?? []).length && !one.textContent).map(one => one.id)"
    )
    assert unnamed == []
    page.evaluate("document.body.focus()")
    for _ in range(controls.count() + 1):
        page.keyboard.press("Tab")
        shape = page.evaluate("getComputedStyle(document.activeElement).outlineStyle")
        assert shape == "solid", page.evaluate("document.activeElement.outerHTML")
    # The last of them: nothing holds the focus.
    assert page.evaluate("document.activeElement.id") == "scene"
    for figure in ("force", "resistance", "level"):
        assert page.locator(f"#{figure}-caption").text_content()
        assert page.locator(f"#{figure} path").count() > 5


def test_what_opens_is_shaded_and_said(page: Page) -> None:
    opened(page, "excitation.amplitude=400")
    times = page.evaluate("run.open.length")
    # In each of the 20 periods, as with the scene chatter-41g.
    assert 19 <= times <= 21
    assert page.locator("#force .open").count() == times
    assert f"opens {times} times; 20 interruptions" in str(page.get_by_role("status").text_content())
    opened(page)
    assert page.get_by_role("status").text_content() == "stays closed; no interruption"


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_contrast_is_that_of_wcag_aa(page: Page, scheme: Scheme) -> None:
    page.emulate_media(color_scheme=scheme)
    opened(page)

    def luminance(name: str) -> float:
        code = page.evaluate("name => getComputedStyle(document.documentElement).getPropertyValue(name)", f"--{name}")
        channels = np.array([int(code.strip()[n : n + 2], 16) for n in (1, 3, 5)]) / 255
        linear = np.where(channels <= 0.04045, channels / 12.92, ((channels + 0.055) / 1.055) ** 2.4)
        return float(linear @ [0.2126, 0.7152, 0.0722])

    def contrast(one: str, other: str) -> float:
        low, high = sorted((luminance(one), luminance(other)))
        return (high + 0.05) / (low + 0.05)

    for text in ("ink", "faint", "accent", "second"):
        for behind in ("paper", "panel"):
            assert contrast(text, behind) >= 4.5, (text, behind)
    # Curves need 3.
    assert min(contrast(line, "open") for line in ("accent", "second", "ink")) >= 3


@pytest.mark.parametrize(("width", "height"), [(1280, 900), (390, 844)])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_page_is_no_wider_than_its_window(page: Page, width: int, height: int, scheme: Scheme) -> None:
    page.emulate_media(color_scheme=scheme)
    page.set_viewport_size({"width": width, "height": height})
    opened(page, "excitation.amplitude=400")
    page.wait_for_function("levels.size >= 3")
    PICTURES.mkdir(parents=True, exist_ok=True)
    page.screenshot(path=PICTURES / f"{width}-{scheme}.png", full_page=True)
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
