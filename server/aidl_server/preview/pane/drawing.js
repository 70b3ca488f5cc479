/** The drawing on its sheet: what is shown, what is under the pointer, and what is outlined over it.
 * @import { Preview } from "./protocol.js"
 * @import { Box, View } from "./view.js"
 */

import { svg } from "./dom.js";
import { drawingOf } from "./sanitize.js";

/** Outlines over the drawing, from back to front. */
export const MARKS = /** @type {const} */ (["warning", "error", "conflict", "selected", "reveal", "hover"]);
/** @typedef {(typeof MARKS)[number]} Mark */

const SHAPES = "path, circle, ellipse, rect, line, polyline, polygon";

export class Drawing {
  /** @type {string | null} */
  #text = null;
  #content = svg("g", { class: "drawing" });
  /** @type {Map<Mark, SVGGElement>} */
  #marks = new Map(MARKS.map((mark) => [mark, svg("g", { class: `mark ${mark}` })]));
  /** @type {Map<Mark, readonly number[]>} */
  #marked = new Map();
  /** @type {Preview["elements"]} */
  #elements = [];
  /** @type {Map<number, Element[]>} */
  #nodes = new Map();

  /** @param {SVGGElement} world in which a unit is a millimetre and y points down */
  constructor(world) {
    this.world = world;
    world.append(this.#content, ...this.#marks.values());
  }

  /** @param {View} view */
  place({ scale, x, y }) {
    this.world.setAttribute("transform", `matrix(${scale} 0 0 ${scale} ${x} ${y})`);
  }

  /**
   * Marks of the drawing before are gone.
   * @param {Pick<Preview, "svg" | "elements">} preview
   * @throws {Error} if the SVG is none
   */
  show({ svg: text, elements }) {
    this.#elements = elements;
    this.#marked.clear();
    for (const group of this.#marks.values()) group.replaceChildren();
    if (text === this.#text) return;
    const content = text === null ? svg("g") : drawingOf(text);
    content.classList.add("drawing");
    this.#content.replaceWith(content);
    this.#content = content;
    this.#text = text;
    this.#nodes.clear();
    for (const node of content.querySelectorAll("[data-element]")) {
      const index = Number(node.getAttribute("data-element"));
      this.#nodes.set(index, [...(this.#nodes.get(index) ?? []), node]);
    }
  }

  /**
   * The box of a drawing and of all that stands around it, as dimensions do.
   * @param {Box} box
   * @returns {Box}
   */
  around([left, bottom, right, top]) {
    const { x, y, width, height } = this.#content.getBBox();
    if (!width && !height) return [left, bottom, right, top];
    return [Math.min(left, x), Math.min(bottom, -y - height), Math.max(right, x + width), Math.max(top, -y)];
  }

  /**
   * The element that is drawn at a node of the page, if it is one of the drawing.
   * @param {Node | null} node
   * @returns {number | null}
   */
  elementAt(node) {
    if (!(node instanceof Element) || !this.#content.contains(node)) return null;
    const found = node.closest("[data-element]");
    const index = found ? Number(found.getAttribute("data-element")) : NaN;
    return index in this.#elements ? index : null;
  }

  /**
   * Outline these elements and no others in one of the ways; what is in another of them is not outlined itself.
   * @param {Mark} mark
   * @param {readonly number[]} elements
   */
  mark(mark, elements) {
    const before = this.#marked.get(mark) ?? [];
    if (before.length === elements.length && before.every((element, k) => element === elements[k])) return;
    this.#marked.set(mark, [...elements]);
    const paths = new Set(elements.map((element) => this.#elements[element]?.path ?? ""));
    const outer = elements.filter((element) => !around(this.#elements[element]?.path ?? "").some((path) => paths.has(path)));
    const shapes = new Set(outer.flatMap((element) => this.#shapes(element)));
    const copies = (/** @type {string} */ name) => [...shapes].map((shape) => this.#outline(shape, name));
    this.#marks.get(mark)?.replaceChildren(...copies("rim"), ...copies("line"));
  }

  /**
   * The shapes that an element is seen by: its own, else those of what is in it.
   * @param {number} index
   * @returns {Element[]}
   */
  #shapes(index) {
    const own = this.#own(index);
    const element = this.#elements[index];
    if (own.length || !element) return own;
    const inside = `${element.path}.`;
    return this.#elements.flatMap((other, k) => (other.path.startsWith(inside) ? this.#own(k) : []));
  }

  /**
   * @param {number} index
   * @returns {Element[]}
   */
  #own(index) {
    const nodes = this.#nodes.get(index) ?? [];
    const shapes = nodes.flatMap((node) => {
      if (node.matches(SHAPES)) return [node];
      return [...node.querySelectorAll(SHAPES)].filter((shape) => shape.closest("[data-element]") === node);
    });
    const exact = shapes.filter((shape) => shape.classList.contains("hit"));
    return exact.length ? exact : shapes;
  }

  /**
   * A copy without looks of its own.
   * @param {Element} shape
   * @param {string} name of the class that has its looks
   */
  #outline(shape, name) {
    const copy = /** @type {Element} */ (shape.cloneNode(false));
    const looks = ["fill", "stroke", "opacity", "clip-path", "data-element", "class"];
    for (const { name } of [...copy.attributes]) {
      if (looks.some((look) => name.startsWith(look))) copy.removeAttribute(name);
    }
    copy.setAttribute("class", name);
    copy.setAttribute("fill-rule", "evenodd");
    copy.setAttribute("vector-effect", "non-scaling-stroke");
    const transforms = [];
    for (let node = /** @type {Element | null} */ (shape); node && node !== this.#content; node = node.parentElement) {
      transforms.unshift(node.getAttribute("transform") ?? "");
    }
    const transform = transforms.join(" ").trim();
    if (transform) copy.setAttribute("transform", transform);
    return copy;
  }
}

/**
 * The paths of all that a thing is in.
 * @param {string} path
 */
function around(path) {
  const names = path.split(".");
  return names.slice(0, -1).map((_, k) => names.slice(0, k + 1).join("."));
}
