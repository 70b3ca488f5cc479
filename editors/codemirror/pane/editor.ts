// The editor of the preview's pane: CodeMirror with what AIDL needs, behind what the pane asks of it. It keeps no history
// of its own: what is undone is told by the host, with what was changed elsewhere in the pane.
import { autocompletion, closeBrackets, closeBracketsKeymap, completionKeymap } from "@codemirror/autocomplete";
import { defaultKeymap, indentWithTab } from "@codemirror/commands";
import { bracketMatching, indentOnInput, indentUnit, syntaxHighlighting } from "@codemirror/language";
import { type Diagnostic, lintGutter, lintKeymap, setDiagnostics } from "@codemirror/lint";
import { highlightSelectionMatches, search, searchKeymap } from "@codemirror/search";
import {
  Annotation, ChangeSet, EditorState, type Extension, StateEffect, StateField, Text, type Transaction,
} from "@codemirror/state";
import {
  Decoration, type DecorationSet, drawSelection, EditorView, highlightActiveLine, highlightActiveLineGutter, keymap,
  lineNumbers,
} from "@codemirror/view";
import { tagHighlighter, tags as t } from "@lezer/highlight";
import { aidl } from "../src/index.js";

export interface Position { line: number; character: number }
export interface Range { start: Position; end: Position }
export interface Change { start: Position; end: Position; text: string }
export interface Finding { range: Range; severity: "error" | "warning" | "info"; message: string }
export type Mark = "marked" | "selected";

export interface Listener {
  /** Something was typed. */
  typed(): void;
  save(): void;
  undo(): void;
  redo(): void;
  /** The caret came to another line, by hand. */
  moved(line: number): void;
  /** Another line is under the pointer, or none. */
  pointed(line: number | null): void;
  /** More was to be put in than can be told. */
  tooLong(): void;
}

/** Most characters that can be put in at once. */
const LONGEST = 1_000_000;
const BREAK = /\r\n?|\n/;
const FOREIGN = Annotation.define<boolean>();
const mark = StateEffect.define<{ name: Mark; lines: readonly number[] }>();
const MARKS: Record<Mark, Decoration> = {
  marked: Decoration.line({ class: "marked" }),
  selected: Decoration.line({ class: "selected" }),
};

/** The lines that are marked in one of the ways. */
function marked(name: Mark): Extension {
  return StateField.define<DecorationSet>({
    create: () => Decoration.none,
    update(known, transaction) {
      let found = known.map(transaction.changes);
      for (const effect of transaction.effects) {
        if (!effect.is(mark) || effect.value.name !== name) continue;
        const { doc } = transaction.state;
        const lines = effect.value.lines.filter((line) => line < doc.lines);
        found = Decoration.set(lines.map((line) => MARKS[name].range(doc.line(line + 1).from)));
      }
      return found;
    },
    provide: (field) => EditorView.decorations.from(field),
  });
}

/** Classes of the pane's own for the classes of tokens. */
const COLOURS = tagHighlighter([
  { tag: [t.keyword, t.modifier, t.operatorKeyword], class: "token keyword" },
  { tag: [t.number, t.bool], class: "token number" },
  { tag: t.string, class: "token string" },
  { tag: t.comment, class: "token comment" },
  { tag: [t.typeName, t.className], class: "token type" },
  { tag: [t.function(t.variableName), t.function(t.propertyName)], class: "token function" },
  { tag: [t.attributeName, t.propertyName], class: "token property" },
  { tag: t.annotation, class: "token decorator" },
]);

/** The text in an editor. What the host has of it is `synced`; what was typed since then is `pending`. */
export class Editor {
  private readonly view: EditorView;
  private pending: ChangeSet | null = null;
  private synced: Text;
  private line = -1;

  constructor(parent: HTMLElement, text: string, nonce: string, private readonly listener: Listener) {
    const run = (what: () => void) => () => {
      what();
      return true;
    };
    const keys = [
      { key: "Mod-s", run: run(listener.save) },
      { key: "Mod-z", run: run(listener.undo) },
      { key: "Mod-Shift-z", run: run(listener.redo) },
      { key: "Mod-y", run: run(listener.redo) },
      { key: "Escape", run: () => { this.view.contentDOM.blur(); return true; } },
    ];
    const extensions: Extension[] = [
      EditorView.cspNonce.of(nonce),
      lineNumbers(), lintGutter(), highlightActiveLine(), highlightActiveLineGutter(), drawSelection(), bracketMatching(),
      closeBrackets(), indentOnInput(), indentUnit.of("    "), search({ top: true }), highlightSelectionMatches(),
      autocompletion({ activateOnTypingDelay: 200, selectOnOpen: false }), syntaxHighlighting(COLOURS), aidl(), marked("marked"), marked("selected"),
      keymap.of([
        ...closeBracketsKeymap, ...completionKeymap, ...searchKeymap, ...lintKeymap, ...keys, ...defaultKeymap, indentWithTab,
      ]),
      EditorState.tabSize.of(4),
      EditorState.changeFilter.of((transaction) => {
        const fits = transaction.newDoc.length - transaction.startState.doc.length <= LONGEST;
        if (!fits && !transaction.annotation(FOREIGN)) listener.tooLong();
        return fits || transaction.annotation(FOREIGN) === true;
      }),
      EditorView.contentAttributes.of({ "aria-label": "Text of the program", spellcheck: "false" }),
      EditorView.updateListener.of((update) => this.updated(update.transactions)),
      EditorView.domEventHandlers({
        pointermove: (event) => listener.pointed(this.lineAt(event)),
        pointerleave: () => listener.pointed(null),
      }),
    ];
    this.view = new EditorView({ parent, state: EditorState.create({ doc: text, extensions }) });
    this.synced = this.view.state.doc;
  }

  get text(): string {
    return this.view.state.doc.toString();
  }

  get hasTyped(): boolean {
    return this.pending !== null;
  }

  /** What was typed since the host was told last, for the text that it has. */
  changes(): Change[] {
    const found: Change[] = [];
    this.pending?.iterChanges((from, to, _, __, inserted) => {
      found.push({ start: place(this.synced, from), end: place(this.synced, to), text: inserted.toString() });
    });
    return found;
  }

  /** The host is given what there is. Returns what takes it back, if the host had another text already. */
  handOver(): () => void {
    const [given, before] = [this.pending, this.synced];
    this.pending = null;
    this.synced = this.view.state.doc;
    return () => {
      this.synced = before;
      if (given) this.pending = this.pending ? given.compose(this.pending) : given;
    };
  }

  /** The host has another text: what was typed here meanwhile is put into it. */
  become(text: string): void {
    const theirs = difference(this.synced, text);
    if (theirs === null) return;
    this.synced = theirs.apply(this.synced);
    const here = this.pending ? theirs.map(this.pending, true) : theirs;
    if (this.pending) this.pending = this.pending.map(theirs);
    this.view.dispatch({ changes: here, annotations: FOREIGN.of(true) });
  }

  /** Another host has this text, and not what was typed for the one before: all of that counts as typed anew. */
  keep(text: string): void {
    const theirs = this.synced = Text.of(text.split(BREAK));
    this.pending = difference(theirs, this.text);
  }

  find(findings: readonly Finding[]): void {
    const { doc } = this.view.state;
    const found: Diagnostic[] = findings.map(({ range, severity, message }) => {
      const from = offset(doc, range.start);
      return { from, to: Math.max(offset(doc, range.end), from), severity, message };
    });
    this.view.dispatch(setDiagnostics(this.view.state, found));
  }

  mark(name: Mark, ranges: readonly Range[], scroll: boolean): void {
    const lines = new Set<number>();
    for (const { start, end } of ranges) {
      const last = end.character === 0 && end.line > start.line ? end.line - 1 : end.line;
      for (let line = start.line; line <= last; line++) lines.add(line);
    }
    const sorted = [...lines].sort((a, b) => a - b);
    this.view.dispatch({ effects: mark.of({ name, lines: sorted }) });
    const first = ranges[0];
    if (!scroll || !first || this.view.hasFocus) return;
    this.view.dispatch({ effects: EditorView.scrollIntoView(offset(this.view.state.doc, first.start), { y: "nearest", yMargin: 20 }) });
  }

  /** Puts the caret somewhere. */
  go({ start, end }: Range): void {
    const { doc } = this.view.state;
    this.view.dispatch({ selection: { anchor: offset(doc, start), head: offset(doc, end) }, scrollIntoView: true });
    this.view.focus();
  }

  private updated(transactions: readonly Transaction[]): void {
    let typed = false;
    for (const transaction of transactions) {
      if (!transaction.docChanged || transaction.annotation(FOREIGN)) continue;
      this.pending = this.pending ? this.pending.compose(transaction.changes) : transaction.changes;
      typed = true;
    }
    if (typed) this.listener.typed();
    const line = this.view.state.doc.lineAt(this.view.state.selection.main.head).number - 1;
    if (line === this.line || typed || !transactions.some((each) => each.isUserEvent("select"))) return;
    this.line = line;
    this.listener.moved(line);
  }

  private lineAt(event: PointerEvent): number | null {
    const at = this.view.posAtCoords({ x: event.clientX, y: event.clientY }, false);
    return this.view.state.doc.lineAt(at).number - 1;
  }
}

function place(doc: Text, offset: number): Position {
  const { number, from } = doc.lineAt(offset);
  return { line: number - 1, character: offset - from };
}

function offset(doc: Text, { line, character }: Position): number {
  if (line >= doc.lines) return doc.length;
  const { from, to } = doc.line(line + 1);
  return Math.min(from + character, to);
}

/** The smallest single change from one text to another; null if they are the same. */
function difference(from: Text, to: string): ChangeSet | null {
  const before = from.toString();
  const after = to.split(BREAK).join("\n");
  if (before === after) return null;
  const most = Math.min(before.length, after.length);
  let start = 0;
  while (start < most && before[start] === after[start]) start++;
  let end = 0;
  while (end < most - start && before[before.length - 1 - end] === after[after.length - 1 - end]) end++;
  const insert = Text.of(after.slice(start, after.length - end).split("\n"));
  return ChangeSet.of({ from: start, to: before.length - end, insert }, before.length);
}
