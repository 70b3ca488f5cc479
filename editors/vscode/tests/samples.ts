/** Made-up pictures and programs for the tests. */

import type { Element, Preview, Problem, Range } from "../src/preview/protocol";

export const URI = "file:///home/me/plate.aidl";

export const range = (line: number, character: number, endLine: number, endCharacter: number): Range => ({
  start: { line, character },
  end: { line: endLine, character: endCharacter },
});

export const element = (path: string, where: Range | null, uri: string | null = URI): Element => ({
  path,
  kind: "geometry",
  type: "circle",
  range: where,
  uri,
  hint: path,
});

export const problem = (code: string, where: Range | null): Problem => ({
  severity: "error",
  code,
  message: "it does not fit",
  hints: [],
  range: where,
  uri: URI,
  elements: [],
  points: [],
  fixes: 1,
});

export const preview = (changes: Partial<Preview> = {}): Preview => ({
  uri: URI,
  version: 1,
  status: "solved",
  stale: false,
  seconds: 0.02,
  svg: "<svg/>",
  box: [0, 0, 80, 40],
  elements: [
    element("plate", range(0, 0, 9, 1)),
    element("plate.body", range(1, 4, 1, 30)),
    element("plate.hole", range(2, 4, 4, 5)),
    element("plate.hole.rim", range(3, 8, 3, 20)),
    element("plate.hole.rim", range(3, 8, 3, 20)),
    element("plate.from_library", null, null),
  ],
  knobs: [],
  handles: [],
  problems: [],
  conflicts: [],
  motions: [],
  degrees: 2,
  ...changes,
});
