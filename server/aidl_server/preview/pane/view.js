/** Which part of the plane is in sight.
 * @import { Vec } from "./protocol.js"
 */

import { clamp } from "./numbers.js";

/** Pixels for a millimetre, at least and at most. */
const LEAST = 1e-3;
const MOST = 1e4;
/** Of the window that stays free around a drawing that is fitted into it. */
const MARGIN = 0.08;

/** @typedef {[left: number, bottom: number, right: number, top: number]} Box */

export class View {
  /** Pixels for a millimetre. */
  scale = 4;
  /** Where the origin of the drawing is in the window, in pixels from its upper left. */
  x = 0;
  y = 0;
  width = 1;
  height = 1;
  /** Whether a user has chosen it. */
  isChosen = false;

  /** @param {() => void} changed */
  constructor(changed) {
    this.changed = changed;
  }

  /**
   * @param {Vec} at in mm
   * @returns {Vec} in pixels
   */
  toScreen([x, y]) {
    return [this.x + x * this.scale, this.y - y * this.scale];
  }

  /**
   * @param {number} x in pixels
   * @param {number} y
   * @returns {Vec} in mm
   */
  toDrawing(x, y) {
    return [(x - this.x) / this.scale, (this.y - y) / this.scale];
  }

  /** @param {Box} box */
  fit([left, bottom, right, top]) {
    const room = 1 - 2 * MARGIN;
    const scale = Math.min(
      (this.width * room) / Math.max(right - left, 1e-6),
      (this.height * room) / Math.max(top - bottom, 1e-6),
    );
    this.scale = clamp(scale, LEAST, MOST);
    this.x = this.width / 2 - ((left + right) / 2) * this.scale;
    this.y = this.height / 2 + ((bottom + top) / 2) * this.scale;
    this.isChosen = false;
    this.changed();
  }

  /**
   * @param {number} x the place in the window that stays where it is
   * @param {number} y
   * @param {number} factor
   */
  zoomAt(x, y, factor) {
    const scale = clamp(this.scale * factor, LEAST, MOST);
    const actual = scale / this.scale;
    this.x = x + (this.x - x) * actual;
    this.y = y + (this.y - y) * actual;
    this.scale = scale;
    this.isChosen = true;
    this.changed();
  }

  /** @param {number} factor */
  zoom(factor) {
    this.zoomAt(this.width / 2, this.height / 2, factor);
  }

  /**
   * @param {number} dx in pixels
   * @param {number} dy
   */
  pan(dx, dy) {
    this.x += dx;
    this.y += dy;
    this.isChosen = true;
    this.changed();
  }

  /**
   * The upper left stays where it is.
   * @param {number} width of the window in pixels
   * @param {number} height
   */
  resize(width, height) {
    this.width = width;
    this.height = height;
    this.changed();
  }

  /**
   * Whether anything of a box is in sight.
   * @param {Box} box
   */
  sees([left, bottom, right, top]) {
    const [x0, y0] = this.toScreen([left, top]);
    const [x1, y1] = this.toScreen([right, bottom]);
    return x1 >= 0 && y1 >= 0 && x0 <= this.width && y0 <= this.height;
  }

  /**
   * Whether all of a box is in sight.
   * @param {Box} box
   */
  holds([left, bottom, right, top]) {
    const [x0, y0] = this.toScreen([left, top]);
    const [x1, y1] = this.toScreen([right, bottom]);
    return x0 >= 0 && y0 >= 0 && x1 <= this.width && y1 <= this.height;
  }
}
