# SPDX-License-Identifier: BSD-3-Clause
"""The copy buttons: what they copy is the code, to the last character."""

import pytest
from built_site import pages_with
from selenium.webdriver.common.keys import Keys


@pytest.fixture(params=pages_with('class="highlight"'))
def page(request, browser, addresses):
    browser.open(addresses["file"] + request.param)


def test_code_has_a_copy_button_and_what_was_printed_has_none(page, browser):
    blocks = browser.run(
        """
        return [...document.querySelectorAll("div.highlight")].map((block) => [
          block.querySelectorAll("button.copybtn").length,
          block.closest(".output") ? 0 : 1,
          block.textContent.slice(0, 80),
        ]);
        """
    )
    assert blocks
    assert [block for block in blocks if block[0] != block[1]] == []


def test_the_button_copies_exactly_the_code(page, browser):
    browser.run(
        """
        const field = document.createElement("textarea");
        field.id = "paste-here";
        field.style = "position: fixed; bottom: 0; z-index: 999";
        document.body.append(field);
        for (const one of document.querySelectorAll("details")) one.open = true;
        """
    )
    field = browser.find("#paste-here")[0]
    for button in browser.find("button.copybtn"):
        # Show the tab that the block is in, if it is in any.
        code = browser.run(
            """
            for (let tab = arguments[0].closest(".tab-content"); tab;
                 tab = tab.parentElement.closest(".tab-content"))
              tab.previousElementSibling.click();
            arguments[0].scrollIntoView({block: "center"});
            document.querySelector("#paste-here").value = "";
            return arguments[0].parentElement.querySelector("pre").textContent;
            """,
            button,
        )
        button.click()
        field.send_keys(Keys.CONTROL, "v")
        pasted = field.get_property("value")
        # Without its last line's end: pasted into a terminal, that would run it at once.
        assert pasted == code.removesuffix("\n")
