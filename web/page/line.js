/** The line between the pane and its host in the worker: what of a WebSocket the pane needs. It is the worker's life, too.
 * @import { Line } from "./pane/protocol.js"
 */

/** Milliseconds of work after which it is told, with a button that ends it. */
const LONG = 1200;

/** @typedef {{ name: string, text: string, beside?: Record<string, Uint8Array>, held?: boolean }} Program */

/**
 * @typedef {object} Watcher
 * @property {(stage: string) => void} stage how far a worker that starts has come; empty once the program is open
 * @property {(uri: string) => void} opened
 * @property {(program: { name: string, text: string }) => void} keep
 * @property {(isLong: boolean) => void} long whether it works for long
 * @property {(reason: string) => void} failed it could not begin
 * @property {(reason: string) => void} died it has ended by itself
 * @property {(message: any) => any} asked a message of the pane, which may be changed; null if it goes no further
 * @property {(message: any) => any} told a message to the pane, the same
 */

/** @implements {Line} */
export class WorkerLine extends EventTarget {
  readyState = /** @type {number} */ (WebSocket.CONNECTING);
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #timer = undefined;

  /** @param {Watcher} watcher */
  constructor(watcher) {
    super();
    this.watcher = watcher;
    this.worker = new Worker(new URL("worker.js", import.meta.url), { type: "module" });
    this.worker.addEventListener("message", ({ data }) => this.#heard(data));
    this.worker.addEventListener("error", (event) => this.#broke(event.message || "its script could not be loaded"));
  }

  /** @param {Program} program in place of the one that is open */
  open(program) {
    this.worker.postMessage({ open: { beside: {}, held: false, ...program } });
  }

  /** @param {string} text */
  send(text) {
    const message = this.watcher.asked(JSON.parse(text));
    if (message !== null) this.worker.postMessage(JSON.stringify(message));
  }

  /** @param {string} reason */
  close(reason) {
    if (this.readyState === WebSocket.CLOSED) return;
    this.readyState = WebSocket.CLOSED;
    this.#working(false);
    this.worker.terminate();
    this.dispatchEvent(Object.assign(new Event("close"), { reason }));
  }

  /** @param {any} data */
  #heard(data) {
    if (this.readyState === WebSocket.CLOSED) return;
    const { watcher } = this;
    if (typeof data === "string") {
      const message = watcher.told(JSON.parse(data));
      if (message !== null) this.tell(message);
    } else if ("stage" in data) watcher.stage(data.stage);
    else if ("busy" in data) this.#working(data.busy);
    else if ("keep" in data) watcher.keep(data.keep);
    else if ("opened" in data) {
      this.readyState = WebSocket.OPEN;
      watcher.opened(data.opened);
      this.dispatchEvent(new Event("open"));
    } else if ("failed" in data) this.watcher.failed(data.failed);
    else if ("died" in data) this.#broke(data.died);
  }

  /** @param {unknown} message for the pane */
  tell(message) {
    this.dispatchEvent(new MessageEvent("message", { data: JSON.stringify(message) }));
  }

  /** @param {boolean} isWorking */
  #working(isWorking) {
    clearTimeout(this.#timer);
    if (isWorking) this.#timer = setTimeout(() => this.watcher.long(true), LONG);
    else this.watcher.long(false);
  }

  /** @param {string} reason */
  #broke(reason) {
    if (this.readyState === WebSocket.OPEN) this.watcher.died(reason);
    else this.watcher.failed(reason);
  }
}
