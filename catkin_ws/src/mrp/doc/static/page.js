// SPDX-License-Identifier: BSD-3-Clause
// What Sphinx, the theme and the tabs leave undone: for the keyboard, and for pages opened as files.
"use strict";

// A page opened as a file may not read another, from which the search would take a summary.
if (location.protocol === "file:") {
  DOCUMENTATION_OPTIONS.SHOW_SEARCH_SUMMARY = false;
}

document.addEventListener("DOMContentLoaded", () => {
  // A click on a tab's label chooses all tabs of that name; the arrow keys are to do the same.
  for (const input of document.querySelectorAll(".tab-input")) {
    input.addEventListener("change", () => input.nextElementSibling.click());
  }

  // A link may lead into what is folded.
  const unfold = () => {
    const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
    for (let node = target; node; node = node.parentElement) {
      if (node.tagName === "DETAILS") node.open = true;
    }
    if (target) target.scrollIntoView();
  };
  window.addEventListener("hashchange", unfold);
  unfold();

  // The phone's menu button is a mere <i>, which only a finger can press.
  const button = document.querySelector("i[data-toggle='wy-nav-top']");
  const menu = document.querySelector(".wy-nav-side");
  const isOpen = () => menu.classList.contains("shift");
  button.tabIndex = 0;
  button.setAttribute("role", "button");
  button.setAttribute("aria-label", "Menu");
  const tell = () => button.setAttribute("aria-expanded", isOpen());
  new MutationObserver(tell).observe(menu, { attributeFilter: ["class"] });
  tell();
  button.addEventListener("keydown", (event) => {
    if (event.key === "Enter" || event.key === " ") {
      event.preventDefault();
      button.click();
      if (isOpen()) menu.querySelector("a").focus();
    }
  });
  document.addEventListener("keydown", (event) => {
    if (event.key === "Escape" && isOpen()) {
      button.click();
      button.focus();
    }
  });
});
