"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const FEW = 12;
const filters = [];

/** Returns an element with a class and a text; values are set as texts, never as markup. */
function element(name, text = "", kind = "") {
  const made = document.createElement(name);
  made.textContent = text;
  made.className = kind;
  return made;
}

function shown(value) {
  if (value === null) return "–";
  return Array.isArray(value) ? value.join("; ") : String(value);
}

/** Returns a filter for a column: boxes to tick for few values, else a range or a search. */
function filterOf(name) {
  const values = [...new Set(data.rows.map((row) => row.cells[name]))].filter((value) => value !== null);
  if (values.length < 2) return;
  const group = element("fieldset");
  group.append(element("legend", name));
  const isNumeric = values.every((value) => typeof value === "number");
  if (values.length <= FEW) ticks(group, name, isNumeric ? values.sort((a, b) => a - b) : values);
  else if (isNumeric) range(group, name, Math.min(...values), Math.max(...values));
  else search(group, name);
  document.getElementById("filters").append(group);
}

function ticks(group, name, values) {
  const boxes = values.map((value) => {
    const label = element("label");
    const box = document.createElement("input");
    box.type = "checkbox";
    box.checked = true;
    label.append(box, element("bdi", ` ${shown(value)}`));
    group.append(label);
    return [box, value];
  });
  filters.push((row) => row.cells[name] === null || boxes.some(([box, value]) => box.checked && value === row.cells[name]));
}

function range(group, name, low, high) {
  const ends = [["from", low], ["to", high]].map(([word, value]) => {
    const label = element("label", `${word} `);
    const input = document.createElement("input");
    input.type = "number";
    input.step = "any";
    input.value = value;
    label.append(input);
    group.append(label);
    return input;
  });
  filters.push((row) => {
    const value = row.cells[name];
    const [from, to] = ends.map((input) => input.valueAsNumber);
    return value === null || !(value < from) && !(value > to);
  });
}

function search(group, name) {
  const input = document.createElement("input");
  input.type = "search";
  input.setAttribute("aria-label", name);
  group.append(input);
  filters.push((row) => shown(row.cells[name]).toLowerCase().includes(input.value.toLowerCase()));
}

function failing() {
  const label = element("label");
  const box = document.createElement("input");
  box.type = "checkbox";
  box.id = "failing";
  label.append(box, " only what fails");
  document.getElementById("filters").append(label);
  filters.push((row) => !box.checked || !row.ok);
}

function card(row) {
  const made = element("article", "", row.ok ? "" : "failing");
  if (row.picture) {
    const image = document.createElement("img");
    image.alt = "the drawing";
    image.loading = "lazy";
    image.src = `data:image/png;base64,${row.picture}`;
    made.append(image);
  } else made.append(element("div", "no drawing", "none"));
  const values = element("p");
  for (const name of data.given) {
    if (name === "n") continue;
    const pair = element("span", `${name} `, "pair");
    pair.append(element("bdi", shown(row.cells[name])));
    values.append(pair, " ");
  }
  made.append(element("p", `${row.cells.n}`), values);
  if (!row.ok) made.append(element("p", row.message, "message"));
  const details = element("details");
  details.append(element("summary", "all of it"));
  details.addEventListener("toggle", () => details.children.length < 2 && details.append(all(row)));
  made.append(details);
  return made;
}

function all(row) {
  const list = element("dl");
  for (const name of data.columns) list.append(element("dt", name), element("dd", shown(row.cells[name])));
  return list;
}

const cards = data.rows.map((row) => [row, card(row)]);

function filter() {
  let count = 0;
  let bad = 0;
  for (const [row, made] of cards) {
    made.hidden = !filters.every((accepts) => accepts(row));
    if (!made.hidden) { count += 1; bad += row.ok ? 0 : 1; }
  }
  document.getElementById("count").textContent = `${count} of ${cards.length} variants, ${bad || "none"} failing`;
}

document.querySelector("h1").textContent = data.title;
data.given.filter((name) => name !== "n").forEach(filterOf);
failing();
document.getElementById("cards").append(...cards.map(([, made]) => made));
document.getElementById("filters").addEventListener("input", filter);
document.getElementById("filters").addEventListener("submit", (event) => event.preventDefault());
filter();
