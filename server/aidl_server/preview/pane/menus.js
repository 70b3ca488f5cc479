/** The toolbar: buttons that stay pressed, menus that fold out, the theme, panels that fold.
 * @import { Layer } from "./protocol.js"
 */

import { el, part, set } from "./dom.js";
import { recall, remember } from "./memory.js";

const LAYERS = /** @type {[Layer, string][]} */ ([
  ["names", "Names"],
  ["dimensions", "Dimensions"],
  ["points", "Points"],
  ["bbox", "Bounding boxes"],
  ["constraints", "Constraints"],
  ["dof", "Degrees of freedom"],
  ["plan", "Layout plan"],
]);
const THEMES = ["as the system has it", "light", "dark"];

/**
 * A button that stays pressed until it is pressed again.
 * @param {string} id
 * @param {(isOn: boolean) => void} changed called at once with how it was left
 * @param {boolean} [isOn] if it was never pressed
 */
export function toggle(id, changed, isOn = false) {
  const button = part(id, HTMLButtonElement);
  /** @param {boolean} isOn */
  function put(isOn) {
    set(button, { "aria-pressed": String(isOn) });
    changed(isOn);
  }
  button.addEventListener("click", () => {
    const isNow = button.getAttribute("aria-pressed") !== "true";
    remember(id, isNow);
    put(isNow);
  });
  put(Boolean(recall(id) ?? isOn));
  return button;
}

/**
 * A menu below its button. It closes with Escape, and when the focus or a click goes elsewhere.
 * @param {string} name
 */
export function popup(name) {
  const button = part(`${name}-button`, HTMLButtonElement);
  const menu = part(`${name}-menu`, HTMLElement);
  /** @param {boolean} isOpen */
  function open(isOpen) {
    menu.hidden = !isOpen;
    set(button, { "aria-expanded": String(isOpen) });
  }
  const isWithin = (/** @type {EventTarget | null} */ target) => target instanceof Node && menu.parentElement?.contains(target) === true;
  button.addEventListener("click", () => open(Boolean(menu.hidden)));
  menu.addEventListener("keydown", (event) => {
    const items = /** @type {HTMLElement[]} */ ([...menu.querySelectorAll("button, input")]);
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (step === undefined || event.target instanceof HTMLSelectElement) return;
    event.preventDefault();
    event.stopPropagation();
    const at = items.findIndex((item) => item === document.activeElement);
    items[(at + step + items.length) % items.length]?.focus();
  });
  addEventListener("pointerdown", (event) => isWithin(event.target) || open(false), true);
  menu.parentElement?.addEventListener("focusout", (event) => {
    if (event.relatedTarget && !isWithin(event.relatedTarget)) open(false);
  });
  menu.parentElement?.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || menu.hidden) return;
    event.stopPropagation();
    open(false);
    button.focus();
  });
  return { menu, close: () => open(false), button };
}

/**
 * @param {(layers: Layer[]) => void} changed
 * @param {(hasGrid: boolean) => void} grid
 * @returns {() => Layer[]} what is chosen
 */
export function layersMenu(changed, grid) {
  const { menu, button } = popup("layers");
  const kept = recall("layers");
  const chosen = new Set(Array.isArray(kept) ? kept : []);
  const layers = () => LAYERS.map(([layer]) => layer).filter((layer) => chosen.has(layer));
  const update = () => button.classList.toggle("chosen", chosen.size > 0);
  for (const [layer, words] of LAYERS) {
    const box = el("input", { type: "checkbox", checked: chosen.has(layer) });
    box.addEventListener("change", () => {
      if (box.checked) chosen.add(layer);
      else chosen.delete(layer);
      remember("layers", layers());
      update();
      changed(layers());
    });
    menu.append(el("label", { class: "item" }, box, words));
  }
  const box = el("input", { type: "checkbox", checked: recall("grid") !== false });
  box.addEventListener("change", () => {
    remember("grid", box.checked);
    grid(box.checked);
  });
  menu.append(el("hr"), el("label", { class: "item" }, box, "Millimetre grid"));
  grid(box.checked);
  update();
  return layers;
}

/**
 * Light, dark or as the system has it; in VS Code the editor decides.
 * @param {boolean} isInEditor
 */
export function themeButton(isInEditor) {
  const button = part("theme", HTMLButtonElement);
  button.hidden = isInEditor;
  if (isInEditor) return;
  let theme = Math.max(THEMES.indexOf(String(recall("theme"))), 0);
  function show() {
    const words = `Theme: ${THEMES[theme]}`;
    set(button, { title: words, "aria-label": words });
    set(document.documentElement, { "data-theme": theme ? String(THEMES[theme]) : null });
  }
  button.addEventListener("click", () => {
    theme = (theme + 1) % THEMES.length;
    remember("theme", THEMES[theme]);
    show();
  });
  show();
}

/** Panels whose heading is a button fold away. */
export function foldingPanels() {
  for (const button of document.querySelectorAll("button.fold")) {
    const id = String(button.getAttribute("aria-controls"));
    const list = part(id, HTMLElement);
    /** @param {boolean} isOpen */
    const put = (isOpen) => {
      set(button, { "aria-expanded": String(isOpen) });
      list.hidden = !isOpen;
      list.closest(".panel")?.classList.toggle("folded", !isOpen);
    };
    button.addEventListener("click", () => {
      remember(id, list.hidden);
      put(Boolean(list.hidden));
    });
    put(recall(id) !== false);
  }
}
