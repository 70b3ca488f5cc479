/** Files made of a drawing. */

import * as vscode from "vscode";

import { FORMATS } from "../../../../aidl_lang/tools/preview/pane/formats.js";
import type { Ask, Format } from "./protocol";

/** Undefined: the reader thought better of it. */
export async function chooseFormat(): Promise<Format | undefined> {
  const picked = await vscode.window.showQuickPick(
    FORMATS.map(([format, description]) => ({ label: format.toUpperCase(), description, format })),
    { title: "Export the drawing as", matchOnDescription: true },
  );
  return picked?.format;
}

/** Has the server draw the program and saves that where the reader says. Rejects with what went wrong. */
export async function exportDrawing(
  ask: Ask,
  document: vscode.Uri,
  format: string,
  layers: readonly string[],
): Promise<void> {
  const file = await vscode.window.withProgress(
    { location: vscode.ProgressLocation.Window, title: `AIDL: draws ${format.toUpperCase()}` },
    () => ask("aidl/export", { uri: document.toString(), format, show: [...layers] }),
  );
  if (file === null) throw new Error("The language server made no file.");
  const folder = document.scheme === "file" ? vscode.Uri.joinPath(document, "..") : firstFolder();
  const target = await vscode.window.showSaveDialog({
    ...(folder === undefined ? {} : { defaultUri: vscode.Uri.joinPath(folder, file.name) }),
    filters: { [format.toUpperCase()]: [format] },
    saveLabel: "Export",
  });
  if (target === undefined) return;
  await vscode.workspace.fs.writeFile(target, Buffer.from(file.data, "base64"));
  const open = "Open";
  void vscode.window.showInformationMessage(`Exported ${vscode.workspace.asRelativePath(target)}`, open).then((answer) => {
    if (answer === open) void vscode.commands.executeCommand("vscode.open", target);
  });
}

const firstFolder = (): vscode.Uri | undefined => vscode.workspace.workspaceFolders?.[0]?.uri;
