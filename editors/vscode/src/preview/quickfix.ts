/** Fixes of a problem as the editor's own quick fixes offer them. */

import * as vscode from "vscode";

import type { Problem } from "./protocol";
import { toRange } from "./ranges";

/** Applies the fix with this index among those for the problem; false if there is none. */
export async function applyQuickFix(document: vscode.Uri, problem: Problem, index: number): Promise<boolean> {
  if (problem.range === null) return false;
  const range = toRange(problem.range);
  const uri = problem.uri === null ? document : vscode.Uri.parse(problem.uri);
  const actions = await vscode.commands.executeCommand<vscode.CodeAction[]>(
    "vscode.executeCodeActionProvider",
    uri,
    range,
    vscode.CodeActionKind.QuickFix.value,
  );
  const action = actions.filter((one) =>
    one.diagnostics?.some((diagnostic) => {
      const code = typeof diagnostic.code === "object" ? diagnostic.code.value : diagnostic.code;
      return code === problem.code && diagnostic.range.start.isEqual(range.start);
    }),
  )[index];
  if (action === undefined) return false;
  if (action.edit !== undefined && !(await vscode.workspace.applyEdit(action.edit))) return false;
  if (action.command !== undefined)
    await vscode.commands.executeCommand(action.command.command, ...(action.command.arguments ?? []));
  return true;
}
