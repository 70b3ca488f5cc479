/** Python with AIDL in it: in the worker of the page, and in Node for the build and its tests.
 * @typedef {object} Outside
 * @property {(message: string) => void} say a message for the pane
 * @property {(uri: string) => void} opened a program is open from now on
 * @property {() => Promise<unknown>} scipy has it fetched
 * @property {(name: string, text: string) => void} keep the text of the program, whenever it has changed
 * @property {(isBusy: boolean) => void} busy what is asked has to wait, or does not any more
 * @property {(name: string) => Uint8Array} read a file of the site, at once
 */

import { kernelOf } from "./kernel.js";

/** Where the packs go. */
export const HOME = "/aidl";
/** What Python needs to begin with; the rest comes when it is asked for, or in a pause. */
export const FIRST = "first.pack";

/**
 * Writes the files of a pack: the length of its table, the table as JSON, and the files one after the other.
 * @param {any} py
 * @param {ArrayBuffer} pack
 */
export function unpack(py, pack) {
  const size = new DataView(pack).getUint32(0, true);
  const table = JSON.parse(new TextDecoder().decode(new Uint8Array(pack, 4, size)));
  let at = 4 + size;
  const folders = new Set();
  for (const [name, length] of table) {
    const path = `${HOME}/${name}`;
    const folder = path.slice(0, path.lastIndexOf("/"));
    if (!folders.has(folder)) {
      py.FS.mkdirTree(folder);
      folders.add(folder);
    }
    py.FS.writeFile(path, new Uint8Array(pack, at, length), { canOwn: true });
    at += length;
  }
}

/**
 * Has Python begin with what is in `HOME`.
 * @param {any} py
 * @param {any} module what the package `manifold-3d` loads
 * @param {Outside} outside
 * @returns {any} the desk of `aidl_web/inside/hosting.py`
 */
export function begin(py, module, outside) {
  py.registerJsModule("aidl_outside", { ...outside, kernel: kernelOf(module), unpack: (/** @type {ArrayBuffer} */ pack) => unpack(py, pack) });
  return py.runPython(`
import sys
sys.path.insert(0, "${HOME}")
from aidl_web.inside import start
start.begin()
`);
}
