# SPDX-License-Identifier: BSD-3-Clause
"""What can be wrong with an open page: each check returns a list of faults."""

import contextlib

from browser import SIZES
from mrp_testing.workspace import WORKSPACE

_AXE = WORKSPACE / "build" / "lint" / "node_modules" / "axe-core" / "axe.min.js"


def assert_none(faults):
    """Fail if there are faults, and show them all."""
    assert not faults, "\n".join(faults)


@contextlib.contextmanager
def _all_shown(browser):
    """Have all tabs shown at once, and no colour that is still on its way to another."""
    style = "* { transition: none !important } .tab-content { display: block !important }"
    browser.run(
        "document.head.append(window.added = document.createElement('style'));"
        "added.textContent = arguments[0]",
        style,
    )
    yield
    browser.run("added.remove()")


def console(browser):
    return browser.console()


def requests(browser, address):
    """Every request succeeds, and none goes elsewhere than to the site's address."""
    asked, failures = browser.requests()
    inside = (address, "blob:" + address, "data:", "about:")
    return [f"{url}: is outside" for url in asked if not url.startswith(inside)] + failures


def width(browser, size):
    """The page itself scrolls up and down only; a block of code may scroll sideways."""
    with _all_shown(browser):
        wide = browser.run("return document.scrollingElement.scrollWidth")
    available = SIZES[size][0]
    return [f"the page is {wide} wide, and the screen {available}"] if wide > available else []


def pictures(browser):
    """Every picture says in words what it shows, unless it only decorates; Sphinx would have its
    path say it."""
    return browser.run(
        """
        const says = (item) => item.tagName === "IMG"
          ? item.alt.trim() && !/[.](svg|png|jpe?g|gif)$/.test(item.alt)
          : item.closest(":is([role=img], [role=group])[aria-label]:not([aria-label=''])")
            || item.closest("[aria-hidden=true]");
        return [...document.querySelectorAll("img, svg, object, embed, canvas")]
          .filter((item) => !says(item))
          .map((item) => item.outerHTML.slice(0, 200) + ": has no text alternative");
        """
    )


def proofs(browser):
    """Every mark of a proof can be shown, is 24 px large each way, as WCAG asks, and says what is
    proved."""
    with _all_shown(browser):
        return browser.run(
            """
            const before = document.body.className;
            document.body.classList.add("marks");
            const wrong = (mark) => {
              const { width, height } = mark.getBoundingClientRect();
              const label = mark.getAttribute("aria-label");
              return width < 24 || height < 24 || !/^Proved: ./.test(label);
            };
            const faults = [...document.querySelectorAll(".proof")]
              .filter((mark) => !mark.closest("details:not([open])") && wrong(mark))
              .map((mark) => mark.outerHTML.slice(0, 200))
              .map((html) => html + ": is hidden, too small, or has no label");
            document.body.className = before;
            return faults;
            """
        )


def axe(browser, rules=None):
    """axe-core finds nothing, by these of its rules or by all; such as text of too little contrast,
    color-contrast."""
    with _all_shown(browser):
        browser.run("if (!window.axe) {" + _AXE.read_text() + "}")
        return browser.run(
            """
            // The page may answer first to all of it being shown.
            const frame = () => new Promise(requestAnimationFrame);
            const options = { resultTypes: ["violations"] };
            if (arguments[0]) options.runOnly = arguments[0];
            return frame().then(frame).then(() => axe.run(options)).then(({ violations }) =>
              violations.flatMap(({ id, nodes }) =>
                nodes.map(({ html, failureSummary }) =>
                  `${id}: ${html.slice(0, 200)}: ${failureSummary}`)));
            """,
            rules,
        )


def contrast(browser):
    """All text can be read on what is behind it, by axe-core's measure; it can't tell in SVG."""
    return axe(browser, ["color-contrast"])
