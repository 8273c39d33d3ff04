# SPDX-License-Identifier: BSD-3-Clause
"""The search, as files and served: it finds words that are on pages, and marks them there."""

import checks
import pytest
from mrp_testing.ports import listening
from selenium.webdriver.common.keys import Keys

WORDS = ["publisher", "namespace", "latch"]


@pytest.fixture(params=["file", "served"])
def address(request, browser, addresses):
    browser.open(addresses[request.param] + "index.html")
    return addresses[request.param]


def search(browser, word):
    """Search from the field that every page has; return the addresses of the pages found."""
    field = browser.find("[role=search] input[name=q]")[0]
    field.send_keys(word, Keys.ENTER)
    browser.wait_until(
        lambda: browser.run(
            "return document.readyState === 'complete'"
            " && /^Search finished|did not match/.test("
            "document.querySelector('#search-results > p')?.innerText ?? '')"
        ),
        "the search finishes",
    )
    return browser.run(
        "return [...document.querySelectorAll('#search-results li > a')].map((link) => link.href)"
    )


@pytest.mark.parametrize("word", WORDS)
def test_it_finds_a_page_that_has_the_word(browser, address, word):
    found = search(browser, word)
    assert found
    checks.assert_none(faults(browser, address))
    browser.driver.get(found[0])
    # The word is marked on the page.
    marked = browser.run(
        "return [...document.querySelectorAll('[role=main] :not(rect).highlighted')]"
        ".map((item) => item.textContent.toLowerCase())"
    )
    assert set(marked) == {word}
    checks.assert_none(faults(browser, address))


def faults(browser, address):
    result = checks.console(browser) + checks.requests(browser, address)
    for mode in ("light", "dark"):
        browser.prefer(mode)
        result += checks.contrast(browser)
    return result


def test_it_finds_an_error_text(browser, address):
    found = search(browser, "mutex lock failed in pthread_mutex_lock")
    assert any("/pages/why.html" in link for link in found)


def test_it_finds_nothing_where_there_is_nothing(browser, address):
    assert search(browser, "xylophone") == []


def test_the_server_listens_on_loopback_alone(addresses):
    port = int(addresses["served"].rsplit(":")[-1].strip("/"))
    assert listening(port) == {"127.0.0.1"}
