/** The playground around the pane: where programs come from and go to, and the worker behind it. It loads the pane, which
 * calls `dialAidl` in place of opening a WebSocket.
 */

import { el, part } from "./pane/dom.js";
import { download } from "./pane/download.js";
import { popup } from "./pane/menus.js";
import { keep, programs } from "./keeping.js";
import { WorkerLine } from "./line.js";
import { pixels } from "./pixels.js";
import { hashOf, named, programIn } from "./share.js";

/** @typedef {import("./line.js").Program} Program */
/** @typedef {{ group: string, name: string, title: string, file: string }} Example */

const FIRST = "examples/motor_bracket.aidl";
const NEW = `// A plate with a hole. Change a number, or drag in the drawing.
solid plate {
    param width = 80 in 40..160

    body = rounded_rectangle(center: origin, width: width, height: 40, radius: 6)

    hole middle {
        rim = circle(center: origin, radius: 8)
    }
}
`;
const COPIED_SECONDS = 2;
/** What is not in the file of the program: the browser makes it of the drawing. */
const PICTURE = "png";

/** @param {string} file */
async function example(file) {
  const answer = await fetch(file);
  if (!answer.ok) throw new Error(`There is no example \`${file}\`.`);
  const name = file.slice(file.lastIndexOf("/") + 1);
  return { name, text: await answer.text() };
}

/**
 * A program with a name of its own, if another of its name is kept: that one may have been changed.
 * @param {Program} program
 */
function ownNamed(program) {
  const known = programs().find(({ name }) => name === program.name);
  return known && known.text !== program.text ? { ...program, name: free(program.name.replace(/\.aidl$/, "")) } : program;
}

/** The program of the address, else the one that was open last, else an example. @returns {Promise<Program>} */
async function firstProgram() {
  const given = await addressed();
  return (given && ownNamed(given)) ?? programs()[0] ?? (await example(FIRST));
}

/** @returns {Promise<Program | null>} */
async function addressed() {
  const hash = location.hash;
  if (!hash) return null;
  try {
    const wanted = new URLSearchParams(hash.slice(1)).get("example");
    const found = wanted === null ? await programIn(hash) : await example(`examples/${wanted.replace(/[^\w/-]/g, "")}.aidl`);
    if (found) history.replaceState(null, "", location.pathname + location.search); // what is typed from now on is newer
    return found;
  } catch (error) {
    told(error instanceof Error ? error.message : String(error));
    return null;
  }
}

/** @type {Program} */
let program = { name: "program.aidl", text: "" };
/** @type {WorkerLine | null} */
let line = null;
let isStopped = false;
/** @type {string[]} what is to be told once the pane is there */
const news = [];
/** Requests for pictures of pixels, and to save, by number. */
const pictures = new Set();
const savings = new Set();

const starting = part("starting", HTMLElement);
const stage = part("starting-text", HTMLElement);
const stop = part("stop", HTMLButtonElement);
const held = part("held", HTMLElement);

/** @param {string} message */
function told(message) {
  if (line?.readyState !== WebSocket.OPEN) news.push(message);
  else line.tell({ jsonrpc: "2.0", method: "window/showMessage", params: { type: 1, message } });
}

/** @type {import("./line.js").Watcher} */
const watcher = {
  stage: (words) => show(words),
  opened: (uri) => {
    document.body.dataset.uri = uri;
    if (isStopped) show("");
    held.hidden = !isStopped;
    if (!keep(program)) news.push("This browser keeps nothing: save the program as a file before you leave.");
    queueMicrotask(() => news.splice(0).forEach(told));
  },
  keep: (kept) => {
    program = { ...program, ...kept };
    keep(kept);
    isStopped = false;
    held.hidden = true;
  },
  long: (isLong) => void (stop.hidden = !isLong),
  failed: (reason) => {
    show(`Python could not be started: ${reason}. Load the page again; the first visit needs a connection.`);
    starting.classList.add("failed");
  },
  died: (reason) => {
    console.warn(reason);
    news.push("Python did not survive this program, and begins anew.");
    end();
  },
  asked: (message) => {
    if (message.method === "aidl/save") savings.add(message.id);
    if (message.method !== "aidl/export" || message.params.format !== PICTURE) return message;
    pictures.add(message.id);
    return { ...message, params: { ...message.params, format: "svg" } };
  },
  told: (message) => {
    if (message.method === "aidl/previewChanged" || message.result?.svg !== undefined) show("");
    if (message.method === "aidl/text" && message.params.version === 1) setTimeout(toTop);
    if (savings.delete(message.id) && message.result?.applied) save();
    if (!pictures.delete(message.id) || !message.result) return message;
    pixels(message.result).then(
      (result) => line?.tell({ ...message, result }),
      (error) => line?.tell({ ...message, result: undefined, error: { code: -32803, message: String(error.message ?? error) } }),
    );
    return null;
  },
};

/** Another program is read from its beginning. */
function toTop() {
  document.querySelector(".cm-scroller")?.scrollTo(0, 0);
}

/** @param {string} words how far a start has come; empty when it is over */
function show(words) {
  starting.hidden = !words;
  document.body.classList.toggle("starting", Boolean(words));
  if (stage.textContent !== words) stage.textContent = words;
}

/** The worker begins at once, and the pane comes beside it. */
line = new WorkerLine(watcher);
let isDialled = false;
globalThis.dialAidl = () => {
  if (isDialled || line === null) {
    line = new WorkerLine(watcher);
    line.open({ ...program, held: isStopped });
  }
  isDialled = true;
  return line;
};
program = await firstProgram();
line.open(program);

// What somebody does

/** @param {Program} other in place of the program that is open, once all that was typed is kept */
async function open(other) {
  while (document.body.classList.contains("unsaved") && line?.readyState === WebSocket.OPEN) {
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
  program = other;
  isStopped = false;
  line?.open(other);
}

/** @param {() => Promise<Program | null>} find */
async function bring(find) {
  try {
    const found = await find();
    if (found) await open(ownNamed(found));
  } catch (error) {
    told(error instanceof Error ? error.message : String(error));
  }
}

/** A name that no kept program has. @param {string} stem */
function free(stem) {
  const known = new Set(programs().map(({ name }) => name));
  let name = `${stem}.aidl`;
  for (let k = 2; known.has(name); k++) name = `${stem}_${k}.aidl`;
  return name;
}

function save() {
  const bytes = new TextEncoder().encode(program.text);
  let letters = "";
  for (const byte of bytes) letters += String.fromCharCode(byte);
  download(program.name, btoa(letters));
}

/** @param {FileList} files the program, and what it imports */
async function read(files) {
  const all = [...files];
  const main = all.find(({ name }) => /\.aidl$/i.test(name)) ?? all[0];
  if (!main) return null;
  const decoder = new TextDecoder("utf-8", { fatal: true });
  /** @type {Record<string, Uint8Array>} */
  const beside = {};
  for (const file of all) if (file !== main) beside[file.name] = new Uint8Array(await file.arrayBuffer());
  try {
    return { name: named(main.name), text: decoder.decode(await main.arrayBuffer()), beside };
  } catch {
    throw new Error(`\`${main.name}\` is no text: choose a program, with what it imports beside it.`);
  }
}

// The menu of programs

const menu = popup("programs");
const file = part("file", HTMLInputElement);
let areExamplesThere = false;

/**
 * @param {string} words
 * @param {() => void} chosen
 * @param {string} [suffix]
 */
function item(words, chosen, suffix = "") {
  const button = el("button", { type: "button", class: "item" }, words, ...(suffix ? [el("span", { class: "suffix" }, suffix)] : []));
  button.addEventListener("click", () => {
    menu.close();
    chosen();
  });
  return button;
}

/** @param {string} words @param {HTMLElement[]} items */
function group(words, items) {
  return items.length ? [el("hr"), el("h2", { class: "heading" }, words), ...items] : [];
}

async function fill() {
  part("programs-own", HTMLElement).replaceChildren(
    item("New", () => void open({ name: free("part"), text: NEW })),
    item("Open a file …", () => file.click()),
    item("Save as a file", save, "Ctrl+S"),
    ...group("Kept in this browser", programs().filter(({ name }) => name !== program.name).map((each) => item(each.name, () => void open(each)))),
  );
  if (areExamplesThere) return;
  areExamplesThere = true;
  const answer = await fetch("examples.json");
  /** @type {Example[]} */
  const examples = answer.ok ? await answer.json() : [];
  const groups = [...new Set(examples.map((each) => each.group))];
  const items = (/** @type {string} */ words) => examples
    .filter((each) => each.group === words)
    .map((each) => item(each.title, () => void bring(() => example(each.file))));
  part("programs-examples", HTMLElement).replaceChildren(...groups.flatMap((words) => group(words, items(words))));
}

menu.button.addEventListener("click", () => void fill());
file.addEventListener("change", () => {
  const { files } = file;
  if (files?.length) void bring(() => read(files)).finally(() => (file.value = ""));
});

// Sharing, stopping

const share = popup("share");
const link = part("share-link", HTMLInputElement);
const copy = part("share-copy", HTMLButtonElement);
share.button.addEventListener("click", async () => {
  if (share.menu.hidden) return;
  link.value = new URL(await hashOf(program.name, program.text), location.href).href;
  link.select();
});
copy.addEventListener("click", async () => {
  link.select();
  try {
    await navigator.clipboard.writeText(link.value);
  } catch {
    document.execCommand("copy"); // where a page may not write to the clipboard: what is selected
  }
  copy.textContent = "Copied";
  setTimeout(() => (copy.textContent = "Copy"), COPIED_SECONDS * 1000);
});
stop.addEventListener("click", end);

/** Ends the worker. The pane dials again, and is shown the program without running it. */
function end() {
  isStopped = true;
  show("Starting again");
  line?.close("It was stopped.");
}

part("run-again", HTMLButtonElement).addEventListener("click", () => void open(program));
addEventListener("hashchange", () => void bring(addressed));
addEventListener("keydown", (event) => {
  if (!(event.ctrlKey || event.metaKey) || event.key !== "o" || event.altKey) return;
  event.preventDefault();
  file.click();
});
addEventListener("dragover", (event) => event.dataTransfer?.types.includes("Files") && event.preventDefault());
addEventListener("drop", (event) => {
  if (!event.dataTransfer?.files.length) return;
  event.preventDefault();
  const { files } = event.dataTransfer;
  void bring(() => read(files));
});

// Without a connection: everything is kept once it was loaded, after the first drawing has had its turn.
if ("serviceWorker" in navigator) {
  const shown = new MutationObserver(() => {
    if (!document.body.dataset.shown) return;
    shown.disconnect();
    navigator.serviceWorker.register("service.js").catch((error) => console.warn(error));
  });
  shown.observe(document.body, { attributes: true, attributeFilter: ["data-shown"] });
}

await import("./pane/main.js");
