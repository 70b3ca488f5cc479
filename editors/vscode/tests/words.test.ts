import assert from "node:assert/strict";
import { test } from "node:test";

import { elementsAt } from "../src/preview/elements";
import { complete } from "../src/preview/page";
import { runOf, wordsFor } from "../src/status";
import { element, preview, problem, range, URI } from "./samples";

const { elements } = preview();
const at = (line: number, character: number, uri = URI): number[] => elementsAt(elements, uri, { line, character });

test("elements at the caret: innermost, all that a loop made, both ends, this file only", () => {
  assert.deepEqual(at(1, 4), [1]);
  assert.deepEqual(at(1, 30), [1]);
  assert.deepEqual(at(1, 31), []);
  assert.deepEqual(at(3, 8), [3, 4]);
  assert.deepEqual(at(3, 7), [2]);
  assert.deepEqual(at(0, 2), [0]);
  assert.deepEqual(at(8, 0), []);
  assert.deepEqual(at(1, 4, "file:///other.aidl"), []);
});

test("of two that begin or end together the smaller is the inner, whatever their order", () => {
  const outer = element("a.b", range(1, 0, 5, 1));
  const inner = element("a.b.c", range(1, 0, 2, 9));
  assert.deepEqual(elementsAt([outer, inner], URI, { line: 1, character: 3 }), [1]);
  assert.deepEqual(elementsAt([inner, outer], URI, { line: 1, character: 3 }), [0]);
});

test("the page: values are escaped, the folder ends with a slash, nothing is left open", () => {
  const template = '<meta content="{{csp}}"><script nonce="{{nonce}}" src="{{root}}main.js"></script>{{socket}}';
  const page = complete(template, { source: 'https://"&<x>', root: "https://files/a&b", nonce: "N0nce", uri: URI });
  assert.match(page, /src="https:\/\/files\/a&amp;b\/main.js"/);
  assert.match(page, /nonce="N0nce"/);
  assert.match(page, /content="default-src 'none'; script-src 'nonce-N0nce' https:\/\/&quot;&amp;&lt;x&gt;;/);
  assert.doesNotMatch(page, /unsafe|\{\{|\*/);
  assert.throws(() => complete("{{other}}", { source: "", root: "", nonce: "", uri: URI }), /other/);
});

test("the status bar", () => {
  const words = (changes: Parameters<typeof preview>[0]): string => wordsFor("running", runOf(preview(changes))).text;
  assert.equal(words({}), "$(check) Solved · 2 free");
  assert.equal(words({ degrees: 0 }), "$(check) Solved");
  assert.equal(words({ status: "partial" }), "$(warning) Partly solved · 2 free");
  assert.equal(words({ status: "wrong", degrees: 2 }), "$(error) Not drawn");
  assert.equal(wordsFor("running", null).text, "AIDL");
  assert.equal(wordsFor("starting", runOf(preview())).text, "$(sync~spin) AIDL");
  assert.equal(wordsFor("stopped", null).severity, "warning");
});

test("what the status bar's tooltip tells", () => {
  const problems = [problem("E0101", null), problem("E0102", null), { ...problem("W0601", null), severity: "warning" as const }];
  assert.equal(
    wordsFor("running", runOf(preview({ status: "failed", problems, degrees: 1, seconds: 1.234 }))).tooltip,
    "The constraints could not be solved. 1 degree of freedom. 2 errors, 1 warning. The last run took 1.2 s. Click to open the preview.",
  );
});
