import assert from "node:assert/strict";
import { mock, test } from "node:test";

import type { Applied, FromHost, Place, Preview, Requests, ToHost } from "../src/preview/protocol";
import { BUSY_AFTER, Relay, type Editor } from "../src/preview/relay";
import { Gate, settled } from "./gate";
import { element, preview, problem, range, URI } from "./samples";

type Name = keyof Requests;
type Answer = (params: never) => unknown;

/** An editor that writes down what it is told, and a server that says what the test wants. */
class Desk implements Editor {
  readonly uri = URI;
  readonly posted: FromHost[] = [];
  readonly asked: [Name, Record<string, unknown>][] = [];
  readonly marked: (Place | null)[] = [];
  readonly went: unknown[] = [];
  readonly exported: unknown[] = [];
  answers: Partial<Record<Name, Answer>> = { "aidl/preview": () => preview() };
  now: number | null = 1;
  fixes = true;
  running = true;
  readonly relay = new Relay(this, ["names"]);

  version = (): number | null => this.now;
  connected = (): boolean => this.running;
  post = (message: FromHost): void => void this.posted.push(message);
  mark = (place: Place | null): void => void this.marked.push(place);
  goto = (...where: unknown[]): void => void this.went.push(where);
  quickFix = async (): Promise<boolean> => this.fixes;
  export = async (...what: unknown[]): Promise<void> => void this.exported.push(what);
  ask: Editor["ask"] = async (name, params) => {
    this.asked.push([name, params]);
    const answer = this.answers[name];
    if (answer === undefined) throw failure(-32601, `no ${name}`);
    return (await answer(params as never)) as never;
  };

  say(message: ToHost): Promise<void> {
    return this.relay.receive(message);
  }

  async ready(): Promise<void> {
    await this.say({ type: "ready" });
    this.posted.length = 0;
    this.asked.length = 0;
  }

  get types(): string[] {
    return this.posted.map((message) => message.type);
  }

  requests(name: Name): Record<string, unknown>[] {
    return this.asked.filter(([asked]) => asked === name).map(([, params]) => params);
  }
}

const failure = (code: number, message: string): Error => Object.assign(new Error(message), { code });

const version = (message: FromHost | undefined): number | undefined =>
  message?.type === "picture" ? message.version : undefined;

test("a pane that is ready gets the picture with the layers of the settings", async () => {
  const desk = new Desk();
  await desk.say({ type: "ready" });
  assert.deepEqual(desk.asked, [["aidl/preview", { uri: URI, show: ["names"] }]]);
  assert.deepEqual(desk.posted, [{ type: "picture", ...preview() }]);
});

test("a pane that was loaded again gets the last picture at once, even with no server", async () => {
  const desk = new Desk();
  await desk.ready();
  desk.running = false;
  await desk.say({ type: "ready" });
  assert.deepEqual([desk.types, desk.asked], [["picture"], []]);
});

test("news of an earlier text are dropped", async () => {
  const desk = new Desk();
  await desk.ready();
  desk.relay.changed(preview({ version: 3 }));
  desk.relay.changed(preview({ version: 2 }));
  desk.relay.changed(preview({ version: 3, stale: true }));
  assert.deepEqual(desk.posted.map(version), [3, 3]);
});

test("after a restart of the server its versions begin anew", async () => {
  const desk = new Desk();
  await desk.ready();
  desk.relay.changed(preview({ version: 9 }));
  await desk.relay.refresh();
  desk.relay.changed(preview({ version: 2 }));
  assert.deepEqual(desk.posted.map(version), [9, 1, 2]);
});

test("layers are kept for what is asked and exported later", async () => {
  const desk = new Desk();
  await desk.ready();
  await desk.say({ type: "show", layers: ["dof", "plan"] });
  await desk.say({ type: "export", format: "dxf" });
  assert.deepEqual(desk.requests("aidl/preview"), [{ uri: URI, show: ["dof", "plan"] }]);
  assert.deepEqual(desk.exported, [["dxf", ["dof", "plan"]]]);
});

test("while a slider moves, one try is under way and the newest follows", async () => {
  const desk = new Desk();
  await desk.ready();
  const gate = new Gate();
  desk.answers["aidl/try"] = async () => {
    await gate.pass();
    return preview();
  };
  for (let value = 100; value <= 160; value += 1)
    void desk.say({ type: "knob", path: "plate.width", value, final: false });
  await settled();
  gate.open();
  await settled();
  gate.open();
  await settled();
  const tried = [{ "plate.width": 100 }, { "plate.width": 160 }];
  assert.deepEqual(desk.requests("aidl/try"), tried.map((knobs) => ({ uri: URI, version: 1, knobs })));
  assert.deepEqual(desk.posted, [
    { type: "picture", ...preview(), tried: true },
    { type: "picture", ...preview(), tried: true },
  ]);
});

test("the last word is written at once, and what was being tried is not shown any more", async () => {
  const desk = new Desk();
  await desk.ready();
  const gate = new Gate();
  desk.answers["aidl/try"] = async () => {
    await gate.pass();
    return preview();
  };
  desk.answers["aidl/drag"] = (): Applied => ({ applied: true });
  void desk.say({ type: "drag", id: "a", to: [1, 2], final: false });
  void desk.say({ type: "drag", id: "a", to: [3, 4], final: false });
  await desk.say({ type: "drag", id: "a", to: [5, 6], final: true });
  gate.open();
  await settled();
  assert.deepEqual(
    desk.asked.map(([name]) => name),
    ["aidl/try", "aidl/drag"],
  );
  assert.deepEqual(desk.requests("aidl/drag"), [{ uri: URI, version: 1, id: "a", to: [5, 6] }]);
  assert.deepEqual(desk.posted, []);
});

test("edits follow one another, each with the version that the one before made", async () => {
  const desk = new Desk();
  await desk.ready();
  desk.answers["aidl/setKnob"] = async (): Promise<Applied> => {
    await settled();
    desk.now = (desk.now ?? 0) + 1;
    return { applied: true };
  };
  const edits = [1, 2, 3].map((value) => desk.say({ type: "knob", path: "w", value, final: true }));
  await Promise.all(edits);
  const sent = desk.requests("aidl/setKnob").map(({ version: at, value }) => [at, value]);
  assert.deepEqual(sent, [
    [1, 1],
    [2, 2],
    [3, 3],
  ]);
});

test("an edit that is refused is told, and the picture of the text comes back", async () => {
  const desk = new Desk();
  await desk.ready();
  desk.answers["aidl/setKnob"] = (): Applied => ({ applied: false, reason: "The text has changed." });
  await desk.say({ type: "knob", path: "w", value: 7, final: true });
  assert.deepEqual(desk.posted, [
    { type: "error", message: "The text has changed." },
    { type: "picture", ...preview() },
  ]);
});

test("one that fails does not hold up the next", async () => {
  const desk = new Desk();
  await desk.ready();
  await desk.say({ type: "knob", path: "w", value: 7, final: true });
  desk.answers["aidl/setKnob"] = (): Applied => ({ applied: true });
  await desk.say({ type: "knob", path: "w", value: 8, final: true });
  assert.deepEqual(desk.posted, [{ type: "error", message: "no aidl/setKnob" }]);
  assert.equal(desk.requests("aidl/setKnob").length, 2);
});

for (const code of [-32800, -32801, -32802])
  test(`a try overtaken by an edit (${code}) is answered with the picture of the text, without a complaint`, async () => {
    const desk = new Desk();
    await desk.ready();
    desk.answers["aidl/try"] = () => {
      throw failure(code, "overtaken");
    };
    await desk.say({ type: "knob", path: "w", value: 7, final: false });
    await settled();
    assert.deepEqual(desk.posted, [{ type: "picture", ...preview() }]);
  });

test("to cancel is to ask for the picture of the text", async () => {
  const desk = new Desk();
  await desk.ready();
  await desk.say({ type: "cancel" });
  assert.deepEqual(desk.types, ["picture"]);
});

test("hovering marks where an element is written; leaving it marks nothing", async () => {
  const desk = new Desk();
  await desk.ready();
  await desk.say({ type: "hover", element: 1 });
  await desk.say({ type: "hover", element: 99 });
  await desk.say({ type: "hover", element: null });
  assert.deepEqual(desk.marked, [element("plate.body", range(1, 4, 1, 30)), null, null]);
});

test("a click goes to the text, of an element or of a problem; what is in the library has none", async () => {
  const desk = new Desk();
  await desk.ready();
  await desk.say({ type: "goto", element: 3 });
  await desk.say({ type: "goto", element: 5 });
  await desk.say({ type: "goto", element: -1 });
  await desk.say({ type: "goto", uri: "file:///other.aidl", range: range(4, 0, 4, 3) });
  assert.deepEqual(desk.went, [
    [URI, range(3, 8, 3, 20)],
    ["file:///other.aidl", range(4, 0, 4, 3)],
  ]);
});

test("the caret reveals the innermost elements, once", async () => {
  const desk = new Desk();
  await desk.ready();
  for (const line of [3, 3, 2, 7]) desk.relay.caretMoved({ line, character: 10 });
  assert.deepEqual(desk.posted, [
    { type: "reveal", elements: [3, 4] },
    { type: "reveal", elements: [2] },
    { type: "reveal", elements: [] },
  ]);
});

test("what the caret is at is revealed in the next picture, too", async () => {
  const desk = new Desk();
  await desk.ready();
  desk.relay.caretMoved({ line: 1, character: 10 });
  desk.relay.changed(preview({ version: 2 }));
  assert.deepEqual(desk.types, ["reveal", "picture", "reveal"]);
});

test("a fix names the problem of the picture that was seen, not of the text as it is", async () => {
  const desk = new Desk();
  desk.answers["aidl/preview"] = () => preview({ problems: [problem("E0101", range(1, 0, 1, 3))] });
  await desk.ready();
  desk.now = 5;
  desk.answers["aidl/fix"] = (): Applied => ({ applied: true });
  await desk.say({ type: "fix", problem: 0, fix: 0 });
  assert.deepEqual(desk.requests("aidl/fix"), [{ uri: URI, version: 1, problem: 0, fix: 0 }]);
  assert.deepEqual(desk.posted, []);
});

test("a server without fixes of its own: the editor's quick fixes are taken", async () => {
  const desk = new Desk();
  desk.answers["aidl/preview"] = () => preview({ problems: [problem("E0101", range(1, 0, 1, 3))] });
  await desk.ready();
  await desk.say({ type: "fix", problem: 0, fix: 0 });
  assert.deepEqual(desk.posted, []);
  desk.fixes = false;
  await desk.say({ type: "fix", problem: 0, fix: 0 });
  await desk.say({ type: "fix", problem: 8, fix: 0 });
  const errors = (desk.posted as FromHost[]).flatMap((message) => (message.type === "error" ? [message.message] : []));
  assert.deepEqual(errors, ["The language server offers no such fix.", "This problem is gone."]);
});

test("only a run that takes long is announced", (context) => {
  context.mock.timers.enable({ apis: ["setTimeout"] });
  const desk = new Desk();
  desk.relay.edited();
  context.mock.timers.tick(BUSY_AFTER - 1);
  desk.relay.changed(preview({ version: 2 }));
  context.mock.timers.tick(10 * BUSY_AFTER);
  assert.deepEqual(desk.types, ["picture"]);
  desk.relay.edited();
  context.mock.timers.tick(BUSY_AFTER - 10);
  desk.relay.edited();
  context.mock.timers.tick(10);
  assert.deepEqual(desk.types, ["picture", "busy"]);
  desk.relay.edited();
  desk.relay.dispose();
  context.mock.timers.tick(10 * BUSY_AFTER);
  assert.deepEqual(desk.types, ["picture", "busy"]);
  assert.deepEqual(desk.marked, [null]);
});

test("no picture: hovering, going and the caret do nothing", async () => {
  const desk = new Desk();
  desk.answers["aidl/preview"] = (): Preview | null => null;
  await desk.say({ type: "ready" });
  await desk.say({ type: "hover", element: 0 });
  await desk.say({ type: "goto", element: 0 });
  desk.relay.caretMoved({ line: 0, character: 0 });
  assert.deepEqual([desk.posted, desk.marked, desk.went], [[], [null], []]);
  mock.reset();
});
