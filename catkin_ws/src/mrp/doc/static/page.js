// SPDX-License-Identifier: BSD-3-Clause
// What Sphinx, the theme and the tabs leave undone: for the keyboard, and for pages opened as files.
"use strict";

// A page opened as a file may not read another, from which the search would take a summary.
if (location.protocol === "file:") {
  DOCUMENTATION_OPTIONS.SHOW_SEARCH_SUMMARY = false;
}

// The tabs' label that was chosen last, on whichever page. A browser may refuse to keep anything.
const CHOSEN = "mrp-tab";
function chosen(label) {
  try {
    if (label !== undefined) localStorage.setItem(CHOSEN, label);
    return localStorage.getItem(CHOSEN);
  } catch {
    return null;
  }
}

// A click on a tab's label chooses all tabs of that name; the arrow keys are to do the same.
function connectTabs() {
  const labels = [...document.querySelectorAll(".tab-label")];
  for (const label of labels) {
    label.previousElementSibling.addEventListener("change", () => label.click());
    label.addEventListener("click", () => chosen(label.textContent));
  }
  const before = chosen();
  for (const label of labels) {
    if (label.textContent === before) label.previousElementSibling.checked = true;
  }
}

// What scrolls sideways can be scrolled by keyboard: so the Tab key must come to it.
function makeReachable() {
  const boxes = ".rst-content :is(pre, .picture, .wy-table-responsive)";
  const watcher = new ResizeObserver((entries) => {
    for (const { target } of entries) {
      const box = target.closest(boxes);
      if (box.scrollWidth > box.clientWidth) box.tabIndex = 0;
      else box.removeAttribute("tabindex");
    }
  });
  // What is in a box may grow without it: a font comes late.
  for (const one of document.querySelectorAll(`${boxes}, ${boxes} > *`)) watcher.observe(one);
}

// Sphinx makes headings of the captions of a list of pages, but does not say of which level.
function giveLevels() {
  for (const caption of document.querySelectorAll("[role=heading]:not([aria-level])")) {
    caption.setAttribute("aria-level", 2);
  }
}

// A link may lead into what is folded.
function unfold() {
  const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
  for (let node = target; node; node = node.parentElement) {
    if (node.tagName === "DETAILS") node.open = true;
  }
  if (target) target.scrollIntoView();
}

// The phone's menu button is a mere <i>, which only a finger can press.
function connectMenu() {
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
}

document.addEventListener("DOMContentLoaded", () => {
  connectTabs();
  // The theme puts boxes around tables in a function that jQuery calls from another one: so it has
  // done so when jQuery calls this.
  jQuery(() => jQuery(makeReachable));
  giveLevels();
  window.addEventListener("hashchange", unfold);
  unfold();
  connectMenu();
});
