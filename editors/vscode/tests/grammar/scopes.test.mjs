// Every token of every example has the scope of its class, read by the very engine that VS Code has.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import oniguruma from "vscode-oniguruma";
import textmate from "vscode-textmate";

const root = join(dirname(fileURLToPath(import.meta.url)), "../../../..");
const { scopes, programs } = JSON.parse(readFileSync(join(root, "tests/editors/classes.json"), "utf8"));
const wasm = createRequire(import.meta.url).resolve("vscode-oniguruma/release/onig.wasm");
await oniguruma.loadWASM(readFileSync(wasm).buffer);
const path = join(root, "editors/vscode/syntaxes/aidl.tmLanguage.json");
const registry = new textmate.Registry({
  onigLib: Promise.resolve({
    createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
    createOnigString: (text) => new oniguruma.OnigString(text),
  }),
  loadGrammar: async () => textmate.parseRawGrammar(readFileSync(path, "utf8"), path),
});
const grammar = await registry.loadGrammar("source.aidl");

/** The innermost scope at every place of a text, in units of UTF-16. */
function colours(text) {
  const found = new Array(text.length).fill("");
  let stack = textmate.INITIAL;
  let start = 0;
  for (const line of text.split("\n")) {
    const { tokens, ruleStack } = grammar.tokenizeLine(line, stack);
    for (const token of tokens) {
      for (let i = token.startIndex; i < token.endIndex && i < line.length; i++) {
        found[start + i] = token.scopes;
      }
    }
    stack = ruleStack;
    start += line.length + 1;
  }
  return found;
}

const has = (names, wanted) => names.some((name) => name === `${wanted}.aidl` || name.startsWith(`${wanted}.`));

for (const [name, pieces] of Object.entries(programs)) {
  test(`${name}: every token has the scope of its class`, () => {
    const text = readFileSync(join(root, name), "utf8");
    const found = colours(text);
    const wrong = [];
    for (const [start, end, kind] of pieces) {
      for (let i = start; i < end; i++) {
        const names = found[i];
        if (text[i] === "\n" || has(names.slice(-1), scopes[kind])) continue;
        if (kind.startsWith("string") && has(names, "string.quoted")) continue;
        wrong.push(`${text.slice(0, start).split("\n").length}: ${text.slice(start, end)} is ${kind}: ${names}`);
        break;
      }
    }
    assert.deepEqual(wrong, []);
  });
}

test("every class but what is no token occurs", () => {
  const kinds = new Set(Object.values(programs).flat().map(([, , kind]) => kind));
  assert.deepEqual(Object.keys(scopes).filter((kind) => !kinds.has(kind)), ["unknown"]);
});

/** The scopes of the first place of a part of a text. */
const at = (text, part) => colours(text)[text.indexOf(part)].at(-1);

test("what is still being written colours nothing behind it", () => {
  const after = '\nsolid b { r = circle(radius: 4) }\nparam w = "x"';
  for (const broken of [
    "solid a { x = circle(radius: 5", "x = [1, 2", "x = f((1", "fn f(x", "shape s(a: length", "constraint c(",
    "constraint c(a)", "constrain {", "for i in", "for", "import a,", 'x = "open', "import", "a.", "@color(", "@",
    "param", "x = 5mm +", "if a {", "constrain for i in 0..2", "x = a[1", "solid s(a = ", "x =",
  ]) {
    const text = broken + after;
    assert.match(at(text, "param w"), /^keyword\.declaration/, broken);
    assert.match(at(text, '"x"'), /^string|^punctuation/, broken);
    assert.match(at(text, "solid b"), /^storage\.type\.kind/, broken);
  }
});

test("numbers, units, names beyond ASCII, and what is wrong", () => {
  assert.match(at("x = 5px", "px"), /^invalid\.illegal/);
  assert.match(at("x = 5mm", "mm"), /^keyword\.other\.unit/);
  assert.match(at("x = 30°", "°"), /^keyword\.other\.unit/);
  assert.match(at("x = 1e3in", "in"), /^keyword\.other\.unit/);
  assert.match(at("x = 5mi", "mi"), /^invalid\.illegal/);
  assert.match(at("x = 1..<9", "..<"), /^keyword\.operator\.range/);
  assert.match(at("größe = 1", "größe"), /^variable\.other\.definition/);
  assert.match(at("solid 𝒳y2 {", "𝒳"), /^entity\.name\.type\.structure/);
  assert.match(at("param_in = 3", "param_in"), /^variable\.other\.definition/);
  assert.match(at("@colour(red)", "colour"), /^entity\.other\.attribute-name\.aidl/);
  assert.match(at("@paint(red)", "paint"), /^entity\.other\.attribute-name\.unknown/);
  assert.match(at("//// no\n/// yes", "/// yes"), /^comment\.line\.documentation/);
  assert.match(at("x = 5 // 2", "// 2"), /^comment/);
});
