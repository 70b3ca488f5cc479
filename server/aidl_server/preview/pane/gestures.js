/** Pointer, wheel and fingers on the drawing: move and zoom the view, or tell where a click went.
 * @import { View } from "./view.js"
 */

/** Pixels that a pointer may move between press and release of a click. */
const CLICK = 4;
const LINE_HEIGHT = 16;

/**
 * @typedef {object} Listener
 * @property {(event: MouseEvent) => void} click the first of clicks that follow each other
 * @property {() => void} doubleClick
 * @property {(event: PointerEvent) => void} move no button is pressed
 * @property {() => void} leave
 */

/**
 * What is dragged by its own handler must stop the event.
 * @param {HTMLElement} stage
 * @param {View} view
 * @param {Listener} listener
 */
export function watch(stage, view, listener) {
  /** @type {Map<number, PointerEvent>} */
  const down = new Map();
  let travelled = 0;

  stage.addEventListener("pointerdown", (event) => {
    if (event.button > 1) return;
    if (!down.size) travelled = 0;
    down.set(event.pointerId, event);
    stage.setPointerCapture(event.pointerId);
  });

  stage.addEventListener("pointermove", (event) => {
    const before = down.get(event.pointerId);
    if (!before) return listener.move(event);
    travelled = Math.max(travelled, Math.hypot(event.clientX - before.clientX, event.clientY - before.clientY));
    const [other] = [...down].filter(([id]) => id !== event.pointerId).map(([, pointer]) => pointer);
    if (other) pinch(before, event, other);
    else if (travelled > CLICK) {
      stage.classList.add("panning");
      view.pan(event.clientX - before.clientX, event.clientY - before.clientY);
    } else return;
    down.set(event.pointerId, event);
  });

  /**
   * @param {PointerEvent} before
   * @param {PointerEvent} now
   * @param {PointerEvent} other the finger that rests
   */
  function pinch(before, now, other) {
    travelled = Infinity;
    const { left, top } = stage.getBoundingClientRect();
    const spread = (/** @type {PointerEvent} */ p) =>
      Math.max(Math.hypot(p.clientX - other.clientX, p.clientY - other.clientY), 1);
    view.pan((now.clientX - before.clientX) / 2, (now.clientY - before.clientY) / 2);
    const [x, y] = [(now.clientX + other.clientX) / 2 - left, (now.clientY + other.clientY) / 2 - top];
    view.zoomAt(x, y, spread(now) / spread(before));
  }

  /** @param {PointerEvent} event */
  function release(event) {
    down.delete(event.pointerId);
    if (!down.size) stage.classList.remove("panning");
  }
  stage.addEventListener("pointerup", release);
  stage.addEventListener("pointercancel", release);
  stage.addEventListener("pointerleave", () => listener.leave());
  stage.addEventListener("click", (event) => {
    if (travelled <= CLICK && event.detail === 1) listener.click(event);
  });
  stage.addEventListener("dblclick", () => listener.doubleClick());

  stage.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const unit = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? LINE_HEIGHT : 1;
      const speed = event.ctrlKey ? 0.01 : 0.0015; // a pinch on a touchpad comes as a wheel with Ctrl
      const { left, top } = stage.getBoundingClientRect();
      const turned = Math.max(-300, Math.min(300, event.deltaY * unit));
      view.zoomAt(event.clientX - left, event.clientY - top, Math.exp(-turned * speed));
    },
    { passive: false },
  );
}
