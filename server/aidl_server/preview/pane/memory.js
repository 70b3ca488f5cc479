/** What the pane remembers of its user's choices: in VS Code with the panel, else in the browser.
 * @import { VsCodeApi } from "./protocol.js"
 */

const KEY = "aidl-preview";

/** @type {VsCodeApi | null} */
let code = null;
/** @type {Record<string, unknown>} */
let known = {};

/** @param {VsCodeApi | null} api of the panel that remembers, if there is one */
export function remembering(api) {
  code = api;
  known = {};
  const kept = code ? code.getState() : stored();
  if (typeof kept === "object" && kept !== null) known = { ...kept };
}

/** @param {string} name */
export function recall(name) {
  return known[name];
}

/**
 * @param {string} name
 * @param {unknown} value
 */
export function remember(name, value) {
  if (known[name] === value) return;
  known[name] = value;
  if (code) return code.setState(known);
  try {
    localStorage.setItem(KEY, JSON.stringify(known));
  } catch {
    // Where a browser keeps nothing, choices last until the page is left.
  }
}

/** @returns {unknown} */
function stored() {
  try {
    return JSON.parse(localStorage.getItem(KEY) ?? "null");
  } catch {
    return null;
  }
}
