// Bundles the editor of the preview's pane: server/aidl_server/preview/pane/editor.js, which ships as it is, so that nobody
// needs Node to see a program, and the licences of what is in it. `--check` writes nothing, and fails if they are others.
//
// The words of the language stay outside: the pane has them in a file of its own (words.js), which `make colours` writes.

import { createHash } from "node:crypto";
import { readFile, writeFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = dirname(fileURLToPath(import.meta.url));
const project = dirname(here);
const pane = join(project, "..", "..", "server", "aidl_server", "preview", "pane");
/** What the bundle is made of, below editors/codemirror: server/tests/preview/test_bundle.py has the same list. */
const SOURCES = [
  "package-lock.json", "pane/build.mjs", "pane/editor.ts", "src/aidl.grammar", "src/complete.ts", "src/highlight.ts",
  "src/index.ts", "src/tokens.ts",
];

const digest = createHash("sha256");
for (const source of SOURCES) digest.update(await readFile(join(project, source)));
const made = await build({
  absWorkingDir: project,
  entryPoints: ["pane/editor.ts"],
  bundle: true,
  minify: true,
  format: "esm",
  target: "es2022",
  external: ["./words.js"],
  legalComments: "none",
  banner: { js: `// Made by \`npm run pane\` in editors/codemirror; do not edit. Of: ${digest.digest("hex")}\n// @ts-nocheck` },
  write: false,
  metafile: true,
  logLevel: "warning",
});

const packages = new Set();
for (const input of Object.keys(made.metafile.inputs)) {
  const found = /node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(input);
  if (found) packages.add(found[1]);
}
const licences = [];
for (const name of [...packages].sort()) {
  licences.push(`${name}\n\n${(await readFile(join(project, "node_modules", name, "LICENSE"), "utf8")).trim()}\n`);
}
const files = {
  "editor.js": made.outputFiles[0].text,
  "editor.LICENSES.txt": `What is in editor.js, besides what is in this repository:\n\n${licences.join("\n\n")}`,
};

for (const [name, text] of Object.entries(files)) {
  const file = join(pane, name);
  if (!process.argv.includes("--check")) await writeFile(file, text);
  else if ((await readFile(file, "utf8").catch(() => "")) !== text) {
    console.error(`${name} is not what its sources make: run \`npm run pane\` in editors/codemirror`);
    process.exitCode = 1;
  }
}
