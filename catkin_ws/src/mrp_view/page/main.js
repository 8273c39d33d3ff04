// SPDX-License-Identifier: BSD-3-Clause
// Takes what the viewer sends, and has each part of the page show it.

import { Connection } from "./connection.js";
import { byId, html, setText } from "./dom.js";
import { count, Graph } from "./graph.js";
import { LogView } from "./log.js";
import { History, showPlot } from "./plot.js";
import { keyOfSender, showLinks, showSenders } from "./tables.js";

const NARROW = matchMedia("(max-width: 700px)");
const LOG_TOPICS = ["/rosout", "/rosout_agg"];

const graph = new Graph();
const log = new LogView();
const history = new History();
const shown = new Map(); // key of a sender -> [[now, count, samples], ...] of the last two seconds
const hidden = new Set(); // topics
let senders = [];
let links = [];
let findings = [];
let latest = null; // the last graph
let now = 0;
let state = "connecting";
let paused = false;

const options = () => ({
  rosout: byId("show-log").checked,
  viewer: byId("show-viewer").checked,
  hidden: [...hidden],
  rankdir: NARROW.matches ? "TB" : "LR",
});
const connection = new Connection(take, onState, options);

function onState(value) {
  state = value;
  if (state === "live") {
    // The viewer sends its last lines again.
    log.clear();
    shown.clear();
  }
  showStatus();
}

function isShown(topic) {
  return !hidden.has(topic) && (byId("show-log").checked || !LOG_TOPICS.includes(topic));
}

function take(message) {
  if (paused) return;
  if (message.t === "graph") {
    latest = message;
    graph.draw(message);
    showTopics(message.all_topics);
    showFindings();
    showStatus();
    showCounts();
    return;
  }
  now = message.now;
  senders = message.rows;
  links = message.links;
  for (const row of senders) receive(row);
  // Only if they differ: otherwise a link would be replaced while it is pressed.
  if (JSON.stringify(findings) !== JSON.stringify(message.findings)) {
    findings = message.findings;
    showFindings();
  }
  if (message.log.length) log.add(message.log, message.log_count);
  history.forget(now);
  showTables();
}

function receive(row) {
  const key = keyOfSender(row);
  history.add(key, row.samples, now);
  const before = shown.get(key) ?? [[now, row.count, 0]];
  const last = before[before.length - 1];
  before.push([now, row.count, last[2] + row.samples.length]);
  while (before.length > 2 && before[1][0] < now - 2) before.shift();
  shown.set(key, before);
  if (!row.samples.length || !isShown(row.topic)) return;
  const subscribers = (latest?.graph.links ?? [])
    .filter((link) => link.topic === row.topic && link.from === row.from && link.state === "ok")
    .map((link) => link.to);
  // Several at once are one pulse: the eye could not tell them apart.
  graph.pulse(row.topic, row.from, [...new Set(subscribers)]);
}

// How many messages there are for one that is shown.
function shares() {
  const result = new Map();
  for (const [key, all] of shown) {
    const [first, last] = [all[0], all[all.length - 1]];
    if (last[2] > first[2]) result.set(key, (last[1] - first[1]) / (last[2] - first[2]));
  }
  return result;
}

let tablesDue = false;

// Not more often than the screen can show it.
function showTables() {
  if (tablesDue) return;
  tablesDue = true;
  setTimeout(() => {
    tablesDue = false;
    showSenders(visibleSenders(), shares());
    showCounts();
    showPlot(history, visibleSenders(), now);
  }, 250);
}

const visibleSenders = () => senders.filter((sender) => isShown(sender.topic));
const visibleLinks = () => links.filter(
  (link) => isShown(link.topic) && (byId("show-viewer").checked || link.to !== latest?.viewer),
);

function showCounts() {
  showLinks(visibleLinks());
  graph.showCounts(visibleLinks(), visibleSenders());
}

function showFindings() {
  const items = findings.map((finding) => {
    const item = html("li", { class: `finding ${finding.kind}` }, `${finding.text}. `);
    if (latest?.tutorial) item.append(html("a", { href: `tutorial/${finding.page}` }, "Read more in the tutorial"));
    return item;
  });
  const words = latest?.graph.nodes.length ? "Everything looks normal." : "No node is running, so there's nothing to see yet.";
  if (!items.length) items.push(html("li", {}, words));
  byId("findings").replaceChildren(...items);
}

function showTopics(topics) {
  const place = byId("topics");
  const names = [...new Set([...topics, ...hidden])].filter((name) => !LOG_TOPICS.includes(name)).sort();
  const had = [...place.querySelectorAll("input")].map((input) => input.value);
  if (had.length === names.length && had.every((value, index) => value === names[index])) return;
  place.replaceChildren(...names.map((name) => {
    const box = html("input", { type: "checkbox", value: name });
    box.checked = !hidden.has(name);
    box.addEventListener("change", () => {
      if (box.checked) hidden.delete(name);
      else hidden.add(name);
      choose();
    });
    return html("label", {}, box, ` ${name}`);
  }));
}

function choose() {
  connection.tell();
  showTables();
}

function showStatus() {
  const words = [];
  const master = latest?.master;
  if (paused) words.push("Paused here. The nodes keep running.");
  else if (state !== "live") words.push("The connection to the viewer is lost. This page is trying to reconnect; until then, it shows what it saw last.");
  if (state === "live" && master) {
    if (master.state === "here") words.push(`Master ${master.uri}: ${count(latest.graph.nodes.length, "node")}, ${count(latest.graph.topics.length, "topic")}.`);
    else if (master.state === "gone") words.push(`The master ${master.uri} doesn't answer. Below are the nodes that answered last; connected nodes don't need a master.`);
    else if (master.state === "ended") words.push(`The nodes have ended, and so has the master. Waiting for a master at ${master.uri}: start one, for example with make run.`);
    else words.push(`No master at ${master.uri} yet. This page is waiting for one: try make run in another terminal.`);
  }
  setText(byId("status"), words.join(" ") || "Connected to the viewer.");
  document.body.dataset.state = state !== "live" ? "lost" : master?.state ?? "";
}

byId("pause").addEventListener("click", () => {
  paused = !paused;
  byId("pause").setAttribute("aria-pressed", String(paused));
  setText(byId("pause"), paused ? "Resume" : "Pause");
  connection.pause(paused);
  showStatus();
});
for (const id of ["show-log", "show-viewer"]) byId(id).addEventListener("change", choose);
byId("plot-topic").addEventListener("change", (event) => {
  event.target.dataset.chosen = "yes";
  showPlot(history, visibleSenders(), now);
});
NARROW.addEventListener("change", () => connection.tell());
