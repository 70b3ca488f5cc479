/** The keys of the preview.
 * @import { View } from "./view.js"
 */

/** Pixels that an arrow moves the view. */
const STEP = 40;
const ZOOM = 1.25;

/**
 * @typedef {object} Listener
 * @property {() => void} fit
 * @property {() => void} escape
 */

/** @typedef {{ undo?: () => void, redo?: () => void, save?: () => void }} TextKeys */

/**
 * @param {HTMLElement} stage
 * @param {View} view
 * @param {Listener & TextKeys} listener
 */
export function listenToKeys(stage, view, listener) {
  const press = (/** @type {string} */ id) => () => {
    const button = document.getElementById(id);
    if (button && !button.hidden) button.click();
  };
  /** @type {Record<string, () => void>} */
  const anywhere = {
    "+": () => view.zoom(ZOOM),
    "=": () => view.zoom(ZOOM),
    "-": () => view.zoom(1 / ZOOM),
    "\u2212": () => view.zoom(1 / ZOOM),
    0: listener.fit,
    f: listener.fit,
    t: press("source-toggle"),
    p: press("handles-toggle"),
    d: press("freedom-toggle"),
    Escape: listener.escape,
  };
  /** @type {Record<string, () => void>} */
  const onStage = {
    ArrowLeft: () => view.pan(STEP, 0),
    ArrowRight: () => view.pan(-STEP, 0),
    ArrowUp: () => view.pan(0, STEP),
    ArrowDown: () => view.pan(0, -STEP),
  };
  /** @param {KeyboardEvent} event */
  function withControl({ key, shiftKey }) {
    const letter = key.toLowerCase();
    if (letter === "z") return shiftKey ? listener.redo : listener.undo;
    return { y: listener.redo, s: listener.save }[letter];
  }
  addEventListener("keydown", (event) => {
    if (event.altKey || event.defaultPrevented) return;
    const { target } = event;
    const isField = target instanceof HTMLInputElement && !["range", "checkbox"].includes(target.type);
    if (event.ctrlKey || event.metaKey) {
      const action = isField && event.key.toLowerCase() !== "s" ? undefined : withControl(event);
      if (!action) return; // a field has a history of its own
      event.preventDefault();
      return action();
    }
    if (target instanceof HTMLInputElement || target instanceof HTMLSelectElement) return;
    if (target instanceof HTMLElement && target.isContentEditable) return;
    const isOnStage = target === document.body || target === stage;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const action = anywhere[key] ?? (isOnStage ? onStage[key] : undefined);
    if (!action) return;
    event.preventDefault();
    action();
  });
}
