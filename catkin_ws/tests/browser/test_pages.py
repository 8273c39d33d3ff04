# SPDX-License-Identifier: BSD-3-Clause
"""Every page, as a file on a desktop and served to a phone: nothing fails, all fits, and all can be
read in light and in dark mode. With a screenshot of each to look at."""

import base64
import itertools
import re

import checks
import pytest
from browser import SIZES
from built_site import PAGES, WORKSPACE, by_page, pages_with

SCREENSHOTS = WORKSPACE / "build" / "screenshots"
TALLEST = 16000  # a taller picture the browser cannot draw
VIEWS = itertools.product((("file", "desktop"), ("served", "phone")), PAGES)


@pytest.fixture(scope="module", params=by_page((*view, page) for view, page in VIEWS), ids=" ".join)
def view(request, browser, addresses):
    """An open page: (address of the site, size, name of the page)."""
    where, size, page = request.param
    browser.prefer("light")
    browser.open(addresses[where] + page, size)
    return addresses[where], size, page


@pytest.fixture
def mode(browser, view):
    """Light on a desktop and dark on a phone: a size changes no colour."""
    _, size, _ = view
    mode = "dark" if size == "phone" else "light"
    browser.prefer(mode)
    return mode


def test_the_console_stays_empty(browser, view):
    checks.assert_none(checks.console(browser))


def test_no_request_fails_or_goes_outside(browser, view):
    address, _, _ = view
    checks.assert_none(checks.requests(browser, address))


def test_the_page_does_not_scroll_sideways(browser, view):
    _, size, _ = view
    checks.assert_none(checks.width(browser, size))


def test_every_picture_has_a_text_alternative(browser, view):
    checks.assert_none(checks.pictures(browser))


def test_every_mark_can_be_pressed_and_says_what_is_proved(browser, view):
    checks.assert_none(checks.proofs(browser))


def test_axe_finds_nothing(browser, view):
    checks.assert_none(checks.axe(browser))


def test_the_page_is_dark_in_dark_mode_alone(browser, mode):
    colour = browser.run("return getComputedStyle(document.body).backgroundColor")
    assert (max(map(int, re.findall(r"\d+", colour))) < 64) == (mode == "dark"), colour


def test_text_has_contrast(browser, mode):
    checks.assert_none(checks.contrast(browser))


def test_screenshot(browser, view, mode):
    _, size, page = view
    width, _ = SIZES[size]
    height = min(browser.run("return document.scrollingElement.scrollHeight"), TALLEST)
    shot = browser.command(
        "Page.captureScreenshot",
        format="png",
        optimizeForSpeed=True,
        captureBeyondViewport=True,
        clip={"x": 0, "y": 0, "width": width, "height": height, "scale": 1},
    )
    path = (SCREENSHOTS / f"{size}-{mode}" / page).with_suffix(".png")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(base64.b64decode(shot["data"]))


@pytest.mark.parametrize("page", by_page(PAGES))
def test_firefox_has_nothing_to_complain_of(firefox, addresses, page):
    firefox.open(addresses["served"] + page)  # of files, it does not tell what was asked for
    checks.assert_none(checks.console(firefox))
    checks.assert_none(checks.requests(firefox, addresses["served"]))


@pytest.mark.parametrize(
    ("kind", "colour"), [("original", "rgb(176, 58, 46)"), ("ours", "rgb(39, 118, 47)")]
)
@pytest.mark.parametrize("page", pages_with("quote original"))
def test_a_quote_has_its_bar(browser, addresses, page, kind, colour):
    """Red for what the original prints, green for what stands here: the errata say so."""
    browser.open(addresses["file"] + page, next(iter(SIZES)))
    bars = browser.run(
        "return [...document.querySelectorAll('.quote.' + arguments[0])].map(getComputedStyle)"
        ".map((style) => style.borderLeftWidth + ' ' + style.borderLeftColor)",
        kind,
    )
    assert bars
    assert set(bars) == {f"4px {colour}"}
