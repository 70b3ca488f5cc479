/** The preview: brings what the host says onto the page, and what is done there to the host.
 * @import { Box } from "./view.js"
 * @import { Applied, Asked, Attempt, ExportWish, Handle, Params, Place, Preview, Range, TextState, Told, Vec } from "./protocol.js"
 */

import { Attempts } from "./attempts.js";
import { el, part, quoted, svg } from "./dom.js";
import { download } from "./download.js";
import { Drawing } from "./drawing.js";
import { elementsOn } from "./elements.js";
import { exportMenu } from "./exporting.js";
import { Freedom } from "./freedom.js";
import { watch } from "./gestures.js";
import { coordinates, Handles } from "./handles.js";
import { connect, Refusal } from "./host.js";
import { listenToKeys } from "./keys.js";
import { Knobs } from "./knobs.js";
import { remember, remembering } from "./memory.js";
import { foldingPanels, layersMenu, themeButton, toggle } from "./menus.js";
import { fileName } from "./numbers.js";
import { Paper } from "./paper.js";
import { PointMarks } from "./points.js";
import { Pointing } from "./pointing.js";
import { Problems } from "./problems.js";
import { StatusView } from "./status.js";
import { TextButtons, TextPanel } from "./text.js";
import { Tooltip } from "./tooltip.js";
import { View } from "./view.js";

/** Milliseconds after which it is shown that something takes long. */
const BUSY_AFTER = 150;
/** Wide enough for the text beside the drawing from the start. */
const WIDE = 900;

class Pane {
  /** @type {Preview | null} what is shown */
  preview = null;
  /** @type {Preview | null} the last that is of the text and not of values that are tried */
  settled = null;
  #isSourceWanted = false;
  #isFreedomWanted = false;
  #isOpen = false;
  /** Requests under way. */
  #asked = 0;
  /** The box that was fitted into the window last. */
  #fitted = /** @type {Box} */ ([0, 0, 0, 0]);

  stage = part("stage", HTMLElement);
  host = connect({
    told: (told) => this.receive(told),
    open: () => this.open(),
    lost: (seconds, reason) => this.lost(seconds, reason),
  });

  /** Of the document that is shown: a host may come to show another. */
  get uri() {
    return document.body.dataset.uri ?? "";
  }

  constructor() {
    remembering(this.host.code);
    const overlay = part("overlay", SVGGElement);
    const [motions, points, handles] = [svg("g", { class: "motions" }), svg("g"), svg("g", { class: "handles" })];
    overlay.append(motions, points, handles);
    const point = (/** @type {readonly number[]} */ elements) => this.pointing.reveal(elements);

    this.status = new StatusView();
    this.attempts = new Attempts((attempt, isWanted) => this.attempt(attempt, isWanted));
    this.view = new View(() => this.place());
    this.paper = new Paper(part("paper", SVGGElement));
    this.drawing = new Drawing(part("world", SVGGElement));
    this.points = new PointMarks(points, this.view);
    this.freedom = new Freedom(motions, part("freedom-list", HTMLElement), this.view, { point });
    this.tooltip = new Tooltip(part("tooltip", HTMLElement), this.stage);
    this.handles = new Handles(handles, this.stage, this.view, {
      drag: ({ id }, to) => this.attempts.attempt({ drag: { id, to } }),
      drop: ({ id }, to) => this.edit("aidl/drag", { uri: this.uri, id, to }),
      cancel: () => this.cancel(),
      tell: (handle, at, where) => this.tell(handle, at, where),
      hush: () => this.tooltip.hide(),
    });
    const text = {
      undo: () => void this.change("aidl/undo", { uri: this.uri }),
      redo: () => void this.change("aidl/redo", { uri: this.uri }),
      save: (anyway = false) => void this.change("aidl/save", { uri: this.uri, anyway }),
      takeFile: () => void this.change("aidl/takeFile", { uri: this.uri }),
    };
    this.source = new TextPanel(part("source-lines", HTMLElement), {
      ...text,
      typed: () => this.textButtons.unsaved(true),
      type: (version, changes) => this.ask("aidl/type", { uri: this.uri, version, changes }),
      choose: (line) => this.pointing.choose(this.preview ? elementsOn(this.preview, line) : []),
      point: (line) => point(this.preview && line !== null ? elementsOn(this.preview, line) : []),
      failed: (message) => this.failed(message),
    });
    this.textButtons = new TextButtons(text);
    this.pointing = new Pointing(this.drawing, this.handles, this.source, (element) => this.hover(element));
    this.knobs = new Knobs(part("knobs-list", HTMLElement), {
      attempt: ({ path }, value) => this.attempts.attempt({ knobs: { [path]: value } }),
      write: ({ path }, value) => this.edit("aidl/setKnob", { uri: this.uri, path, value }),
      type: ({ path }, text, isTried) => this.typed(path, text, isTried),
      cancel: () => this.cancel(),
    });
    this.problems = new Problems(part("problems-list", HTMLElement), part("problems-count", HTMLElement), {
      goto: (uri, range) => this.goto(uri, range),
      fix: (problem, fix) => this.edit("aidl/fix", { uri: this.uri, version: this.settled?.version ?? 0, problem, fix }),
      point,
    });
    this.watch(this.host.code === null ? text : {}); // in VS Code the editor has these keys
    this.menus();
  }

  /**
   * The pointer, the keys, and the size of the window.
   * @param {import("./keys.js").TextKeys} text
   */
  watch(text) {
    watch(this.stage, this.view, {
      click: (event) => this.click(event),
      doubleClick: () => this.fit(),
      move: (event) => this.move(event),
      leave: () => this.leave(),
    });
    listenToKeys(this.stage, this.view, {
      fit: () => this.fit(),
      escape: () => this.pointing.clear(),
      ...text,
    });
    new ResizeObserver(() => {
      if (this.measure() && !this.view.isChosen) this.fit();
    }).observe(this.stage);
  }

  /** Whether the stage has another size than the view knew. */
  measure() {
    const { clientWidth: width, clientHeight: height } = this.stage;
    if (width === this.view.width && height === this.view.height) return false;
    this.view.resize(width, height);
    return true;
  }

  menus() {
    foldingPanels();
    themeButton(this.host.code !== null);
    exportMenu(() => this.ask("aidl/exports", { uri: this.uri }), (wish) => this.export(wish));
    this.layers = layersMenu(
      () => void this.want(),
      (hasGrid) => {
        this.paper.hasGrid = hasGrid;
        this.place();
      },
    );
    part("walk", HTMLButtonElement).addEventListener("click", () => void this.walk());
    toggle("handles-toggle", (isOn) => this.handles.showAll(isOn));
    toggle("freedom-toggle", (isOn) => {
      this.#isFreedomWanted = isOn;
      this.freedom.toggle(isOn);
      this.panels();
      if (this.#isOpen) void this.want();
    });
    const isWide = innerWidth >= WIDE;
    toggle("source-toggle", (isOn) => {
      this.#isSourceWanted = isOn;
      this.panels();
    }, isWide);
    part("fit", HTMLElement).addEventListener("click", () => this.fit());
    part("zoom-in", HTMLElement).addEventListener("click", () => this.view.zoom(1.25));
    part("zoom-out", HTMLElement).addEventListener("click", () => this.view.zoom(0.8));
    part("reconnect", HTMLElement).addEventListener("click", () => this.host.reconnect());
  }

  /**
   * Null where there is no answer; why is told, unless something newer came first.
   * @template {keyof Asked} N
   * @param {N} method
   * @param {Params<N>} params
   * @param {(reason: string) => void} [refused] told in place of a toast
   * @returns {Promise<Asked[N]["result"] | null>}
   */
  async ask(method, params, refused = (reason) => this.failed(reason)) {
    const timer = setTimeout(() => this.status.busy(true), BUSY_AFTER);
    this.#asked += 1;
    try {
      return await this.host.ask(method, params);
    } catch (error) {
      if (!(error instanceof Refusal && error.isOvertaken)) refused(error instanceof Error ? error.message : String(error));
      return null;
    } finally {
      clearTimeout(timer);
      this.#asked -= 1;
      if (this.#asked === 0) this.status.busy(false);
    }
  }

  open() {
    this.#isOpen = true;
    this.status.connected();
    this.source.open();
    void this.want();
  }

  /** Ask for the picture, with what is wanted beside the drawing: what can move takes a while to find out. */
  async want() {
    const picture = await this.ask("aidl/preview", { uri: this.uri, show: this.#wanted() });
    if (picture) this.picture(picture);
  }

  /**
   * Whether it is worth to be looked into, should nothing newer come.
   * @param {Attempt & { rests?: boolean }} attempt
   * @param {() => boolean} isWanted
   */
  async attempt(attempt, isWanted) {
    const picture = await this.ask("aidl/try", { uri: this.uri, ...attempt });
    if (picture && isWanted()) this.picture(picture);
    return picture !== null && picture.status !== "solved" && "knobs" in attempt;
  }

  /**
   * The last word on what was tried: the text changes, and its picture follows.
   * @template {"aidl/setKnob" | "aidl/drag" | "aidl/fix"} N
   * @param {N} method
   * @param {Params<N>} params
   */
  async edit(method, params) {
    this.attempts.forget();
    await this.source.flush();
    const done = /** @type {Applied | null} */ (await this.ask(method, params));
    if (done === null) this.restore();
    else if (!done.applied) this.failed(done.reason ?? "This could not be written into the text.");
  }

  /**
   * What was typed into the field of a param is worked out, and written or tried.
   * @param {string} path
   * @param {string} text
   * @param {boolean} isTried
   * @returns {Promise<string>} why it was refused; empty if it was not
   */
  async typed(path, text, isTried) {
    let why = "";
    const refused = (/** @type {string} */ reason) => void (why = reason);
    this.attempts.forget();
    await this.source.flush();
    if (isTried) {
      const picture = await this.ask("aidl/try", { uri: this.uri, knobs: { [path]: text }, rests: true }, refused);
      if (picture) this.picture(picture);
    } else {
      const done = await this.ask("aidl/setKnob", { uri: this.uri, path, value: text }, refused);
      if (done?.applied === false) refused(done.reason ?? "This could not be written into the text.");
    }
    return why;
  }

  /**
   * Undoes, redoes or saves, what was typed last among it.
   * @template {"aidl/undo" | "aidl/redo" | "aidl/save" | "aidl/takeFile"} N
   * @param {N} method
   * @param {Params<N>} params
   */
  async change(method, params) {
    this.attempts.forget();
    await this.source.flush();
    const done = /** @type {Applied | null} */ (await this.ask(method, params));
    if (done?.applied === false) this.failed(done.reason ?? "This could not be done.");
  }

  /**
   * Why nothing was exported is told by the dialog.
   * @param {ExportWish} wish
   * @returns {Promise<string>} why there is no file; empty if there is one
   */
  async export(wish) {
    let why = "";
    await this.source.flush();
    const asked = { uri: this.uri, ...wish, show: this.#wanted() };
    const file = await this.ask("aidl/export", asked, (reason) => void (why = reason));
    if (file) download(file.name, file.data);
    for (const note of file?.notes ?? []) this.status.toast(note, "warning");
    return why;
  }

  /** Ask where the params change kind, which takes seconds; the answer of a text that was changed since is of no use. */
  async walk() {
    const button = part("walk", HTMLButtonElement);
    await this.source.flush();
    button.disabled = true;
    const version = this.settled?.version ?? 0;
    const found = await this.ask("aidl/ranges", { uri: this.uri });
    button.disabled = false;
    if (found && version === this.settled?.version) this.knobs.mark(version, found);
  }

  /** @param {number | null} element */
  hover(element) {
    this.host.tell("aidl/hover", { place: element === null ? null : placeOf(this.preview?.elements[element]) });
  }

  /** @returns {import("./protocol.js").Layer[]} */
  #wanted() {
    return [...(this.layers?.() ?? []), ...(this.#isFreedomWanted ? /** @type {const} */ (["freedom"]) : [])];
  }

  /**
   * @param {number} seconds
   * @param {string} reason
   */
  lost(seconds, reason) {
    this.attempts.forget();
    this.status.lost(seconds, reason);
    document.body.classList.add("lost");
  }

  /** @param {Told} told */
  receive(told) {
    switch (told.method) {
      case "aidl/previewChanged":
        return this.changed(told.params);
      case "aidl/text":
        return this.words(told.params);
      case "aidl/busy":
        return this.status.busy(true);
      case "aidl/reveal":
        return this.pointing.revealFromHost(told.params.elements);
      case "window/showMessage":
        return this.failed(told.params.message);
    }
  }

  /** @param {TextState} state */
  words(state) {
    this.source.told(state);
    this.textButtons.show(state, this.source.isUnsaved);
    this.panels();
  }

  /**
   * The program was run. News that come late, of a text before the one shown, are dropped.
   * @param {Preview} preview
   */
  changed(preview) {
    if (this.settled === null || preview.version >= this.settled.version) this.picture(preview);
  }

  /** @param {Preview} preview */
  picture(preview) {
    document.body.classList.remove("lost");
    this.status.busy(false);
    if (!preview.tried) this.settled = preview;
    this.show(preview);
  }

  /** @param {string} message */
  failed(message) {
    this.status.busy(false);
    this.status.toast(message);
    if (!this.attempts.active) this.restore();
  }

  /** Forget what was tried. */
  cancel() {
    this.attempts.forget();
    this.restore();
  }

  restore() {
    this.knobs.restore();
    if (this.settled) this.show(this.settled);
  }

  /** @param {Preview} preview */
  show(preview) {
    const before = this.preview;
    this.preview = preview;
    try {
      this.drawing.show(preview);
    } catch (error) {
      this.status.toast(error instanceof Error ? error.message : String(error));
      this.preview = preview = { ...preview, svg: null };
      this.drawing.show(preview);
    }
    remember("uri", preview.uri);
    const name = fileName(preview.uri);
    document.title = `${name} \u2013 AIDL`;
    part("name", HTMLElement).textContent = name;
    document.body.classList.toggle("stale", preview.stale);
    this.paper.box = preview.svg === null ? null : this.drawing.around(preview.box);
    this.knobs.show(preview);
    this.problems.show(preview);
    this.status.show(preview);
    this.points.show(preview.problems);
    this.handles.show(preview.stale ? [] : preview.handles);
    this.freedom.show(preview);
    this.source.showProblems(preview);
    this.panels();
    this.pointing.show(preview);
    this.measure(); // panels that come and go while one types must not move the drawing
    const isOther = before?.uri !== preview.uri || before.svg === null;
    if (isOther || this.#strays(preview)) this.fit();
    else this.place();
    document.body.dataset.shown = JSON.stringify([preview.uri, preview.version]);
  }

  /**
   * Whether the drawing has moved out of a view that was fitted, or wholly out of one that was chosen. What is
   * only tried does not move the view: somebody is pulling at the drawing.
   * @param {Preview} preview
   */
  #strays({ box, tried }) {
    const around = this.paper.box ?? box;
    const hasMoved = around.some((side, k) => side !== this.#fitted[k]);
    return !this.view.sees(around) || (hasMoved && !tried && !this.view.isChosen && !this.view.holds(around));
  }

  /** Which panels there is something to show in. */
  panels() {
    const preview = this.preview;
    const hasSource = this.source.isThere;
    part("source-toggle", HTMLElement).hidden = part("history", HTMLElement).hidden = !hasSource;
    part("source", HTMLElement).hidden = !(hasSource && this.#isSourceWanted);
    if (hasSource && this.#isSourceWanted) void this.source.show();
    part("problems", HTMLElement).hidden = !preview || !(preview.problems.length || preview.conflicts.length);
    const hasKnobs = Boolean(preview?.knobs.length);
    const hasFreedom = this.#isFreedomWanted && Boolean(preview?.motions.length);
    part("knobs", HTMLElement).hidden = !hasKnobs;
    part("freedom", HTMLElement).hidden = !hasFreedom;
    part("side", HTMLElement).hidden = !hasKnobs && !hasFreedom;
    const isAlone = typeof dialAidl === "function"; // a page without a server has no processes that could walk
    part("walk", HTMLElement).hidden = isAlone || !this.knobs.canBeWalked;
    part("knobs-count", HTMLElement).textContent = String(preview?.knobs.length ?? "");
    part("freedom-count", HTMLElement).textContent = String(preview?.motions.length ?? "");
  }

  /** Put everything where the view has it. */
  place() {
    this.paper.place(this.view);
    this.drawing.place(this.view);
    this.points.place();
    this.freedom.place();
    this.handles.place();
  }

  fit() {
    if (!this.paper.box) return;
    this.#fitted = this.paper.box;
    this.view.fit(this.paper.box);
  }

  /** @param {PointerEvent} event */
  move(event) {
    const { left, top } = this.stage.getBoundingClientRect();
    const at = this.view.toDrawing(event.clientX - left, event.clientY - top);
    part("coordinates", HTMLElement).textContent = this.preview?.svg ? coordinates(at, this.view.scale) : "";
    if (event.target instanceof Element && event.target.closest(".handle")) return;
    const element = this.drawing.elementAt(/** @type {Node} */ (event.target));
    this.pointing.hover(element);
    const drawn = element === null ? undefined : this.preview?.elements[element];
    if (!drawn) return this.tooltip.hide();
    const words = [el("strong", {}, drawn.path), el("span", {}, drawn.hint || drawn.type)];
    this.tooltip.show(words, event.clientX, event.clientY);
  }

  leave() {
    part("coordinates", HTMLElement).textContent = "";
    this.pointing.hover(null);
    if (!this.handles.isDragging) this.tooltip.hide();
  }

  /** @param {MouseEvent} event */
  click(event) {
    const element = this.drawing.elementAt(document.elementFromPoint(event.clientX, event.clientY));
    this.pointing.select(element);
    const { uri, range } = placeOf(element === null ? undefined : this.preview?.elements[element]) ?? NOWHERE;
    if (uri !== null && range !== null) this.host.tell("aidl/goto", { uri, range });
  }

  /**
   * @param {string} uri
   * @param {Range} range
   */
  goto(uri, range) {
    this.host.tell("aidl/goto", { uri, range });
    if (uri === this.preview?.uri) this.source.go(range);
  }

  /**
   * @param {Handle} handle
   * @param {Vec} at
   * @param {DOMRect} where
   */
  tell({ hint, path }, at, where) {
    this.pointing.hover(this.pointing.ownerOf(path));
    const words = [el("strong", {}, coordinates(at, this.view.scale)), el("span", {}, ...quoted(hint))];
    this.tooltip.show(words, where.right - 6, where.bottom - 6);
  }
}

/** @type {Place} */
const NOWHERE = { uri: null, range: null };

/**
 * @param {Place | undefined} element
 * @returns {Place | null}
 */
function placeOf(element) {
  return element === undefined ? null : { uri: element.uri, range: element.range };
}

new Pane();
