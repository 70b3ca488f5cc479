// Folding, indentation, comments, and completion.
import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { CompletionContext } from "@codemirror/autocomplete";
import { ensureSyntaxTree, foldable, getIndentation, indentUnit, matchBrackets } from "@codemirror/language";
import { EditorState } from "@codemirror/state";
import { aidl, aidlLanguage, completeAidl } from "../dist/index.js";
import { about, calls, snippets, words } from "../dist/words.js";

const root = join(dirname(fileURLToPath(import.meta.url)), "../../..");
const examples = readdirSync(join(root, "examples")).filter((file) => file.endsWith(".aidl"));
const read = (name) => readFileSync(join(root, "examples", name), "utf8");

function editor(doc) {
  const state = EditorState.create({ doc, extensions: [aidl(), indentUnit.of("    ")] });
  ensureSyntaxTree(state, state.doc.length, 10_000);
  return state.update({}).state; // which has the whole tree
}

test("every line of the examples is indented as written", () => {
  let compared = 0;
  for (const name of examples) {
    const state = editor(read(name));
    for (let n = 2; n <= state.doc.lines; n++) {
      const [line, before] = [state.doc.line(n), state.doc.line(n - 1)];
      if (!line.text.trim() || /^\s*"/.test(line.text)) continue; // `"why"` below an `assert` goes on with it
      assert.equal(getIndentation(state, line.from), /^ */.exec(line.text)[0].length, `${name}:${n} ${before.text}`);
      compared += 1;
    }
  }
  assert.ok(compared > 400, `${compared}`);
});

test("what has braces over several lines is folded", () => {
  for (const name of examples) {
    const state = editor(read(name));
    for (let n = 1; n <= state.doc.lines; n++) {
      const line = state.doc.line(n);
      const opens = /[{(\[]\s*(\/\/.*)?$/.test(line.text) && !/^\s*\/\//.test(line.text);
      const found = foldable(state, line.from, line.to);
      assert.equal(Boolean(found), opens, `${name}:${n} ${line.text}`);
      if (found) assert.match(state.doc.sliceString(found.to, found.to + 1), /[})\]]/);
    }
  }
});

test("brackets are matched by the tree, not inside of texts", () => {
  const text = 'solid a { x = text("}") }';
  const found = matchBrackets(editor(text), text.indexOf("{"), 1);
  assert.deepEqual([found.matched, found.end.from], [true, text.length - 1]);
});

test("comments are those of the language", () => {
  const [data] = editor("x").languageDataAt("commentTokens", 0);
  assert.deepEqual(data, { line: "//", block: { open: "/*", close: "*/" } });
  assert.equal(aidlLanguage.name, "aidl");
});

/** What is offered where `|` stands, and from where. */
function offered(marked, explicit = false) {
  const pos = marked.indexOf("|");
  const result = completeAidl(new CompletionContext(editor(marked.replace("|", "")), pos, explicit));
  return result && { from: result.from, labels: result.options.map(({ label }) => label), options: result.options };
}

test("a block offers statements, the library, and the names of the text", () => {
  const { labels } = offered("solid plate { rim = circle(radius: 4)\n r| }");
  for (const name of ["rim", "rectangle", "solid", "param", "for", "origin", "pi", "tangent"]) {
    assert.ok(labels.includes(name), name);
  }
  assert.equal(labels.filter((label) => label === "rim").length, 1);
  assert.deepEqual(Object.keys(calls).filter((name) => labels.includes(name) !== Boolean(about[name])), []);
});

test("constraints have their own snippets", () => {
  const { labels } = offered("assembly s { constrain { a| } }");
  assert.ok(labels.includes("gap") && labels.includes("above") && !labels.includes("assembly"), labels.join());
});

test("an attribute, a unit, a type", () => {
  assert.deepEqual(new Set(offered("@|").labels), new Set(words.attributes.filter((n) => n !== "colour").map((n) => `@${n}`)));
  assert.equal(offered("@co|").from, 0);
  assert.deepEqual(offered("param w = 5|", true).labels, words.units);
  assert.equal(offered("param w = 5|"), null);
  assert.equal(offered("param w = 5m|").from, 11);
  const { labels } = offered("shape s(a: l|) { }");
  assert.ok(labels.includes("length") && labels.includes("ring") && !labels.includes("param"));
});

test("nothing is offered where words mean nothing or only a server knows", () => {
  for (const text of ["// a|", "/// a|", '"a|"', "/* a| */", "x = a.b|", "x = |"]) assert.equal(offered(text), null, text);
  assert.ok(offered("x = |", true));
  assert.ok(offered("for i in 0..n|").labels.includes("origin"));
});

test("what is inserted reads as it is meant", () => {
  const { options } = offered("r|");
  assert.equal(options.find(({ label }) => label === "ring").apply, "ring(");
  for (const snippet of snippets) {
    const place = { attribute: "@|", constraints: "constrain { a| }" }[snippet.place] ?? "a|";
    const option = offered(place).options.find(({ label }) => label === snippet.prefix);
    assert.equal(typeof option.apply, "function", snippet.prefix);
    const pos = place.indexOf("|");
    let { state } = { state: editor(place.replace("|", "")) };
    option.apply({ state, dispatch: (tr) => (state = tr.state ?? state.update(tr).state) }, option, pos - 1, pos);
    assert.doesNotMatch(state.doc.toString(), /\$|#\{/, snippet.prefix);
    let errors = 0;
    aidlLanguage.parser.parse(state.doc.toString()).iterate({ enter: ({ type }) => void (errors += type.isError) });
    if (snippet.place !== "attribute") assert.equal(errors, 0, state.doc.toString());
  }
});
