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

/**
 * @param {HTMLElement} stage
 * @param {View} view
 * @param {Listener} listener
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
  addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
    const { target } = event;
    if (target instanceof HTMLInputElement || target instanceof HTMLSelectElement) return;
    const isOnStage = target === document.body || target === stage;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const action = anywhere[key] ?? (isOnStage ? onStage[key] : undefined);
    if (!action) return;
    event.preventDefault();
    action();
  });
}
