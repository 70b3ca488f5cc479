/** What can still move: arrows and arcs over the drawing, and a list in words.
 * @import { Element as Drawn, Motion, Preview, Turn, Vec } from "./protocol.js"
 * @import { View } from "./view.js"
 */

import { el, svg } from "./dom.js";
import { localName } from "./numbers.js";

/** Things that are named in one entry. */
const NAMED = 3;
/** Half of the arrow's head, and the shortest arrow, in pixels. */
const HEAD = 5;
const SHORTEST = 26;

/**
 * @typedef {object} Listener
 * @property {(elements: readonly number[]) => void} point
 */

export class Freedom {
  /** @type {Motion[]} */
  #motions = [];
  #isShown = false;
  #pointed = -1;
  #state = "";

  /**
   * @param {SVGGElement} group in pixels
   * @param {HTMLElement} list
   * @param {View} view
   * @param {Listener} listener
   */
  constructor(group, list, view, listener) {
    this.group = group;
    this.list = list;
    this.view = view;
    this.listener = listener;
  }

  /** @param {Preview} preview */
  show({ motions, elements, stale }) {
    this.#motions = stale ? [] : motions;
    const state = JSON.stringify([this.#motions, elements.map((element) => element.path)]);
    if (state !== this.#state) {
      this.#state = state;
      this.#pointed = -1;
      this.list.replaceChildren(...this.#motions.map((motion, k) => this.#entry(motion, k, elements)));
    }
    this.place();
  }

  /** @param {boolean} shown */
  toggle(shown) {
    this.#isShown = shown;
    this.place();
  }

  place() {
    if (!this.#isShown) return this.group.replaceChildren();
    this.group.replaceChildren(
      ...this.#motions.map((motion, k) => {
        const shapes = [
          ...motion.arrows.map(({ from, to }) => this.#arrow(from, to)),
          ...motion.turns.map((turn) => this.#turn(turn)),
        ];
        const label = this.#label(motion);
        return svg("g", { class: k === this.#pointed ? "motion pointed" : "motion" }, ...shapes, ...label);
      }),
    );
  }

  /**
   * @param {Motion} motion
   * @param {number} index
   * @param {Drawn[]} elements
   */
  #entry({ words, elements: moved }, index, elements) {
    const names = moved.map((k) => elements[k]).filter((element) => element !== undefined);
    const more = names.length > NAMED ? ` and ${names.length - NAMED} more` : "";
    const listed = names.slice(0, NAMED).map((element) => localName(element.path)).join(", ") + more;
    const entry = el("li", { class: "way", tabindex: "0" }, el("strong", {}, listed), ` can ${words}`);
    const point = (/** @type {boolean} */ isOn) => () => {
      this.#pointed = isOn ? index : -1;
      this.listener.point(isOn ? moved : []);
      this.place();
    };
    for (const type of ["pointerenter", "focus"]) entry.addEventListener(type, point(true));
    for (const type of ["pointerleave", "blur"]) entry.addEventListener(type, point(false));
    return entry;
  }

  /**
   * @param {Vec} from
   * @param {Vec} to
   */
  #arrow(from, to) {
    const [x0, y0] = this.view.toScreen(from);
    let [x1, y1] = this.view.toScreen(to);
    const length = Math.hypot(x1 - x0, y1 - y0);
    if (length < 1e-9) return svg("g");
    const longer = Math.max(SHORTEST / length, 1);
    [x1, y1] = [x0 + (x1 - x0) * longer, y0 + (y1 - y0) * longer];
    const path = `M${x0} ${y0}L${x1} ${y1}${head(x1, y1, Math.atan2(y1 - y0, x1 - x0))}`;
    return doubled(path);
  }

  /** @param {Turn} turn */
  #turn({ center, radius, sweep, start }) {
    const [x, y] = this.view.toScreen(center);
    const r = Math.max(radius * this.view.scale, 12);
    const size = Math.min(Math.abs(sweep), 350) * Math.sign(sweep || 1);
    const first = ((start ?? 90 - size / 2) * Math.PI) / 180;
    const last = first + (size * Math.PI) / 180;
    const at = (/** @type {number} */ angle) => [x + r * Math.cos(angle), y - r * Math.sin(angle)];
    const [x0 = 0, y0 = 0] = at(first);
    const [x1 = 0, y1 = 0] = at(last);
    const way = size > 0 ? 1 : -1;
    const arc = `M${x0} ${y0}A${r} ${r} 0 ${Math.abs(size) > 180 ? 1 : 0} ${size > 0 ? 0 : 1} ${x1} ${y1}`;
    const tip = head(x1, y1, -last - (way * Math.PI) / 2);
    const tail = head(x0, y0, -first + (way * Math.PI) / 2);
    return doubled(arc + tip + tail);
  }

  /** @param {Motion} motion */
  #label({ words, arrows, turns }) {
    const [arrow] = arrows;
    const [turn] = turns;
    const at = arrow ? this.view.toScreen(arrow.to) : turn && this.view.toScreen(turn.center);
    if (!at) return [];
    const up = turn && !arrow ? Math.max(turn.radius * this.view.scale, 12) + 8 : 8;
    const place = { x: `${at[0]}`, y: `${at[1] - up}`, "text-anchor": "middle" };
    return [svg("text", { ...place, class: "halo", "aria-hidden": "true" }, words), svg("text", place, words)];
  }
}

/**
 * Two strokes that meet in a point.
 * @param {number} x
 * @param {number} y
 * @param {number} angle of the way that the arrow points, clockwise in radians
 */
function head(x, y, angle) {
  const end = (/** @type {number} */ turn) =>
    `${x - 1.6 * HEAD * Math.cos(angle + turn)} ${y - 1.6 * HEAD * Math.sin(angle + turn)}`;
  return `M${end(0.5)}L${x} ${y}L${end(-0.5)}`;
}

/**
 * A line with a light rim, to be seen on any ground.
 * @param {string} path
 */
function doubled(path) {
  return svg("g", {}, svg("path", { d: path, class: "rim" }), svg("path", { d: path, class: "line" }));
}
