/** Ranges of the protocol as VS Code's: both count lines and UTF-16 units from 0. */

import * as vscode from "vscode";

import type { Position, Range } from "./protocol";

export const toRange = ({ start, end }: Range): vscode.Range =>
  new vscode.Range(start.line, start.character, end.line, end.character);

export const toPosition = ({ line, character }: vscode.Position): Position => ({ line, character });
