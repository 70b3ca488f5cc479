/** Which elements of the picture are written where.
 * @import { Preview, Range } from "./protocol.js"
 */

/**
 * The innermost elements that are written on a line of the document: those whose place has the fewest lines. The whole
 * program is only meant where its first line is.
 * @param {Preview} preview
 * @param {number} line
 * @returns {number[]}
 */
export function elementsOn({ uri, elements }, line) {
  let least = Infinity;
  /** @type {number[]} */
  let found = [];
  elements.forEach(({ range, path, uri: file }, k) => {
    if (!range || file !== uri || line < range.start.line || line > lastLine(range)) return;
    if (!path.includes(".") && line !== range.start.line) return;
    const size = range.end.line - range.start.line;
    if (size < least) [least, found] = [size, []];
    if (size === least) found.push(k);
  });
  return found;
}

/** @param {Range} range */
function lastLine({ start, end }) {
  return end.character === 0 && end.line > start.line ? end.line - 1 : end.line;
}
