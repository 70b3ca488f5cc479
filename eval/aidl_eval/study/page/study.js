/**
 * The page of a study. It knows the pictures by their places on the screen alone.
 *
 * @typedef {{ rater: string, number: number, count: number, answered: number, id?: string, text?: string,
 *   pictures?: string[], answer?: { ranking: number[][] | null } | null }} Sheet
 */

/** Keys of the first ten pictures. */
const KEYS = "1234567890";
const KEPT = "study-rater";

/** @template {HTMLElement} T @param {string} id @param {new () => T} kind @returns {T} */
function element(id, kind) {
  const found = document.getElementById(id);
  if (!(found instanceof kind)) throw new Error(`the page has no ${id}`);
  return found;
}

const button = /** @param {string} id */ (id) => element(id, HTMLButtonElement);
const part = /** @param {string} id */ (id) => element(id, HTMLElement);

const field = element("name", HTMLInputElement);
const bar = part("bar");
const begin = element("begin", HTMLFormElement);
const rank = part("rank");
const done = part("done");
const pictures = part("pictures");
const trouble = part("trouble");
const back = button("back");
const undo = button("undo");
const alike = button("alike");
const skip = button("skip");
const next = button("next");

/** What is shown, the places chosen from best to worst, and whether the next one shares the last place. */
let sheet = /** @type {Sheet | null} */ (null);
let groups = /** @type {number[][]} */ ([]);
let shares = false;
let busy = false;

/** @param {number} n */
function ordinal(n) {
  const end = { one: "st", two: "nd", few: "rd", other: "th", zero: "th", many: "th" };
  return `${n}${end[new Intl.PluralRules("en", { type: "ordinal" }).select(n)]}`;
}

// --- asking the server -------------------------------------------------------------------------------

/**
 * Sends a question, and shows the sheet that comes back.
 *
 * @param {"sheet" | "answer"} what
 * @param {Record<string, unknown>} said
 */
async function ask(what, said) {
  if (busy) return;
  busy = true;
  trouble.hidden = true;
  try {
    const answer = await fetch(what, {
      method: "POST",
      headers: { "Content-Type": "application/json" },
      body: JSON.stringify(said),
    });
    const found = await answer.json();
    if (answer.ok) show(found);
    else complain(found.reason);
  } catch {
    complain("This was not kept: the study does not answer. Is it still running? Then try again.");
  } finally {
    busy = false;
  }
}

/** @param {string} reason */
function complain(reason) {
  trouble.textContent = reason;
  trouble.hidden = false;
}

// --- showing -----------------------------------------------------------------------------------------

/** @param {Sheet} found */
function show(found) {
  sheet = found;
  groups = (found.answer?.ranking ?? []).map((group) => [...group]);
  shares = false;
  sessionStorage.setItem(KEPT, found.rater);
  const isDone = found.pictures === undefined;
  bar.hidden = false;
  begin.hidden = true;
  rank.hidden = isDone;
  done.hidden = !isDone;
  const progress = element("progress", HTMLProgressElement);
  progress.max = found.count;
  progress.value = found.answered;
  part("count").textContent = isDone ? `${found.answered} of ${found.count}` : `${found.number + 1} of ${found.count}`;
  part("rater").textContent = found.rater;
  if (isDone) {
    part("all").textContent = `That was all: ${found.count === 1 ? "one answer is" : `${found.count} answers are`} kept.`;
    part("thanks").focus();
    return;
  }
  part("asked").textContent = found.text ?? "";
  lay(found.pictures ?? []);
  part("asked").focus();
  mark(found.answer && found.answer.ranking === null ? "You could not tell." : "");
}

/** @param {string[]} sources */
function lay(sources) {
  const count = sources.length;
  const columns = count <= 4 ? count : Math.ceil(count / Math.ceil(count / 4));
  pictures.style.setProperty("--columns", String(columns));
  pictures.style.setProperty("--rows", String(Math.ceil(count / columns)));
  pictures.replaceChildren(
    ...sources.map((source, place) => {
      const card = document.createElement("button");
      const image = document.createElement("img");
      const foot = document.createElement("span");
      const key = document.createElement("kbd");
      const badge = document.createElement("span");
      card.type = "button";
      card.className = "card";
      image.src = source;
      image.alt = "";
      image.draggable = false;
      foot.className = "foot";
      key.textContent = String(place + 1);
      badge.className = "place";
      foot.append(key, badge);
      card.append(image, foot);
      card.addEventListener("click", () => choose(place));
      return card;
    }),
  );
}

/** Shows what is chosen so far; `said` stands where nothing is. @param {string} [said] */
function mark(said = "") {
  const cards = [...pictures.children];
  cards.forEach((card, place) => {
    const group = groups.findIndex((members) => members.includes(place));
    const above = groups.slice(0, Math.max(group, 0)).flat().length;
    const badge = card.querySelector(".place");
    if (!(badge instanceof HTMLElement)) return;
    badge.hidden = group < 0;
    badge.textContent = group < 0 ? "" : `${ordinal(above + 1)}${(groups[group] ?? []).length > 1 ? " =" : ""}`;
    card.setAttribute("aria-pressed", String(group >= 0));
    card.setAttribute("aria-label", `Drawing ${place + 1}, ${group < 0 ? "no place yet" : `place ${above + 1}`}`);
  });
  const chosen = groups.flat().length;
  const isWhole = chosen === cards.length;
  const order = groups.map((group) => group.map((place) => place + 1).join(" = ")).join(" > ");
  const rest = isWhole ? "" : shares ? " = …" : " > …";
  part("order").textContent = chosen ? `${order}${rest}` : said || "Choose from best to worst.";
  back.disabled = !sheet || sheet.number === 0;
  undo.disabled = chosen === 0;
  alike.disabled = chosen === 0 || isWhole;
  alike.setAttribute("aria-pressed", String(shares));
  next.disabled = !isWhole;
}

// --- choosing ----------------------------------------------------------------------------------------

/** Gives a picture the next place; takes it away from one that has a place. @param {number} place */
function choose(place) {
  if (busy || place >= pictures.children.length) return;
  const isPlaced = groups.some((group) => group.includes(place));
  if (isPlaced) {
    groups = groups.map((group) => group.filter((other) => other !== place)).filter((group) => group.length);
  } else if (shares) {
    groups.at(-1)?.push(place);
  } else {
    groups.push([place]);
  }
  shares = false;
  mark();
}

/** Takes the last place away, or that the next one shares it. */
function takeBack() {
  if (!shares) {
    groups.at(-1)?.pop();
    groups = groups.filter((group) => group.length);
  }
  shares = false;
  mark();
}

function share() {
  shares = !shares;
  mark();
}

/** @param {number[][] | null} ranking */
function answer(ranking) {
  if (sheet?.id) ask("answer", { rater: sheet.rater, number: sheet.number, id: sheet.id, ranking });
}

function goBack() {
  if (sheet && sheet.number > 0) ask("sheet", { rater: sheet.rater, number: sheet.number - 1 });
}

function leave() {
  if (busy) return;
  sessionStorage.removeItem(KEPT);
  sheet = null;
  bar.hidden = rank.hidden = done.hidden = trouble.hidden = true;
  begin.hidden = false;
  field.value = "";
  field.focus();
}

back.addEventListener("click", goBack);
undo.addEventListener("click", takeBack);
alike.addEventListener("click", share);
skip.addEventListener("click", () => answer(null));
next.addEventListener("click", () => answer(groups));
button("again").addEventListener("click", goBack);
button("another").addEventListener("click", leave);
button("leave").addEventListener("click", leave);
begin.addEventListener("submit", (event) => {
  event.preventDefault();
  ask("sheet", { rater: field.value });
});

/** What keys press. @type {Record<string, HTMLButtonElement>} */
const SHORTCUTS = { Backspace: undo, "=": alike, s: skip, b: back, ArrowLeft: back };

addEventListener("keydown", (event) => {
  if (rank.hidden || event.ctrlKey || event.metaKey || event.altKey || event.repeat) return;
  const target = event.target;
  const place = KEYS.indexOf(event.key);
  if (place >= 0 && event.key.length === 1) {
    event.preventDefault();
    choose(place);
  } else if (event.key === "Enter") {
    // On a button Enter presses that one; on a drawing it goes on once all have a place, which Space takes away.
    const isElsewhere = target instanceof HTMLButtonElement && target !== next;
    const isCard = target instanceof HTMLElement && target.classList.contains("card");
    if (isElsewhere && !(isCard && !next.disabled)) return;
    event.preventDefault();
    if (!next.disabled) answer(groups);
  } else {
    const pressed = SHORTCUTS[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!pressed) return;
    event.preventDefault();
    if (!pressed.disabled) pressed.click();
  }
});

const kept = sessionStorage.getItem(KEPT);
if (kept) ask("sheet", { rater: kept });
else field.focus();
