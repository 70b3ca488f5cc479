/** What this browser keeps: the program that is open, and those before it. Nothing of it leaves the browser. */

const KEY = "aidl-playground";
const MOST = 12;

/** @typedef {{ name: string, text: string }} Program */

/** @returns {Program[]} the newest first */
export function programs() {
  try {
    const kept = JSON.parse(localStorage.getItem(KEY) ?? "[]");
    if (!Array.isArray(kept)) return [];
    return kept.filter((each) => typeof each?.name === "string" && typeof each.text === "string");
  } catch {
    return [];
  }
}

/**
 * Keeps a program as the newest, in place of the one of that name.
 * @param {Program} program
 * @returns {boolean} false if this browser keeps nothing, or no more
 */
export function keep(program) {
  let kept = [program, ...programs().filter(({ name }) => name !== program.name)].slice(0, MOST);
  while (kept.length) {
    try {
      localStorage.setItem(KEY, JSON.stringify(kept));
      return true;
    } catch {
      kept = kept.slice(0, kept.length > 1 ? -1 : 0);
    }
  }
  return false;
}
