/** Stands between one pane and the language server: what the pane says becomes requests, what the server says becomes
 * pictures. Knows nothing of VS Code, which it reaches through `Editor`. */

import { messageOf } from "../errors";
import { elementsAt } from "./elements";
import { Latest } from "./latest";
import type {
  Applied,
  Ask,
  Attempt,
  FromHost,
  Place,
  Position,
  Preview,
  Problem,
  Range,
  ToHost,
} from "./protocol";

/** What the relay needs of the editor. */
export interface Editor {
  readonly uri: string;
  /** Of the document as it is now; null where it is not open. */
  version(): number | null;
  /** Whether there is a server to ask; when there is one again, `refresh` is called. */
  connected(): boolean;
  post(message: FromHost): void;
  ask: Ask;
  /** Shows in the text where something is written; null: nothing. */
  mark(place: Place | null): void;
  goto(uri: string, range: Range): void;
  /** Applies a fix without the server's own request; false if there is no such fix. */
  quickFix(problem: Problem, fix: number): Promise<boolean>;
  export(format: string, layers: readonly string[]): Promise<void>;
}

/** A run that takes longer than this, in ms, is announced. */
export const BUSY_AFTER = 150;

/** Codes of LSP for requests that were overtaken by another: nothing that a reader should be told. */
const OVERTAKEN = new Set([-32800, -32801, -32802]);
const METHOD_NOT_FOUND = -32601;

export class Relay {
  private picture: Preview | null = null;
  private caret: Position | null = null;
  private revealed: string = "";
  private busy: ReturnType<typeof setTimeout> | undefined;
  private edits: Promise<void> = Promise.resolve();
  /** Counts what makes the answer to an earlier try worthless. */
  private epoch = 0;
  private readonly tries = new Latest<Attempt>((attempt) => this.attempt(attempt));

  constructor(
    private readonly editor: Editor,
    private layers: readonly string[],
  ) {}

  /** Asks for the picture anew, for example after the server was started again. */
  async refresh(): Promise<void> {
    const { uri } = this.editor;
    this.forgetTries();
    if (!this.editor.connected()) return;
    await this.guarded(async () => {
      const picture = await this.editor.ask("aidl/preview", { uri, show: [...this.layers] });
      if (picture !== null) this.show(picture);
    });
  }

  /** The server has run the program. News that come late, of a text before the one shown, are dropped. */
  changed(picture: Preview): void {
    if (this.picture !== null && picture.version < this.picture.version) return;
    this.show(picture);
  }

  /** The text was changed; its picture is on the way. */
  edited(): void {
    this.busy ??= setTimeout(() => this.editor.post({ type: "busy" }), BUSY_AFTER);
  }

  caretMoved(caret: Position): void {
    this.caret = caret;
    this.reveal();
  }

  async receive(message: ToHost): Promise<void> {
    switch (message.type) {
      case "ready":
        if (this.picture !== null) this.show(this.picture);
        return this.refresh();
      case "cancel":
        return this.refresh();
      case "show":
        this.layers = message.layers;
        return this.refresh();
      case "knob": {
        const { path, value } = message;
        if (!message.final) return this.tries.put({ knobs: { [path]: value } });
        return this.edit((version) => this.editor.ask("aidl/setKnob", { ...this.at(version), path, value }));
      }
      case "drag": {
        const { id, to } = message;
        if (!message.final) return this.tries.put({ drag: { id, to } });
        return this.edit((version) => this.editor.ask("aidl/drag", { ...this.at(version), id, to }));
      }
      case "fix":
        return this.edit((_, shown) => this.fix(message.problem, message.fix, shown));
      case "hover":
        return this.editor.mark(this.element(message.element));
      case "goto": {
        const { uri, range } = "element" in message ? (this.element(message.element) ?? NOWHERE) : message;
        return uri === null || range === null ? undefined : this.editor.goto(uri, range);
      }
      case "export":
        return this.guarded(() => this.editor.export(message.format, this.layers));
    }
  }

  dispose(): void {
    this.forgetTries();
    this.rested();
    this.editor.mark(null);
  }

  private at(version: number): { uri: string; version: number } {
    return { uri: this.editor.uri, version };
  }

  private element(index: number | null): Place | null {
    return index === null ? null : (this.picture?.elements[index] ?? null);
  }

  private show(picture: Preview): void {
    this.picture = picture;
    this.rested();
    this.editor.post({ type: "picture", ...picture });
    this.revealed = "";
    this.reveal();
  }

  private rested(): void {
    clearTimeout(this.busy);
    this.busy = undefined;
  }

  private reveal(): void {
    if (this.picture === null || this.caret === null) return;
    const elements = elementsAt(this.picture.elements, this.editor.uri, this.caret);
    if (elements.join() === this.revealed) return;
    this.revealed = elements.join();
    this.editor.post({ type: "reveal", elements });
  }

  /** Solves with values that are not in the text. Every try is answered: the pane waits for it. */
  private async attempt(attempt: Attempt): Promise<void> {
    const epoch = this.epoch;
    await this.guarded(async () => {
      const tried = await this.editor.ask("aidl/try", { ...this.at(this.version()), ...attempt });
      if (epoch !== this.epoch) return;
      const answer = tried === null ? this.picture : { ...tried, tried: true };
      if (answer !== null) this.editor.post({ type: "picture", ...answer });
    });
  }

  private forgetTries(): void {
    this.epoch += 1;
    this.tries.clear();
  }

  private version(): number {
    return this.editor.version() ?? this.picture?.version ?? 0;
  }

  /** Edits the text, one edit after the other so that each knows the version that the one before made. `shown` is the
   * version of the picture that the reader saw. What was tried meanwhile is forgotten. */
  private edit(change: (version: number, shown: number) => Promise<Applied>): Promise<void> {
    const shown = this.picture?.version ?? 0;
    this.forgetTries();
    this.edits = this.edits.then(() =>
      this.guarded(async () => {
        const { applied, reason } = await change(this.version(), shown);
        if (applied) return;
        this.editor.post({ type: "error", message: reason ?? "This could not be written into the text." });
        if (this.picture !== null) this.show(this.picture);
      }),
    );
    return this.edits;
  }

  private async fix(index: number, fix: number, version: number): Promise<Applied> {
    const problem = this.picture?.problems[index];
    if (problem === undefined) return { applied: false, reason: "This problem is gone." };
    try {
      return await this.editor.ask("aidl/fix", { ...this.at(version), problem: index, fix });
    } catch (error) {
      if (codeOf(error) !== METHOD_NOT_FOUND) throw error;
      const applied = await this.editor.quickFix(problem, fix);
      return applied ? { applied } : { applied, reason: "The language server offers no such fix." };
    }
  }

  /** Tells the reader what went wrong, except that something newer came first. Then the picture of the text is shown. */
  private async guarded(action: () => Promise<void>): Promise<void> {
    try {
      await action();
    } catch (error) {
      if (!OVERTAKEN.has(codeOf(error))) this.editor.post({ type: "error", message: messageOf(error) });
      else if (this.picture !== null) this.show(this.picture);
    }
  }
}

const NOWHERE: Place = { uri: null, range: null };

/** The code that an error of JSON-RPC carries; 0 for others. */
const codeOf = (error: unknown): number =>
  error instanceof Error && "code" in error && typeof error.code === "number" ? error.code : 0;
