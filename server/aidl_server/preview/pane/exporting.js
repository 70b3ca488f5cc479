/** The dialog for exports: a format, and what the host offers to set for it.
 * @import { ExportOption, Exports, ExportWish } from "./protocol.js"
 */

import { el, part, quoted, set } from "./dom.js";
import { recall, remember } from "./memory.js";
import { popup } from "./menus.js";

/**
 * @param {() => Promise<Exports | null>} offered
 * @param {(wish: ExportWish) => Promise<string>} chosen tells why there is no file; empty if there is one
 */
export function exportMenu(offered, chosen) {
  const form = part("export-menu", HTMLFormElement);
  const { close, button } = popup("export");
  let isMade = false;
  button.addEventListener("click", () => {
    if (isMade) return;
    isMade = true;
    void offered().then((exports) => {
      if (exports) make(form, exports, chosen, close);
      else isMade = false;
    });
  });
}

/**
 * @param {HTMLFormElement} form
 * @param {Exports} exports
 * @param {(wish: ExportWish) => Promise<string>} chosen
 * @param {() => void} close
 */
function make(form, { formats, options }, chosen, close) {
  const format = el("select", { name: "format", id: "export-format" });
  for (const { name, label } of formats) format.append(el("option", { value: name }, `${label} (.${name})`));
  const kept = recall("export");
  const known = /** @type {Record<string, unknown>} */ (typeof kept === "object" && kept !== null ? kept : {});
  if (formats.some(({ name }) => name === known["format"])) format.value = String(known["format"]);
  const rows = options.map((option) => row(option, known[option.name]));
  const save = el("button", { type: "submit", class: "button" }, "Save");
  const refusal = el("p", { class: "refusal", role: "alert", hidden: true });
  form.replaceChildren(
    el("label", { class: "option" }, el("span", {}, "Format"), format), ...rows.map(({ label }) => label), refusal, save,
  );
  const update = () => {
    for (const { option, label } of rows) label.hidden = !option.formats.includes(format.value);
    refusal.hidden = true;
  };
  format.addEventListener("change", update);
  update();
  format.focus();
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const given = rows.filter(({ label, field }) => !label.hidden && field.value.trim());
    const wish = { format: format.value, options: Object.fromEntries(given.map(({ option, field }) => [option.name, field.value])) };
    remember("export", { ...Object.fromEntries(rows.map(({ option, field }) => [option.name, field.value])), format: format.value });
    set(save, { disabled: true });
    void chosen(wish).then((why) => {
      set(save, { disabled: false });
      refusal.hidden = !why;
      refusal.replaceChildren(...quoted(why));
      if (!why) close();
    });
  });
}

/**
 * @param {ExportOption} option
 * @param {unknown} known
 */
function row(option, known) {
  const { name, label, hint, choices } = option;
  const field = choices.length
    ? el("select", { name }, ...["", ...choices.filter((choice) => choice !== hint)].map((choice) => el("option", { value: choice }, choice || hint)))
    : el("input", { type: "text", name, placeholder: hint, autocomplete: "off", spellcheck: "false", size: "12" });
  if (typeof known === "string") field.value = known;
  return { option, field, label: el("label", { class: "option" }, el("span", {}, label), field) };
}
