// SPDX-License-Identifier: BSD-3-Clause
// What is on the screen, as a file.

import { byId } from "./dom.js";

const COPIED = ["fill", "stroke", "stroke-width", "stroke-dasharray", "font-family", "font-size", "font-weight", "text-anchor", "paint-order"];

function save(blob, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

// The graph with its styles in it, as it has no style sheet where it goes.
function graphAsText() {
  const picture = byId("graph").querySelector("svg");
  if (!picture) return null;
  const copy = picture.cloneNode(true);
  const originals = picture.querySelectorAll("*");
  copy.querySelectorAll("*").forEach((element, index) => {
    const style = getComputedStyle(originals[index]);
    for (const name of COPIED) element.setAttribute(name, style.getPropertyValue(name));
    element.removeAttribute("style");
    element.removeAttribute("tabindex");
  });
  const { width, height } = picture.viewBox.baseVal;
  copy.removeAttribute("style");
  copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
  copy.setAttribute("width", width);
  copy.setAttribute("height", height);
  const paper = document.createElementNS("http://www.w3.org/2000/svg", "rect");
  for (const [name, value] of Object.entries({ x: -2, y: -2, width, height, fill: getComputedStyle(document.body).backgroundColor })) {
    paper.setAttribute(name, value);
  }
  copy.prepend(paper);
  return { text: new XMLSerializer().serializeToString(copy), width, height };
}

export function saveSvg() {
  const graph = graphAsText();
  if (graph) save(new Blob([graph.text], { type: "image/svg+xml" }), "graph.svg");
}

export function savePng() {
  const graph = graphAsText();
  if (!graph) return;
  const address = URL.createObjectURL(new Blob([graph.text], { type: "image/svg+xml" }));
  const image = new Image();
  image.onload = () => {
    const canvas = document.createElement("canvas");
    canvas.width = graph.width * 2;
    canvas.height = graph.height * 2;
    canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
    URL.revokeObjectURL(address);
    canvas.toBlob((blob) => save(blob, "graph.png"), "image/png");
  };
  image.src = address;
}

// A program that opens the file must not take a text for a formula.
export function csv(rows) {
  const cell = (value) => {
    let text = value === null || value === undefined ? "" : String(value);
    if (typeof value === "string" && /^[=+\-@\t\r]/.test(text)) text = `'${text}`;
    return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
  };
  return rows.map((row) => row.map(cell).join(",")).join("\r\n") + "\r\n";
}

export function saveCsv(rows, name) {
  save(new Blob([csv(rows)], { type: "text/csv" }), name);
}
