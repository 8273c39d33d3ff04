# SPDX-License-Identifier: BSD-3-Clause
"""The checks find what they are there for: pages with one fault each, and harmless ones."""

import checks
import pytest

FINE = (
    '<!DOCTYPE html><html lang="en"><meta name="viewport" content="width=device-width">'
    '<title>A page</title><main><h1>A page</h1><p>With <a href="other.html">a link</a>.</p>'
    '<img src="p.svg" alt="A line">'
)
TEXT = '<p style="color: {}; background: {}">Some text</p>'
PROOF = (
    '<button class="proof" aria-label="{}" '
    'style="display: {}; padding: 0; width: {}px; height: 24px">&#10003;</button>'
)
SCROLLS = '<pre style="overflow: auto" {}>' + "long" * 50 + "</pre>"

FAULTS = {
    "a warning on the console": ("<script>console.warn('beware')</script>", "console"),
    "a script that is not there": ('<script src="gone.js"></script>', "requests console"),
    "a stylesheet from outside": (
        '<link rel="stylesheet" href="https://style.example/one.css">',
        "requests console",
    ),
    "a word that is too long": ("<p>" + "long" * 50 + "</p>", "width"),
    "an image whose alt is its path": ('<img src="p.svg" alt="p.svg">', "pictures"),
    "an svg that says nothing": ("<svg><circle r='9'/></svg>", "pictures"),
    "a mark that is too small": (PROOF.format("Proved: It is.", "block", 8), "proofs"),
    "a mark that stays hidden": (PROOF.format("Proved: It is.", "none", 24), "proofs"),
    "a mark without a label": (PROOF.format("Proved:", "block", 24), "proofs"),
    "white on a light blue": (TEXT.format("#fff", "#2980b9"), "axe"),
    "code that only a mouse can scroll": (SCROLLS.format(""), "axe"),
}

HARMLESS = {
    "nothing else": "",
    "code that scrolls in itself": SCROLLS.format('tabindex="0"'),
    "a mark of a proof": PROOF.format("Proved: It is.", "block", 24),
    "the least contrast": TEXT.format("#767676", "#fff"),
    "a picture in the page's own text": '<img alt="A dot" src="data:image/svg+xml,<svg/>">',
}


@pytest.fixture
def failed(browser, tmp_path):
    """Return a function that opens a page with these elements, and names the checks that fail."""
    svg = '<svg xmlns="http://www.w3.org/2000/svg"><path d="M0 0h9" stroke="red"/></svg>'
    (tmp_path / "p.svg").write_text(svg)

    def check(elements):
        (tmp_path / "page.html").write_text(FINE + elements)
        address = tmp_path.as_uri() + "/"
        browser.open(address + "page.html", "phone")
        browser.prefer("light")
        faults = {
            "requests": checks.requests(browser, address),
            "console": checks.console(browser),
            "width": checks.width(browser, "phone"),
            "pictures": checks.pictures(browser),
            "proofs": checks.proofs(browser),
            "axe": checks.axe(browser),
        }
        return " ".join(name for name in faults if faults[name])

    return check


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_found(failed, fault):
    elements, check = FAULTS[fault]
    assert failed(elements) == check


@pytest.mark.parametrize("harmless", HARMLESS)
def test_what_is_harmless_is_not(failed, harmless):
    assert failed(HARMLESS[harmless]) == ""
