// SPDX-License-Identifier: BSD-3-Clause
// Makes elements. Whatever comes from ROS goes in as text, and never as markup.

export const byId = (id) => document.getElementById(id);

function fill(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

export function html(tag, attributes = {}, ...children) {
  return fill(document.createElement(tag), attributes, children);
}

export function svg(tag, attributes = {}, ...children) {
  return fill(document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);
}

// Sets a text only if it is another one: otherwise a selection would be lost, and time.
export function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

// Has in a <select> these values, and keeps the one that is chosen.
export function setOptions(select, values, first) {
  const wanted = first === undefined ? values : ["", ...values];
  const had = [...select.options].map((option) => option.value);
  if (had.length === wanted.length && had.every((value, index) => value === wanted[index])) return;
  const chosen = select.value;
  select.replaceChildren(...wanted.map((value) => html("option", { value }, value || first)));
  if (wanted.includes(chosen)) select.value = chosen;
}

// The same colour and dash for a publisher everywhere: by the order in which they came.
const known = new Map();
const DASHES = ["", "6 3", "2 3", "8 3 2 3"];

export function styleOf(publisher) {
  if (!known.has(publisher)) known.set(publisher, known.size);
  const number = known.get(publisher);
  return { colour: `var(--line-${number % 8})`, dash: DASHES[Math.floor(number / 2) % DASHES.length] };
}
