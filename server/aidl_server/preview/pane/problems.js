/** The list of what is wrong: conflicts of constraints, errors, warnings, notes.
 * @import { Party, Place, Preview, Problem, Range } from "./protocol.js"
 */

import { el, icon, quoted } from "./dom.js";
import { fileName, shown } from "./numbers.js";

/**
 * @typedef {object} Listener
 * @property {(uri: string, range: Range) => void} goto
 * @property {(problem: number, fix: number) => void} fix
 * @property {(elements: readonly number[]) => void} point what an entry under the pointer is about; none when it leaves
 */

const SEVERITIES = /** @type {const} */ (["error", "warning", "note"]);

export class Problems {
  #shown = "";

  /**
   * @param {HTMLElement} list
   * @param {HTMLElement} counter
   * @param {Listener} listener
   */
  constructor(list, counter, listener) {
    this.list = list;
    this.counter = counter;
    this.listener = listener;
  }

  /** @param {Preview} preview */
  show({ uri, problems, conflicts }) {
    const state = JSON.stringify([uri, problems, conflicts]);
    if (state === this.#shown) return; // keeps the focus and where it is scrolled to
    this.#shown = state;
    this.counter.replaceChildren(...counts(problems));
    const rank = (/** @type {Problem} */ problem) => SEVERITIES.indexOf(problem.severity);
    const order = problems.map((problem, k) => ({ problem, k })).sort((a, b) => rank(a.problem) - rank(b.problem));
    const parties = new Map(conflicts.map(({ headline, constraints }) => [headline, constraints]));
    const entries = order.map(({ problem, k }) => {
      const own = parties.get(problem.message) ?? [];
      parties.delete(problem.message);
      return this.#problem(problem, k, own, uri);
    });
    const others = [...parties].map(([headline, own]) => this.#conflict(headline, own, uri));
    this.list.replaceChildren(...others, ...entries);
  }

  /**
   * @param {Problem} problem
   * @param {number} index
   * @param {Party[]} parties if it is a conflict
   * @param {string} uri of the document
   */
  #problem(problem, index, parties, uri) {
    const { severity, message, code, hints, fixes, titles } = problem;
    const body = el("div", { class: "body" }, el("p", { class: "message" }, ...quoted(message)));
    if (parties.length) body.append(this.#parties(parties, uri));
    if (hints.length) body.append(el("ul", { class: "hints" }, ...hints.map((hint) => el("li", {}, ...quoted(hint)))));
    const actions = el("div", { class: "actions" }, ...this.#place(problem, uri), el("span", { class: "code" }, code));
    for (let fix = 0; fix < fixes; fix++) {
      const title = titles?.[fix] ?? (fixes > 1 ? `Fix ${fix + 1}` : "Fix");
      const button = el("button", { type: "button", class: "button small" }, ...quoted(title));
      button.addEventListener("click", () => this.listener.fix(index, fix));
      actions.append(button);
    }
    body.append(actions);
    const kind = parties.length ? "conflict" : severity;
    const entry = el("li", { class: `problem ${kind}` }, icon(kind), el("span", { class: "unseen" }, kind), body);
    this.#pointing(entry, [...problem.elements, ...parties.flatMap(({ elements }) => elements)], problem, uri);
    return entry;
  }

  /**
   * One of which no problem speaks.
   * @param {string} headline
   * @param {Party[]} parties
   * @param {string} uri
   */
  #conflict(headline, parties, uri) {
    const message = el("p", { class: "message" }, ...quoted(headline));
    const body = el("div", { class: "body" }, message, this.#parties(parties, uri));
    return el("li", { class: "problem conflict" }, icon("conflict"), el("span", { class: "unseen" }, "conflict"), body);
  }

  /**
   * @param {Party[]} parties
   * @param {string} uri
   */
  #parties(parties, uri) {
    return el("ul", { class: "parties" }, ...parties.map((party) => this.#party(party, uri)));
  }

  /**
   * @param {Party} party
   * @param {string} uri
   */
  #party(party, uri) {
    const entry = el("li", { class: "party" }, el("code", {}, party.text), ...this.#place(party, uri));
    if (party.off !== null) entry.append(el("span", { class: "off" }, `off by ${shown(party.off, 3)}`));
    this.#pointing(entry, party.elements, party, uri);
    return entry;
  }

  /**
   * A button to where something is written; none for what is written nowhere.
   * @param {Place} place
   * @param {string} document
   */
  #place({ uri, range }, document) {
    if (!range) return [];
    const line = `line ${range.start.line + 1}`;
    const text = uri === null || uri === document ? line : `${fileName(uri)}, ${line}`;
    const button = el("button", { type: "button", class: "link" }, text);
    button.addEventListener("click", (event) => {
      event.stopPropagation();
      this.listener.goto(uri ?? document, range);
    });
    return [button];
  }

  /**
   * @param {HTMLElement} entry
   * @param {readonly number[]} elements
   * @param {Place} place
   * @param {string} document
   */
  #pointing(entry, elements, { uri, range }, document) {
    const point = (/** @type {readonly number[]} */ pointed) => (/** @type {Event} */ event) => {
      event.stopPropagation(); // a constraint of a conflict alone, not the whole conflict
      this.listener.point(pointed);
    };
    for (const type of ["pointerover", "focusin"]) entry.addEventListener(type, point(elements));
    for (const type of ["pointerout", "focusout"]) entry.addEventListener(type, point([]));
    if (!range) return;
    entry.classList.add("leads");
    entry.addEventListener("click", (event) => {
      event.stopPropagation();
      if (event.target instanceof Element && event.target.closest("button")) return;
      if (getSelection()?.isCollapsed !== false) this.listener.goto(uri ?? document, range);
    });
  }
}

/** @param {Problem[]} problems */
function counts(problems) {
  return SEVERITIES.flatMap((severity) => {
    const count = problems.filter((problem) => problem.severity === severity).length;
    const words = `${count} ${severity}${count === 1 ? "" : "s"}`;
    return count ? [el("span", { class: `pill ${severity}`, title: words, "aria-label": words }, `${count}`)] : [];
  });
}
