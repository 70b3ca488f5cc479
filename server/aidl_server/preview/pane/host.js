/** The ways to a host: the page is a webview of VS Code, or it talks on a line, which is a WebSocket to `aidl preview` or
 * what the page has in its place. By each it speaks JSON-RPC: the requests of the language server below `aidl/`.
 * @import { Ask, Line, Message, Tell, Told, VsCodeApi } from "./protocol.js"
 */

/**
 * @typedef {object} Host
 * @property {Ask} ask rejects with a `Refusal`; what is asked while there is no connection is overtaken
 * @property {Tell} tell what is told while there is no connection is lost
 * @property {() => void} reconnect
 * @property {VsCodeApi | null} code
 */

/**
 * @typedef {object} Listener
 * @property {(told: Told) => void} told
 * @property {() => void} open the host is there, for the first time or again
 * @property {(seconds: number, reason: string) => void} lost the connection is gone, for a reason if the host told
 *   one; the next try comes in so many seconds
 */

const FIRST_WAIT = 0.5;
const LONGEST_WAIT = 10;

/** Codes of requests that were overtaken by another, or by the text: nothing that a reader should be told. */
const OVERTAKEN = new Set([-32800, -32801, -32802]);

/** Why something was not answered. */
export class Refusal extends Error {
  /**
   * @param {number} code
   * @param {string} message
   */
  constructor(code, message) {
    super(message);
    this.isOvertaken = OVERTAKEN.has(code);
  }
}

/**
 * @param {Listener} listener
 * @returns {Host}
 */
export function connect(listener) {
  if (typeof acquireVsCodeApi === "function") return webview(acquireVsCodeApi(), listener);
  return new Caller(typeof dialAidl === "function" ? dialAidl : socket, listener);
}

/** Requests that wait for their answers. */
class Conversation {
  #count = 0;
  /** @type {Map<number, { resolve: (result: any) => void, reject: (reason: Refusal) => void }>} */
  #waiting = new Map();

  /**
   * @param {(message: Message) => boolean} post false if it is lost
   * @param {(told: Told) => void} told
   */
  constructor(post, told) {
    this.post = post;
    this.told = told;
    this.ask = /** @type {Ask} */ ((method, params) => this.#ask(method, params));
    this.tell = /** @type {Tell} */ ((method, params) => void this.post({ jsonrpc: "2.0", method, params }));
  }

  /**
   * @param {string} method
   * @param {unknown} params
   * @returns {Promise<any>}
   */
  #ask(method, params) {
    return new Promise((resolve, reject) => {
      const id = ++this.#count;
      this.#waiting.set(id, { resolve, reject });
      if (!this.post({ jsonrpc: "2.0", id, method, params })) this.#end(id)?.reject(lost());
    });
  }

  /** @param {number} id */
  #end(id) {
    const waiting = this.#waiting.get(id);
    this.#waiting.delete(id);
    return waiting;
  }

  /** @param {unknown} data what the host sends; what is no message is passed over */
  hear(data) {
    if (!isObject(data)) return;
    if (typeof data["method"] === "string" && isObject(data["params"] ?? {})) {
      if (TOLD.has(data["method"])) this.told(/** @type {Told} */ (/** @type {unknown} */ (data)));
    } else if (typeof data["id"] === "number") {
      const waiting = this.#end(data["id"]);
      const error = data["error"];
      if (isObject(error)) waiting?.reject(new Refusal(Number(error["code"]), String(error["message"])));
      else waiting?.resolve(data["result"] ?? null);
    }
  }

  /** Nothing will be answered any more. */
  break() {
    for (const id of [...this.#waiting.keys()]) this.#end(id)?.reject(lost());
  }
}

const lost = () => new Refusal(-32800, "The connection is lost.");
const TOLD = new Set(["aidl/previewChanged", "aidl/text", "aidl/busy", "aidl/reveal", "window/showMessage"]);

/**
 * @param {VsCodeApi} code
 * @param {Listener} listener
 * @returns {Host}
 */
function webview(code, listener) {
  const post = (/** @type {Message} */ message) => {
    code.postMessage(message);
    return true;
  };
  const conversation = new Conversation(post, listener.told);
  window.addEventListener("message", (event) => conversation.hear(event.data));
  queueMicrotask(listener.open);
  return { code, ask: conversation.ask, tell: conversation.tell, reconnect: () => {} };
}

/** @returns {Line} */
function socket() {
  const url = new URL(document.body.dataset.socket || "socket", location.href);
  url.protocol = url.protocol.replace(/^http/, "ws");
  return new WebSocket(url);
}

/** @implements {Host} */
class Caller {
  code = null;
  /** @type {Line | null} */
  #line = null;
  #wait = FIRST_WAIT;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #timer = undefined;

  /**
   * @param {() => Line} dial
   * @param {Listener} listener
   */
  constructor(dial, listener) {
    this.dial = dial;
    this.listener = listener;
    this.conversation = new Conversation((message) => this.#post(message), listener.told);
    this.ask = this.conversation.ask;
    this.tell = this.conversation.tell;
    this.reconnect = this.reconnect.bind(this);
    this.#open();
  }

  /** @param {Message} message */
  #post(message) {
    if (this.#line?.readyState !== WebSocket.OPEN) return false;
    this.#line.send(JSON.stringify(message));
    return true;
  }

  reconnect() {
    if (this.#line !== null) return;
    this.#wait = FIRST_WAIT;
    this.#open();
  }

  #open() {
    clearTimeout(this.#timer);
    const line = (this.#line = this.dial());
    line.addEventListener("open", () => this.listener.open());
    line.addEventListener("message", (event) => {
      this.#wait = FIRST_WAIT; // a host that takes no more pages opens the connection to say so
      this.conversation.hear(parsed(event.data));
    });
    line.addEventListener("close", ({ reason }) => {
      this.#line = null;
      this.conversation.break();
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

/**
 * @param {unknown} data
 * @returns {data is Record<string, unknown>}
 */
function isObject(data) {
  return typeof data === "object" && data !== null && !Array.isArray(data);
}
