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
  const boxes = "article :is(pre, .picture, .table-wrapper)";
  const watcher = new ResizeObserver((entries) => {
    for (const { target } of entries) {
      const box = target.closest(boxes);
      if (box.scrollWidth > box.clientWidth) box.tabIndex = 0;
      else box.removeAttribute("tabindex");
    }
  });
  // What is in a box may grow without it: a font comes late.
  for (const box of document.querySelectorAll(`${boxes}, ${boxes} > *`)) watcher.observe(box);
}

// Sphinx makes headings of the captions of a list of pages, but does not say of which level.
function giveLevels() {
  for (const caption of document.querySelectorAll("[role=heading]:not([aria-level])")) {
    caption.setAttribute("aria-level", 2);
  }
}

// The theme's page of search results has no heading of its own.
function headSearch() {
  const results = document.getElementById("search-results");
  if (!results || document.querySelector("h1")) return;
  const heading = document.createElement("h1");
  heading.textContent = "Search";
  results.before(heading);
}

// A link may lead into what is folded.
function unfold() {
  const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
  for (let node = target; node; node = node.parentElement) {
    if (node.tagName === "DETAILS") node.open = true;
  }
  if (target) target.scrollIntoView();
}

// The questions (extension/quiz.py): what was answered stays in this browser.
const ANSWERS = "mrp-answers";
function answers() {
  try {
    return JSON.parse(localStorage.getItem(ANSWERS)) ?? {};
  } catch {
    return {};
  }
}
function keepAnswers(all) {
  try {
    localStorage.setItem(ANSWERS, JSON.stringify(all));
  } catch {
    // The verdict is shown all the same.
  }
}

function showVerdict(form, answer) {
  const right = answer === form.dataset.right;
  form.querySelector("fieldset").className = right ? "right" : "wrong";
  form.querySelector("[role=status]").textContent = right ? "Right!" : "Not quite. Have another go.";
  for (const why of form.querySelectorAll(".why")) why.hidden = why.dataset.answer !== answer;
}

function connectQuestions() {
  for (const form of document.querySelectorAll("form.quiz")) {
    const name = form.dataset.question;
    const before = answers()[name];
    const chosen = form.querySelector(`input[value="${CSS.escape(before ?? "")}"]`);
    if (chosen) {
      chosen.checked = true;
      showVerdict(form, before);
    }
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      const answer = new FormData(form).values().next().value;
      if (answer === undefined) {
        form.querySelector("[role=status]").textContent = "Choose an answer first.";
        return;
      }
      // With the right answer beside it, for the page that counts them.
      keepAnswers({ ...answers(), [name]: answer, [`${name}=`]: form.dataset.right });
      showVerdict(form, answer);
    });
  }
}

function showScore() {
  const kept = answers();
  const rows = [...document.querySelectorAll("table.score tbody tr")];
  let all = 0;
  let right = 0;
  for (const row of rows) {
    const names = JSON.parse(row.dataset.questions);
    const good = names.filter((name) => kept[name] && kept[name] === kept[`${name}=`]).length;
    row.lastElementChild.textContent = good;
    all += names.length;
    right += good;
  }
  const total = document.querySelector(".score-total");
  total.textContent =
    right === all ? `All ${all} right. Well done!` : `${right} of ${all} right so far.`;
}

function connectScore() {
  const reset = document.querySelector(".score-reset");
  if (!reset) return;
  showScore();
  reset.addEventListener("click", () => {
    keepAnswers({});
    showScore();
  });
}

// The theme's menu buttons are labels, which only a mouse or a finger can press: make buttons of them.
function connectMenus() {
  connectMenu(".nav-overlay-icon", "Menu", ".sidebar-drawer");
  connectMenu(".toc-header-icon", "On this page", ".toc-drawer");
}

function connectMenu(selector, name, drawer) {
  const label = document.querySelector(selector);
  if (!label) return;
  const box = document.getElementById(label.htmlFor);
  const button = document.createElement("button");
  button.type = "button";
  button.className = label.className;
  button.setAttribute("aria-label", name);
  button.append(...label.childNodes);
  label.replaceWith(button);
  const tell = () => button.setAttribute("aria-expanded", box.checked);
  tell();
  box.addEventListener("change", tell);
  button.addEventListener("click", (event) => {
    box.checked = !box.checked;
    tell();
    // Pressed by a key: go on in the menu.
    if (box.checked && event.detail === 0) document.querySelector(`${drawer} a`)?.focus();
  });
  document.addEventListener("keydown", (event) => {
    if (event.key === "Escape" && box.checked) {
      box.checked = false;
      tell();
      button.focus();
    }
  });
}

// The icons of the theme and of the copy buttons say nothing that their buttons do not say.
window.addEventListener("load", () => {
  for (const icon of document.querySelectorAll("svg:not([role])")) {
    icon.setAttribute("aria-hidden", "true");
  }
  for (const button of document.querySelectorAll("button.copybtn")) {
    button.setAttribute("aria-label", "Copy");
  }
});

// The marks of what tests prove (extension/proofs.py): the switch at the end of a page shows them.
const MARKS = "mrp-marks";
function marksAreShown(shown) {
  try {
    if (shown !== undefined) localStorage.setItem(MARKS, shown);
    return localStorage.getItem(MARKS) === "true";
  } catch {
    return Boolean(shown);
  }
}

function connectMarks() {
  const show = (shown) => document.body.classList.toggle("marks", shown);
  show(marksAreShown());
  const toggle = document.querySelector(".proofs input");
  if (!toggle) return;
  toggle.checked = marksAreShown();
  toggle.addEventListener("change", () => show(marksAreShown(toggle.checked)));
  // With autofocus, a browser would look for the button when the page opens, too.
  for (const box of document.querySelectorAll(".proof-box")) {
    box.addEventListener("toggle", (event) => {
      if (event.newState === "open") box.querySelector("button").focus();
    });
  }
}

document.addEventListener("DOMContentLoaded", () => {
  connectMarks();
  connectMenus();
  connectQuestions();
  connectScore();
  connectTabs();
  makeReachable();
  giveLevels();
  headSearch();
  window.addEventListener("hashchange", unfold);
  unfold();
});
