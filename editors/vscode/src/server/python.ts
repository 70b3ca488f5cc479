/** The interpreter that is selected in the Python extension, if that is installed. */

import * as vscode from "vscode";

/** What is used of the API of `ms-python.python`. */
interface PythonApi {
  environments?: { getActiveEnvironmentPath?: (resource?: vscode.Uri) => { path: string } };
}

/** Path of the interpreter or of the folder of its environment; null where none is known. */
export async function selectedPython(): Promise<string | null> {
  const extension = vscode.extensions.getExtension<PythonApi>("ms-python.python");
  if (extension === undefined) return null;
  const api = await extension.activate();
  const folder = vscode.workspace.workspaceFolders?.[0]?.uri;
  return api.environments?.getActiveEnvironmentPath?.(folder).path ?? null;
}
