/** How things stand: the status bar, the banners over the drawing, what is shown in place of one, and toasts.
 * @import { Preview, Status } from "./protocol.js"
 */

import { el, icon, part, quoted } from "./dom.js";
import { shown } from "./numbers.js";

const WORDS = /** @type {Record<Status, string>} */ ({
  solved: "Solved",
  partial: "Partly solved",
  failed: "Not solved",
  wrong: "Has errors",
});
const TOAST_SECONDS = 8;

export class StatusView {
  #status = part("status", HTMLElement);
  #freedom = part("status-freedom", HTMLElement);
  #size = part("status-size", HTMLElement);
  #time = part("status-time", HTMLElement);
  #stale = part("stale", HTMLElement);
  #staleText = part("stale-text", HTMLElement);
  #empty = part("empty", HTMLElement);
  #emptyTitle = part("empty-title", HTMLElement);
  #emptyText = part("empty-text", HTMLElement);
  #disconnected = part("disconnected", HTMLElement);
  #disconnectedText = part("disconnected-text", HTMLElement);
  #toasts = part("toasts", HTMLElement);
  #busy = part("busy", HTMLElement);

  /** @param {Preview} preview */
  show({ status, stale, tried, svg, box, seconds, degrees, problems }) {
    this.#status.className = `status ${status}`;
    tell(this.#status, (WORDS[status] ?? status) + (tried ? " (tried, not in the text)" : ""));
    const [left, bottom, right, top] = box;
    tell(this.#freedom, degrees === null || stale ? "" : freedom(degrees));
    tell(this.#size, svg === null ? "" : `${shown(right - left)} × ${shown(top - bottom)} mm`);
    tell(this.#time, seconds < 1 ? `${Math.round(seconds * 1000)} ms` : `${shown(seconds)} s`);
    const first = problems.find((problem) => problem.severity === "error");
    const where = first?.range ? ` (line ${first.range.start.line + 1})` : "";
    const why = () => (first ? [...quoted(first.message), where] : []);
    this.#stale.hidden = !stale || svg === null;
    this.#staleText.replaceChildren(...(first ? why() : ["The program does not draw at the moment."]));
    this.#empty.hidden = svg !== null;
    tell(this.#emptyTitle, first ? "There is no drawing yet" : "Nothing is drawn yet");
    this.#emptyText.replaceChildren(...(first ? why() : ["Write a program, and it is drawn here."]));
  }

  /** @param {boolean} isBusy */
  busy(isBusy) {
    this.#busy.hidden = !isBusy;
  }

  connected() {
    this.#disconnected.hidden = true;
  }

  /**
   * @param {number} seconds until the next try
   * @param {string} reason why, if that is known
   */
  lost(seconds, reason) {
    this.#disconnected.hidden = false;
    this.#status.className = "status";
    tell(this.#status, "Not connected");
    const why = reason || "Is \u201caidl preview\u201d still running?";
    tell(this.#disconnectedText, `${why} The next try comes in ${shown(seconds, 1)} s.`);
    this.busy(false);
  }

  /**
   * @param {string} message
   * @param {"error" | "warning"} [kind]
   */
  toast(message, kind = "error") {
    const isThere = [...this.#toasts.children].some((toast) => toast.getAttribute("data-message") === message);
    if (isThere) return;
    const close = el("button", { type: "button", class: "tool small", "aria-label": "Close" }, icon("close"));
    const toast = el("div", { class: `toast ${kind}`, "data-message": message }, icon(kind), el("p", {}, ...quoted(message)), close);
    close.addEventListener("click", () => toast.remove());
    setTimeout(() => toast.remove(), TOAST_SECONDS * 1000);
    this.#toasts.append(toast);
    while (this.#toasts.children.length > 4) this.#toasts.firstElementChild?.remove();
  }
}

/** @param {number} degrees */
function freedom(degrees) {
  if (degrees === 0) return "fully constrained";
  return `${degrees} degree${degrees === 1 ? "" : "s"} of freedom`;
}

/**
 * Live regions are read out when they are set, so only what is new is set.
 * @param {HTMLElement} element
 * @param {string} text
 */
function tell(element, text) {
  if (element.textContent !== text) element.textContent = text;
}
