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

// The same colour for a publisher everywhere: by the order in which they came.
const known = new Map();

export function colourOf(publisher) {
  if (!known.has(publisher)) known.set(publisher, known.size);
  return `var(--line-${known.get(publisher) % 8})`;
}
