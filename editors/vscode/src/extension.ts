/** AIDL in VS Code: starts the language server and has its commands, previews and status. */

import * as vscode from "vscode";

import { messageOf } from "./errors";
import { newProgram } from "./newProgram";
import { chooseFormat, exportDrawing } from "./preview/export";
import { Previews } from "./preview/panels";
import { Server } from "./server/server";
import { previewLayers, toggleSolvedValues } from "./settings";
import { StatusItem } from "./statusItem";

let server: Server | null = null;

export function activate(context: vscode.ExtensionContext): void {
  const output = vscode.window.createOutputChannel("AIDL", { log: true });
  const language = (server = new Server(output));
  const previews = new Previews(context.extensionUri, language);
  context.subscriptions.push(output, language, previews, new StatusItem(language, previews));

  const commands: Record<string, (target?: unknown) => Promise<void> | void> = {
    "aidl.openPreview": (target) => withDocument(target, previews, (document) => previews.show(document)),
    "aidl.export": (target) =>
      withDocument(target, previews, async (document) => {
        const format = await chooseFormat(language.ask, document);
        if (format !== undefined) await exportDrawing(language.ask, document, { format }, previewLayers());
      }),
    "aidl.newProgram": (target) => newProgram(language, target instanceof vscode.Uri ? target : undefined),
    "aidl.toggleSolvedValues": toggleSolvedValues,
    "aidl.restartServer": () => language.restart(),
    "aidl.showOutput": () => output.show(),
  };
  for (const [name, run] of Object.entries(commands))
    context.subscriptions.push(vscode.commands.registerCommand(name, (target?: unknown) => told(run, target)));

  context.subscriptions.push(
    vscode.workspace.onDidGrantWorkspaceTrust(() => void language.restart()),
    vscode.workspace.onDidChangeConfiguration((change) => {
      if (change.affectsConfiguration("aidl.server.command")) void language.restart();
    }),
  );
  void language.restart();
}

export async function deactivate(): Promise<void> {
  await server?.stop();
  server = null;
}

/** `target` is the URI that a menu gives, or that of a code lens as text; else what is in front is meant. */
async function withDocument(
  target: unknown,
  previews: Previews,
  action: (document: vscode.Uri) => Promise<void>,
): Promise<void> {
  const document =
    target instanceof vscode.Uri
      ? target
      : typeof target === "string"
        ? vscode.Uri.parse(target)
        : previews.active;
  if (document === undefined) throw new Error("Open an AIDL program first.");
  await action(document);
}

/** Runs a command and tells the reader if it fails. */
async function told(run: (target?: unknown) => Promise<void> | void, target: unknown): Promise<void> {
  try {
    await run(target);
  } catch (error) {
    void vscode.window.showErrorMessage(`AIDL: ${messageOf(error)}`);
  }
}
