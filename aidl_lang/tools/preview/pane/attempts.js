/** Trying values while something is dragged: the host is asked one thing at a time, and next always the newest.
 * @import { Attempt } from "./protocol.js"
 */

/** After so long an answer is not waited for. */
const PATIENCE = 3000;

export class Attempts {
  /** @type {Attempt | null} */
  #next = null;
  /** What is under way; its answer counts while it is the last. */
  #asked = 0;
  #isAsked = false;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #timer = undefined;
  /** Whether what is shown may be of values that are not in the text. */
  active = false;

  /** @param {(attempt: Attempt, isWanted: () => boolean) => Promise<void>} show asks for it and shows what comes, if that
   *   is wanted still; does not reject */
  constructor(show) {
    this.show = show;
  }

  /** @param {Attempt} attempt */
  attempt(attempt) {
    this.active = true;
    if (this.#isAsked) this.#next = attempt;
    else this.#ask(attempt);
  }

  /** What was tried is over: something is written, or forgotten. */
  forget() {
    clearTimeout(this.#timer);
    this.#asked += 1;
    this.#next = null;
    this.#isAsked = false;
    this.active = false;
  }

  /** @param {Attempt} attempt */
  #ask(attempt) {
    const asked = ++this.#asked;
    this.#isAsked = true;
    this.#timer = setTimeout(() => this.#answered(asked), PATIENCE);
    void this.show(attempt, () => this.active && asked === this.#asked).then(() => this.#answered(asked));
  }

  /** @param {number} asked */
  #answered(asked) {
    if (asked !== this.#asked || !this.#isAsked) return;
    clearTimeout(this.#timer);
    this.#isAsked = false;
    const next = this.#next;
    this.#next = null;
    if (next) this.#ask(next);
  }
}
