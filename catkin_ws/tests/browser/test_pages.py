# SPDX-License-Identifier: BSD-3-Clause
"""Every page, as a file on a desktop in light mode and served to a phone in dark mode: nothing
fails, all fits, and all can be read. With a screenshot of each to look at."""

import base64
import re

import checks
import pytest
from browser import SIZES
from built_site import PAGES, WORKSPACE, with_each_kind

SCREENSHOTS = WORKSPACE / "build" / "screenshots"
TALLEST = 16000  # a taller picture the browser cannot draw


@pytest.mark.parametrize("page", PAGES)
def test_file_on_a_desktop_in_light_mode(browser, addresses, page):
    browser.prefer("light")
    browser.open(addresses["file"] + page, "desktop")
    faults = checks.console(browser)
    faults += checks.requests(browser, addresses["file"])
    faults += checks.width(browser, "desktop")
    faults += checks.pictures(browser)
    faults += checks.proofs(browser)
    faults += checks.axe(browser)
    take_screenshot(browser, "desktop", page)
    checks.assert_none(faults)


@pytest.mark.parametrize("page", PAGES)
def test_served_to_a_phone_in_dark_mode(browser, addresses, page):
    browser.prefer("dark")
    browser.open(addresses["served"] + page, "phone")
    faults = checks.width(browser, "phone")
    faults += checks.proofs(browser)
    faults += checks.contrast(browser)
    take_screenshot(browser, "phone", page)
    checks.assert_none(faults)


def take_screenshot(browser, size, page):
    """Save a picture of the whole page, without its end if it is too tall."""
    width, _ = SIZES[size]
    height = min(browser.run("return document.scrollingElement.scrollHeight"), TALLEST)
    shot = browser.command(
        "Page.captureScreenshot",
        format="png",
        optimizeForSpeed=True,
        captureBeyondViewport=True,
        clip={"x": 0, "y": 0, "width": width, "height": height, "scale": 1},
    )
    path = (SCREENSHOTS / size / page).with_suffix(".png")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(base64.b64decode(shot["data"]))


@pytest.mark.parametrize("page", ["index.html", "search.html", "pages/latch.html"])
def test_the_page_is_dark_in_dark_mode_alone(browser, addresses, page):
    browser.open(addresses["file"] + page)
    for mode in ("light", "dark"):
        browser.prefer(mode)
        colour = browser.run("return getComputedStyle(document.body).backgroundColor")
        assert (max(map(int, re.findall(r"\d+", colour))) < 64) == (mode == "dark"), colour


@pytest.mark.xdist_group("firefox")
@pytest.mark.parametrize("page", with_each_kind())
def test_firefox_has_nothing_to_complain_of(firefox, addresses, page):
    firefox.open(addresses["served"] + page)  # of files, it does not tell what was asked for
    checks.assert_none(checks.console(firefox))
    checks.assert_none(checks.requests(firefox, addresses["served"]))


@pytest.mark.parametrize(
    ("kind", "colour"), [("original", "rgb(176, 58, 46)"), ("ours", "rgb(39, 118, 47)")]
)
def test_a_quote_has_its_bar(browser, addresses, kind, colour):
    """Red for what the original prints, green for what stands here: the errata say so."""
    browser.open(addresses["file"] + "pages/errata.html")
    bars = browser.run(
        "return [...document.querySelectorAll('.quote.' + arguments[0])].map(getComputedStyle)"
        ".map((style) => style.borderLeftWidth + ' ' + style.borderLeftColor)",
        kind,
    )
    assert bars
    assert set(bars) == {f"4px {colour}"}
