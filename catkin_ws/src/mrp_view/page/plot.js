// SPDX-License-Identifier: BSD-3-Clause
// The numbers in a topic's messages over the last 60 s: one line per publisher.

import { byId, setOptions, setText, styleOf, svg } from "./dom.js";

export const SECONDS = 60;
const HEIGHT = 240;
const MARGIN = { left: 64, right: 12, top: 10, bottom: 26 };

// Keeps of each publisher's samples those of the last 60 s, but not more than ten a second.
export class History {
  constructor() {
    this.samples = new Map();
  }

  clear() {
    this.samples.clear();
  }

  add(key, samples, now) {
    const kept = this.samples.get(key) ?? [];
    this.samples.set(key, kept);
    for (const one of samples) {
      const last = kept.length > 1 ? kept[kept.length - 2] : null;
      if (last && one[0] - last[0] < 0.1) kept.pop();
      kept.push(one);
    }
    let old = 0;
    while (old < kept.length && kept[old][0] < now - SECONDS) old += 1;
    kept.splice(0, old);
  }

  forget(now) {
    for (const [key, kept] of this.samples) {
      if (!kept.length || kept[kept.length - 1][0] < now - SECONDS) this.samples.delete(key);
    }
  }
}

function ticks(low, high) {
  const step = 10 ** Math.floor(Math.log10((high - low) / 2));
  const wide = [1, 2, 5, 10].map((one) => one * step).find((one) => (high - low) / one <= 5);
  const result = [];
  for (let value = Math.ceil(low / wide) * wide; value <= high; value += wide) result.push(value);
  return result;
}

const shortened = (value) => (Math.abs(value) >= 1e7 ? value.toExponential(3) : String(Number(value.toPrecision(6))));

export function showPlot(history, rows, now) {
  const select = byId("plot-topic");
  setOptions(select, [...new Set(rows.map((one) => one.topic))].sort());
  // Until the reader chooses: the first topic of which there is something to see.
  const fresh = rows.find((one) => history.samples.get(`${one.topic}\n${one.from}`)?.some((point) => point[1] !== null));
  const chosen = select.dataset.chosen || rows.some((one) => one.topic === select.value && one.rate > 0);
  if (!chosen && fresh) select.value = fresh.topic;
  const lines = rows
    .filter((one) => one.topic === select.value)
    .map((one) => ({
      name: one.from,
      field: one.number,
      points: (history.samples.get(`${one.topic}\n${one.from}`) ?? []).filter((point) => point[1] !== null && point[0] >= now - SECONDS),
    }))
    .filter((one) => one.points.length);
  const place = byId("plot");
  const width = Math.max(280, place.clientWidth);
  const values = lines.flatMap((one) => one.points.map((point) => point[1]));
  if (!values.length) {
    place.replaceChildren();
    setText(byId("plot-note"), select.value ? "No number in this topic's messages in the last 60 s." : "No message yet.");
    return;
  }
  let low = Math.min(...values);
  let high = Math.max(...values);
  if (low === high) [low, high] = [low - 1, high + 1];
  const x = (time) => MARGIN.left + ((time - now + SECONDS) / SECONDS) * (width - MARGIN.left - MARGIN.right);
  const y = (value) => HEIGHT - MARGIN.bottom - ((value - low) / (high - low)) * (HEIGHT - MARGIN.top - MARGIN.bottom);
  const words = lines.map((one) => `${one.name} ${shortened(one.points[one.points.length - 1][1])}`);
  const picture = svg("svg", {
    role: "img",
    "aria-label": `${select.value} over the last 60 seconds; last values: ${words.join(", ")}`,
    viewBox: `0 0 ${width} ${HEIGHT}`,
  });
  for (const value of ticks(low, high)) {
    picture.append(
      svg("line", { class: "grid", x1: MARGIN.left, x2: width - MARGIN.right, y1: y(value), y2: y(value) }),
      svg("text", { class: "tick left", x: MARGIN.left - 6, y: y(value) + 4 }, shortened(value)),
    );
  }
  for (const seconds of [60, 45, 30, 15, 0]) {
    picture.append(svg("text", { class: `tick ${seconds ? "" : "left"}`, x: x(now - seconds), y: HEIGHT - 8 }, seconds ? `−${seconds} s` : "now"));
  }
  for (const { name, points } of lines) {
    const { colour, dash } = styleOf(name);
    const path = points.map((point) => `${x(point[0]).toFixed(1)} ${y(point[1]).toFixed(1)}`).join("L");
    const line = svg("path", { class: "line", d: `M${path}`, "stroke-dasharray": dash });
    line.style.stroke = colour;
    picture.append(line);
    // Single messages are seen as such.
    if (points.length <= 150) {
      for (const point of points) {
        const dot = svg("circle", { cx: x(point[0]).toFixed(1), cy: y(point[1]).toFixed(1), r: 2 });
        dot.style.fill = colour;
        picture.append(dot);
      }
    }
  }
  place.replaceChildren(picture);
  const field = lines[0].field;
  setText(byId("plot-note"), `What is plotted: ${field}. Each line is that of the publisher with the same line in the table.`);
}
