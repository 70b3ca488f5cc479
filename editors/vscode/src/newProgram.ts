/** A new program to change, written by `aidl new`. */

import { execFile } from "node:child_process";
import { dirname } from "node:path";
import { promisify } from "node:util";
import * as vscode from "vscode";

import { isFound, otherVerb } from "./server/find";
import type { Server } from "./server/server";

/** Asks where, writes the program and opens it. Rejects with what went wrong. `folder` is where to begin. */
export async function newProgram(server: Server, folder: vscode.Uri | undefined): Promise<void> {
  const start = folder ?? vscode.workspace.workspaceFolders?.[0]?.uri;
  const target = await vscode.window.showSaveDialog({
    ...(start === undefined ? {} : { defaultUri: vscode.Uri.joinPath(start, "part.aidl") }),
    filters: { AIDL: ["aidl"] },
    title: "New AIDL program",
    saveLabel: "Create",
  });
  if (target === undefined) return;
  const { found } = await server.locate();
  const command = isFound(found) ? otherVerb(found, "new", target.fsPath) : undefined;
  if (command === undefined) throw new Error("The program `aidl`, which writes new programs, was not found.");
  await run(command.program, command.arguments, dirname(target.fsPath));
  await vscode.window.showTextDocument(target);
}

/** Rejects with what the program said. */
async function run(program: string, args: string[], folder: string): Promise<void> {
  try {
    await promisify(execFile)(program, args, { cwd: folder, windowsHide: true });
  } catch (error) {
    const said = error instanceof Error && "stderr" in error ? String(error.stderr).trim() : "";
    throw new Error(said === "" ? `${program} failed.` : said, { cause: error });
  }
}
