/** The two ways to a host: the page is a webview of VS Code, or it talks to `aidl preview` by a WebSocket.
 * @import { FromHost, ToHost, VsCodeApi } from "./protocol.js"
 */

/**
 * @typedef {object} Host
 * @property {(message: ToHost) => void} send what is sent while there is no connection is lost
 * @property {() => void} reconnect
 * @property {VsCodeApi | null} code
 */

/**
 * @typedef {object} Listener
 * @property {(message: FromHost) => void} message
 * @property {() => void} open the host is there, for the first time or again
 * @property {(seconds: number, reason: string) => void} lost the connection is gone, for a reason if the host told
 *   one; the next try comes in so many seconds
 */

const FIRST_WAIT = 0.5;
const LONGEST_WAIT = 10;

/**
 * @param {Listener} listener
 * @returns {Host}
 */
export function connect(listener) {
  if (typeof acquireVsCodeApi === "function") return webview(acquireVsCodeApi(), listener);
  return new Socket(document.body.dataset.socket || "socket", listener);
}

/**
 * @param {VsCodeApi} code
 * @param {Listener} listener
 * @returns {Host}
 */
function webview(code, listener) {
  window.addEventListener("message", (event) => {
    if (isMessage(event.data)) listener.message(event.data);
  });
  queueMicrotask(listener.open);
  return { code, send: (message) => code.postMessage(message), reconnect: () => {} };
}

/** @implements {Host} */
class Socket {
  code = null;
  /** @type {WebSocket | null} */
  #socket = null;
  #wait = FIRST_WAIT;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #timer = undefined;

  /**
   * @param {string} address relative to the page
   * @param {Listener} listener
   */
  constructor(address, listener) {
    this.listener = listener;
    this.url = new URL(address, location.href);
    this.url.protocol = this.url.protocol.replace(/^http/, "ws");
    this.send = this.send.bind(this);
    this.reconnect = this.reconnect.bind(this);
    this.#open();
  }

  /** @param {ToHost} message */
  send(message) {
    if (this.#socket?.readyState === WebSocket.OPEN) this.#socket.send(JSON.stringify(message));
  }

  reconnect() {
    if (this.#socket !== null) return;
    this.#wait = FIRST_WAIT;
    this.#open();
  }

  #open() {
    clearTimeout(this.#timer);
    const socket = (this.#socket = new WebSocket(this.url));
    socket.addEventListener("open", () => this.listener.open());
    socket.addEventListener("message", (event) => {
      this.#wait = FIRST_WAIT; // a host that takes no more pages opens the connection to say so
      const message = parsed(event.data);
      if (isMessage(message)) this.listener.message(message);
    });
    socket.addEventListener("close", ({ reason }) => {
      this.#socket = null;
      this.#timer = setTimeout(() => this.#open(), this.#wait * 1000);
      this.listener.lost(this.#wait, reason);
      this.#wait = Math.min(this.#wait * 2, LONGEST_WAIT);
    });
  }
}

/** @param {unknown} data */
function parsed(data) {
  if (typeof data !== "string") return null;
  try {
    return /** @type {unknown} */ (JSON.parse(data));
  } catch {
    return null;
  }
}

const TYPES = new Set(["picture", "busy", "reveal", "error", "export"]);

/**
 * @param {unknown} data
 * @returns {data is FromHost}
 */
function isMessage(data) {
  return typeof data === "object" && data !== null && "type" in data && TYPES.has(String(data.type));
}
