/** The worker: Python, the language server in it, and the host of the pane.
 * Texts are messages of the pane, either way; all else is between the page and the worker:
 *     in   { open: { name, text, beside, held } }
 *     out  { stage }, { opened: uri }, { keep: { name, text } }, { busy }, { failed }, { died }
 */

import load from "./manifold.js";
import { begin, FIRST, unpack } from "./engine.js";
import { PYTHON } from "./place.js";

const LATER = "later.pack";
/** Seconds after the first drawing in which what it did without is not fetched yet. */
const PAUSE = 1.5;

const say = (/** @type {unknown} */ message) => self.postMessage(message);
const address = (/** @type {string} */ name) => new URL(name, import.meta.url).href;

/** @param {string} name */
async function fetched(name) {
  const answer = await fetch(address(name));
  if (!answer.ok || !answer.body) throw new Error(`${name} could not be fetched (${answer.status})`);
  return new Response(answer.body.pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}

/** @param {string} name */
function read(name) {
  const asking = new XMLHttpRequest();
  asking.open("GET", address(name), false);
  asking.responseType = "arraybuffer";
  asking.send();
  if (asking.status !== 200) throw new Error(`${name} could not be fetched (${asking.status})`);
  return new Uint8Array(asking.response);
}

async function started() {
  say({ stage: "Fetching Python" });
  const python = new URL(PYTHON, import.meta.url).href;
  const pack = fetched(FIRST);
  const manifold = load();
  const { loadPyodide } = await import(`${python}pyodide.mjs`);
  const py = await loadPyodide({ indexURL: python, stdout: () => {}, stderr: (/** @type {string} */ line) => console.warn(line) });
  // What Python cannot survive, as a nesting deeper than the browser's stack, ends it: the page begins anew.
  py._api.on_fatal = (/** @type {unknown} */ error) => died(error);
  say({ stage: "Loading the language" });
  unpack(py, await pack);
  const desk = begin(py, await manifold, {
    say,
    opened: (uri) => say({ opened: uri }),
    scipy: () => {
      say({ stage: "Fetching scipy, which large programs take: 20 MB, once" });
      py.loadedPackages.numpy = FIRST; // it asks for numpy, which is there
      return py.loadPackage("scipy", { messageCallback: () => {} });
    },
    keep: (name, text) => say({ keep: { name, text } }),
    busy: (isBusy) => say({ busy: isBusy }),
    read,
  });
  return { py, desk };
}

/** @param {any} py */
async function fetchRest(py) {
  const pack = await fetched(LATER);
  if (py.runPython("from aidl_web.inside import fetching; fetching.arrived('later.pack')")) unpack(py, pack);
}

let isDead = false;

/** @param {unknown} error */
function died(error) {
  if (!isDead) say({ died: String(/** @type {Error} */ (error)?.message ?? error) });
  isDead = true;
}

const starting = started();
starting.catch((error) => say({ failed: String(error?.message ?? error) }));
let isRestAsked = false;

/** Messages that came while Python was still starting have their turn in order. */
self.addEventListener("message", async ({ data }) => {
  const { py, desk } = await starting;
  try {
    if (typeof data === "string") {
      desk.hear(data);
      return;
    }
    const { name, text, beside, held } = data.open;
    say({ stage: "Drawing" });
    await desk.open(name, text, py.toPy(beside), held);
    if (!isRestAsked) {
      isRestAsked = true;
      setTimeout(() => fetchRest(py).catch((error) => console.warn(error)), PAUSE * 1000);
    }
  } catch (error) {
    died(error);
  }
});
