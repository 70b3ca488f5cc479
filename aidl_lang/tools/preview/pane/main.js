/** The preview: brings what the host says onto the page, and what is done there to the host.
 * @import { Box } from "./view.js"
 * @import { FromHost, Handle, Preview, Range, ToHost, Vec } from "./protocol.js"
 */

import { Attempts } from "./attempts.js";
import { el, part, svg } from "./dom.js";
import { download } from "./download.js";
import { Drawing } from "./drawing.js";
import { Freedom } from "./freedom.js";
import { watch } from "./gestures.js";
import { coordinates, Handles } from "./handles.js";
import { connect } from "./host.js";
import { listenToKeys } from "./keys.js";
import { Knobs } from "./knobs.js";
import { remember, remembering } from "./memory.js";
import { exportMenu, foldingPanels, layersMenu, themeButton, toggle } from "./menus.js";
import { fileName } from "./numbers.js";
import { Paper } from "./paper.js";
import { PointMarks } from "./points.js";
import { Pointing } from "./pointing.js";
import { Problems } from "./problems.js";
import { elementsOn, SourceView } from "./source.js";
import { StatusView } from "./status.js";
import { Tooltip } from "./tooltip.js";
import { View } from "./view.js";

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
  /** The box that was fitted into the window last. */
  #fitted = /** @type {Box} */ ([0, 0, 0, 0]);

  stage = part("stage", HTMLElement);
  host = connect({
    message: (message) => this.receive(message),
    open: () => this.open(),
    lost: (seconds, reason) => this.lost(seconds, reason),
  });

  constructor() {
    remembering(this.host.code);
    const overlay = part("overlay", SVGGElement);
    const [motions, points, handles] = [svg("g", { class: "motions" }), svg("g"), svg("g", { class: "handles" })];
    overlay.append(motions, points, handles);
    const point = (/** @type {readonly number[]} */ elements) => this.pointing.reveal(elements);

    this.status = new StatusView();
    this.attempts = new Attempts((message) => this.send(message));
    this.view = new View(() => this.place());
    this.paper = new Paper(part("paper", SVGGElement));
    this.drawing = new Drawing(part("world", SVGGElement));
    this.points = new PointMarks(points, this.view);
    this.freedom = new Freedom(motions, part("freedom-list", HTMLElement), this.view, { point });
    this.tooltip = new Tooltip(part("tooltip", HTMLElement), this.stage);
    this.handles = new Handles(handles, this.stage, this.view, {
      drag: ({ id }, to) => this.attempts.attempt({ type: "drag", id, to, final: false }),
      drop: ({ id }, to) => this.attempts.finish({ type: "drag", id, to, final: true }),
      cancel: () => this.cancel(),
      tell: (handle, at, where) => this.tell(handle, at, where),
      hush: () => this.tooltip.hide(),
    });
    this.source = new SourceView(part("source-lines", HTMLElement), {
      choose: (line) => this.pointing.choose(this.preview ? elementsOn(this.preview, line) : []),
      point: (line) => point(this.preview && line !== null ? elementsOn(this.preview, line) : []),
    });
    this.pointing = new Pointing(this.drawing, this.handles, this.source, (element) => this.send({ type: "hover", element }));
    this.knobs = new Knobs(part("knobs-list", HTMLElement), {
      attempt: ({ path }, value) => this.attempts.attempt({ type: "knob", path, value, final: false }),
      write: ({ path }, value) => this.attempts.finish({ type: "knob", path, value, final: true }),
      cancel: () => this.cancel(),
    });
    this.problems = new Problems(part("problems-list", HTMLElement), part("problems-count", HTMLElement), {
      goto: (uri, range) => this.goto(uri, range),
      fix: (problem, fix) => this.send({ type: "fix", problem, fix }),
      point,
    });
    this.watch();
    this.menus();
  }

  /** The pointer, the keys, and the size of the window. */
  watch() {
    watch(this.stage, this.view, {
      click: (event) => this.click(event),
      doubleClick: () => this.fit(),
      move: (event) => this.move(event),
      leave: () => this.leave(),
    });
    listenToKeys(this.stage, this.view, {
      fit: () => this.fit(),
      escape: () => this.pointing.clear(),
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
    exportMenu((format) => this.send({ type: "export", format }));
    this.layers = layersMenu(
      () => this.want(),
      (hasGrid) => {
        this.paper.hasGrid = hasGrid;
        this.place();
      },
    );
    toggle("handles-toggle", (isOn) => this.handles.showAll(isOn));
    toggle("freedom-toggle", (isOn) => {
      this.#isFreedomWanted = isOn;
      this.freedom.toggle(isOn);
      this.panels();
      if (this.#isOpen) this.want();
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

  /** @param {ToHost} message */
  send(message) {
    this.host.send(message);
  }

  open() {
    this.#isOpen = true;
    this.status.connected();
    this.send({ type: "ready" });
    if (this.#wanted().length) this.want();
  }

  /** Tell the host what is wanted beside the drawing: what can move takes it a while to find out. */
  want() {
    this.send({ type: "show", layers: this.#wanted() });
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

  /** @param {FromHost} message */
  receive(message) {
    switch (message.type) {
      case "picture":
        return this.picture(message);
      case "busy":
        return this.status.busy(true);
      case "reveal":
        return this.pointing.revealFromHost(message.elements);
      case "error":
        return this.failed(message.message);
      case "export":
        return download(message.name, message.data);
    }
  }

  /** @param {Preview} preview */
  picture(preview) {
    document.body.classList.remove("lost");
    this.status.busy(false);
    const isAwaited = this.attempts.active;
    this.attempts.answered();
    if (preview.tried && !isAwaited) return; // it was cancelled or written meanwhile
    if (!preview.tried) this.settled = preview;
    this.show(preview);
  }

  /** @param {string} message */
  failed(message) {
    this.status.busy(false);
    this.status.toast(message);
    this.attempts.answered();
    if (!this.attempts.active) this.restore();
  }

  /** Forget what was tried. */
  cancel() {
    this.attempts.finish({ type: "cancel" });
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
    if (preview.source) this.source.show(preview.source, preview.problems.filter(({ uri }) => uri === preview.uri));
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
    const hasSource = Boolean(preview?.source);
    part("source-toggle", HTMLElement).hidden = !hasSource;
    part("source", HTMLElement).hidden = !(hasSource && this.#isSourceWanted);
    part("problems", HTMLElement).hidden = !preview || !(preview.problems.length || preview.conflicts.length);
    const hasKnobs = Boolean(preview?.knobs.length);
    const hasFreedom = this.#isFreedomWanted && Boolean(preview?.motions.length);
    part("knobs", HTMLElement).hidden = !hasKnobs;
    part("freedom", HTMLElement).hidden = !hasFreedom;
    part("side", HTMLElement).hidden = !hasKnobs && !hasFreedom;
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
    if (element !== null && this.preview?.elements[element]?.range) this.send({ type: "goto", element });
  }

  /**
   * @param {string} uri
   * @param {Range} range
   */
  goto(uri, range) {
    this.send({ type: "goto", uri, range });
    if (uri === this.preview?.uri) this.source.mark([range], { scroll: true });
  }

  /**
   * @param {Handle} handle
   * @param {Vec} at
   * @param {DOMRect} where
   */
  tell({ hint, path }, at, where) {
    this.pointing.hover(this.pointing.ownerOf(path));
    const words = [el("strong", {}, coordinates(at, this.view.scale)), el("span", {}, hint)];
    this.tooltip.show(words, where.right - 6, where.bottom - 6);
  }
}

new Pane();
