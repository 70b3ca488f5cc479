/** Trying values while something is dragged: the host is asked one thing at a time, and next always the newest.
 * @import { ToHost } from "./protocol.js"
 */

/** After so long an answer is not waited for. */
const PATIENCE = 3000;

export class Attempts {
  /** @type {ToHost | null} */
  #next = null;
  #asked = false;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #timer = undefined;
  /** Whether what is shown may be of values that are not in the text. */
  active = false;

  /** @param {(message: ToHost) => void} send */
  constructor(send) {
    this.send = send;
  }

  /** @param {ToHost} message */
  attempt(message) {
    this.active = true;
    if (this.#asked) this.#next = message;
    else this.#ask(message);
  }

  /** A picture or an error has come. */
  answered() {
    clearTimeout(this.#timer);
    this.#asked = false;
    const next = this.#next;
    this.#next = null;
    if (next) this.#ask(next);
  }

  /**
   * The last word, which is sent at once: what to write, or to forget what was tried.
   * @param {ToHost} message
   */
  finish(message) {
    this.forget();
    this.send(message);
  }

  forget() {
    clearTimeout(this.#timer);
    this.#next = null;
    this.#asked = false;
    this.active = false;
  }

  /** @param {ToHost} message */
  #ask(message) {
    this.#asked = true;
    this.#timer = setTimeout(() => this.answered(), PATIENCE);
    this.send(message);
  }
}
