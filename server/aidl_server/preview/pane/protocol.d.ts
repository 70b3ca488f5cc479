/** The messages between the pane and its host. Points are [x, y] in mm in the frame of the root, y up; places in a
 * text are lines and UTF-16 characters from 0. */

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
}

/** The text of the program, `null` where the pane has it: `saved` if it is in the file, `contested` if the file was
 * changed meanwhile. `undo` and `redo` say what each would do. */
export interface TextState {
  version: number;
  text: string | null;
  saved: boolean;
  contested: boolean;
  undo: string | null;
  redo: string | null;
}

/** Text in place of what stood from one place to another. */
export interface Change extends Range { text: string }

export type Layer = "names" | "points" | "bbox" | "constraints" | "dof" | "plan" | "dimensions" | "freedom";

/** What a dialog for exports offers: `formats` of an option are those that have it. */
export interface ExportOption { name: string; label: string; hint: string; choices: string[]; formats: string[] }
export interface Exports { formats: { name: string; label: string }[]; options: ExportOption[] }

/** Where a param changes kind on its way from end to end: the first `value` of another one, and edits that keep it. */
export interface KindChange { value: number; message: string; fixes: { title: string }[] }
export interface Walked { summary: string; walked: { param: string; turns: KindChange[] }[] }

/** Values to solve with that are not in the text. */
export type Attempt = { knobs: Record<string, Value> } | { drag: { id: string; to: Vec } };

/** The answer to a request that edits the text. */
export interface Applied { applied: boolean; reason?: string; version?: number }

/** A file; `data` is base64. */
export interface Exported { name: string; data: string; notes: string[] }

/** The requests that the language server answers beyond those of the protocol that all editors speak. `viewer` tells
 * apart those who see one document. Without `version` the text as it is is meant. */
export interface Requests {
  "aidl/preview": { params: { show: readonly string[] }; result: Preview | null };
  "aidl/previewClose": { params: object; result: null };
  "aidl/try": { params: { version?: number; rests?: boolean } & Attempt; result: Preview };
  "aidl/setKnob": { params: { version?: number; path: string; value: Value }; result: Applied };
  "aidl/drag": { params: { version?: number; id: string; to: Vec }; result: Applied };
  "aidl/fix": { params: { version: number; problem: number; fix: number }; result: Applied };
  "aidl/export": { params: ExportWish & { show?: readonly string[] }; result: Exported | null };
  "aidl/exports": { params: object; result: Exports };
  "aidl/ranges": { params: object; result: Walked };
}
export interface ExportWish { format: string; options?: Record<string, string> }

/** The requests about the text that `aidl preview` answers; in VS Code the text is the editor's. */
export interface TextRequests {
  "aidl/type": { params: { version: number; changes: Change[] }; result: Applied };
  "aidl/save": { params: { anyway: boolean }; result: Applied };
  "aidl/takeFile": { params: object; result: Applied };
  "aidl/undo": { params: object; result: Applied };
  "aidl/redo": { params: object; result: Applied };
}
export type Asked = Requests & TextRequests;
export type Name = keyof Requests;
export type Params<N extends keyof Asked> = { uri: string; viewer?: string } & Asked[N]["params"];
export type Ask = <N extends keyof Asked>(method: N, params: Params<N>) => Promise<Asked[N]["result"]>;

/** What a host tells a pane unasked. */
export type Told =
  | { method: "aidl/previewChanged"; params: Preview }
  | { method: "aidl/text"; params: TextState }
  | { method: "aidl/busy"; params?: object }
  | { method: "aidl/reveal"; params: { elements: number[] } }
  | { method: "window/showMessage"; params: { type: number; message: string } };

/** What a pane tells its host unasked: what is pointed at, null where nothing is, and where to go in the text. */
export type Tells = { "aidl/hover": { place: Place | null }; "aidl/goto": { uri: string; range: Range } };
export type Tell = <N extends keyof Tells>(method: N, params: Tells[N]) => void;

/** JSON-RPC, in either direction. */
export interface Message {
  jsonrpc: "2.0";
  id?: number;
  method?: string;
  params?: unknown;
  result?: unknown;
  error?: { code: number; message: string };
}

/** What VS Code gives a webview. */
export interface VsCodeApi {
  postMessage(message: Message): void;
  getState(): unknown;
  setState(state: unknown): void;
}

/** What of a WebSocket the pane needs to talk to its host. `readyState` is that of one. It may open again, when the host
 * has another program. */
export interface Line {
  readonly readyState: number;
  send(text: string): void;
  /** A message has `data`, a close has the `reason`. */
  addEventListener(type: "open" | "message" | "close", listener: (event: any) => void): void;
}

declare global {
  function acquireVsCodeApi(): VsCodeApi;
  /** Where a page has it, it is called in place of opening a WebSocket. */
  function dialAidl(): Line;
}
