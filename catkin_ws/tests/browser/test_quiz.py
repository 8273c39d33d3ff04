# SPDX-License-Identifier: BSD-3-Clause
"""The questions: the page says right or wrong and why, and the browser keeps the score."""

import checks
import pytest

pytestmark = pytest.mark.xdist_group("quiz")

FORM = "form[data-question='run/seven']"


@pytest.fixture(params=["file", "served"])
def address(request, browser, addresses):
    browser.open(addresses[request.param] + "pages/run.html")
    browser.run("localStorage.clear()")
    browser.open(addresses[request.param] + "pages/run.html")
    return addresses[request.param]


def answer(browser, number):
    browser.run(
        "const form = document.querySelector(arguments[0]);"
        "form.querySelector(`input[value='${arguments[1]}']`).click();"
        "form.querySelector('button').click();",
        FORM,
        number,
    )
    return browser.run(
        "const form = document.querySelector(arguments[0]);"
        "return [form.querySelector('[role=status]').textContent,"
        " [...form.querySelectorAll('.why')].filter((item) => item.checkVisibility())"
        ".map((item) => item.textContent.trim().split(' ')[0])]",
        FORM,
    )


def test_verdict_and_reason(address, browser):
    assert answer(browser, 1) == ["Not quite. Have another go.", ["The"]]
    assert answer(browser, 2) == ["Right!", ["Yes:"]]
    checks.assert_none(checks.axe(browser))


def test_no_answer_is_no_verdict(address, browser):
    browser.run("document.querySelector(arguments[0] + ' button').click()", FORM)
    assert browser.run(
        "return document.querySelector(arguments[0] + ' [role=status]').textContent", FORM
    ) == ("Choose an answer first.")


def test_score_is_kept_and_can_be_cleared(address, browser):
    answer(browser, 2)
    browser.driver.get(address + "pages/score.html")
    total = "return document.querySelector('.score-total').textContent"
    assert browser.run(total).startswith("1 of ")
    right = "table.score tbody tr:first-child td:last-child"
    assert browser.find(right)[0].text == "1"
    browser.find(".score-reset")[0].click()
    assert browser.run(total).startswith("0 of ")
