# SPDX-License-Identifier: BSD-3-Clause
"""Without a mouse: the Tab key reaches all there is to press, and the phone's menu opens."""

import pytest
from built_site import PAGES, by_page
from selenium.webdriver.common.keys import Keys

AT_ONCE = 100  # presses of the Tab key
_MISSED = """
return [...document.querySelectorAll("a[href], button, input:not([type=hidden]), [role=button]")]
  .filter((one) => one.checkVisibility({visibilityProperty: true}))
  .filter((one) => one.type !== "radio" || one.checked)  // the arrow keys lead to the others
  .filter((one) => !reached.has(one))
  .map((one) => one.outerHTML.slice(0, 200));
"""


@pytest.mark.parametrize("page", by_page(PAGES))
def test_the_tab_key_reaches_everything(browser, addresses, page):
    browser.open(addresses["file"] + page)
    number = browser.run(
        """
        window.reached = new Set();
        document.addEventListener("focusin", (event) => reached.add(event.target));
        return document.querySelectorAll("a, button, input, pre, [tabindex]").length;
        """
    )
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


def menu_is_shown(browser):
    return browser.run(
        """
        const menu = document.querySelector(".wy-nav-side");
        const shown = menu.checkVisibility({visibilityProperty: true});
        return shown && menu.getBoundingClientRect().left === 0;
        """
    )


def test_the_phones_menu_opens_and_closes_with_a_finger(phone, browser):
    assert not menu_is_shown(browser)
    browser.find("[data-toggle=wy-nav-top]")[0].click()
    assert menu_is_shown(browser)
    browser.find("[data-toggle=wy-nav-top]")[0].click()
    assert not menu_is_shown(browser)


@pytest.mark.parametrize("key", [Keys.ENTER, Keys.SPACE], ids=["enter", "space"])
def test_the_phones_menu_opens_and_closes_by_keyboard(phone, browser, key):
    # What is hidden is not in the way: the button is the first thing that the Tab key comes to.
    browser.press(Keys.TAB)
    assert has_focus(browser, "[role=button][aria-label=Menu][aria-expanded=false]")
    browser.press(key)
    assert menu_is_shown(browser)
    assert browser.find("[aria-label=Menu][aria-expanded=true]")
    assert has_focus(browser, ".wy-nav-side a")
    browser.press(Keys.TAB)
    assert has_focus(browser, "[role=search] input")
    browser.press(Keys.TAB)
    assert has_focus(browser, ".wy-menu a")
    browser.press(Keys.ESCAPE)
    assert not menu_is_shown(browser)
    assert has_focus(browser, "[role=button][aria-label=Menu][aria-expanded=false]")
