// Names, which regular expressions of Lezer cannot tell: those of calls, those of units, and those beyond ASCII.
import { ExternalTokenizer, type InputStream } from "@lezer/lr";
import { calls, words } from "./words.js";
// Made from aidl.grammar.
import { CallName, ConstraintName, DocComment, FunctionName, identifier, NoUnit, ShapeName, standard, Unit } from "./parser.terms.js";

const START = /[\p{L}\p{Nl}\p{No}_]/u;
const REST = /[\p{L}\p{N}_]/u;
const [PARENTHESIS, ZERO, NINE] = [40, 48, 57];
const RESERVED = new Set(words.reserved);
const KEYWORDS = new Set(words.keywords);
const UNITS = new Set(words.units);

/** The character that begins at an offset from where the input is, whole even beyond the first plane; "" at the end. */
function character(input: InputStream, offset: number): string {
  const code = input.peek(offset);
  if (code < 0) return "";
  const pair = code >= 0xd800 && code < 0xdc00 ? String.fromCharCode(code, input.peek(offset + 1)) : "";
  return pair || String.fromCharCode(code);
}

/** The name that begins where the input is, or "". */
function name(input: InputStream): string {
  let text = "";
  for (let test = START; ; test = REST) {
    const next = character(input, text.length);
    if (!next || !test.test(next)) return text;
    text += next;
  }
}

export const names = new ExternalTokenizer(
  (input, stack) => {
    const text = name(input);
    const before = input.peek(-1);
    if (before >= ZERO && before <= NINE && stack.canShift(Unit)) {
      const letters = text || character(input, 0);
      if (UNITS.has(letters)) return input.acceptToken(Unit, letters.length);
      if (text && !KEYWORDS.has(text)) return input.acceptToken(NoUnit, text.length);
    }
    if (!text) return;
    const called = input.peek(text.length) === PARENTHESIS && !RESERVED.has(text);
    input.acceptToken(called ? CallName : identifier, text.length);
  },
  { contextual: true },
);

const CLASSES = { "call.shape": ShapeName, "call.constraint": ConstraintName, "call.function": FunctionName };

/** What the library knows under the name of a call. */
export function callClass(text: string, _: unknown): number {
  return Object.hasOwn(calls, text) ? CLASSES[calls[text]!] : -1;
}

const STANDARD = new Set([...words.everywhere!, ...words.constants!]);

/** Whether a name is there without being defined. */
export function nameClass(text: string, _: unknown): number {
  return STANDARD.has(text) ? standard : -1;
}

export function commentClass(text: string, _: unknown): number {
  return /^\/\/\/(?!\/)/.test(text) ? DocComment : -1;
}
