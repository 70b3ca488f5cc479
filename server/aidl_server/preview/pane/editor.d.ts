/** What the pane needs of editor.js, which is made from editors/codemirror/pane/editor.ts. */

import type { Change, Range } from "./protocol.js";

export interface Finding { range: Range; severity: "error" | "warning" | "info"; message: string }

export interface Listener {
  typed(): void;
  save(): void;
  undo(): void;
  redo(): void;
  moved(line: number): void;
  pointed(line: number | null): void;
  tooLong(): void;
}

export class Editor {
  constructor(parent: HTMLElement, text: string, nonce: string, listener: Listener);
  readonly hasTyped: boolean;
  changes(): Change[];
  handOver(): () => void;
  become(text: string): void;
  keep(text: string): void;
  find(findings: readonly Finding[]): void;
  mark(name: "marked" | "selected", ranges: readonly Range[], scroll: boolean): void;
  go(range: Range): void;
}
