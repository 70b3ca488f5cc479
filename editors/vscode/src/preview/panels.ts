/** The previews that are open: one for each document. */

import { randomBytes } from "node:crypto";
import * as vscode from "vscode";

import type { Server } from "../server/server";
import { previewLayers } from "../settings";
import { exportDrawing } from "./export";
import { Marks } from "./marks";
import { complete } from "./page";
import type { Message, Place, Range } from "./protocol";
import { toPosition, toRange } from "./ranges";
import { Relay } from "./relay";

const TYPE = "aidl.preview";

interface Open {
  panel: vscode.WebviewPanel;
  relay: Relay;
}

export class Previews implements vscode.Disposable, vscode.WebviewPanelSerializer {
  private readonly open = new Map<string, Open>();
  private readonly marks = new Marks();
  private readonly pane: vscode.Uri;
  private readonly icon: { light: vscode.Uri; dark: vscode.Uri };
  private readonly subscriptions: vscode.Disposable[];
  private readonly changedActive = new vscode.EventEmitter<void>();
  readonly onActive = this.changedActive.event;

  constructor(
    extension: vscode.Uri,
    private readonly server: Server,
  ) {
    this.pane = vscode.Uri.joinPath(extension, "media", "pane");
    const icon = (theme: string): vscode.Uri => vscode.Uri.joinPath(extension, "icons", `aidl-${theme}.svg`);
    this.icon = { light: icon("light"), dark: icon("dark") };
    this.subscriptions = [
      this.marks,
      this.changedActive,
      vscode.window.registerWebviewPanelSerializer(TYPE, this),
      server.onPreview((preview) => this.open.get(normal(preview.uri))?.relay.changed(preview)),
      server.onState((state) => {
        if (state === "running") for (const { relay } of this.open.values()) void relay.refresh();
      }),
      vscode.workspace.onDidChangeTextDocument(({ document, contentChanges }) => {
        if (contentChanges.length > 0) this.open.get(document.uri.toString())?.relay.edited();
      }),
      vscode.window.onDidChangeTextEditorSelection(({ textEditor }) => this.followCaret(textEditor)),
      vscode.workspace.onDidCloseTextDocument((document) => void this.closed(document)),
      vscode.workspace.onDidRenameFiles(({ files }) => files.forEach((file) => void this.renamed(file))),
    ];
  }

  /** Shows the preview of a document beside its text, or brings forward the one there is. */
  async show(document: vscode.Uri): Promise<void> {
    const there = this.open.get(document.toString());
    if (there !== undefined) return there.panel.reveal(undefined, true);
    await vscode.workspace.openTextDocument(document);
    const column = { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true };
    await this.adopt(vscode.window.createWebviewPanel(TYPE, "Preview", column, { retainContextWhenHidden: true }), document);
  }

  /** The program in front: the one whose preview or text has the focus. */
  get active(): vscode.Uri | undefined {
    for (const [uri, { panel }] of this.open) if (panel.active) return vscode.Uri.parse(uri);
    const document = vscode.window.activeTextEditor?.document;
    return document?.languageId === "aidl" ? document.uri : undefined;
  }

  /** After a reload of the window: the pane keeps the URI of its document. */
  async deserializeWebviewPanel(panel: vscode.WebviewPanel, state: unknown): Promise<void> {
    const uri = typeof state === "object" && state !== null && "uri" in state ? state.uri : undefined;
    if (typeof uri !== "string" || this.open.has(normal(uri))) return panel.dispose();
    const document = vscode.Uri.parse(uri);
    try {
      await vscode.workspace.openTextDocument(document);
    } catch {
      return panel.dispose(); // the file is gone, and with it what there was to preview
    }
    await this.adopt(panel, document);
  }

  dispose(): void {
    for (const { panel } of [...this.open.values()]) panel.dispose();
    for (const subscription of this.subscriptions) subscription.dispose();
  }

  private async adopt(panel: vscode.WebviewPanel, document: vscode.Uri): Promise<void> {
    const uri = document.toString();
    const relay = this.relay(panel, document);
    this.open.set(uri, { panel, relay });
    panel.title = `Preview ${nameOf(document)}`;
    panel.iconPath = this.icon;
    panel.onDidDispose(() => {
      relay.dispose();
      this.open.delete(uri);
      this.changedActive.fire();
      if (this.server.state === "running") void this.server.ask("aidl/previewClose", { uri }).catch(() => undefined);
    });
    panel.onDidChangeViewState(() => this.changedActive.fire());
    panel.webview.options = { enableScripts: true, localResourceRoots: [this.pane] };
    panel.webview.onDidReceiveMessage((message: Message) => void relay.receive(message));
    panel.webview.html = await this.page(panel.webview, uri);
    const editor = vscode.window.visibleTextEditors.find((one) => one.document.uri.toString() === uri);
    if (editor !== undefined) this.followCaret(editor);
  }

  private relay(panel: vscode.WebviewPanel, document: vscode.Uri): Relay {
    const uri = document.toString();
    return new Relay(
      {
        uri,
        connected: () => this.server.state === "running",
        post: (message) => void panel.webview.postMessage(message),
        ask: this.server.ask,
        mark: (place) => this.marks.mark(place === null ? null : normalPlace(place)),
        goto: (file, range) => void goto(vscode.Uri.parse(file), range, panel.viewColumn),
        export: (wish, layers) => exportDrawing(this.server.ask, document, wish, layers),
      },
      previewLayers(),
    );
  }

  private async page(webview: vscode.Webview, uri: string): Promise<string> {
    const template = await vscode.workspace.fs.readFile(vscode.Uri.joinPath(this.pane, "index.html"));
    return complete(Buffer.from(template).toString("utf8"), {
      source: webview.cspSource,
      root: webview.asWebviewUri(this.pane).toString(),
      nonce: randomBytes(16).toString("base64url"),
      uri,
    });
  }

  private followCaret({ document, selection }: vscode.TextEditor): void {
    this.open.get(document.uri.toString())?.relay.caretMoved(toPosition(selection.active));
  }

  /** The text's tab was closed and the preview was not: the document is opened again, without a tab. */
  private async closed({ uri }: vscode.TextDocument): Promise<void> {
    const there = this.open.get(uri.toString());
    if (there === undefined) return;
    try {
      await vscode.workspace.openTextDocument(uri);
    } catch {
      return there.panel.dispose(); // an untitled text, or the file was deleted
    }
    void there.relay.refresh();
  }

  private async renamed({ oldUri, newUri }: { oldUri: vscode.Uri; newUri: vscode.Uri }): Promise<void> {
    const there = this.open.get(oldUri.toString());
    if (there === undefined) return;
    there.panel.dispose();
    await this.show(newUri);
  }
}

/** A URI as VS Code writes it: servers escape other characters. */
const normal = (uri: string): string => vscode.Uri.parse(uri).toString();

const normalPlace = ({ uri, range }: Place): Place => ({ uri: uri === null ? null : normal(uri), range });

const nameOf = (uri: vscode.Uri): string => uri.path.slice(uri.path.lastIndexOf("/") + 1);

/** Moves the caret, in the editor that shows the file if one does, else beside the preview. */
async function goto(uri: vscode.Uri, range: Range, preview: vscode.ViewColumn | undefined): Promise<void> {
  const shown = vscode.window.visibleTextEditors.find((one) => one.document.uri.toString() === uri.toString());
  const other = preview === vscode.ViewColumn.One ? vscode.ViewColumn.Two : vscode.ViewColumn.One;
  const editor = await vscode.window.showTextDocument(uri, { viewColumn: shown?.viewColumn ?? other });
  const { start } = toRange(range);
  editor.selection = new vscode.Selection(start, start);
  editor.revealRange(toRange(range), vscode.TextEditorRevealType.InCenterIfOutsideViewport);
}
