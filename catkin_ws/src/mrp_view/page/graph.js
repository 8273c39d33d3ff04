// SPDX-License-Identifier: BSD-3-Clause
// The graph: drawn where dot has put everything, with a pulse for each message that is shown.

import { byId, html, setText, styleOf, svg } from "./dom.js";

const LEGIBLE = 0.75; // the smallest scale: a larger graph scrolls
const MOST_PULSES = 60;
const PULSE = 450; // milliseconds along one edge
const calm = matchMedia("(prefers-reduced-motion: reduce)");
const STATES = { dead: "dead", silent: "doesn't answer", unknown: "not asked yet" };

const lastPart = (name) => name.slice(name.lastIndexOf("/") + 1);

export class Graph {
  constructor() {
    this.place = byId("graph");
    this.pulses = [];
    this.items = [];
    this.edges = new Map();
    this.size = null;
    addEventListener("resize", () => this.fit());
  }

  // message: as the viewer sends it
  draw({ graph, layout }) {
    this.pulses = [];
    this.edges.clear();
    const instead = layout.error ? html("p", { class: "fault" }, layout.error)
      : !graph.nodes.length && html("p", {}, "No nodes to show.");
    if (instead) {
      this.size = null;
      this.place.replaceChildren(instead);
      return;
    }
    const focused = document.activeElement?.closest("#graph .item")?.dataset.key;
    this.items = [];
    const picture = this.picture(graph, layout);
    this.size = layout;
    this.place.replaceChildren(picture);
    this.fit();
    for (const edge of this.edges.values()) edge.length = edge.path.getTotalLength();
    const again = this.items.find((item) => item.dataset.key === focused);
    (again ?? this.items[0])?.setAttribute("tabindex", "0");
    again?.focus();
    this.placeBadges();
  }

  // Fills `items`, and the badges of the edges.
  picture(graph, layout) {
    const picture = svg("svg", {
      role: "group",
      "aria-label": describe(graph),
      viewBox: `-2 -2 ${layout.width + 4} ${layout.height + 4}`,
    });
    picture.append(arrowheads());
    for (const [name, x, y, width, height] of layout.groups) {
      picture.append(
        svg("rect", { class: "group", x, y, width, height, rx: 6 }),
        svg("text", { class: "group-name", x: x + width / 2, y: y + 16 }, name),
      );
    }
    graph.edges.forEach((edge, index) => picture.append(this.edge(edge, layout.edges[index])));
    for (const topic of graph.topics) picture.append(this.topic(topic, layout.topics[topic.name]));
    for (const node of graph.nodes) picture.append(this.node(node, layout.nodes[node.name]));
    // On top of all edges.
    for (const { badge } of this.edges.values()) picture.append(badge);
    this.front = svg("g", { "aria-hidden": "true" });
    picture.append(this.front);
    picture.addEventListener("keydown", (event) => this.key(event));
    return picture;
  }

  fit() {
    const picture = this.place.querySelector("svg");
    if (!picture || !this.size) return;
    const { paddingLeft, paddingRight } = getComputedStyle(this.place);
    const room = this.place.clientWidth - parseFloat(paddingLeft) - parseFloat(paddingRight);
    const scale = Math.max(LEGIBLE, Math.min(1.25, room / (this.size.width + 4)));
    picture.style.width = `${Math.floor((this.size.width + 4) * scale)}px`;
  }

  item(key, label, detail, ...children) {
    const item = svg("g", { class: "item", tabindex: "-1", role: "img", "aria-label": label }, ...children);
    item.dataset.key = key;
    const show = () => setText(byId("detail"), detail);
    item.addEventListener("focus", show);
    item.addEventListener("click", () => {
      this.focus(item);
      show();
    });
    this.items.push(item);
    return item;
  }

  node(node, [x, y, width, height]) {
    const state = STATES[node.state];
    const detail = `Node ${node.name}: ${state ?? "alive"}.${node.why ? ` ${node.why}` : ""}`;
    const shape = svg("ellipse", { cx: x, cy: y, rx: width / 2, ry: height / 2 });
    const text = svg("text", { x, y: y + (state ? -2 : 4) }, lastPart(node.name));
    const group = this.item(`node ${node.name}`, detail, detail, shape, text);
    group.classList.add("node", node.state);
    if (state) group.append(svg("text", { class: "second", x, y: y + 13 }, state));
    return group;
  }

  topic(topic, [x, y, width, height]) {
    const types = topic.types.join(" or ") + (topic.latched ? ", latched" : "");
    const detail = `Topic ${topic.name}: ${types}.`;
    const shape = svg("rect", { x: x - width / 2, y: y - height / 2, width, height });
    const group = this.item(
      `topic ${topic.name}`, detail, detail, shape,
      svg("text", { x, y: y - 2 }, lastPart(topic.name)),
      svg("text", { class: "second", x, y: y + 13 }, topic.label),
    );
    group.classList.add("topic");
    return group;
  }

  edge(edge, d) {
    const path = svg("path", { d, "marker-end": `url(#arrow-${edge.state})` });
    const badge = svg("text", { class: "badge" });
    const words = edge.publishes ? `${edge.from} publishes ${edge.to}` : `${edge.to} subscribes to ${edge.from}`;
    const reason = { mismatch: "The types differ", none: "Not connected", dead: "Dead" }[edge.state];
    const detail = `${words}.${reason ? ` ${reason}. ${edge.why}` : ""}`;
    const group = reason && edge.state !== "dead" ? this.item(`edge ${edge.from} ${edge.to}`, detail, detail, path) : svg("g", {}, path);
    group.classList.add("edge", edge.state);
    group.append(svg("title", {}, detail));
    const fault = { mismatch: "✗ types differ", none: "? not connected" }[edge.state] ?? "";
    this.edges.set(`${edge.publishes ? "p" : "s"} ${edge.from} ${edge.to}`, { path, badge, fault, group });
    return group;
  }

  // The keys that go from one part of the graph to the next.
  key(event) {
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    const end = { Home: 0, End: this.items.length - 1 }[event.key];
    if (step === undefined && end === undefined) return;
    event.preventDefault();
    const now = this.items.indexOf(document.activeElement);
    this.focus(this.items[end ?? (now + step + this.items.length) % this.items.length]);
  }

  focus(item) {
    for (const other of this.items) other.setAttribute("tabindex", "-1");
    item.setAttribute("tabindex", "0");
    item.focus();
  }

  // What the nodes have counted: at the edge where it happened.
  showCounts(links, rows) {
    this.counts = new Map();
    const add = (key, text) => {
      if (text) this.counts.set(key, text);
    };
    const dropped = new Map();
    for (const link of links) {
      const key = `s ${link.topic} ${link.to}`;
      const sum = dropped.get(key) ?? { dropped: 0, missing: 0 };
      sum.dropped += link.dropped ?? 0;
      sum.missing += link.missing ?? 0;
      dropped.set(key, sum);
    }
    for (const [key, sum] of dropped) {
      const parts = [];
      if (sum.dropped) parts.push(`${sum.dropped} dropped`);
      if (sum.missing) parts.push(`${sum.missing} dropped?`);
      add(key, parts.join(", "));
    }
    for (const row of rows) {
      if (row.missing?.[0]) add(`p ${row.from} ${row.topic}`, `${row.missing[0]} missing`);
    }
    this.placeBadges();
  }

  placeBadges() {
    for (const [key, edge] of this.edges) {
      const text = [edge.fault, this.counts?.get(key)].filter(Boolean).join(", ");
      setText(edge.badge, text);
      edge.badge.classList.toggle("bad", edge.fault.startsWith("✗"));
      if (text && edge.placed !== text && edge.length) {
        const { x, y } = edge.path.getPointAtLength(edge.length * 0.55);
        edge.badge.setAttribute("x", x);
        edge.badge.setAttribute("y", y - 4);
        edge.placed = text;
      }
    }
  }

  // A message of that publisher: to the topic, and on to all who are connected.
  pulse(topic, publisher, subscribers) {
    if (document.hidden) return;
    const { colour } = styleOf(publisher);
    this.start(`p ${publisher} ${topic}`, colour, () => {
      for (const subscriber of subscribers) this.start(`s ${topic} ${subscriber}`, colour);
    });
  }

  start(key, colour, then) {
    const edge = this.edges.get(key);
    if (!edge || this.pulses.length >= MOST_PULSES) return;
    if (calm.matches) {
      edge.group.classList.add("hit");
      setTimeout(() => edge.group.classList.remove("hit"), PULSE);
      then?.();
      return;
    }
    const dot = svg("circle", { r: 5, class: "pulse" });
    dot.style.fill = colour;
    this.front.append(dot);
    this.pulses.push({ edge, dot, then, begin: performance.now() });
    if (this.pulses.length === 1) requestAnimationFrame((now) => this.step(now));
  }

  step(now) {
    const going = this.pulses;
    this.pulses = [];
    const ended = [];
    for (const pulse of going) {
      const share = Math.max(0, (now - pulse.begin) / PULSE);
      if (share >= 1) {
        pulse.dot.remove();
        ended.push(pulse);
        continue;
      }
      const { x, y } = pulse.edge.path.getPointAtLength(share * pulse.edge.length);
      pulse.dot.setAttribute("cx", x);
      pulse.dot.setAttribute("cy", y);
      this.pulses.push(pulse);
    }
    const wait = this.pulses.length;
    for (const pulse of ended) pulse.then?.();
    // start() has asked for the next frame if these were the first.
    if (wait) requestAnimationFrame((next) => this.step(next));
  }
}

export const count = (number, word) => `${number} ${word}${number === 1 ? "" : "s"}`;

function describe(graph) {
  return `Graph of ${count(graph.nodes.length, "node")} and ${count(graph.topics.length, "topic")}`;
}

function arrowheads() {
  return svg("defs", {}, ...["ok", "mismatch", "none", "dead"].map((state) => svg(
    "marker",
    { id: `arrow-${state}`, class: state, viewBox: "0 0 10 10", refX: 9, refY: 5, markerWidth: 9, markerHeight: 9, orient: "auto", markerUnits: "userSpaceOnUse" },
    svg("path", { d: "M0 0L10 5L0 10z" }),
  )));
}
