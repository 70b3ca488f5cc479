/** Stands between one pane and the language server: what the pane asks is asked of the server, what both say is handed
 * on. Knows nothing of VS Code, which it reaches through `Editor`. */

import { messageOf } from "../errors";
import { elementsAt } from "./elements";
import type { ExportWish, Message, Name, Params, Place, Position, Preview, Range, Requests, Tells, Told } from "./protocol";

/** What the relay needs of the editor. */
export interface Editor {
  readonly uri: string;
  /** Whether there is a server to ask; when there is one again, `refresh` is called. */
  connected(): boolean;
  post(message: Message): void;
  ask<N extends Name>(method: N, params: Params<N>): Promise<Requests[N]["result"]>;
  /** Shows in the text where something is written; null: nothing. */
  mark(place: Place | null): void;
  goto(uri: string, range: Range): void;
  export(wish: ExportWish, layers: readonly string[]): Promise<void>;
}

/** A run that takes longer than this, in ms, is announced. */
export const BUSY_AFTER = 150;

/** What a pane may ask of the server. */
const ASKED = new Set<string>(["aidl/preview", "aidl/try", "aidl/setKnob", "aidl/drag", "aidl/fix", "aidl/exports", "aidl/ranges"]);
const METHOD_NOT_FOUND = -32601;
const FAILED = -32803;

export class Relay {
  private picture: Preview | null = null;
  private caret: Position | null = null;
  private revealed: string = "";
  private busy: ReturnType<typeof setTimeout> | undefined;
  private hasChosen = false;

  /** `layers` are those of the settings, which are shown until others are chosen in the pane. */
  constructor(
    private readonly editor: Editor,
    private layers: readonly string[],
  ) {}

  /** Asks for the picture anew, for example after the server was started again. */
  async refresh(): Promise<void> {
    const { uri } = this.editor;
    if (!this.editor.connected()) return;
    try {
      const picture = await this.editor.ask("aidl/preview", { uri, show: this.layers });
      if (picture !== null) this.show(picture);
    } catch (error) {
      this.tell({ method: "window/showMessage", params: { type: 1, message: messageOf(error) } });
    }
  }

  /** The server has run the program. News that come late, of a text before the one shown, are dropped. */
  changed(picture: Preview): void {
    if (this.picture !== null && picture.version < this.picture.version) return;
    this.show(picture);
  }

  /** The text was changed; its picture is on the way. */
  edited(): void {
    this.busy ??= setTimeout(() => this.tell({ method: "aidl/busy" }), BUSY_AFTER);
  }

  caretMoved(caret: Position): void {
    this.caret = caret;
    this.reveal();
  }

  /** What the pane says: a request, which is answered in any case, or what it only tells. */
  async receive({ id, method, params }: Message): Promise<void> {
    if (method === undefined) return;
    if (id === undefined) return this.heard(method, params);
    try {
      this.editor.post({ jsonrpc: "2.0", id, result: await this.answer(method, params) });
    } catch (error) {
      this.editor.post({ jsonrpc: "2.0", id, error: { code: codeOf(error), message: messageOf(error) } });
    }
    if (method === "aidl/preview") this.reveal();
  }

  dispose(): void {
    this.rested();
    this.editor.mark(null);
  }

  private async answer(method: string, params: unknown): Promise<unknown> {
    if (method === "aidl/export") {
      const { format, options } = params as Params<typeof method>;
      await this.editor.export({ format, ...(options === undefined ? {} : { options }) }, this.layers);
      return null; // it is saved already
    }
    if (!ASKED.has(method)) throw Object.assign(new Error(`There is no ${method}.`), { code: METHOD_NOT_FOUND });
    if (method !== "aidl/preview") return this.editor.ask(method as Name, params as Params<Name>);
    const { show } = params as Params<typeof method>;
    this.hasChosen ||= show.length > 0;
    if (this.hasChosen) this.layers = show;
    if (!this.editor.connected()) return this.picture;
    const picture = await this.editor.ask(method, { uri: this.editor.uri, show: this.layers });
    if (picture !== null) this.keep(picture);
    return picture;
  }

  private heard(method: string, params: unknown): void {
    if (method === "aidl/hover") this.editor.mark((params as Tells[typeof method]).place);
    if (method === "aidl/goto") {
      const { uri, range } = params as Tells[typeof method];
      this.editor.goto(uri, range);
    }
  }

  private show(picture: Preview): void {
    this.keep(picture);
    this.tell({ method: "aidl/previewChanged", params: picture });
    this.reveal();
  }

  private keep(picture: Preview): void {
    this.picture = picture;
    this.revealed = "";
    this.rested();
  }

  private tell(told: Told): void {
    this.editor.post({ jsonrpc: "2.0", ...told });
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
    this.tell({ method: "aidl/reveal", params: { elements } });
  }
}

/** The code that an error of JSON-RPC carries. */
const codeOf = (error: unknown): number =>
  error instanceof Error && "code" in error && typeof error.code === "number" ? error.code : FAILED;
