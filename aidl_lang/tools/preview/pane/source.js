/** The text of the program beside its drawing.
 * @import { Preview, Problem, Range, Source } from "./protocol.js"
 */

import { el } from "./dom.js";

/**
 * @typedef {object} Listener
 * @property {(line: number) => void} choose
 * @property {(line: number | null) => void} point
 */

export class SourceView {
  /** @type {string | null} */
  #state = null;
  /** @type {HTMLElement[]} */
  #lines = [];
  #current = 0;

  /**
   * @param {HTMLElement} list
   * @param {Listener} listener
   */
  constructor(list, listener) {
    this.list = list;
    this.listener = listener;
    list.addEventListener("click", (event) => {
      const line = this.#lineOf(event.target);
      if (line === null || getSelection()?.isCollapsed === false) return;
      this.#move(line);
      listener.choose(line);
    });
    list.addEventListener("pointermove", (event) => listener.point(this.#lineOf(event.target)));
    list.addEventListener("pointerleave", () => listener.point(null));
    list.addEventListener("keydown", (event) => this.#key(event));
  }

  /**
   * @param {Source} source
   * @param {Problem[]} problems in this text
   */
  show(source, problems) {
    const state = JSON.stringify(source);
    if (state !== this.#state) {
      this.#state = state;
      const colored = byLine(source);
      const texts = source.text.split(/\r\n|\r|\n/);
      const rows = texts.map((text, line) => {
        const code = el("code", {}, ...pieces(text, colored.get(line) ?? []));
        const number = el("span", { class: "gutter", "aria-hidden": "true" }, `${line + 1}`);
        return el("div", { class: "line", role: "listitem", "data-line": `${line}` }, number, code);
      });
      this.list.replaceChildren(...rows);
      this.list.style.setProperty("--digits", String(String(texts.length).length));
      this.#lines = rows;
    }
    for (const row of this.#lines) row.classList.remove("error", "warning", "note");
    for (const { range, severity, message } of [...problems].reverse()) {
      const row = range && this.#lines[range.start.line];
      row?.classList.add(severity);
      row?.querySelector(".gutter")?.setAttribute("title", message);
    }
  }

  /**
   * Mark the lines of these ranges, and bring the first into sight if asked to.
   * @param {readonly Range[]} ranges
   * @param {{ scroll?: boolean, mark?: string }} [how]
   */
  mark(ranges, { scroll = false, mark = "marked" } = {}) {
    const covers = (/** @type {number} */ line) =>
      ranges.some((range) => range.start.line <= line && line <= lastLine(range));
    this.#lines.forEach((row, line) => row.classList.toggle(mark, covers(line)));
    const [first] = ranges;
    const row = first && this.#lines[first.start.line];
    if (scroll && row) row.scrollIntoView({ block: "nearest" });
  }

  /** @param {KeyboardEvent} event */
  #key(event) {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (step !== undefined) this.#move(this.#current + step);
    else if (event.key === "Enter") this.listener.choose(this.#current);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  /** @param {number} line */
  #move(line) {
    const row = this.#lines[line];
    if (!row) return;
    this.#lines[this.#current]?.classList.remove("current");
    row.classList.add("current");
    row.scrollIntoView({ block: "nearest" });
    this.#current = line;
  }

  /**
   * @param {EventTarget | null} target
   * @returns {number | null}
   */
  #lineOf(target) {
    const row = target instanceof Element ? target.closest("[data-line]") : null;
    return row ? Number(row.getAttribute("data-line")) : null;
  }
}

/**
 * The innermost elements that are written on a line of the document: those whose place has the fewest lines.
 * @param {Preview} preview
 * @param {number} line
 * @returns {number[]}
 */
export function elementsOn({ uri, elements }, line) {
  let least = Infinity;
  /** @type {number[]} */
  let found = [];
  elements.forEach(({ range, uri: file }, k) => {
    if (!range || file !== uri || line < range.start.line || line > lastLine(range)) return;
    const size = range.end.line - range.start.line;
    if (size < least) [least, found] = [size, []];
    if (size === least) found.push(k);
  });
  return found;
}

/** @param {Range} range */
function lastLine({ start, end }) {
  return end.character === 0 && end.line > start.line ? end.line - 1 : end.line;
}

/** @param {Source} source */
function byLine({ tokens }) {
  /** @type {Map<number, { start: number, end: number, type: string }[]>} */
  const lines = new Map();
  for (const [line, start, length, type] of tokens) {
    const known = lines.get(line) ?? [];
    known.push({ start, end: start + length, type });
    lines.set(line, known);
  }
  for (const tokens of lines.values()) tokens.sort((a, b) => a.start - b.start);
  return lines;
}

/**
 * The text of a line, cut at its tokens.
 * @param {string} text
 * @param {{ start: number, end: number, type: string }[]} tokens in order
 */
function pieces(text, tokens) {
  /** @type {(Node | string)[]} */
  const found = [];
  let done = 0;
  for (const { start, end, type } of tokens) {
    if (start < done || end > text.length || start >= end) continue; // of another text
    found.push(text.slice(done, start), el("span", { class: `token ${type.replace(/[^\w-]/g, "")}` }, text.slice(start, end)));
    done = end;
  }
  found.push(text.slice(done));
  return found.filter((piece) => piece !== "");
}
