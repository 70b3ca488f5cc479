/** The sheet below the drawing with its grid, and the scale bar.
 * @import { Box, View } from "./view.js"
 */

import { part, set, svg } from "./dom.js";
import { niceAbove, shown } from "./numbers.js";

/** Of the sheet around the drawing, relative to its larger side. */
const EDGE = 0.06;
/** Least distance of grid lines, and the least length of the scale bar, in pixels. */
const GRID = 11;
const BAR = 56;

export class Paper {
  #sheet = svg("rect", { class: "sheet", rx: "3" });
  #fine = svg("path", { class: "grid fine" });
  #coarse = svg("path", { class: "grid coarse" });
  #bar = part("scale-bar", HTMLElement);
  #text = part("scale-text", HTMLElement);
  /** @type {Box | null} */
  box = null;
  hasGrid = true;

  /** @param {SVGGElement} group in pixels */
  constructor(group) {
    group.append(this.#sheet, this.#fine, this.#coarse);
  }

  /** @param {View} view */
  place(view) {
    const length = niceAbove(BAR / view.scale);
    this.#bar.style.width = `${length * view.scale}px`;
    this.#text.textContent = length >= 1000 ? `${shown(length / 1000)} m` : `${shown(length, 4)} mm`;
    this.#sheet.classList.toggle("hidden", !this.box);
    this.#bar.parentElement?.classList.toggle("hidden", !this.box);
    const sheet = this.box && this.#onScreen(this.box, view);
    if (sheet) {
      const [x0, y0, x1, y1] = sheet;
      set(this.#sheet, { x: `${x0}`, y: `${y0}`, width: `${x1 - x0}`, height: `${y1 - y0}` });
    }
    const step = niceAbove(GRID / view.scale);
    const ten = niceAbove((GRID * 4.5) / view.scale);
    const seen = this.hasGrid && sheet ? sheet : null;
    this.#fine.setAttribute("d", seen ? lines(seen, view, step) : "");
    this.#coarse.setAttribute("d", seen ? lines(seen, view, ten) : "");
  }

  /**
   * The corners of the sheet in pixels: left, top, right, bottom.
   * @param {Box} box
   * @param {View} view
   * @returns {[number, number, number, number]}
   */
  #onScreen([left, bottom, right, top], view) {
    const edge = EDGE * Math.max(right - left, top - bottom);
    const [x0, y0] = view.toScreen([left - edge, top + edge]);
    const [x1, y1] = view.toScreen([right + edge, bottom - edge]);
    return [x0, y0, x1, y1];
  }
}

/**
 * @param {[number, number, number, number]} sheet
 * @param {View} view
 * @param {number} step in mm
 */
function lines(sheet, view, step) {
  const x0 = Math.max(sheet[0], 0);
  const y0 = Math.max(sheet[1], 0);
  const x1 = Math.min(sheet[2], view.width);
  const y1 = Math.min(sheet[3], view.height);
  if (x0 >= x1 || y0 >= y1) return "";
  const [left, top] = view.toDrawing(x0, y0);
  const [right, bottom] = view.toDrawing(x1, y1);
  const crisp = (/** @type {number} */ pixel) => Math.round(pixel) + 0.5;
  let path = "";
  for (let k = Math.ceil(left / step); k * step < right; k++) {
    path += `M${crisp(view.toScreen([k * step, 0])[0])} ${y0}V${y1}`;
  }
  for (let k = Math.ceil(bottom / step); k * step < top; k++) {
    path += `M${x0} ${crisp(view.toScreen([0, k * step])[1])}H${x1}`;
  }
  return path;
}
