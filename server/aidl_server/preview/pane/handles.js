/** Points of the drawing that can be dragged: dots that stay as large as they are however close one looks.
 * @import { Handle, Vec } from "./protocol.js"
 * @import { View } from "./view.js"
 */

import { set, svg } from "./dom.js";
import { fixed, tidy } from "./numbers.js";

/**
 * @typedef {object} Listener
 * @property {(handle: Handle, to: Vec) => void} drag
 * @property {(handle: Handle, to: Vec) => void} drop
 * @property {() => void} cancel
 * @property {(handle: Handle, at: Vec, where: DOMRect) => void} tell
 * @property {() => void} hush
 */

/** @typedef {{ handle: Handle, dot: SVGGElement }} Dot */

const ARROWS = /** @type {Record<string, Vec>} */ ({
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
});
const SHAPE = {
  guess: () => svg("circle", { r: "5", class: "knot" }),
  param: () => svg("path", { d: "M0-6.5 6.5 0 0 6.5-6.5 0Z", class: "knot" }),
  size: () => svg("rect", { x: "-4.5", y: "-4.5", width: "9", height: "9", rx: "1.5", class: "knot" }),
};

/**
 * The step to which a dragged point keeps, in mm.
 * @param {number} scale pixels for a millimetre
 */
export function snapStep(scale) {
  return scale < 8 ? 1 : scale < 40 ? 0.5 : 0.1;
}

export class Handles {
  /** @type {Map<string, Dot>} */
  #dots = new Map();
  /** @type {{ handle: Handle, to: Vec, byKey: boolean, moved: boolean, grab: Vec } | null} */
  #drag = null;
  #areAllShown = false;
  /** @type {readonly string[]} */
  #paths = [];

  /**
   * @param {SVGGElement} group in pixels
   * @param {HTMLElement} stage
   * @param {View} view
   * @param {Listener} listener
   */
  constructor(group, stage, view, listener) {
    this.group = group;
    this.stage = stage;
    this.view = view;
    this.listener = listener;
    addEventListener("keydown", (event) => {
      if (event.key !== "Escape" || !this.#drag) return;
      event.stopImmediatePropagation();
      this.cancel();
    }, true);
  }

  /** Whether one is being dragged. */
  get isDragging() {
    return this.#drag !== null;
  }

  /** @param {Handle[]} handles */
  show(handles) {
    const kept = new Map();
    for (const handle of handles) {
      const before = this.#dots.get(handle.id);
      const isSame = before?.handle.moves === handle.moves && before.handle.hint === handle.hint;
      const dot = before && isSame ? before : { handle, dot: this.#make(handle) };
      dot.handle = handle;
      kept.set(handle.id, dot);
    }
    for (const [id, { dot }] of this.#dots) if (kept.get(id)?.dot !== dot) dot.remove();
    this.#dots = kept;
    if (this.#drag && !kept.has(this.#drag.handle.id)) this.cancel();
    this.#choose();
    this.place();
  }

  place() {
    for (const { handle, dot } of this.#dots.values()) {
      const at = this.#drag?.handle.id === handle.id ? this.#drag.to : handle.at;
      const [x, y] = this.view.toScreen(at);
      dot.setAttribute("transform", `translate(${x} ${y})`);
    }
  }

  /** @param {boolean} all */
  showAll(all) {
    this.#areAllShown = all;
    this.#choose();
  }

  /**
   * Those of these elements are shown.
   * @param {readonly string[]} paths
   */
  showOf(paths) {
    if (paths.join() === this.#paths.join()) return;
    this.#paths = paths;
    this.#choose();
  }

  cancel() {
    if (!this.#drag) return;
    this.#end();
    this.listener.cancel();
  }

  #choose() {
    for (const { handle, dot } of this.#dots.values()) {
      const isOf = (/** @type {string} */ path) => handle.path === path || handle.path.startsWith(`${path}.`);
      const isShown = this.#areAllShown || this.#drag?.handle.id === handle.id || this.#paths.some(isOf);
      dot.classList.toggle("shown", isShown);
      set(dot, { tabindex: isShown ? "0" : null });
    }
  }

  /** @param {Handle} handle */
  #make({ id, moves, hint }) {
    const knot = (SHAPE[moves] ?? SHAPE.guess)();
    const dot = svg("g", { class: `handle ${moves}`, role: "button", "aria-label": `Drag: ${hint}` });
    dot.append(svg("circle", { r: "11", class: "reach" }), knot);
    dot.addEventListener("pointerdown", (event) => this.#start(event, id, dot));
    dot.addEventListener("pointermove", (event) => this.#move(event, id));
    dot.addEventListener("pointerup", () => this.#drop());
    dot.addEventListener("pointercancel", () => this.cancel());
    dot.addEventListener("pointerenter", () => this.#tell(id));
    dot.addEventListener("pointerleave", () => this.#drag ?? this.listener.hush());
    dot.addEventListener("focus", () => this.#tell(id));
    dot.addEventListener("blur", () => {
      if (!this.#drag) this.listener.hush();
      else if (this.#drag.handle.id === id) this.#drop(); // else the focus goes to the one that is pulled at
    });
    dot.addEventListener("keydown", (event) => this.#key(event, id));
    dot.addEventListener("keyup", (event) => event.key in ARROWS && this.#drag?.byKey && this.#drop());
    for (const type of ["click", "dblclick"]) dot.addEventListener(type, (event) => event.stopPropagation());
    this.group.append(dot);
    return dot;
  }

  /**
   * @param {PointerEvent} event
   * @param {string} id
   * @param {SVGGElement} dot
   */
  #start(event, id, dot) {
    if (event.button !== 0) return;
    event.stopPropagation();
    const handle = this.#dots.get(id)?.handle;
    if (!handle) return;
    dot.setPointerCapture(event.pointerId);
    const [x, y] = this.#pointer(event);
    const grab = /** @type {Vec} */ ([x - handle.at[0], y - handle.at[1]]);
    this.#drag = { handle, to: handle.at, byKey: false, moved: false, grab };
    dot.classList.add("dragged");
    this.stage.classList.add("dragging");
  }

  /**
   * @param {PointerEvent} event
   * @param {string} id
   */
  #move(event, id) {
    event.stopPropagation();
    if (!this.#drag || this.#drag.handle.id !== id || this.#drag.byKey) return;
    const [x, y] = this.#pointer(event);
    const { grab } = this.#drag;
    this.#to([x - grab[0], y - grab[1]], event.shiftKey ? 0.001 : snapStep(this.view.scale));
  }

  /**
   * @param {KeyboardEvent} event
   * @param {string} id
   */
  #key(event, id) {
    const way = ARROWS[event.key];
    const handle = this.#dots.get(id)?.handle;
    if (!way || !handle || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    event.stopPropagation();
    this.#drag ??= { handle, to: handle.at, byKey: true, moved: false, grab: [0, 0] };
    const step = event.shiftKey ? 0.1 : snapStep(this.view.scale);
    const [x, y] = this.#drag.to;
    this.#to([x + way[0] * step, y + way[1] * step], event.shiftKey ? 0.1 : step);
  }

  /**
   * @param {Vec} at
   * @param {number} step
   */
  #to(at, step) {
    const drag = this.#drag;
    if (!drag) return;
    const to = /** @type {Vec} */ (at.map((value) => tidy(Math.round(value / step) * step)));
    if (to[0] === drag.to[0] && to[1] === drag.to[1]) return;
    drag.to = to;
    drag.moved = true;
    this.place();
    this.#tell(drag.handle.id);
    this.listener.drag(drag.handle, to);
  }

  #drop() {
    const drag = this.#drag;
    if (!drag) return;
    const dot = this.#dots.get(drag.handle.id);
    if (dot) dot.handle = { ...dot.handle, at: drag.to }; // until the next picture says where it is
    this.#end();
    if (drag.moved) this.listener.drop(drag.handle, drag.to);
  }

  #end() {
    const drag = this.#drag;
    this.#drag = null;
    this.stage.classList.remove("dragging");
    if (drag) this.#dots.get(drag.handle.id)?.dot.classList.remove("dragged");
    this.#choose();
    this.place();
    this.listener.hush();
  }

  /** @param {string} id */
  #tell(id) {
    const dot = this.#dots.get(id);
    if (!dot) return;
    const at = this.#drag?.handle.id === id ? this.#drag.to : dot.handle.at;
    this.listener.tell(dot.handle, at, dot.dot.getBoundingClientRect());
  }

  /**
   * @param {PointerEvent} event
   * @returns {Vec} in mm
   */
  #pointer(event) {
    const { left, top } = this.stage.getBoundingClientRect();
    return this.view.toDrawing(event.clientX - left, event.clientY - top);
  }
}

/**
 * @param {Vec} at in mm
 * @param {number} scale pixels for a millimetre
 */
export function coordinates([x, y], scale) {
  const digits = scale < 40 ? 1 : 2;
  return `${fixed(x, digits)}, ${fixed(y, digits)} mm`;
}
