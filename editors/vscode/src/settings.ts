/** The settings that the extension reads itself; the server asks for its own. */

import * as vscode from "vscode";

const SOLVED_VALUES = "inlayHints.solvedValues";

const settings = (scope?: vscode.Uri): vscode.WorkspaceConfiguration => vscode.workspace.getConfiguration("aidl", scope);

export const serverCommand = (): string[] => settings().get<string[]>("server.command", ["aidl", "lsp"]);

export const previewLayers = (): string[] => settings().get<string[]>("preview.layers", []);

/** Changes the setting where it is set, or for the user. */
export async function toggleSolvedValues(): Promise<void> {
  const found = settings().inspect<boolean>(SOLVED_VALUES);
  const target =
    found?.workspaceValue === undefined ? vscode.ConfigurationTarget.Global : vscode.ConfigurationTarget.Workspace;
  await settings().update(SOLVED_VALUES, !settings().get<boolean>(SOLVED_VALUES, true), target);
}
