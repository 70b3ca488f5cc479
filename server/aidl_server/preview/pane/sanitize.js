/** The drawing that a host sends, made safe: it is built anew from what a drawing may consist of. */

import { clamp } from "./numbers.js";

const SVG = "http://www.w3.org/2000/svg";

const ELEMENTS = new Set([
  "svg", "g", "path", "circle", "ellipse", "rect", "line", "polyline", "polygon", "text", "tspan", "defs", "clipPath",
  "linearGradient", "radialGradient", "stop",
]);

const ATTRIBUTES = new Set([
  "d", "cx", "cy", "r", "rx", "ry", "x", "y", "x1", "y1", "x2", "y2", "dx", "dy", "width", "height", "points",
  "transform", "viewBox", "class", "fill", "fill-rule", "fill-opacity", "stroke", "stroke-width", "stroke-opacity",
  "stroke-linecap", "stroke-linejoin", "stroke-miterlimit", "stroke-dasharray", "stroke-dashoffset", "opacity",
  "font-size", "font-family", "font-weight", "font-style", "text-anchor", "dominant-baseline", "clip-path",
  "clip-rule", "clipPathUnits", "gradientUnits", "gradientTransform", "offset", "stop-color", "stop-opacity", "aria-hidden", "data-element",
]);

/** What others refer to by its id, and the attributes that do. */
const REFERRED = new Set(["clipPath", "linearGradient", "radialGradient"]);
const REFERRING = new Set(["clip-path", "fill"]);
const LOCAL = /^\s*url\(\s*["']?#([^"')]*)["']?\s*\)\s*$/;
/** A function that names something elsewhere, or an escape that may hide one; `burlywood` is neither. */
const OUTSIDE = /(url|image|image-set|src)\s*\(|\\/i;
/** Before the ids of the drawing, which must not be those of the page. */
const PREFIX = "drawing-";
/** Widths of lines in pixels: of most outlines, and of any. */
const LINE = 1.25;
const THINNEST = 0.75;
const THICKEST = 3;

/**
 * A group with the content of an SVG document, for a page that shows 1 mm as any number of pixels.
 * @param {string} text
 * @returns {SVGGElement}
 * @throws {Error} if it is no SVG document
 */
export function drawingOf(text) {
  const parsed = new DOMParser().parseFromString(text, "image/svg+xml");
  const root = parsed.documentElement;
  if (root.namespaceURI !== SVG || root.localName !== "svg" || parsed.querySelector("parsererror")) {
    throw new Error("The drawing is not an SVG document.");
  }
  const group = document.createElementNS(SVG, "g");
  for (const child of root.childNodes) {
    const clean = cleaned(child);
    if (clean) group.append(clean);
  }
  thin(group);
  return group;
}

/**
 * @param {Node} node
 * @returns {Node | null}
 */
function cleaned(node) {
  if (node.nodeType === Node.TEXT_NODE || node.nodeType === Node.CDATA_SECTION_NODE) {
    return document.createTextNode(node.nodeValue ?? "");
  }
  if (!(node instanceof Element) || node.namespaceURI !== SVG || !ELEMENTS.has(node.localName)) return null;
  const copy = document.createElementNS(SVG, node.localName);
  for (const { name, value } of node.attributes) {
    const safe = safeValue(name, value);
    if (safe !== null) copy.setAttribute(name, safe);
  }
  if (REFERRED.has(node.localName)) copy.id = PREFIX + node.id;
  for (const child of node.childNodes) {
    const clean = cleaned(child);
    if (clean) copy.append(clean);
  }
  return copy;
}

/**
 * @param {string} name
 * @param {string} value
 */
function safeValue(name, value) {
  if (!ATTRIBUTES.has(name)) return null;
  if (name === "data-element") return /^\d{1,9}$/.test(value) ? String(Number(value)) : null;
  if (!OUTSIDE.test(value)) return value;
  const id = REFERRING.has(name) ? LOCAL.exec(value)?.[1] : undefined;
  return id === undefined ? null : `url(#${PREFIX}${id})`;
}

/**
 * Lines get widths in pixels in place of millimetres, so that they stay thin when one looks closely; they keep
 * their proportions, and so do dashes.
 * @param {SVGGElement} group
 */
function thin(group) {
  const lines = [...group.querySelectorAll("[stroke-width]")].filter((line) => line.closest("text") === null);
  const outlines = lines.filter((line) => !["none", null].includes(line.getAttribute("fill")));
  const usual = usualWidth(outlines) || usualWidth(lines); // of bodies, else of whatever there is
  if (!usual) return;
  const factor = LINE / usual;
  for (const line of lines) {
    const width = clamp(Number(line.getAttribute("stroke-width")) * factor, THINNEST, THICKEST);
    line.setAttribute("vector-effect", "non-scaling-stroke");
    line.setAttribute("stroke-width", width.toFixed(3));
    const dashes = line.getAttribute("stroke-dasharray");
    if (dashes === null) continue;
    const scaled = dashes.split(/[\s,]+/).map((dash) => Number(dash) * factor);
    line.setAttribute("stroke-dasharray", scaled.every(Number.isFinite) ? scaled.join(" ") : "none");
  }
}

/**
 * The width that the most lines have; 0 if there are none.
 * @param {Element[]} lines
 */
function usualWidth(lines) {
  /** @type {Map<number, number>} */
  const counts = new Map();
  for (const line of lines) {
    const width = Number(line.getAttribute("stroke-width"));
    if (width > 0) counts.set(width, (counts.get(width) ?? 0) + 1);
  }
  return [...counts].reduce((most, one) => (one[1] > most[1] ? one : most), [0, 0])[0];
}
