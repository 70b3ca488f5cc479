/** What is said between the pane, this extension and the language server. The pane owns the types of its messages. */

import type { FromHost, Preview, Status, Value, Vec } from "../../../../aidl_lang/tools/preview/pane/protocol";

export type {
  Element,
  Format,
  FromHost,
  Layer,
  Place,
  Position,
  Preview,
  Problem,
  Range,
  Status,
  ToHost,
  Value,
  Vec,
} from "../../../../aidl_lang/tools/preview/pane/protocol";

/** The answer to a request that edits the text. */
export interface Applied {
  applied: boolean;
  reason?: string;
}

/** A file, as the server writes it; `data` is base64. */
export interface Exported {
  name: string;
  data: string;
}

/** After every run of an open document, whether it is previewed or not. */
export interface RunStatus {
  uri: string;
  version: number;
  status: Status;
  degrees: number | null;
  seconds: number;
  problems: { errors: number; warnings: number };
}

/** The requests that the server answers beyond those of the protocol that all editors speak. */
export interface Requests {
  "aidl/preview": { params: { uri: string; show: string[] }; result: Preview | null };
  "aidl/previewClose": { params: { uri: string }; result: null };
  "aidl/try": { params: { uri: string; version: number } & Attempt; result: Preview | null };
  "aidl/setKnob": { params: { uri: string; version: number; path: string; value: Value }; result: Applied };
  "aidl/drag": { params: { uri: string; version: number; id: string; to: Vec }; result: Applied };
  "aidl/fix": { params: { uri: string; version: number; problem: number; fix: number }; result: Applied };
  "aidl/export": { params: { uri: string; format: string; show?: string[] }; result: Exported };
}

/** Values to solve with that are not in the text. */
export type Attempt = { knobs: Record<string, Value> } | { drag: { id: string; to: Vec } };

/** The requests by name, for whoever can ask the server. */
export type Ask = <Name extends keyof Requests>(
  name: Name,
  params: Requests[Name]["params"],
) => Promise<Requests[Name]["result"]>;

export type Picture = Extract<FromHost, { type: "picture" }>;
