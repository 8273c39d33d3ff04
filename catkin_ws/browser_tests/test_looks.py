# SPDX-License-Identifier: BSD-3-Clause
"""Every page, at both widths, in light and in dark mode: contrast, and a screenshot to look at."""

import base64
import itertools
import re

import checks
import pytest
from browser import SIZES
from built_site import PAGES, WORKSPACE, pages_with

SCREENSHOTS = WORKSPACE / "build" / "screenshots"
TALLEST = 16000  # a taller picture the browser cannot draw


@pytest.fixture(scope="module", params=itertools.product(SIZES, PAGES), ids=" ".join)
def view(request, browser, addresses):
    """An open page: its size and its name."""
    size, page = request.param
    browser.open(addresses["file"] + page, size)
    return size, page


@pytest.fixture(scope="module", params=["light", "dark"])
def mode(request, browser, view):
    browser.prefer(request.param)
    return request.param


def test_the_page_is_dark_in_dark_mode_alone(browser, mode):
    colour = browser.run("return getComputedStyle(document.body).backgroundColor")
    assert (max(map(int, re.findall(r"\d+", colour))) < 64) == (mode == "dark"), colour


def test_text_has_contrast(browser, mode):
    checks.assert_none(checks.contrast(browser))


def test_screenshot(browser, view, mode):
    size, page = view
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


@pytest.mark.parametrize("page", PAGES)
def test_axe_finds_nothing(browser, addresses, page):
    """On a phone most boxes scroll, and its menu is one more thing that can be wrong."""
    browser.open(addresses["file"] + page, "phone")
    for mode in ("light", "dark"):
        browser.prefer(mode)
        checks.assert_none(checks.axe(browser))


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
