import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

import { installFake } from "./fake_vscode";
import { settled } from "./gate";

const ROOT = join(__dirname, "..", "..");
const manifest = JSON.parse(readFileSync(join(ROOT, "package.json"), "utf8"));
const { contributes } = manifest;
const bundled = join(ROOT, "dist", "extension.js");

test("activated in plain node, it registers the commands it contributes and no others", async () => {
  const path = process.env["PATH"];
  process.env["PATH"] = "";
  try {
    const recorded = installFake();
    const extension = require(bundled) as { activate: (context: object) => void; deactivate: () => Promise<void> };
    const subscriptions: unknown[] = [];
    extension.activate({ subscriptions, extensionUri: "extension" });
    await settled();
    const contributed = contributes.commands.map(({ command }: { command: string }) => command);
    assert.deepEqual(recorded.commands.sort(), contributed.sort());
    assert.deepEqual(recorded.serializers, ["aidl.preview"]);
    assert.match(recorded.messages.join(), /"aidl".*was not found.*pip install "aidl-lang\[editor\]"/);
    assert.ok(subscriptions.length > contributed.length);
    await extension.deactivate();
  } finally {
    process.env["PATH"] = path;
  }
});

test("the panel's type is the one that wakes the extension", () => {
  assert.deepEqual(manifest.activationEvents, ["onWebviewPanel:aidl.preview"]);
});

test("menus and keys name commands that exist", () => {
  const commands = new Set(contributes.commands.map(({ command }: { command: string }) => command));
  const named = [...Object.values(contributes.menus).flat(), ...contributes.keybindings] as { command: string }[];
  for (const { command } of named) assert.ok(commands.has(command), command);
});

test("every file that the manifest names is there", () => {
  const [language] = contributes.languages;
  const files = [
    manifest.main,
    manifest.icon,
    language.configuration,
    language.icon.light,
    language.icon.dark,
    ...contributes.grammars.map(({ path }: { path: string }) => path),
    ...contributes.snippets.map(({ path }: { path: string }) => path),
    "media/pane/index.html",
    "media/pane/main.js",
  ];
  for (const file of files) assert.ok(existsSync(join(ROOT, file)), file);
});

test("grammars have the scopes that the manifest says", () => {
  for (const { path, scopeName } of contributes.grammars)
    assert.equal(JSON.parse(readFileSync(join(ROOT, path), "utf8")).scopeName, scopeName);
});

test("every setting has a description and a default that fits its type", () => {
  for (const [name, setting] of Object.entries<Record<string, unknown>>(contributes.configuration.properties)) {
    assert.match(name, /^aidl\./);
    assert.ok(setting["description"] ?? setting["markdownDescription"], name);
    const value = setting["default"];
    const type = Array.isArray(value) ? "array" : Number.isInteger(value) ? "integer" : typeof value;
    assert.equal(type, setting["type"], name);
  }
});

test("what the bundle requires is in it, in VS Code or in node", () => {
  const required = [...readFileSync(bundled, "utf8").matchAll(/\brequire\("([^"]+)"\)/g)].map((match) => match[1] ?? "");
  const builtin = new Set(["vscode", ...require("node:module").builtinModules]);
  assert.ok(required.length > 3);
  for (const name of required) assert.ok(builtin.has(name.replace(/^node:/, "")), name);
});

test("the lock names no registry but the public one", () => {
  const lock = JSON.parse(readFileSync(join(ROOT, "package-lock.json"), "utf8"));
  for (const [name, { resolved }] of Object.entries<{ resolved?: string }>(lock.packages))
    if (resolved !== undefined) assert.ok(resolved.startsWith("https://registry.npmjs.org/"), name);
});
