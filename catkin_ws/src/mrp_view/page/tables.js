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
      row = html("tr", {}, html("th", { scope: "row", ...first }), ...others.map((text) => html("td", text)));
      const after = [...this.rows.keys()].filter((other) => other > key).sort()[0];
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

export const keyOfSender = (sender) => `${sender.topic}\n${sender.from}`;
const keyOfLink = (link) => `${link.topic}\n${link.from}\n${link.to}`;
const known = (value) => (value === null || value === undefined ? "not reported" : String(value));

export function latency(seconds) {
  return seconds === null ? "no stamp" : `${(seconds * 1000).toFixed(1)} ms`;
}

// shares: key -> how many messages there are for one that is shown
export function showSenders(rows, shares) {
  const keys = new Set(rows.map(keyOfSender));
  for (const key of [...senders.rows.keys()]) if (!keys.has(key)) senders.remove(key);
  for (const sender of rows) {
    const key = keyOfSender(sender);
    let missing = "no counter";
    if (sender.missing) {
      missing = String(sender.missing[0]);
      if (sender.missing[1]) missing += `, restarted ${sender.missing[1]} ×`;
    }
    const share = shares.get(key) ?? 1;
    const row = senders.set(key, [
      sender.from,
      sender.topic,
      String(sender.count),
      sender.rate.toFixed(1),
      missing,
      latency(sender.latency),
      share > 1.05 ? `1 of ${Math.round(share)}` : "all",
      sender.value,
    ]);
    row.classList.toggle("gone", sender.gone);
    row.classList.toggle("bad", Boolean(sender.missing?.[0]));
    if (!row.cells[0].querySelector("svg")) row.cells[0].prepend(sign(sender.from));
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
  for (const link of rows) {
    const row = links.set(keyOfLink(link), [
      link.to,
      link.from,
      link.topic,
      known(link.sent),
      known(link.received),
      known(link.dropped),
      link.missing === null ? "–" : String(link.missing),
    ]);
    row.classList.toggle("bad", Boolean(link.dropped || link.missing));
  }
}
