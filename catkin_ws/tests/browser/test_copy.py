# SPDX-License-Identifier: BSD-3-Clause
"""The copy buttons: what they copy is the code, to the last character."""

import pytest

pytestmark = pytest.mark.xdist_group("copy")

# With tabs, what is folded, proofs, files, and what was printed; and one without proofs.
PAGES = ("pages/cpp.html", "pages/latch.html", "pages/tldr.html")


@pytest.fixture(scope="module", params=PAGES)
def page(request, browser, addresses):
    # A browser lets no script read the clipboard from a file.
    browser.open(addresses["served"] + request.param)
    browser.command("Page.bringToFront")  # a page without the focus has no clipboard, either


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


# A copy needs a press of the user's that is not long ago: see userGesture below.
AT_ONCE = 3  # buttons
PRESS = """
(async (begin, end) => {
  const wrong = [];
  for (const item of document.querySelectorAll("details")) item.open = true;
  for (const button of [...document.querySelectorAll("button.copybtn")].slice(begin, end)) {
    // Show the tab that the block is in, if it is in any.
    for (let tab = button.closest(".tab-content"); tab;
         tab = tab.parentElement.closest(".tab-content"))
      tab.previousElementSibling.click();
    const box = button.closest("[popover]");  // a proof's source is in one
    box?.showPopover();
    button.scrollIntoView({ block: "center", behavior: "instant" });
    const { x, y, width, height } = button.getBoundingClientRect();
    const hit = document.elementFromPoint(x + width / 2, y + height / 2);
    const code = button.parentElement.querySelector("pre").textContent;
    if (!button.contains(hit)) wrong.push(`no mouse reaches the button of ${code}`);
    await navigator.clipboard.writeText("");
    button.click();
    const copied = await navigator.clipboard.readText();
    // Without its last line's end: pasted into a terminal, that would run it at once.
    if (copied !== code.replace(/\\n$/, "")) wrong.push(`${copied}, not ${code}`);
    box?.hidePopover();
  }
  return wrong;
})
"""


def test_the_button_copies_exactly_the_code(page, browser):
    permissions = ["clipboardReadWrite", "clipboardSanitizedWrite"]
    browser.command("Browser.grantPermissions", permissions=permissions)
    for begin in range(0, len(browser.find("button.copybtn")), AT_ONCE):
        done = browser.command(
            "Runtime.evaluate",
            expression=f"({PRESS})({begin}, {begin + AT_ONCE})",
            userGesture=True,
            awaitPromise=True,
            returnByValue=True,
        )
        assert done["result"].get("value") == [], done
