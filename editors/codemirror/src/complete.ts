// Completion without a server: the words of the language and of the library, the snippets, and the names of the text.
import { type Completion, type CompletionContext, type CompletionResult, snippetCompletion } from "@codemirror/autocomplete";
import { syntaxTree } from "@codemirror/language";
import type { SyntaxNode } from "@lezer/common";
import { about, calls, snippets, words } from "./words.js";

const WORD = /[\p{L}\p{Nl}\p{No}_][\p{L}\p{N}_]*$/u;
const SORTS = { "call.shape": "class", "call.constraint": "function", "call.function": "function" };
const CATEGORIES = { "call.shape": "shape", "call.constraint": "constraint", "call.function": "function" };

/** A name of the library with what it is for; the parenthesis has to touch it. */
function called([name, kind]: [string, keyof typeof SORTS]): Completion {
  return { label: name, type: SORTS[kind], detail: CATEGORIES[kind], info: about[name], apply: `${name}(` };
}

const listed = (names: readonly string[], type: string): Completion[] => names.map((label) => ({ label, type }));

/** A snippet in the syntax of this editor, which ends with `${}` rather than `$0`. */
function filled({ prefix, title, body }: (typeof snippets)[number]): Completion {
  const text = body.replace(/\$(\d+)/g, (_, number) => (number === "0" ? "${}" : `\${${number}}`));
  return snippetCompletion(text, { label: prefix, detail: title, type: "keyword", boost: 1 });
}

const inPlace = (...places: string[]) => snippets.filter(({ place }) => places.includes(place)).map(filled);
// Synonyms are understood, but not offered: nothing is said about them.
const LIBRARY = Object.entries(calls).filter(([name]) => about[name]).map((entry) => called(entry as [string, keyof typeof SORTS]));
const GIVEN = [...listed(words.everywhere!, "variable"), ...listed(words.constants!, "constant")];
const STATEMENTS = [...listed(words.statements!, "keyword"), ...listed(words.clauses!, "keyword")];
const BLOCK = [...inPlace("file", "block"), ...STATEMENTS, ...GIVEN, ...LIBRARY];
const CONSTRAINTS = [...inPlace("constraints"), ...STATEMENTS, ...GIVEN, ...LIBRARY];
const ATTRIBUTES = inPlace("attribute");
const TYPES = [...listed(words.types!, "type"), ...listed(Object.keys(calls).filter((n) => calls[n] === "call.shape"), "class")];

/** What a text gives names to, each once. */
function defined(context: CompletionContext): Completion[] {
  const types: Record<string, string> = {
    Definition: "variable", StructureName: "class", DefinedName: "function", ParameterName: "variable",
  };
  const found = new Map<string, string>();
  syntaxTree(context.state).iterate({
    enter: (node) => {
      const type = types[node.name];
      if (!type || (node.from <= context.pos && context.pos <= node.to)) return;
      const name = context.state.sliceDoc(node.from, node.to).split("[")[0]!.trim();
      if (!found.has(name)) found.set(name, type);
    },
  });
  return [...found].map(([label, type]) => ({ label, type, boost: 2 }));
}

function within(node: SyntaxNode | null, names: readonly string[]): string | undefined {
  for (; node; node = node.parent) if (names.includes(node.name)) return node.name;
  return undefined;
}

/** Whether the innermost braces around a place are those of a `constrain`. */
function inConstraints(node: SyntaxNode | null): boolean {
  for (; node; node = node.parent) {
    if (["Constrain", "ConstraintDefinition", "Equation"].includes(node.name)) return true;
    if (["Structure", "Template", "ShapeDefinition"].includes(node.name)) return false;
  }
  return false;
}

/** The source for `autocompletion`; nothing in comments, texts and behind dots, where only a server knows. */
export function completeAidl(context: CompletionContext): CompletionResult | null {
  const node = syntaxTree(context.state).resolveInner(context.pos, -1);
  if (within(node, ["LineComment", "DocComment", "BlockComment", "String"])) return null;
  const line = context.state.doc.lineAt(context.pos);
  const before = line.text.slice(0, context.pos - line.from);
  const word = WORD.exec(before)?.[0] ?? "";
  const rest = before.slice(0, before.length - word.length);
  const from = context.pos - word.length;
  const attribute = /@\s*$/.exec(rest);
  if (attribute) return { from: from - attribute[0].length, options: ATTRIBUTES };
  if (/(^|[^.])\.\s*$/.test(rest)) return null;
  const number = /(?:^|[^\p{L}\p{N}_])\d+(?:\.\d+)?(?<unit>\p{L}*)$/u.exec(before);
  if (number && (word || context.explicit)) {
    const options = listed(words.units!, "unit");
    return { from: context.pos - number.groups!.unit!.length, options };
  }
  if (!word && !context.explicit) return null;
  if (/:\s*$/.test(rest) && within(node, ["ParameterList"])) return { from, options: TYPES };
  const options = inConstraints(node) ? CONSTRAINTS : BLOCK;
  return { from, options: [...defined(context), ...options], validFor: /^[\p{L}\p{N}_]*$/u };
}
