/** Trying values while something is dragged: the host is asked one thing at a time, and next always the newest.
 * @import { Attempt } from "./protocol.js"
 */

/** After so long an answer is not waited for. */
const PATIENCE = 3000;
/** Milliseconds without anything newer after which what is wrong is looked into. */
const REST = 350;

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

  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #resting = undefined;

  /** @param {(attempt: Attempt & { rests?: boolean }, isWanted: () => boolean) => Promise<boolean>} show asks for it and
   *   shows what comes, if that is wanted still; tells whether that is to be looked into; does not reject */
  constructor(show) {
    this.show = show;
  }

  /** @param {Attempt} attempt */
  attempt(attempt) {
    this.active = true;
    clearTimeout(this.#resting);
    if (this.#isAsked) this.#next = attempt;
    else this.#ask(attempt);
  }

  /** What was tried is over: something is written, or forgotten. */
  forget() {
    clearTimeout(this.#timer);
    clearTimeout(this.#resting);
    this.#asked += 1;
    this.#next = null;
    this.#isAsked = false;
    this.active = false;
  }

  /** @param {Attempt & { rests?: boolean }} attempt */
  #ask(attempt) {
    const asked = ++this.#asked;
    this.#isAsked = true;
    this.#timer = setTimeout(() => this.#answered(asked), PATIENCE);
    void this.show(attempt, () => this.active && asked === this.#asked).then((isWrong) => {
      const isLast = asked === this.#asked && this.#isAsked && this.#next === null;
      this.#answered(asked);
      if (isWrong && isLast && !attempt.rests) {
        this.#resting = setTimeout(() => this.#ask({ ...attempt, rests: true }), REST);
      }
    });
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
