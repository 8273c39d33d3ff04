// SPDX-License-Identifier: BSD-3-Clause
// The tables of the publishers' messages and of the connections.

import { byId, html, setText, styleOf, svg } from "./dom.js";

// Keeps the rows of a table, sorted by their keys.
class Table {
  constructor(id, empty) {
    this.body = byId(id).tBodies[0];
    this.labels = [...byId(id).tHead.rows[0].cells].map((cell) => cell.textContent);
    this.rows = new Map();
    this.empty = html("tr", {}, html("td", { colspan: this.labels.length }, empty));
    this.body.append(this.empty);
  }

  clear() {
    for (const key of [...this.rows.keys()]) this.remove(key);
  }

  remove(key) {
    this.rows.get(key)?.remove();
    this.rows.delete(key);
    this.empty.hidden = this.rows.size > 0;
  }

  // texts: one for each column; returns the row
  set(key, texts) {
    let row = this.rows.get(key);
    if (!row) {
      // On a phone, where there is no room for the head, each cell says what it is.
      const [first, ...others] = this.labels.map((label) => ({ "data-label": label }));
      row = html("tr", {}, html("th", { scope: "row", ...first }), ...others.map((one) => html("td", one)));
      const after = [...this.rows.keys()].filter((one) => one > key).sort()[0];
      this.body.insertBefore(row, after === undefined ? null : this.rows.get(after));
      this.rows.set(key, row);
      this.empty.hidden = true;
    }
    texts.forEach((text, index) => setText(row.cells[index], text));
    return row;
  }
}

const senders = new Table("senders", "No messages yet.");
const links = new Table("links", "No connections yet.");

export const keyOfSender = (one) => `${one.topic}\n${one.from}`;
export const keyOfLink = (one) => `${one.topic}\n${one.from}\n${one.to}`;
const known = (value) => (value === null || value === undefined ? "not reported" : String(value));

export function latency(seconds) {
  return seconds === null ? "no stamp" : `${(seconds * 1000).toFixed(1)} ms`;
}

// shares: key -> how many messages there are for one that is shown
export function showSenders(rows, shares) {
  const keys = new Set(rows.map(keyOfSender));
  for (const key of [...senders.rows.keys()]) if (!keys.has(key)) senders.remove(key);
  for (const one of rows) {
    const key = keyOfSender(one);
    let missing = "no counter";
    if (one.missing) {
      missing = String(one.missing[0]);
      if (one.missing[1]) missing += `, restarted ${one.missing[1]} ×`;
    }
    const share = shares.get(key) ?? 1;
    const row = senders.set(key, [
      one.from,
      one.topic,
      String(one.count),
      one.rate.toFixed(1),
      missing,
      latency(one.latency),
      share > 1.05 ? `1 of ${Math.round(share)}` : "all",
      one.value,
    ]);
    row.classList.toggle("gone", one.gone);
    row.classList.toggle("bad", Boolean(one.missing?.[0]));
    if (!row.cells[0].querySelector("svg")) row.cells[0].prepend(sign(one.from));
  }
}

// The line that is this publisher's in the plot.
function sign(publisher) {
  const { colour, dash } = styleOf(publisher);
  const line = svg("line", { x1: 0, y1: 5, x2: 22, y2: 5, "stroke-width": 3, "stroke-dasharray": dash });
  line.style.stroke = colour;
  return svg("svg", { class: "sign", width: 24, height: 10, "aria-hidden": "true" }, line);
}

export function showLinks(rows) {
  const keys = new Set(rows.map(keyOfLink));
  for (const key of [...links.rows.keys()]) if (!keys.has(key)) links.remove(key);
  for (const one of rows) {
    const row = links.set(keyOfLink(one), [
      one.to,
      one.from,
      one.topic,
      known(one.sent),
      known(one.received),
      known(one.dropped),
      one.missing === null ? "–" : String(one.missing),
    ]);
    row.classList.toggle("bad", Boolean(one.dropped || one.missing));
  }
}
