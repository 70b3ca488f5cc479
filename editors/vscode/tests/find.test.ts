import assert from "node:assert/strict";
import { test } from "node:test";

import { findServer, installLine, isFound, otherVerb, type Surroundings } from "../src/server/find";

const around = (files: string[], changes: Partial<Surroundings> = {}): Surroundings => ({
  platform: "linux",
  home: "/home/me",
  path: "/usr/local/bin::/usr/bin",
  folders: ["/work/parts", "/work/more"],
  python: "/opt/python/bin/python3",
  isProgram: (file) => files.includes(file),
  ...changes,
});

const found = (command: string[], surroundings: Surroundings): string | undefined => {
  const result = findServer(command, surroundings);
  return isFound(result) ? [result.program, ...result.arguments].join(" ") : undefined;
};

const PLACES = [
  "/usr/local/bin/aidl",
  "/usr/bin/aidl",
  "/work/parts/.venv/bin/aidl",
  "/work/more/.venv/bin/aidl",
  "/opt/python/bin/aidl",
];

test("the PATH comes first, then the folders' .venv, then the selected Python", () => {
  PLACES.forEach((place, index) => assert.equal(found(["aidl", "lsp"], around(PLACES.slice(index))), `${place} lsp`));
});

test("where it was looked for is told", () => {
  assert.deepEqual(findServer(["aidl", "lsp"], around([])), { name: "aidl", places: PLACES });
});

test("with no folders and no Python only the PATH counts", () => {
  const bare = around(PLACES.slice(2), { folders: [], python: null });
  assert.deepEqual(findServer(["aidl"], bare), { name: "aidl", places: PLACES.slice(0, 2) });
});

test("a path is taken as it is, with ~ and the folder filled in", () => {
  const files = ["/opt/aidl", "/home/me/bin/aidl", "/work/parts/env/bin/aidl"];
  assert.equal(found(["/opt/aidl", "lsp", "--x"], around(files)), "/opt/aidl lsp --x");
  assert.equal(found(["~/bin/aidl"], around(files)), "/home/me/bin/aidl");
  assert.equal(found(["${workspaceFolder}/env/bin/aidl"], around(files)), "/work/parts/env/bin/aidl");
  assert.equal(found(["./env/bin/aidl"], around(files)), "/work/parts/env/bin/aidl");
  const log = found(["/opt/aidl", "${workspaceFolder}/log"], around(files));
  assert.equal(log, "/opt/aidl /work/parts/log");
});

test("an empty command finds nothing", () => {
  assert.equal(isFound(findServer([], around(PLACES))), false);
});

test("Windows: other separators, folders and endings", () => {
  const windows = around(["C:\\parts\\.venv\\Scripts\\aidl.exe", "D:\\Python\\Scripts\\aidl.exe"], {
    platform: "win32",
    home: "C:\\Users\\me",
    path: "C:\\Windows;C:\\tools",
    folders: ["C:\\parts"],
    python: "D:\\Python\\Scripts\\python.exe",
  });
  assert.equal(found(["aidl", "lsp"], windows), "C:\\parts\\.venv\\Scripts\\aidl.exe lsp");
  assert.equal(found(["aidl.exe"], { ...windows, folders: [] }), "D:\\Python\\Scripts\\aidl.exe");
  assert.equal(found([".\\.venv\\Scripts\\aidl"], windows), "C:\\parts\\.venv\\Scripts\\aidl.exe");
});

test("the other verbs of the same program", () => {
  const server = { program: "/opt/python", arguments: ["-m", "aidl_lang", "lsp", "--tcp"] };
  assert.deepEqual(otherVerb(server, "new", "/x/part.aidl"), {
    program: "/opt/python",
    arguments: ["-m", "aidl_lang", "new", "/x/part.aidl"],
  });
  assert.equal(otherVerb({ program: "/opt/my-server", arguments: [] }, "new"), undefined);
});

test("the line that installs", () => {
  assert.equal(installLine(null, "linux"), 'pip install "aidl-lang[editor]"');
  assert.equal(installLine("/a/python", "linux"), '/a/python -m pip install "aidl-lang[editor]"');
  assert.equal(installLine("/a b/python", "linux"), "'/a b/python' -m pip install \"aidl-lang[editor]\"");
  assert.equal(installLine("C:\\a b\\python.exe", "win32"), '& "C:\\a b\\python.exe" -m pip install "aidl-lang[editor]"');
});
