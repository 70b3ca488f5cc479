/** The text of the program beside its drawing. The host has it; what is typed here is told to the host soon after, one
 * lot at a time, and drawn. It goes into the file when it is saved.
 * @import { Editor } from "./editor.js"
 * @import { Applied, Change, Preview, Range, TextState } from "./protocol.js"
 */

import { part } from "./dom.js";

/** Milliseconds without a key after which what was typed is told. */
const PAUSE = 120;
const SEVERITIES = /** @type {const} */ ({ error: "error", warning: "warning", note: "info" });

/**
 * @typedef {object} Host
 * @property {() => void} typed something was, of which the host is not told yet
 * @property {(version: number, changes: Change[]) => Promise<Applied | null>} type
 * @property {() => void} save
 * @property {() => void} undo
 * @property {() => void} redo
 * @property {(line: number) => void} choose the caret was put on a line
 * @property {(line: number | null) => void} point a line is under the pointer
 * @property {(message: string) => void} failed
 */

export class TextPanel {
  /** @type {Editor | null} */
  #editor = null;
  #isLoading = false;
  /** @type {TextState | null} what the host told last */
  #state = null;
  /** The text that the host has, as far as it is known here. */
  #text = "";
  #version = 0;
  /** @type {Promise<void> | null} what is being told */
  #telling = null;
  /** @type {{ version: number, text: string } | null} what came meanwhile */
  #next = null;
  #isOther = false;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #timer = undefined;
  /** @type {Preview | null} */
  #preview = null;
  /** @type {Map<"marked" | "selected", readonly Range[]>} */
  #marks = new Map();

  /**
   * @param {HTMLElement} place
   * @param {Host} host
   */
  constructor(place, host) {
    this.place = place;
    this.host = host;
    addEventListener("beforeunload", (event) => {
      if (this.isUnsaved) event.preventDefault();
    });
  }

  get isThere() {
    return this.#state !== null;
  }

  get isUnsaved() {
    return this.#editor?.hasTyped === true || this.#telling !== null || this.#state?.saved === false;
  }

  /** Another host may be there. */
  open() {
    this.#isOther = this.#editor !== null;
    this.#telling = null;
  }

  /** @param {TextState} state */
  told(state) {
    const isOther = this.#isOther && this.isUnsaved;
    this.#state = state;
    const { text, version } = state;
    if (text === null) return;
    this.#isOther = false;
    if (isOther && this.#editor) {
      [this.#text, this.#version] = [text, version];
      this.#editor.keep(text);
      void this.flush();
    } else if (this.#telling) this.#next = { text, version };
    else this.#become(text, version);
  }

  /** Brings the editor, which is large, when it is first wanted. */
  async show() {
    if (this.#editor || this.#isLoading || !this.isThere) return;
    this.#isLoading = true;
    const { Editor } = await import("./editor.js");
    const nonce = document.querySelector("script")?.nonce ?? "";
    this.#editor = new Editor(this.place, this.#text, nonce, {
      typed: () => this.#typed(),
      save: () => this.host.save(),
      undo: () => this.host.undo(),
      redo: () => this.host.redo(),
      moved: (line) => this.host.choose(line),
      pointed: (line) => this.host.point(line),
      tooLong: () => this.host.failed("This is too long to be put in at once."),
    });
    for (const [name, ranges] of this.#marks) this.#editor.mark(name, ranges, false);
    this.#find();
  }

  /** Tells the host what was typed, and waits until it has that. */
  async flush() {
    clearTimeout(this.#timer);
    await this.#telling;
    if (!this.#editor?.hasTyped) return;
    this.#telling = this.#tell(this.#editor);
    await this.#telling;
  }

  /** @param {Editor} editor */
  async #tell(editor) {
    const changes = editor.changes();
    const takeBack = editor.handOver();
    const done = await this.host.type(this.#version, changes);
    this.#telling = null;
    if (done?.applied && done.version !== undefined) this.#version = done.version;
    else takeBack();
    const next = this.#next;
    this.#next = null;
    if (next) this.#become(next.text, next.version);
    else if (done && !done.applied) return this.host.failed(done.reason ?? "What was typed did not arrive.");
    if (editor.hasTyped) this.#later();
    else this.#find();
  }

  /**
   * @param {string} text
   * @param {number} version
   */
  #become(text, version) {
    [this.#text, this.#version] = [text, version];
    this.#editor?.become(text);
    if (this.#editor?.hasTyped) this.#later();
  }

  #typed() {
    this.host.typed();
    this.#later();
  }

  #later() {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => void this.flush(), PAUSE);
  }

  /** @param {Preview} preview */
  showProblems(preview) {
    this.#preview = preview;
    this.#find();
  }

  /** Underlines what is wrong, if what is known of that is of this very text. */
  #find() {
    const preview = this.#preview;
    if (!this.#editor || this.#editor.hasTyped || !preview || preview.tried || preview.version !== this.#version) return;
    const here = preview.problems.filter(({ uri, range }) => uri === preview.uri && range);
    this.#editor.find(
      here.map(({ range, severity, message }) => ({ range: /** @type {Range} */ (range), severity: SEVERITIES[severity], message })),
    );
  }

  /**
   * Marks the lines of these ranges, and brings the first into sight if asked to.
   * @param {readonly Range[]} ranges
   * @param {{ scroll?: boolean, mark?: "marked" | "selected" }} [how]
   */
  mark(ranges, { scroll = false, mark = "marked" } = {}) {
    this.#marks.set(mark, ranges);
    this.#editor?.mark(mark, ranges, scroll);
  }

  /** @param {Range} range */
  go(range) {
    this.#editor?.go(range);
  }
}

/** What stands over the text and in the toolbar: whether it is saved, and what can be undone. */
export class TextButtons {
  #undo = part("undo", HTMLButtonElement);
  #redo = part("redo", HTMLButtonElement);
  #save = part("save", HTMLButtonElement);
  #contested = part("contested", HTMLElement);

  /** @param {{ undo: () => void, redo: () => void, save: (anyway: boolean) => void, takeFile: () => void }} listener */
  constructor({ undo, redo, save, takeFile }) {
    this.#undo.addEventListener("click", undo);
    this.#redo.addEventListener("click", redo);
    this.#save.addEventListener("click", () => save(false));
    part("save-anyway", HTMLButtonElement).addEventListener("click", () => save(true));
    part("take-file", HTMLButtonElement).addEventListener("click", takeFile);
  }

  /**
   * @param {TextState} state
   * @param {boolean} isUnsaved
   */
  show({ undo, redo, contested }, isUnsaved) {
    this.#undo.disabled = undo === null;
    this.#redo.disabled = redo === null;
    this.#undo.title = undo === null ? "Nothing to undo" : `Undo: ${undo} (Ctrl+Z)`;
    this.#redo.title = redo === null ? "Nothing to redo" : `Redo: ${redo} (Ctrl+Y)`;
    this.unsaved(isUnsaved);
    this.#contested.hidden = !contested;
  }

  /** @param {boolean} isUnsaved */
  unsaved(isUnsaved) {
    this.#save.hidden = !isUnsaved;
    document.body.classList.toggle("unsaved", isUnsaved);
  }
}
