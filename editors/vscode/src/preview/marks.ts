/** Shows in the text what the pointer is over in a picture. */

import * as vscode from "vscode";

import type { Place } from "./protocol";
import { toRange } from "./ranges";

export class Marks implements vscode.Disposable {
  private readonly decoration = vscode.window.createTextEditorDecorationType({
    backgroundColor: new vscode.ThemeColor("editor.wordHighlightStrongBackground"),
    borderRadius: "2px",
    overviewRulerColor: new vscode.ThemeColor("editorOverviewRuler.wordHighlightStrongForeground"),
    overviewRulerLane: vscode.OverviewRulerLane.Full,
  });

  mark(place: Place | null): void {
    for (const editor of vscode.window.visibleTextEditors) {
      const here = place?.range && place.uri === editor.document.uri.toString();
      editor.setDecorations(this.decoration, here && place.range ? [toRange(place.range)] : []);
    }
  }

  dispose(): void {
    this.decoration.dispose();
  }
}
