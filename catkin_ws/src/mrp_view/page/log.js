// SPDX-License-Identifier: BSD-3-Clause
// The lines of /rosout, by node and level.

import { byId, html, setOptions, setText } from "./dom.js";

const MOST = 500; // lines that are kept
const LEVELS = ["DEBUG", "INFO", "WARN", "ERROR", "FATAL"];

export class LogView {
  constructor() {
    this.lines = [];
    this.place = byId("log");
    for (const id of ["log-node", "log-level"]) byId(id).addEventListener("change", () => this.showAll());
  }

  clear() {
    this.lines = [];
    this.showAll();
  }

  // count: of all lines, also of those that are left out because they come too fast
  add(lines, count) {
    const down = this.place.scrollTop + this.place.clientHeight >= this.place.scrollHeight - 8;
    this.lines.push(...lines);
    const old = this.lines.splice(0, Math.max(0, this.lines.length - MOST));
    for (const line of old) line.element?.remove();
    for (const line of lines) this.append(line);
    if (lines.length) {
      setOptions(byId("log-node"), [...new Set(this.lines.map((line) => line.node))].sort(), "all");
      if (down) this.place.scrollTop = this.place.scrollHeight;
    }
    setText(byId("log-note"), `${count} lines since the viewer started; here are the last ${this.lines.length}.`);
  }

  matches(line) {
    const node = byId("log-node").value;
    const level = LEVELS.indexOf(line.level);
    return (!node || line.node === node) && (level < 0 || level >= LEVELS.indexOf(byId("log-level").value));
  }

  append(line) {
    if (!this.matches(line)) return;
    const time = new Date(line.t * 1000).toTimeString().slice(0, 8);
    line.element = html(
      "p",
      { class: `log-line ${LEVELS.includes(line.level) ? line.level : ""}` },
      html("span", { class: "time" }, time), " ",
      html("span", { class: "level" }, line.level), " ",
      html("span", { class: "from" }, line.node), " ",
      line.text,
    );
    this.place.append(line.element);
  }

  showAll() {
    this.place.replaceChildren();
    for (const line of this.lines) this.append(line);
    this.place.scrollTop = this.place.scrollHeight;
  }
}
