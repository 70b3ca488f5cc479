// The scopes of every token of every example, as committed: `ACCEPT=1 npm run test:grammar` takes the present ones.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { copyFileSync, readdirSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, relative } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const root = join(here, "../../../..");
const samples = [
  ...readdirSync(join(root, "examples")).filter((file) => file.endsWith(".aidl")).map((file) => join("examples", file)),
  "tests/editors/classes.aidl",
];
const tool = createRequire(import.meta.url).resolve("vscode-tmgrammar-test/dist/snapshot.js");

// The tool looks for a snapshot beside its program, so the programs are brought to the snapshots.
test("the scopes of the examples are those of the snapshots", () => {
  const folder = join(here, "snapshots");
  const copies = samples.map((path) => join(folder, path.split("/").at(-1)));
  samples.forEach((path, i) => copyFileSync(join(root, path), copies[i]));
  try {
    const committed = readdirSync(folder).filter((file) => file.endsWith(".snap")).sort();
    const expected = copies.map((path) => `${relative(folder, path)}.snap`).sort();
    if (!process.env.ACCEPT) assert.deepEqual(committed, expected, "a snapshot for each example");
    const options = process.env.ACCEPT ? ["--updateSnapshot"] : [];
    const grammar = join(root, "editors/vscode/syntaxes/aidl.tmLanguage.json");
    const run = spawnSync(
      process.execPath,
      [tool, ...options, "--config", join(root, "editors/vscode/package.json"), "-g", grammar, "-s", "source.aidl", join(folder, "*.aidl")],
      { encoding: "utf8" },
    );
    assert.equal(run.status, 0, run.stdout + run.stderr);
  } finally {
    for (const path of copies) rmSync(path, { force: true });
  }
});
