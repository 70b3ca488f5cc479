/** Which elements of the picture the caret is at. */

import type { Element, Position, Range } from "./protocol";

/** Indices of the elements with the innermost range that holds the caret: several where a loop made several of one text.
 * The whole program is only meant where its first line is, so that an empty line does not light up everything. */
export function elementsAt(elements: readonly Element[], uri: string, caret: Position): number[] {
  let innermost: Range | null = null;
  let found: number[] = [];
  elements.forEach(({ range, path, uri: file }, index) => {
    if (range === null || file !== uri || !contains(range, caret)) return;
    if (!path.includes(".") && caret.line !== range.start.line) return;
    if (innermost === null || inside(range, innermost)) {
      innermost = range;
      found = [];
    }
    if (same(range, innermost)) found.push(index);
  });
  return found;
}

const comesBefore = (a: Position, b: Position): boolean =>
  a.line < b.line || (a.line === b.line && a.character < b.character);

/** Both ends belong to the range: a caret behind the last letter of a word is still at that word. */
const contains = (range: Range, at: Position): boolean =>
  !comesBefore(at, range.start) && !comesBefore(range.end, at);

const equal = (a: Position, b: Position): boolean => a.line === b.line && a.character === b.character;
const same = (a: Range, b: Range): boolean => equal(a.start, b.start) && equal(a.end, b.end);

/** Whether `a` lies within `b` and is smaller. */
const inside = (a: Range, b: Range): boolean =>
  !comesBefore(a.start, b.start) && !comesBefore(b.end, a.end) && !same(a, b);
