import assert from "node:assert/strict";
import { mock, test } from "node:test";

import type { Message, Name, Place, Preview, Requests } from "../src/preview/protocol";
import { BUSY_AFTER, Relay, type Editor } from "../src/preview/relay";
import { element, preview, range, URI } from "./samples";

type Answer = (params: never) => unknown;

/** An editor that writes down what it is told, and a server that says what the test wants. */
class Desk implements Editor {
  readonly uri = URI;
  readonly posted: Message[] = [];
  readonly asked: [Name, object][] = [];
  readonly marked: (Place | null)[] = [];
  readonly went: unknown[] = [];
  readonly exported: unknown[] = [];
  answers: Partial<Record<Name, Answer>> = { "aidl/preview": () => preview() };
  running = true;
  readonly relay = new Relay(this, ["names"]);
  private count = 0;

  connected = (): boolean => this.running;
  post = (message: Message): void => void this.posted.push(message);
  mark = (place: Place | null): void => void this.marked.push(place);
  goto = (...where: unknown[]): void => void this.went.push(where);
  export = async (...what: unknown[]): Promise<void> => void this.exported.push(what);
  ask: Editor["ask"] = async (name, params) => {
    this.asked.push([name, params]);
    const answer = this.answers[name];
    if (answer === undefined) throw failure(-32601, `no ${name}`);
    return (await answer(params as never)) as never;
  };

  /** What the pane is answered. */
  async say<N extends Name>(method: N, params: Requests[N]["params"]): Promise<Message | undefined> {
    const id = ++this.count;
    await this.relay.receive({ jsonrpc: "2.0", id, method, params: { uri: URI, ...params } });
    return this.posted.find((message) => message.id === id);
  }

  async tell(method: string, params: unknown): Promise<void> {
    await this.relay.receive({ jsonrpc: "2.0", method, params });
  }

  async ready(): Promise<void> {
    await this.say("aidl/preview", { show: [] });
    this.posted.length = 0;
    this.asked.length = 0;
  }

  get told(): (string | undefined)[] {
    return this.posted.map((message) => message.method);
  }

  requests(name: Name): object[] {
    return this.asked.filter(([asked]) => asked === name).map(([, params]) => params);
  }
}

const failure = (code: number, message: string): Error => Object.assign(new Error(message), { code });

const version = (message: Message): number => (message.params as Preview).version;
const revealed = (elements: number[]): Message => ({ jsonrpc: "2.0", method: "aidl/reveal", params: { elements } });

test("a pane gets the picture with the layers of the settings until others are chosen", async () => {
  const desk = new Desk();
  const answer = await desk.say("aidl/preview", { show: [] });
  assert.deepEqual(desk.asked, [["aidl/preview", { uri: URI, show: ["names"] }]]);
  assert.deepEqual(answer?.result, preview());
  assert.deepEqual(desk.posted, [answer]);
});

test("a pane that was loaded again gets the last picture at once, even with no server", async () => {
  const desk = new Desk();
  await desk.ready();
  desk.running = false;
  const answer = await desk.say("aidl/preview", { show: [] });
  assert.deepEqual([answer?.result, desk.asked], [preview(), []]);
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
  await desk.say("aidl/preview", { show: ["dof", "plan"] });
  const answer = await desk.say("aidl/export", { format: "dxf" });
  await desk.relay.refresh();
  await desk.say("aidl/preview", { show: [] });
  const shown = [["dof", "plan"], ["dof", "plan"], []];
  assert.deepEqual(desk.requests("aidl/preview"), shown.map((show) => ({ uri: URI, show })));
  assert.deepEqual(desk.exported, [[{ format: "dxf" }, ["dof", "plan"]]]);
  assert.equal(answer?.result, null); // the editor has saved it
});

test("what a pane asks is asked of the server as it is, and answered with what that says", async () => {
  const desk = new Desk();
  desk.answers["aidl/try"] = () => preview({ tried: true });
  desk.answers["aidl/setKnob"] = () => ({ applied: false, reason: "The text has changed." });
  const tried = await desk.say("aidl/try", { knobs: { "plate.width": 100 } });
  const set = await desk.say("aidl/setKnob", { path: "w", value: 7 });
  assert.deepEqual(tried?.result, preview({ tried: true }));
  assert.deepEqual(set?.result, { applied: false, reason: "The text has changed." });
  assert.deepEqual(desk.asked, [
    ["aidl/try", { uri: URI, knobs: { "plate.width": 100 } }],
    ["aidl/setKnob", { uri: URI, path: "w", value: 7 }],
  ]);
});

for (const code of [-32800, -32801, -32802])
  test(`why the server does not answer (${code}) is told to who asked`, async () => {
    const desk = new Desk();
    desk.answers["aidl/try"] = () => {
      throw failure(code, "overtaken");
    };
    const answer = await desk.say("aidl/try", { knobs: { w: 7 } });
    assert.deepEqual(answer?.error, { code, message: "overtaken" });
  });

test("a pane asks for nothing but what it is to know", async () => {
  const desk = new Desk();
  const answer = await desk.say("workspace/executeCommand" as "aidl/previewClose", {});
  assert.equal(answer?.error?.code, -32601);
  assert.deepEqual(desk.asked, []);
});

test("a server that cannot be asked anew says why", async () => {
  const desk = new Desk();
  desk.answers = {};
  await desk.relay.refresh();
  assert.deepEqual(desk.posted, [
    { jsonrpc: "2.0", method: "window/showMessage", params: { type: 1, message: "no aidl/preview" } },
  ]);
});

test("hovering marks where an element is written; leaving it marks nothing", async () => {
  const desk = new Desk();
  const { uri, range: at } = element("plate.body", range(1, 4, 1, 30));
  await desk.tell("aidl/hover", { place: { uri, range: at } });
  await desk.tell("aidl/hover", { place: null });
  assert.deepEqual(desk.marked, [{ uri, range: at }, null]);
});

test("a click goes to the text", async () => {
  const desk = new Desk();
  await desk.tell("aidl/goto", { uri: "file:///other.aidl", range: range(4, 0, 4, 3) });
  assert.deepEqual(desk.went, [["file:///other.aidl", range(4, 0, 4, 3)]]);
});

test("the caret reveals the innermost elements, once", async () => {
  const desk = new Desk();
  await desk.ready();
  for (const line of [3, 3, 2, 7]) desk.relay.caretMoved({ line, character: 10 });
  assert.deepEqual(desk.posted, [revealed([3, 4]), revealed([2]), revealed([])]);
});

test("what the caret is at is revealed in the next picture, too", async () => {
  const desk = new Desk();
  await desk.ready();
  desk.relay.caretMoved({ line: 1, character: 10 });
  desk.relay.changed(preview({ version: 2 }));
  await desk.say("aidl/preview", { show: [] });
  assert.deepEqual(desk.told, ["aidl/reveal", "aidl/previewChanged", "aidl/reveal", undefined, "aidl/reveal"]);
});

test("only a run that takes long is announced", (context) => {
  context.mock.timers.enable({ apis: ["setTimeout"] });
  const desk = new Desk();
  desk.relay.edited();
  context.mock.timers.tick(BUSY_AFTER - 1);
  desk.relay.changed(preview({ version: 2 }));
  context.mock.timers.tick(10 * BUSY_AFTER);
  assert.deepEqual(desk.told, ["aidl/previewChanged"]);
  desk.relay.edited();
  context.mock.timers.tick(BUSY_AFTER - 10);
  desk.relay.edited();
  context.mock.timers.tick(10);
  assert.deepEqual(desk.told, ["aidl/previewChanged", "aidl/busy"]);
  desk.relay.edited();
  desk.relay.dispose();
  context.mock.timers.tick(10 * BUSY_AFTER);
  assert.deepEqual(desk.told, ["aidl/previewChanged", "aidl/busy"]);
  assert.deepEqual(desk.marked, [null]);
});

test("no picture: the caret does nothing", async () => {
  const desk = new Desk();
  desk.answers["aidl/preview"] = (): Preview | null => null;
  const answer = await desk.say("aidl/preview", { show: [] });
  desk.relay.caretMoved({ line: 0, character: 0 });
  assert.equal(answer?.result, null);
  assert.deepEqual(desk.posted, [answer]);
  mock.reset();
});
