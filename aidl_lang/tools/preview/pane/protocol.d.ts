/** The messages between the pane and its host. Points are [x, y] in mm in the frame of the root, y up; places in a
 * text are lines and UTF-16 characters from 0. */

import type { FORMATS } from "./formats.js";

export type Vec = [number, number];
export interface Position { line: number; character: number }
export interface Range { start: Position; end: Position }
export type Value = number | string | boolean;

/** Where something is written; both null for what is in the library. */
export interface Place { range: Range | null; uri: string | null }

/** What elements of the picture are: `data-element` in the SVG is an index into these. */
export interface Element extends Place {
  path: string;
  kind: "structure" | "geometry";
  type: string;
  hint: string;
}

export interface Knob extends Place {
  path: string;
  name: string;
  kind: "number" | "choice" | "truth" | "text";
  value: Value;
  unit: "mm" | "deg" | "";
  low: number | null;
  high: number | null;
  step: number | null;
  choices: Value[];
  doc: string;
  editable: boolean;
}

/** A point that can be dragged: a first guess moves freely, a param or a size changes the number it shows. */
export interface Handle {
  id: string;
  path: string;
  at: Vec;
  moves: "guess" | "param" | "size";
  hint: string;
}

export type Severity = "error" | "warning" | "note";

/** `fixes` is how many there are, `titles` says what each does. */
export interface Problem extends Place {
  severity: Severity;
  code: string;
  message: string;
  hints: string[];
  elements: number[];
  points: Vec[];
  fixes: number;
  titles?: string[];
}

/** `off`: by how much it is missed, mm or degrees. */
export interface Party extends Place { text: string; elements: number[]; off: number | null }
export interface Conflict { headline: string; constraints: Party[] }

/** An angle in degrees, counter-clockwise; without `start` the arc is centred on straight up. */
export interface Turn { center: Vec; radius: number; sweep: number; start?: number }
export interface Motion { words: string; elements: number[]; arrows: { from: Vec; to: Vec }[]; turns: Turn[] }

/** A line, a character in it, a length in UTF-16 units, and the name of a semantic token type. */
export type Token = [number, number, number, string];
export interface Source { text: string; tokens: Token[] }

export type Status = "solved" | "partial" | "failed" | "wrong";

/** `stale`: the drawing is of an earlier text. `tried`: it is of values that are not in the text. */
export interface Preview {
  uri: string;
  version: number;
  status: Status;
  stale: boolean;
  tried?: boolean;
  seconds: number;
  svg: string | null;
  box: [number, number, number, number];
  elements: Element[];
  knobs: Knob[];
  handles: Handle[];
  problems: Problem[];
  conflicts: Conflict[];
  motions: Motion[];
  degrees: number | null;
  source: Source | null;
}

export type Layer = "names" | "points" | "bbox" | "constraints" | "dof" | "plan" | "dimensions" | "freedom";
export type Format = (typeof FORMATS)[number][0];

export type FromHost =
  | ({ type: "picture" } & Preview)
  | { type: "busy" }
  | { type: "reveal"; elements: number[] }
  | { type: "error"; message: string }
  | { type: "export"; name: string; data: string };

export type ToHost =
  | { type: "ready" }
  | { type: "knob"; path: string; value: Value; final: boolean }
  | { type: "drag"; id: string; to: Vec; final: boolean }
  | { type: "cancel" }
  | { type: "hover"; element: number | null }
  | { type: "goto"; element: number }
  | { type: "goto"; uri: string; range: Range }
  | { type: "fix"; problem: number; fix: number }
  | { type: "export"; format: Format }
  | { type: "show"; layers: Layer[] };

/** What VS Code gives a webview. */
export interface VsCodeApi {
  postMessage(message: ToHost): void;
  getState(): unknown;
  setState(state: unknown): void;
}

declare global {
  function acquireVsCodeApi(): VsCodeApi;
}
