# SPDX-License-Identifier: BSD-3-Clause
"""The tabs: a choice of one applies to all of that name on the page, by mouse and by keyboard."""

import pytest
from selenium.webdriver.common.keys import Keys


# Many sets of two tabs, and one of four.
@pytest.fixture(params=["pages/publisher.html", "pages/cpp.html"])
def page(request, browser, addresses):
    open_still(browser, addresses["file"] + request.param)


def open_still(browser, address):
    """Open a page that jumps to what is clicked: the theme's pages glide there, past the click."""
    browser.open(address)
    browser.run("document.documentElement.style.scrollBehavior = 'auto'")


def shown(browser):
    """Return [[(label, is chosen, is shown) of each tab] of each set], and check that it fits."""
    sets = browser.run(
        """
        return [...document.querySelectorAll(".tab-set")].map((set) =>
          [...set.querySelectorAll(":scope > input")].map((input) => {
            const label = input.nextElementSibling;
            const shown = label.nextElementSibling.checkVisibility();
            return [label.textContent, input.checked, shown];
          }));
        """
    )
    for tabs in sets:
        assert [chosen for _, chosen, _ in tabs].count(True) == 1, tabs
        assert [chosen for _, chosen, _ in tabs] == [visible for _, _, visible in tabs], tabs
    return sets


def assert_chosen_everywhere(browser, name):
    """In every set that has a tab of that name, that tab is the one that is shown."""
    sets = [tabs for tabs in shown(browser) if name in [label for label, _, _ in tabs]]
    assert sets
    assert [label for tabs in sets for label, chosen, _ in tabs if chosen] == [name] * len(sets)


def test_a_click_on_a_label_shows_its_tab_everywhere(page, browser):
    for number, tabs in enumerate(shown(browser)):
        for index in (*range(1, len(tabs)), 0):
            label = browser.find(".tab-set")[number].find_elements("css selector", "label")[index]
            label.click()
            assert_chosen_everywhere(browser, label.text)


def test_the_arrow_keys_show_the_next_tab_everywhere(page, browser):
    for number, tabs in enumerate(shown(browser)):
        chosen = [is_chosen for _, is_chosen, _ in tabs].index(True)
        focus(browser, number)
        for key, step in ((Keys.RIGHT, 1), (Keys.LEFT, 0)):
            browser.press(key)
            assert_chosen_everywhere(browser, tabs[(chosen + step) % len(tabs)][0])


def test_the_choice_is_remembered_on_the_next_page(browser, addresses):
    for name in ("C++", "Python"):
        open_still(browser, addresses["served"] + "pages/publisher.html")
        label = next(label for label in browser.find(".tab-label") if label.text == name)
        label.click()
        browser.open(addresses["served"] + "pages/subscriber.html")
        assert_chosen_everywhere(browser, name)


def test_paper_has_all_tabs_one_below_the_other(page, browser):
    browser.command("Emulation.setEmulatedMedia", media="print")
    missing = browser.run(
        "return [...document.querySelectorAll('.tab-content')]"
        ".filter((item) => !item.checkVisibility()).length"
    )
    heights = browser.run(
        """
        const parts = document.querySelectorAll(".tab-set > :is(.tab-label, .tab-content)");
        return [...parts].map((item) => item.getBoundingClientRect().top);
        """
    )
    browser.command("Emulation.setEmulatedMedia", media="")
    assert missing == 0
    assert heights == sorted(heights)


def focus(browser, number):
    """Go to a set of tabs by the Tab key, from where the page before it ends."""
    browser.run(
        """
        const set = document.querySelectorAll(".tab-set")[arguments[0]];
        const before = document.createElement("button");
        set.before(before);
        before.focus();
        """,
        number,
    )
    browser.press(Keys.TAB)
    assert browser.run(
        """
        const set = document.querySelectorAll(".tab-set")[arguments[0]];
        return document.activeElement.parentElement === set && document.activeElement.checked;
        """,
        number,
    )
