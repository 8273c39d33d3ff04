# SPDX-License-Identifier: BSD-3-Clause
"""Every page, as a file on a desktop and served to a phone."""

import itertools

import checks
import pytest
from built_site import PAGES


@pytest.fixture(
    scope="module",
    params=itertools.product((("file", "desktop"), ("served", "phone")), PAGES),
    ids=lambda param: " ".join((*param[0], param[1])),
)
def view(request, browser, addresses):
    """An open page: (address of the site, size)."""
    (where, size), page = request.param
    browser.open(addresses[where] + page, size)
    return addresses[where], size


def test_the_console_stays_empty(browser, view):
    checks.assert_none(checks.console(browser))


def test_no_request_fails_or_goes_outside(browser, view):
    checks.assert_none(checks.requests(browser, view[0]))


def test_the_page_does_not_scroll_sideways(browser, view):
    checks.assert_none(checks.width(browser, view[1]))


def test_every_picture_has_a_text_alternative(browser, view):
    checks.assert_none(checks.pictures(browser))


def test_every_proof_can_be_pressed_and_says_what_it_proves(browser, view):
    checks.assert_none(checks.proofs(browser))


@pytest.mark.parametrize("page", PAGES)
def test_firefox_has_nothing_to_complain_of(firefox, addresses, page):
    firefox.open(addresses["served"] + page)  # of files, it does not tell what was asked for
    checks.assert_none(checks.console(firefox))
    checks.assert_none(checks.requests(firefox, addresses["served"]))
