// The tree of every program is whole, and every token has the colour of its class.
import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { getStyleTags, highlightTree, tagHighlighter, tags as t } from "@lezer/highlight";
import { aidlLanguage } from "../dist/index.js";
import { words } from "../dist/words.js";

const root = join(dirname(fileURLToPath(import.meta.url)), "../../..");
const read = (path) => readFileSync(join(root, path), "utf8");
const { scopes, programs } = JSON.parse(read("tests/editors/classes.json"));
const files = ["examples", "stdlib", "eval/aidl_eval/prompts"].flatMap((folder) =>
  readdirSync(join(root, folder), { recursive: true }).filter((f) => f.endsWith(".aidl")).map((f) => join(folder, f)),
);

/** The classes of the project by the tags of this editor. */
const TAGS = {
  "comment.line": t.lineComment,
  "comment.documentation": t.docComment,
  "comment.block": t.blockComment,
  "keyword.declaration": t.definitionKeyword,
  "keyword.demand": t.keyword,
  "keyword.modifier": t.modifier,
  "keyword.control": t.controlKeyword,
  "keyword.import": t.moduleKeyword,
  "keyword.clause": t.keyword,
  "keyword.operator": t.operatorKeyword,
  "constant.truth": t.bool,
  "operator.comparison": t.compareOperator,
  "operator.arithmetic": t.arithmeticOperator,
  "operator.logic": t.logicOperator,
  "operator.range": t.operator,
  "operator.assignment": t.definitionOperator,
  bracket: t.bracket,
  punctuation: t.punctuation, // `.` aside
  "attribute.sign": t.annotation,
  attribute: t.annotation,
  kind: t.typeName,
  "name.structure": t.definition(t.className),
  "name.template": t.definition(t.className),
  "name.function": t.definition(t.function(t.variableName)),
  "name.definition": t.definition(t.variableName),
  "name.parameter": t.definition(t.local(t.variableName)),
  "name.argument": t.attributeName,
  "name.type": t.typeName,
  "name.member": t.propertyName,
  "name.everywhere": t.standard(t.variableName),
  "name.constant": t.standard(t.variableName),
  "name.module": t.variableName,
  name: t.variableName,
  "call.shape": t.standard(t.className),
  "call.constraint": t.standard(t.function(t.variableName)),
  "call.function": t.standard(t.function(t.variableName)),
  "call.member": t.function(t.propertyName),
  call: t.function(t.variableName),
  number: t.number,
  unit: t.unit,
  string: t.string,
  escape: t.escape,
};
const named = new Map([...Object.values(TAGS), t.derefOperator].map((tag, i) => [tag, `c${i}`]));
const highlighter = tagHighlighter([...named].map(([tag, name]) => ({ tag, class: name })));

const parse = (text) => aidlLanguage.parser.parse(text);

function errors(text) {
  const found = [];
  parse(text).iterate({
    enter: ({ type, from }) => {
      if (type.isError || ["NoUnit", "OpenString"].includes(type.name)) found.push(`${text.slice(0, from).split("\n").length}: ${text.slice(from, from + 30)}`);
    },
  });
  return found;
}

test("no program has an error in its tree", () => {
  assert.ok(files.length > 40);
  for (const file of [...files, "tests/editors/classes.aidl"]) assert.deepEqual(errors(read(file)), [], file);
});

test("no program of the documentation has one", () => {
  let count = 0;
  const pages = [...readdirSync(join(root, "docs")), ...readdirSync(join(root, "docs/reference")).map((f) => `reference/${f}`)];
  for (const page of pages.filter((file) => file.endsWith(".md"))) {
    for (const [, text] of read(`docs/${page}`).matchAll(/^```aidl(?: error| fragment| file=\S+\.aidl)?\n(.*?)^```$/gms)) {
      assert.deepEqual(errors(text), [], page);
      count += 1;
    }
  }
  assert.ok(count > 250, `${count}`);
});

for (const [name, pieces] of Object.entries(programs)) {
  test(`${name}: every token has the colour of its class`, () => {
    const text = read(name);
    const found = new Array(text.length).fill("");
    highlightTree(parse(text), highlighter, (from, to, classes) => found.fill(classes, from, to));
    const wrong = [];
    for (const [start, end, kind] of pieces) {
      const wanted = named.get(text.slice(start, end) === "." ? t.derefOperator : TAGS[kind]);
      for (let i = start; i < end; i++) {
        if (found[i] === wanted) continue;
        const has = [...named].find(([, n]) => n === found[i])?.[0];
        wrong.push(`${text.slice(0, start).split("\n").length}: ${text.slice(start, end)} is ${kind}, not ${has ?? found[i]}`);
        break;
      }
    }
    assert.deepEqual(wrong, []);
  });
}

test("every class has a tag", () => {
  assert.deepEqual(Object.keys(scopes).filter((kind) => !TAGS[kind]), ["unknown"]);
});

test("a mistake stays where it is", () => {
  const good = "solid b { r = circle(radius: 4) }";
  for (const bad of ["solid a { x = circle(radius: 5 }", "param = 5", "x = 5px", "solid a { ] }", "x = 'open", "x = = 3"]) {
    const text = `${bad}\n${good}`;
    assert.notDeepEqual(errors(text), [], bad);
    const found = new Set();
    parse(text).iterate({ enter: ({ name, from, to }) => void found.add(`${name} ${text.slice(from, to)}`) });
    assert.ok(found.has("StructureName b") && found.has("ShapeName circle"), `${bad}: ${[...found].join("; ")}`);
  }
});

test("the keywords are those of the language, and each has a colour", () => {
  const types = aidlLanguage.parser.nodeSet.types.filter(({ name }) => /^[a-z]+$/i.test(name));
  const keywords = types.filter(({ name }) => words.keywords.includes(name));
  assert.deepEqual(keywords.map(({ name }) => name).sort(), [...words.keywords].sort());
  for (const type of keywords) {
    const { tags } = getStyleTags({ type, matchContext: () => true }) ?? assert.fail(type.name);
    assert.equal(tags.length, 1, type.name);
  }
  const small = types.filter(({ name }) => /^[a-z]/.test(name) && !words.keywords.includes(name));
  assert.deepEqual(small.map(({ name }) => name), []);
});
