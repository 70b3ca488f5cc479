/** Which numbers a knob may have, and where they are on its slider.
 * @import { Knob } from "./protocol.js"
 */

import { clamp, digitsOf, niceAbove, tidy } from "./numbers.js";

/** Steps on a slider whose knob has none of its own, at most. */
const STEPS = 400;

export class Scale {
  /**
   * @param {Knob} knob of numbers
   * @param {number} value in the text: where there is no bound, the slider reaches to about twice that
   */
  constructor({ low, high, step, unit }, value) {
    this.low = low ?? -Infinity;
    this.high = high ?? Infinity;
    const reach = Math.max(2 * Math.abs(value), unit === "deg" ? 180 : 10);
    const natural = value < 0 ? [-reach, 0] : [0, reach];
    /** The ends of the slider. */
    this.start = low ?? Math.min(Number(natural[0]), high === null ? Infinity : high - reach);
    this.end = high ?? Math.max(Number(natural[1]), this.start + reach);
    const isCount = unit === "" && [value, low ?? 0, high ?? 0].every(Number.isInteger);
    this.step = step !== null && step > 0 ? step : isCount ? 1 : niceStep(this.end - this.start);
    this.origin = step !== null && low !== null ? low : 0;
    this.digits = Math.max(digitsOf(this.step), digitsOf(this.origin));
  }

  /**
   * The nearest number that the slider may have: a step, or an end of it.
   * @param {number} value
   */
  onSlider(value) {
    const isInside = this.start < value && value < this.end;
    const step = isInside ? tidy(this.origin + Math.round((value - this.origin) / this.step) * this.step) : value;
    return clamp(clamp(step, this.start, this.end), this.low, this.high);
  }
}

/** @param {number} length */
function niceStep(length) {
  return length > 0 ? niceAbove(length / STEPS) : 1;
}
