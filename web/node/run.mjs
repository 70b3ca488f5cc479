/** Runs a Python script in the playground's Python, without a page.
 *
 *     node run.mjs SITE SCRIPT ARGUMENT…
 *
 * The files of this machine are below /host.
 */
import { readFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { gunzipSync } from "node:zlib";
import { begin, FIRST, unpack } from "../page/engine.js";

const [given, script, ...rest] = process.argv.slice(2);
if (!given || !script) throw new Error("run.mjs SITE SCRIPT ARGUMENT…");
const site = resolve(given);
process.on("uncaughtException", (error) => {
  console.error(String(error.stack ?? error)); // not the line of Pyodide's that Node would show, of a megabyte
  process.exit(1);
});
const bring = (/** @type {string} */ name) => import(pathToFileURL(join(site, name)).href);
const { loadPyodide } = await bring("pyodide/pyodide.mjs");
const { default: load } = await bring("manifold.js");
const py = await loadPyodide({ indexURL: `${join(site, "pyodide")}/` });
const { buffer, byteOffset, length } = gunzipSync(readFileSync(join(site, FIRST)));
unpack(py, buffer.slice(byteOffset, byteOffset + length));
py.FS.mkdirTree("/host");
py.FS.mount(py.FS.filesystems.NODEFS, { root: "/" }, "/host");
begin(py, await load(), {
  say: () => {},
  opened: () => {},
  scipy: () => py.loadPackage("scipy"),
  keep: () => {},
  busy: () => {},
  read: (name) => new Uint8Array(readFileSync(join(site, name))),
});
py.globals.set("ARGUMENTS", py.toPy(rest));
await py.runPythonAsync(readFileSync(script, "utf8"));
process.exit(0);
