// Bundles the extension into dist/extension.js and copies what it ships but does not own: the preview pane and the
// licence. `--minify` for the package, `--tests` to bundle tests/*.test.ts beside it.

import { build } from "esbuild";
import { cp, copyFile, readdir, rm } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const root = join(here, "..", "..");
const options = new Set(process.argv.slice(2));

const common = {
  absWorkingDir: here,
  bundle: true,
  platform: "node",
  target: "node20",
  format: "cjs",
  external: ["vscode"],
  logLevel: "warning",
};

await build({
  ...common,
  entryPoints: ["src/extension.ts"],
  outfile: "dist/extension.js",
  minify: options.has("--minify"),
  sourcemap: options.has("--minify") ? false : "linked",
});

const pane = join(root, "server", "aidl_server", "preview", "pane");
await rm(join(here, "media"), { recursive: true, force: true });
await cp(pane, join(here, "media", "pane"), {
  recursive: true,
  filter: (source) => !/(\.d\.ts|[\\/](editor\..*|words\.js))$/.test(source), // the text is in VS Code's own editor
});
await copyFile(join(root, "LICENSE"), join(here, "LICENSE"));

if (options.has("--tests")) {
  await rm(join(here, "dist", "tests"), { recursive: true, force: true });
  const tests = (await readdir(join(here, "tests"))).filter((name) => name.endsWith(".test.ts"));
  await build({
    ...common,
    entryPoints: tests.map((name) => join("tests", name)),
    outdir: "dist/tests",
    sourcemap: "inline",
  });
}
