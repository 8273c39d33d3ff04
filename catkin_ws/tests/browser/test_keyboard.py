# SPDX-License-Identifier: BSD-3-Clause
"""Without a mouse: the Tab key reaches all there is to press, and the phone's menu opens."""

import pytest
from built_site import with_each_kind
from selenium.webdriver.common.keys import Keys

AT_ONCE = 100  # presses of the Tab key
# What is hidden now may appear while the page scrolls, such as the link to its top.
_SHOWN = """
window.missed = new Set(
  [...document.querySelectorAll("a[href], button, input:not([type=hidden]), [role=button]")]
    .filter((item) => item.checkVisibility({visibilityProperty: true}))
    .filter((item) => item.type !== "radio" || item.checked),  // the arrow keys lead to the others
);
document.addEventListener("focusin", (event) => missed.delete(event.target));
return document.querySelectorAll("a, button, input, pre, [tabindex]").length;
"""
_MISSED = "return [...missed].map((item) => item.outerHTML.slice(0, 200))"


@pytest.mark.parametrize("page", with_each_kind())
def test_the_tab_key_reaches_everything(browser, addresses, page):
    browser.open(addresses["file"] + page)
    number = browser.run(_SHOWN)
    assert browser.run("return document.querySelector('[role=search] input').name") == "q"
    for _ in range(number // AT_ONCE + 2):
        browser.press(*[Keys.TAB] * AT_ONCE)
        if not browser.run(_MISSED):
            return
    assert browser.run(_MISSED) == []


@pytest.fixture
def phone(browser, addresses):
    browser.open(addresses["file"] + "index.html", "phone")


def has_focus(browser, selector):
    return browser.run("return document.activeElement.matches(arguments[0])", selector)


BUTTON = "button[aria-label=Menu]"


def menu_is_shown(browser):
    """Wait until the menu rests; return whether it is on the screen."""
    menu = "document.querySelector('.sidebar-drawer')"
    browser.wait_until(
        lambda: browser.run(f"return {menu}.getAnimations().length === 0"), "the menu rests"
    )
    return browser.run(
        f"const menu = {menu}; return menu.checkVisibility({{visibilityProperty: true}})"
        " && menu.getBoundingClientRect().left === 0"
    )


def test_the_phones_menu_opens_and_closes_with_a_finger(phone, browser):
    assert not menu_is_shown(browser)
    browser.find(BUTTON)[0].click()
    assert menu_is_shown(browser)
    browser.run("document.elementFromPoint(350, 370).click()")  # beside the menu
    assert not menu_is_shown(browser)


@pytest.mark.parametrize("key", [Keys.ENTER, Keys.SPACE], ids=["enter", "space"])
def test_the_phones_menu_opens_and_closes_by_keyboard(phone, browser, key):
    browser.run("document.querySelector(arguments[0]).focus()", BUTTON)
    browser.press(key)
    assert menu_is_shown(browser)
    assert browser.find(f"{BUTTON}[aria-expanded=true]")
    assert has_focus(browser, ".sidebar-drawer a")
    browser.press(Keys.TAB)
    assert has_focus(browser, "[role=search] input")
    browser.press(Keys.ESCAPE)
    assert not menu_is_shown(browser)
    assert has_focus(browser, f"{BUTTON}[aria-expanded=false]")
