/** Compiles the Python of a tree as the browser's Python wants it, and tells which files a first drawing takes.
 *
 *     node prepare.mjs PYODIDE MANIFOLD TREE NAME…
 *
 * A file under a folder of one of the names is compiled without its docstrings. Writes the files of the first drawing,
 * one a line, to standard output.
 */
import { readFileSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { begin, HOME } from "../page/engine.js";

const [pyodide, manifold, tree, ...bare] = process.argv.slice(2);
if (!pyodide || !manifold || !tree) throw new Error("prepare.mjs PYODIDE MANIFOLD TREE NAME…");
process.on("uncaughtException", (error) => {
  console.error(String(error.stack ?? error)); // not the line of Pyodide's that Node would show, of a megabyte
  process.exit(1);
});
const { loadPyodide } = await import(pathToFileURL(join(resolve(pyodide), "pyodide.mjs")).href);
const { default: load } = await import(pathToFileURL(join(resolve(manifold), "manifold.js")).href);
const py = await loadPyodide({ indexURL: `${resolve(pyodide)}/`, stdout: (/** @type {string} */ line) => console.error(line) });
py.FS.mkdirTree(HOME);
py.FS.mount(py.FS.filesystems.NODEFS, { root: resolve(tree) }, HOME);
py.globals.set("BARE", py.toPy(bare));
py.runPython(`
import os, py_compile
for folder, _, names in os.walk("${HOME}"):
    for name in names:
        path = os.path.join(folder, name)
        if name.endswith(".py"):
            inner = os.path.relpath(path, "${HOME}")
            level = 2 if inner.split(os.sep)[0] in BARE else 0
            mode = py_compile.PycInvalidationMode.UNCHECKED_HASH
            py_compile.compile(path, path + "c", inner, doraise=True, optimize=level, invalidation_mode=mode)
            os.remove(path)
`);
/** @type {(message: any) => void} */
let heard = () => {};
let opened = "";
const desk = begin(py, await load(), {
  say: (message) => heard(JSON.parse(message)),
  opened: (uri) => void (opened = uri),
  scipy: () => py.loadPackage("scipy"),
  keep: () => {},
  busy: () => {},
  read: (name) => {
    throw new Error(`${name} was asked for`);
  },
});
for (const name of ["motor_bracket.aidl", "gallery/teapot.aidl", "tram.aidl"]) {
  const text = readFileSync(join(tree, "aidl_lang/_data/examples", name), "utf8");
  await desk.open(name, text, py.toPy({}));
  const asked = { jsonrpc: "2.0", id: 1, method: "aidl/preview", params: { uri: opened, show: [] } };
  const shown = new Promise((resolve) => {
    heard = (message) => {
      if (message.id === 1) resolve(message.result?.svg);
    };
  });
  desk.hear(JSON.stringify(asked));
  if (!(await shown)) throw new Error(`${name} was not drawn`);
}
const files = py.runPython(`
import sys
found = {m.__spec__.origin for m in list(sys.modules.values()) if getattr(m, "__spec__", None) and m.__spec__.origin}
sorted(f.removeprefix("${HOME}/") for f in found if f.startswith("${HOME}/"))
`).toJs();
process.stdout.write(`${files.join("\n")}\n`);
process.exit(0);
