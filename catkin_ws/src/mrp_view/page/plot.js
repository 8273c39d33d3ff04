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

  add(key, samples, now) {
    const kept = this.samples.get(key) ?? [];
    this.samples.set(key, kept);
    for (const sample of samples) {
      const last = kept.length > 1 ? kept[kept.length - 2] : null;
      if (last && sample[0] - last[0] < 0.1) kept.pop();
      kept.push(sample);
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
  const wide = [1, 2, 5, 10].map((factor) => factor * step).find((factor) => (high - low) / factor <= 5);
  const result = [];
  for (let value = Math.ceil(low / wide) * wide; value <= high; value += wide) result.push(value);
  return result;
}

const shortened = (value) => (Math.abs(value) >= 1e7 ? value.toExponential(3) : String(Number(value.toPrecision(6))));

// Until the reader chooses: the first topic of which there is something to see.
function chooseTopic(select, history, rows) {
  setOptions(select, [...new Set(rows.map((row) => row.topic))].sort());
  const fresh = rows.find((row) => history.samples.get(`${row.topic}\n${row.from}`)?.some((point) => point[1] !== null));
  const chosen = select.dataset.chosen || rows.some((row) => row.topic === select.value && row.rate > 0);
  if (!chosen && fresh) select.value = fresh.topic;
}

function linesOf(topic, history, rows, now) {
  return rows
    .filter((row) => row.topic === topic)
    .map((row) => ({
      name: row.from,
      field: row.number,
      points: (history.samples.get(`${row.topic}\n${row.from}`) ?? []).filter((point) => point[1] !== null && point[0] >= now - SECONDS),
    }))
    .filter((row) => row.points.length);
}

// Returns where in the picture a time and a value are, and the range of the values.
function scalesOf(values, width, now) {
  let low = Math.min(...values);
  let high = Math.max(...values);
  if (low === high) [low, high] = [low - 1, high + 1];
  const x = (time) => MARGIN.left + ((time - now + SECONDS) / SECONDS) * (width - MARGIN.left - MARGIN.right);
  const y = (value) => HEIGHT - MARGIN.bottom - ((value - low) / (high - low)) * (HEIGHT - MARGIN.top - MARGIN.bottom);
  return { x, y, low, high };
}

function axes({ x, y, low, high }, width, now) {
  const grid = ticks(low, high).flatMap((value) => [
    svg("line", { class: "grid", x1: MARGIN.left, x2: width - MARGIN.right, y1: y(value), y2: y(value) }),
    svg("text", { class: "tick left", x: MARGIN.left - 6, y: y(value) + 4 }, shortened(value)),
  ]);
  const times = [60, 45, 30, 15, 0].map((seconds) =>
    svg("text", { class: `tick ${seconds ? "" : "left"}`, x: x(now - seconds), y: HEIGHT - 8 }, seconds ? `−${seconds} s` : "now"),
  );
  return [...grid, ...times];
}

function drawn({ name, points }, { x, y }) {
  const { colour, dash } = styleOf(name);
  const places = points.map(([time, value]) => [x(time).toFixed(1), y(value).toFixed(1)]);
  const line = svg("path", { class: "line", d: `M${places.map((place) => place.join(" ")).join("L")}`, "stroke-dasharray": dash });
  line.style.stroke = colour;
  // Single messages are seen as such.
  const dots = places.length > 150 ? [] : places.map(([cx, cy]) => svg("circle", { cx, cy, r: 2 }));
  for (const dot of dots) dot.style.fill = colour;
  return [line, ...dots];
}

export function showPlot(history, rows, now) {
  const select = byId("plot-topic");
  chooseTopic(select, history, rows);
  const lines = linesOf(select.value, history, rows, now);
  const place = byId("plot");
  const width = Math.max(280, place.clientWidth);
  if (!lines.length) {
    place.replaceChildren();
    setText(byId("plot-note"), select.value ? "No number in this topic's messages in the last 60 s." : "No message yet.");
    return;
  }
  const scales = scalesOf(lines.flatMap((line) => line.points.map((point) => point[1])), width, now);
  const words = lines.map((line) => `${line.name} ${shortened(line.points[line.points.length - 1][1])}`);
  const picture = svg("svg", {
    role: "img",
    "aria-label": `${select.value} over the last 60 seconds; last values: ${words.join(", ")}`,
    viewBox: `0 0 ${width} ${HEIGHT}`,
  });
  picture.append(...axes(scales, width, now), ...lines.flatMap((line) => drawn(line, scales)));
  place.replaceChildren(picture);
  const field = lines[0].field;
  setText(byId("plot-note"), `This plots ${field}. Each publisher's line is the one next to its name in the table.`);
}
