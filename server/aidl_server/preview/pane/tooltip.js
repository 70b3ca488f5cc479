/** What is said of the thing under the pointer. */

/** Pixels between the tooltip and what it speaks of. */
const GAP = 14;

export class Tooltip {
  /**
   * @param {HTMLElement} tip
   * @param {HTMLElement} stage in which it stays
   */
  constructor(tip, stage) {
    this.tip = tip;
    this.stage = stage;
  }

  /**
   * @param {(Node | string)[]} content
   * @param {number} x where, in pixels of the page
   * @param {number} y
   */
  show(content, x, y) {
    this.tip.replaceChildren(...content);
    this.tip.hidden = false;
    const room = this.stage.getBoundingClientRect();
    const { width, height } = this.tip.getBoundingClientRect();
    const left = Math.min(x - room.left + GAP, room.width - width - 6);
    const below = y - room.top + GAP;
    const top = below + height + 6 > room.height ? y - room.top - height - GAP : below;
    this.tip.style.translate = `${Math.max(left, 6)}px ${Math.max(top, 6)}px`;
  }

  hide() {
    this.tip.hidden = true;
  }
}
