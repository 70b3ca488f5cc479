/** The sliders and fields for the params of a program.
 * @import { Knob, KindChange, Preview, Value, Walked } from "./protocol.js"
 */

import { el, icon, part, quoted, set } from "./dom.js";
import { shown } from "./numbers.js";
import { Scale } from "./scales.js";

/**
 * @typedef {object} Listener
 * @property {(knob: Knob, value: Value) => void} attempt show what it would look like
 * @property {(knob: Knob, value: Value) => void} write it into the text
 * @property {(knob: Knob, text: string, isTried: boolean) => Promise<string>} type work out what was typed, and write it
 *   into the text or try it; tells why that was refused, if it was
 * @property {() => void} cancel forget what was tried
 */

/**
 * A field of the page for one knob.
 * @typedef {object} Control
 * @property {Element[]} elements
 * @property {(value: Value) => void} show
 * @property {(turns: readonly KindChange[]) => void} [mark] shows where the kind changes
 */

export class Knobs {
  /** @type {Map<string, Row>} */
  #rows = new Map();
  /** Of the text that was walked, whose marks are shown; null without any. */
  #walked = /** @type {number | null} */ (null);
  #summary = part("walked", HTMLElement);

  /**
   * @param {HTMLElement} list
   * @param {Listener} listener
   */
  constructor(list, listener) {
    this.list = list;
    /** @type {Listener} */
    this.listener = {
      ...listener,
      attempt: (knob, value) => {
        for (const row of this.#rows.values()) if (row.knob.path !== knob.path) row.restore();
        listener.attempt(knob, value);
      },
    };
  }

  /** @param {Preview} preview */
  show({ knobs, tried, version }) {
    if (this.#walked !== null && this.#walked !== version) this.mark(null, { summary: "", walked: [] });
    /** @type {Map<string, Row>} */
    const rows = new Map();
    for (const knob of knobs) {
      const before = this.#rows.get(knob.path);
      const row = before?.fits(knob) ? before : new Row(knob, this.listener);
      if (tried) row.tried(knob);
      else row.settle(knob);
      rows.set(knob.path, row);
    }
    this.#rows = rows;
    const wanted = [...rows.values()].map((row) => row.element);
    if (wanted.length !== this.list.children.length || wanted.some((row, k) => row !== this.list.children[k])) {
      this.list.replaceChildren(...wanted); // only when they changed, since it takes the focus away
    }
  }

  /**
   * Shows where the kind changes on the way of each param, until the text is another.
   * @param {number | null} version of the text that was walked; null for none
   * @param {Walked} found
   */
  mark(version, { summary, walked }) {
    this.#walked = version;
    this.#summary.textContent = summary;
    this.#summary.hidden = !summary;
    const turns = new Map(walked.map((walk) => [walk.param, walk.turns]));
    for (const [path, row] of this.#rows) row.control.mark?.(turns.get(path) ?? []);
  }

  /** Whether a slider has both ends, between which its param can be walked. */
  get canBeWalked() {
    return [...this.#rows.values()].some(({ knob }) => knob.kind === "number" && knob.low !== null && knob.high !== null);
  }

  /** The values in the text again. */
  restore() {
    for (const row of this.#rows.values()) row.restore();
  }
}

/** One knob: its name, its field, and the way back to the value in the text. */
class Row {
  #isTrying = false;
  #byKey = false;
  /** Whether the host works out what was typed. */
  isAsking = false;

  /**
   * @param {Knob} knob
   * @param {Listener} listener
   */
  constructor(knob, listener) {
    this.knob = knob;
    this.listener = listener;
    /** The value in the text. */
    this.written = knob.value;
    this.value = knob.value;
    this.looks = looksOf(knob);
    const id = `knob-${(count += 1)}`;
    this.reset = el("button", { type: "button", class: "tool small", "aria-label": `Reset ${knob.name}`, title: "Back to the value in the text" }, icon("reset"));
    this.reset.addEventListener("click", () => this.cancel());
    this.control = controlOf(this, id);
    const owner = knob.path.slice(0, -knob.name.length);
    const name = el("label", { for: id, title: knob.path }, el("span", { class: "owner" }, owner.endsWith(".") ? owner : ""), knob.name);
    this.element = el("div", { class: `knob ${knob.kind}`, title: knob.doc || null });
    this.element.append(el("div", { class: "head" }, name, this.reset), el("div", { class: "field" }, ...this.control.elements));
    if (knob.doc) this.element.append(el("p", { class: "doc" }, ...quoted(knob.doc)));
    this.refusal = el("p", { class: "refusal", role: "alert", id: `${id}-refusal`, hidden: true });
    this.element.append(this.refusal);
    if (!isWritable(knob)) {
      this.element.append(el("p", { class: "doc" }, "Can be tried here, but its value in the text cannot be changed."));
    }
    this.element.addEventListener("keydown", (event) => {
      this.#byKey = event.key !== "Escape";
      if (this.#byKey || !(this.#isTrying || this.isRefused)) return;
      event.stopPropagation();
      this.isIgnored = this.isSlid;
      this.cancel();
    });
    for (const end of ["keyup", "focusout"]) {
      this.element.addEventListener(end, () => {
        this.#byKey = false;
        if (this.#isTrying && this.isSlid) this.finish();
      });
    }
    this.#update();
  }

  /** Whether the value is being changed by a slider, which has no end but that of the key or the pointer. */
  isSlid = false;
  /** Whether the pointer still slides after Escape. */
  isIgnored = false;

  /** @param {Knob} knob */
  fits(knob) {
    return looksOf(knob) === this.looks;
  }

  /**
   * The value that the text has now.
   * @param {Knob} knob
   */
  settle(knob) {
    const isSame = knob.value === this.written;
    this.knob = knob;
    this.written = knob.value;
    if (!this.#isTrying && !(this.isRefused && isSame)) this.restore();
    this.#update();
  }

  /**
   * The value that is tried, by what was typed or by a point that is dragged.
   * @param {Knob} knob
   */
  tried({ value }) {
    if (this.#isTrying || this.isRefused) return;
    this.value = value;
    this.control.show(value);
    this.#update();
  }

  get isRefused() {
    return !this.refusal.hidden;
  }

  /**
   * What was typed is worked out by the host, which may refuse it.
   * @param {string} text
   */
  async type(text) {
    this.isAsking = true;
    this.refuse("");
    const why = await this.listener.type(this.knob, text, !isWritable(this.knob));
    this.isAsking = false;
    this.refuse(why);
  }

  /** @param {string} why */
  refuse(why) {
    this.refusal.replaceChildren(...quoted(why));
    this.refusal.hidden = !why;
    this.element.classList.toggle("refused", Boolean(why));
  }

  restore() {
    this.#isTrying = this.isSlid = false;
    this.refuse("");
    this.value = this.written;
    this.control.show(this.value);
    this.#update();
  }

  /** @param {Value} value */
  attempt(value) {
    if (value === this.value) return;
    this.refuse("");
    this.value = value;
    this.#isTrying = true;
    this.#update();
    this.listener.attempt(this.knob, value);
  }

  /**
   * A value that was chosen at once.
   * @param {Value} value
   */
  choose(value) {
    if (isWritable(this.knob)) this.value = value;
    else this.attempt(value);
    this.finish();
  }

  /** The slider or field was let go. */
  finish() {
    if (this.isSlid && this.#byKey) return; // until the key is let go
    const wasTrying = this.#isTrying;
    this.#isTrying = this.isSlid = false;
    if (!isWritable(this.knob)) return;
    if (this.value !== this.written) this.listener.write(this.knob, this.value);
    else if (wasTrying) this.listener.cancel();
    this.#update();
  }

  cancel() {
    this.restore();
    this.listener.cancel();
  }

  #update() {
    const isOther = this.value !== this.written;
    this.reset.hidden = !isOther;
    this.element.classList.toggle("tried", isOther);
  }
}

let count = 0;

/** @param {Knob} knob */
function isWritable(knob) {
  return knob.editable && knob.range !== null;
}

/**
 * What a row must be made anew for.
 * @param {Knob} knob
 */
function looksOf({ path, name, kind, unit, low, high, step, choices, doc, editable, range }) {
  return JSON.stringify([path, name, kind, unit, low, high, step, choices, doc, editable, range === null]);
}

/**
 * @param {Row} row
 * @param {string} id
 * @returns {Control}
 */
function controlOf(row, id) {
  switch (row.knob.kind) {
    case "number":
      return number(row, id);
    case "choice":
      return choice(row, id);
    case "truth":
      return truth(row, id);
    default:
      return text(row, id);
  }
}

/**
 * @param {Row} row
 * @param {string} id
 * @returns {Control}
 */
function number(row, id) {
  const { knob } = row;
  let scale = new Scale(knob, Number(knob.value));
  const slider = el("input", { type: "range", step: "any", "aria-label": knob.name });
  const field = el("input", { type: "text", id, size: "6", autocomplete: "off", spellcheck: "false", "aria-describedby": `${id}-refusal` });
  const unit = el("span", { class: "unit" }, knob.unit === "deg" ? "°" : knob.unit);
  let isTyping = false; // what is being typed stays when a new picture comes
  const bounds = [knob.low, knob.high].map((bound) => (bound === null ? "…" : shown(bound, 6)));
  const range = knob.low === null && knob.high === null ? "" : `${bounds.join(" to ")}; `;
  field.title = `${range}units and sums are worked out: 12cm, 80+20, 1/2in`;

  /** @param {number} value */
  function fill(value) {
    const { start, end } = scale;
    const share = end > start ? (Math.min(Math.max(value, start), end) - start) / (end - start) : 0;
    slider.style.setProperty("--share", `${share * 100}%`);
    set(slider, { "aria-valuetext": `${value} ${knob.unit}`.trim() });
  }

  /** @param {Value} value */
  function show(value) {
    if (value === row.written && !(Number(value) >= scale.start && Number(value) <= scale.end)) {
      scale = new Scale(knob, Number(value));
    }
    set(slider, { min: `${scale.start}`, max: `${scale.end}` });
    slider.value = String(value);
    if (!isTyping) rewrite(field, plain(Number(value)));
    fill(Number(value));
  }

  slider.addEventListener("pointerdown", () => void (row.isIgnored = false));
  slider.addEventListener("input", () => {
    if (row.isIgnored) return show(row.value);
    const value = scale.onSlider(slider.valueAsNumber);
    row.isSlid = true;
    field.value = plain(value);
    fill(value);
    row.attempt(value);
  });
  slider.addEventListener("keydown", (event) => {
    const ways = /** @type {Record<string, number>} */ ({ ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10 });
    const way = ways[event.key];
    if (way === undefined) return;
    row.isIgnored = false;
    event.preventDefault(); // without a step of its own the browser would take a hundredth of the way
    slider.value = String(scale.onSlider(Number(row.value) + way * scale.step));
    slider.dispatchEvent(new Event("input"));
  });
  slider.addEventListener("change", () => {
    slider.value = String(row.value);
    row.finish();
  });
  field.addEventListener("input", () => {
    isTyping = true;
    row.refuse("");
  });
  field.addEventListener("keydown", ({ key }) => {
    if (key !== "Escape") return;
    isTyping = false;
    if (!row.isRefused) show(row.value);
  });
  field.addEventListener("change", () => {
    isTyping = false;
    const text = field.value.trim();
    if (text === "" || text === plain(Number(row.value))) show(row.value);
    else void row.type(text);
  });
  field.addEventListener("blur", () => {
    isTyping = false;
    if (!row.isAsking && !row.isRefused) show(row.value); // what was typed is the value, otherwise written
  });
  const marks = el("div", { class: "turns", hidden: true });

  /** @param {readonly KindChange[]} turns */
  function mark(turns) {
    marks.hidden = turns.length === 0;
    marks.replaceChildren(...turns.map(({ value, message, fixes }) => {
      const words = [message, ...fixes.map((fix) => fix.title)].join("\n").replaceAll("`", "");
      const one = el("span", { class: "turn", role: "img", title: words, "aria-label": words });
      one.style.setProperty("--at", String((value - scale.start) / (scale.end - scale.start)));
      return one;
    }));
  }

  show(knob.value);
  const measure = el("span", { class: knob.unit ? "measure with-unit" : "measure" }, field, unit);
  return { elements: [el("div", { class: "track" }, slider, marks), measure], show, mark };
}

/**
 * Puts a text into a field; if all of it was selected, as by who is about to type, all of it still is.
 * @param {HTMLInputElement} field
 * @param {string} text
 */
function rewrite(field, text) {
  const isSelected = field.selectionStart === 0 && field.selectionEnd === field.value.length;
  field.value = text;
  if (isSelected && document.activeElement === field) field.select();
}

/**
 * Without the noise of binary fractions, as one types it.
 * @param {number} value
 */
function plain(value) {
  return String(Number(value.toPrecision(7)));
}

/**
 * @param {Row} row
 * @param {string} id
 * @returns {Control}
 */
function choice(row, id) {
  const { choices, unit } = row.knob;
  const select = el("select", { id });
  choices.forEach((value, k) => select.append(el("option", { value: `${k}` }, unit ? `${value} ${unit}` : String(value))));
  select.addEventListener("change", () => {
    const value = choices[select.selectedIndex];
    if (value !== undefined) row.choose(value);
  });
  const show = (/** @type {Value} */ value) => void (select.selectedIndex = choices.indexOf(value));
  show(row.knob.value);
  return { elements: [select], show };
}

/**
 * @param {Row} row
 * @param {string} id
 * @returns {Control}
 */
function truth(row, id) {
  const box = el("input", { type: "checkbox", id, role: "switch" });
  box.addEventListener("change", () => row.choose(box.checked));
  const show = (/** @type {Value} */ value) => void (box.checked = value === true);
  show(row.knob.value);
  return { elements: [box], show };
}

/**
 * @param {Row} row
 * @param {string} id
 * @returns {Control}
 */
function text(row, id) {
  const field = el("input", { type: "text", id, autocomplete: "off", spellcheck: "false" });
  field.addEventListener("input", () => row.attempt(field.value));
  field.addEventListener("change", () => row.finish());
  const show = (/** @type {Value} */ value) => {
    if (field.value !== String(value)) field.value = String(value);
  };
  show(row.knob.value);
  return { elements: [field], show };
}
