/** Numbers as people read them. */

/** Of what is shown as a minus sign. */
const MINUS = "\u2212";

/**
 * At most so many digits after the point, no zeros at the end, a true minus sign.
 * @param {number} value
 * @param {number} [digits]
 */
export function shown(value, digits = 2) {
  const text = String(Number(value.toFixed(digits)) + 0);
  return text.replace("-", MINUS);
}

/**
 * So many digits after the point, a true minus sign.
 * @param {number} value
 * @param {number} digits
 */
export function fixed(value, digits) {
  const text = value.toFixed(digits);
  return (/[1-9]/.test(text) ? text : text.replace("-", "")).replace("-", MINUS);
}

/**
 * The least of 1, 2, 5, 10, 20, … (and 0.5, 0.2, …) that is not below a length.
 * @param {number} length above 0
 */
export function niceAbove(length) {
  const power = 10 ** Math.floor(Math.log10(length));
  const factor = [1, 2, 5, 10].find((f) => f * power >= length * (1 - 1e-9)) ?? 10;
  return tidy(factor * power);
}

/**
 * Without the noise of binary fractions.
 * @param {number} value
 */
export function tidy(value) {
  return Number(value.toPrecision(12));
}

/**
 * Digits after the point that multiples of a step need.
 * @param {number} step
 */
export function digitsOf(step) {
  const [mantissa = "", exponent = "0"] = String(tidy(step)).split("e");
  return Math.max(0, (mantissa.split(".")[1] ?? "").length - Number(exponent));
}

/**
 * @param {number} value
 * @param {number} low
 * @param {number} high
 */
export function clamp(value, low, high) {
  return Math.min(Math.max(value, low), high);
}

/**
 * @param {string} uri
 * @returns {string} the name of the file
 */
export function fileName(uri) {
  const last = uri.split(/[\\/]/).filter(Boolean).pop() ?? uri;
  try {
    return decodeURIComponent(last);
  } catch {
    return last;
  }
}

/**
 * The last names of a dotted path, without that of the root.
 * @param {string} path
 */
export function localName(path) {
  const dot = path.indexOf(".");
  return dot < 0 ? path : path.slice(dot + 1);
}
