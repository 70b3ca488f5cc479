/** Files made of a drawing. */

import * as vscode from "vscode";

import type { Ask, ExportWish } from "./protocol";

/** Undefined: the reader thought better of it. */
export async function chooseFormat(ask: Ask, document: vscode.Uri): Promise<string | undefined> {
  const { formats } = await ask("aidl/exports", { uri: document.toString() });
  const picked = await vscode.window.showQuickPick(
    formats.map(({ name, label }) => ({ label: name.toUpperCase(), description: label, name })),
    { title: "Export the drawing as", matchOnDescription: true },
  );
  return picked?.name;
}

/** Has the server draw the program and saves that where the reader says. Rejects with what went wrong. */
export async function exportDrawing(
  ask: Ask,
  document: vscode.Uri,
  wish: ExportWish,
  layers: readonly string[],
): Promise<void> {
  const file = await vscode.window.withProgress(
    { location: vscode.ProgressLocation.Window, title: `AIDL: draws ${wish.format.toUpperCase()}` },
    () => ask("aidl/export", { uri: document.toString(), ...wish, show: [...layers] }),
  );
  if (file === null) throw new Error("The language server made no file.");
  if (file.notes.length > 0) void vscode.window.showWarningMessage(`AIDL: ${file.notes.join("; ")}`);
  const suffix = file.name.slice(file.name.lastIndexOf(".") + 1); // several files come as an archive
  const folder = document.scheme === "file" ? vscode.Uri.joinPath(document, "..") : firstFolder();
  const target = await vscode.window.showSaveDialog({
    ...(folder === undefined ? {} : { defaultUri: vscode.Uri.joinPath(folder, file.name) }),
    filters: { [suffix.toUpperCase()]: [suffix] },
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
