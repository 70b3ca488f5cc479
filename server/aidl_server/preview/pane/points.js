/** Rings around the points that problems are about.
 * @import { Problem, Vec } from "./protocol.js"
 * @import { View } from "./view.js"
 */

import { svg } from "./dom.js";

export class PointMarks {
  /** @type {{ at: Vec, ring: SVGGElement }[]} */
  #marks = [];

  /**
   * @param {SVGGElement} group in pixels
   * @param {View} view
   */
  constructor(group, view) {
    this.group = group;
    this.view = view;
  }

  /** @param {Problem[]} problems */
  show(problems) {
    this.#marks = problems.flatMap(({ points, severity, message }) =>
      points.map((at) => {
        const ring = svg("g", { class: `point ${severity}` }, svg("title", {}, message));
        ring.append(svg("circle", { r: "9", class: "rim" }), svg("circle", { r: "9", class: "line" }), svg("circle", { r: "2" }));
        return { at, ring };
      }),
    );
    this.group.replaceChildren(...this.#marks.map(({ ring }) => ring));
    this.place();
  }

  place() {
    for (const { at, ring } of this.#marks) {
      const [x, y] = this.view.toScreen(at);
      ring.setAttribute("transform", `translate(${x} ${y})`);
    }
  }
}
