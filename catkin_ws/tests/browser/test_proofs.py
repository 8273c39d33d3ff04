# SPDX-License-Identifier: BSD-3-Clause
"""The marks of what is proved: a switch shows them, and each opens a box with its tests."""

import checks
import pytest
from selenium.webdriver.common.keys import Keys

pytestmark = pytest.mark.xdist_group("proofs")

MARKS = "return [...document.querySelectorAll('.proof')].filter((o) => o.checkVisibility()).length"
BOX = "return document.querySelector('.proof-box:popover-open')?.innerText"


@pytest.mark.parametrize("where", ["file", "served"])
def test_marks_are_hidden_at_first_and_a_switch_is_remembered(browser, addresses, where):
    browser.open(addresses[where] + "pages/latch.html")
    browser.run("localStorage.clear()")
    browser.open(addresses[where] + "pages/latch.html")
    assert browser.run(MARKS) == 0
    for shown in (True, False):
        browser.run("document.querySelector('.proofs input').focus()")
        browser.press(Keys.SPACE)
        assert bool(browser.run(MARKS)) == shown
        browser.open(addresses[where] + "pages/queues.html")
        assert bool(browser.run(MARKS)) == shown


@pytest.mark.parametrize(("size", "mode"), [("desktop", "light"), ("phone", "dark")])
def test_a_mark_opens_a_box_that_escape_closes(browser, addresses, size, mode):
    browser.prefer(mode)
    browser.open(addresses["served"] + "pages/queues.html", size)
    browser.run("document.body.classList.add('marks'); document.querySelector('.proof').focus()")
    assert browser.run(BOX) is None
    browser.press(Keys.ENTER)
    in_box = "return document.activeElement.matches('.proof-box:popover-open button')"
    browser.wait_until(lambda: browser.run(in_box), "the box has the focus")
    for text in (
        "There are two such queues",
        "lab/publisher_queue",
        "When a publisher's queue is full, it drops the oldest",  # the launch file's first line
        "publisher_queue.launch, line 1",
        '<group ns="publisher_queue">',
    ):
        assert text in browser.run(BOX)
    faults = checks.width(browser, size) + checks.axe(browser)
    checks.assert_none(faults)
    browser.press(Keys.ESCAPE)
    assert browser.run(BOX) is None
    assert browser.run("return document.activeElement.className") == "proof"
