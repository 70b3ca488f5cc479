import assert from "node:assert/strict";
import { test } from "node:test";

import { Latest } from "../src/preview/latest";
import { Gate, settled } from "./gate";

test("one runs at a time and of those that wait only the newest", async () => {
  const done: number[] = [];
  let running = 0;
  let most = 0;
  const gate = new Gate();
  const latest = new Latest<number>(async (item) => {
    running += 1;
    most = Math.max(most, running);
    await gate.pass();
    running -= 1;
    done.push(item);
  });
  for (let item = 0; item < 60; item += 1) latest.put(item);
  await settled();
  gate.open();
  await settled();
  gate.open();
  await settled();
  assert.deepEqual(done, [0, 59]);
  assert.equal(most, 1);
  latest.put(60);
  await settled();
  gate.open();
  await settled();
  assert.deepEqual(done, [0, 59, 60]);
});

test("what was cleared is not done", async () => {
  const done: string[] = [];
  const gate = new Gate();
  const latest = new Latest<string>(async (item) => {
    await gate.pass();
    done.push(item);
  });
  latest.put("a");
  latest.put("b");
  latest.clear();
  gate.open();
  await settled();
  assert.deepEqual(done, ["a"]);
});
