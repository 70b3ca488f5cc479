// What the editor does by itself - words, indentation, the next line of a comment - fits the examples.
import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

const root = join(dirname(fileURLToPath(import.meta.url)), "../../../..");
const read = (path) => readFileSync(join(root, path), "utf8");
const configuration = JSON.parse(read("editors/vscode/language-configuration.json"));
const { programs } = JSON.parse(read("tests/editors/classes.json"));
const word = new RegExp(configuration.wordPattern.pattern, `${configuration.wordPattern.flags}g`);

test("a double click takes a whole name, and a number with its unit", () => {
  for (const [name, pieces] of Object.entries(programs)) {
    const text = read(name);
    const wanted = new Map();
    for (const [start, end, kind] of pieces) {
      if (kind === "unit" && wanted.get(start) === undefined) {
        const number = [...wanted].find(([, e]) => e === start)[0];
        wanted.set(number, end);
      } else if (/^(name|call|kind|keyword|number|constant|attribute$)/.test(kind)) wanted.set(start, end);
    }
    const found = new Map([...text.matchAll(word)].map((m) => [m.index, m.index + m[0].length]));
    for (const [start, end] of wanted) assert.equal(found.get(start), end, `${name}: ${text.slice(start, end)}`);
  }
});

test("each line of the examples is indented as the editor would", () => {
  const { increaseIndentPattern, decreaseIndentPattern } = configuration.indentationRules;
  const [more, less] = [new RegExp(increaseIndentPattern, "u"), new RegExp(decreaseIndentPattern, "u")];
  let compared = 0;
  for (const name of readdirSync(join(root, "examples")).filter((file) => file.endsWith(".aidl"))) {
    const lines = read(`examples/${name}`).split("\n").filter((line) => line.trim() !== "");
    const indent = (line) => line.length - line.trimStart().length;
    let before = 0; // the line before that is no continuation of another
    for (let i = 1; i < lines.length; i++) {
      const step = 4 * (more.test(lines[before]) - less.test(lines[i]));
      const opened = /[([]\s*(?:\/\/.*)?$/.test(lines[before]);
      const goesOn = /(?:[,+*/=-]|\band|\bor)\s*(?:\/\/.*)?$/.test(lines[i - 1]) && indent(lines[i]) > indent(lines[before]) && !opened;
      if (goesOn) continue; // of a long expression
      assert.equal(indent(lines[i]), indent(lines[before]) + step, `${name}: ${lines[i]}`);
      before = i;
      compared += 1;
    }
  }
  assert.ok(compared > 300, `${compared}`);
});

/** What is put on the next line when Enter is pressed between two texts. */
function entered(before, after = "") {
  const rule = configuration.onEnterRules.find(
    (rule) => new RegExp(rule.beforeText).test(before) && (!rule.afterText || new RegExp(rule.afterText).test(after)),
  );
  return rule && (rule.action.appendText ?? rule.action.indent);
}

test("Enter goes on with a comment that is not at its end", () => {
  assert.equal(entered("    /// A thing."), "/// ");
  assert.equal(entered("/// A", " thing"), "/// ");
  assert.equal(entered("/// "), undefined);
  assert.equal(entered("//// no documentation"), undefined);
  assert.equal(entered("// one", " two"), "// ");
  assert.equal(entered("// one"), undefined);
  assert.equal(entered("x = 5  /// behind"), undefined);
  assert.equal(entered("solid a {", "}"), "indentOutdent");
  assert.equal(entered("x = f(", ")"), "indentOutdent");
});
