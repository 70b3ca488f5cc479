/** How solving went, in the status bar, for the program in front. */

import * as vscode from "vscode";

import type { Previews } from "./preview/panels";
import type { RunStatus } from "./preview/protocol";
import type { Server } from "./server/server";
import { wordsFor } from "./status";

export class StatusItem implements vscode.Disposable {
  private readonly item = vscode.window.createStatusBarItem("aidl.status", vscode.StatusBarAlignment.Right, 90);
  private readonly runs = new Map<string, RunStatus>();
  private readonly subscriptions: vscode.Disposable[];

  constructor(
    private readonly server: Server,
    private readonly previews: Previews,
  ) {
    this.item.name = "AIDL";
    this.subscriptions = [
      this.item,
      server.onState((state) => {
        if (state !== "running") this.runs.clear();
        this.update();
      }),
      server.onRun((run) => {
        this.runs.set(vscode.Uri.parse(run.uri).toString(), run);
        this.update();
      }),
      vscode.window.onDidChangeActiveTextEditor(() => this.update()),
      previews.onActive(() => this.update()),
      vscode.workspace.onDidCloseTextDocument(({ uri }) => this.runs.delete(uri.toString())),
    ];
    this.update();
  }

  dispose(): void {
    for (const subscription of this.subscriptions) subscription.dispose();
  }

  private update(): void {
    const document = this.previews.active;
    if (document === undefined) return this.item.hide();
    const { state } = this.server;
    const { text, tooltip, severity } = wordsFor(state, this.runs.get(document.toString()) ?? null);
    this.item.text = text;
    this.item.tooltip = tooltip;
    this.item.command = state === "stopped" ? "aidl.restartServer" : "aidl.openPreview";
    this.item.backgroundColor =
      severity === "none" ? undefined : new vscode.ThemeColor(`statusBarItem.${severity}Background`);
    this.item.show();
  }
}
