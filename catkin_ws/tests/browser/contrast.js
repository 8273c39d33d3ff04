// SPDX-License-Identifier: BSD-3-Clause
// Returns the texts of the page whose contrast is below WCAG's 4.5, each once per pair of colours.

const LEAST = 4.5;

function parse(colour) {
  const [r, g, b, alpha = 1] = colour.match(/[\d.]+/g).map(Number);
  return { rgb: [r, g, b], alpha };
}

function over({ rgb, alpha }, below) {
  return rgb.map((value, index) => value * alpha + below[index] * (1 - alpha));
}

// What is behind an element: the backgrounds of all that it is in, the outermost first.
function background(element) {
  const canvas = matchMedia("(prefers-color-scheme: dark)").matches ? 0 : 255;
  const around = [];
  for (let one = element; one; one = one.parentElement) around.unshift(one);
  return around.reduce(
    (below, one) => over(parse(getComputedStyle(one).backgroundColor), below),
    [canvas, canvas, canvas],
  );
}

// The part of an element that its own opacity and those of all that it is in let through.
function opacity(element) {
  const rest = element.parentElement ? opacity(element.parentElement) : 1;
  return Number(getComputedStyle(element).opacity) * rest;
}

function luminance(rgb) {
  const [r, g, b] = rgb.map((value) => {
    const share = value / 255;
    return share <= 0.04045 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

function ratio(one, other) {
  const [dark, light] = [luminance(one), luminance(other)].sort((a, b) => a - b);
  return (light + 0.05) / (dark + 0.05);
}

// In a picture a text stands on the shape before it, if there is one.
function behind(element) {
  const shape = element.closest("text")?.previousElementSibling;
  const isFilled = shape?.matches("circle, ellipse, polygon, rect")
    && getComputedStyle(shape).fill !== "none";
  if (!isFilled) return background(element);
  const fill = parse(getComputedStyle(shape).fill);
  return over({ ...fill, alpha: fill.alpha * opacity(shape) }, background(element));
}

const faults = new Map();
const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
while (texts.nextNode()) {
  const text = texts.currentNode.data.trim();
  const element = texts.currentNode.parentElement;
  if (!text || !element.checkVisibility({ visibilityProperty: true, opacityProperty: true })) continue;
  const style = getComputedStyle(element);
  const below = behind(element);
  const own = parse(element.closest("svg") ? style.fill : style.color);
  const colour = over({ ...own, alpha: own.alpha * opacity(element) }, below);
  const value = ratio(colour, below);
  if (value < LEAST) {
    const where = `${element.tagName.toLowerCase()}.${element.getAttribute("class") || ""}`;
    const fault = `${where}: rgb(${colour}) on rgb(${below}) has a contrast of ${value.toFixed(2)}`;
    if (!faults.has(fault)) faults.set(fault, `${fault}: ${text.slice(0, 40)}`);
  }
}
return [...faults.values()];
