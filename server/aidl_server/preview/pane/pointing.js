/** Which elements are under the pointer, selected, or pointed at from elsewhere: outlined on the drawing, their
 * lines marked in the text. They are known by their paths, since their numbers change with every picture.
 * @import { Element, Preview, Range } from "./protocol.js"
 * @import { Drawing } from "./drawing.js"
 * @import { Handles } from "./handles.js"
 * @import { TextPanel } from "./text.js"
 */

export class Pointing {
  /** @type {Preview | null} */
  #preview = null;
  /** @type {readonly string[]} under the pointer */
  #hovered = [];
  /** @type {readonly string[]} */
  #selected = [];
  /** @type {readonly string[]} what the caret of the host is on */
  #revealed = [];
  /** @type {readonly string[]} what an entry of a list under the pointer is about */
  #pointed = [];

  /**
   * @param {Drawing} drawing
   * @param {Handles} handles
   * @param {TextPanel} source
   * @param {(element: number | null) => void} hovers told when another element comes under the pointer
   */
  constructor(drawing, handles, source, hovers) {
    this.drawing = drawing;
    this.handles = handles;
    this.source = source;
    this.hovers = hovers;
  }

  /** @param {Preview} preview */
  show(preview) {
    this.#preview = preview;
    this.#update();
  }

  /** @param {number | null} element */
  hover(element) {
    const hovered = this.#paths(element === null ? [] : [element]);
    if (hovered.join() === this.#hovered.join()) return;
    this.#hovered = hovered;
    this.hovers(element);
    this.#update();
    this.source.mark(this.#ranges(hovered), { scroll: true });
  }

  /**
   * The innermost element at a path or around it.
   * @param {string} path
   * @returns {number | null}
   */
  ownerOf(path) {
    const names = path.split(/(?=[.[])/);
    for (let count = names.length; count > 0; count--) {
      const [found] = this.#indices([names.slice(0, count).join("")]);
      if (found !== undefined) return found;
    }
    return null;
  }

  /** @param {number | null} element */
  select(element) {
    this.choose(element === null ? [] : [element]);
  }

  /** @param {readonly number[]} elements */
  choose(elements) {
    this.#selected = this.#paths(elements);
    this.#revealed = [];
    this.#update();
    this.source.mark(this.#ranges(this.#selected), { mark: "selected" });
  }

  /** @param {readonly number[]} elements */
  reveal(elements) {
    this.#pointed = this.#paths(elements);
    this.#update();
  }

  /** @param {readonly number[]} elements */
  revealFromHost(elements) {
    this.#revealed = this.#paths(elements);
    this.#update();
    this.source.mark(this.#ranges(this.#revealed), { scroll: true });
  }

  clear() {
    this.#selected = this.#revealed = this.#pointed = [];
    this.#update();
    this.source.mark([]);
    this.source.mark([], { mark: "selected" });
  }

  #update() {
    const problems = this.#preview?.problems ?? [];
    const of = (/** @type {string} */ severity) =>
      problems.flatMap((problem) => (problem.severity === severity ? problem.elements : []));
    const conflicts = this.#preview?.conflicts ?? [];
    this.drawing.mark("warning", of("warning"));
    this.drawing.mark("error", of("error"));
    this.drawing.mark("conflict", conflicts.flatMap(({ constraints }) => constraints.flatMap(({ elements }) => elements)));
    this.drawing.mark("selected", this.#indices(this.#selected));
    this.drawing.mark("reveal", this.#indices([...this.#revealed, ...this.#pointed]));
    this.drawing.mark("hover", this.#indices(this.#hovered));
    this.handles.showOf([...this.#hovered, ...this.#selected]);
  }

  /** @param {readonly number[]} elements */
  #paths(elements) {
    return elements.flatMap((element) => this.#preview?.elements[element]?.path ?? []);
  }

  /** @param {readonly string[]} paths */
  #indices(paths) {
    const found = /** @type {number[]} */ ([]);
    this.#preview?.elements.forEach(({ path }, k) => paths.includes(path) && found.push(k));
    return found;
  }

  /**
   * Where they are written in the document.
   * @param {readonly string[]} paths
   * @returns {Range[]}
   */
  #ranges(paths) {
    return this.#elements(paths).flatMap(({ range, uri }) => (range && uri === this.#preview?.uri ? [range] : []));
  }

  /**
   * @param {readonly string[]} paths
   * @returns {Element[]}
   */
  #elements(paths) {
    return this.#preview?.elements.filter(({ path }) => paths.includes(path)) ?? [];
  }
}
