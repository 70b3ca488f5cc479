/** What the stand-in for `manifold3d` (`aidl_web/manifold.py`) asks of the package `manifold-3d`: polygons travel as flat
 * arrays, as a call for each point would take longer than the booleans.
 */

/** @param {any} module what the package `manifold-3d` loads */
export function kernelOf(module) {
  module.setup();
  const { CrossSection, Manifold } = module;

  /**
   * @param {Float64Array} points x and y of each
   * @param {Int32Array} lengths points of each polygon
   */
  function polygons(points, lengths) {
    const found = [];
    let at = 0;
    for (const length of lengths) {
      const polygon = new Array(length);
      for (let k = 0; k < length; k++, at += 2) polygon[k] = [points[at], points[at + 1]];
      found.push(polygon);
    }
    return found;
  }

  /** @param {any} vector of the package's; gone afterwards */
  function taken(vector) {
    const found = [];
    for (let k = 0; k < vector.size(); k++) found.push(vector.get(k));
    vector.delete();
    return found;
  }

  return {
    /**
     * @param {Float64Array} points
     * @param {Int32Array} lengths
     * @param {string} rule
     */
    section: (points, lengths, rule) => new CrossSection(polygons(points, lengths), rule),
    nothing: () => CrossSection.square([0, 0]),
    /** @param {number} width @param {number} height */
    square: (width, height) => CrossSection.square([width, height]),
    /** @param {any} section */
    bounds(section) {
      const { min, max } = section.bounds();
      return new Float64Array([min[0], min[1], max[0], max[1]]);
    },
    /** The points of all outlines, and how many each has. @param {any} section */
    outlines(section) {
      const found = taken(section._ToPolygons()).map(taken);
      const points = new Float64Array(2 * found.reduce((sum, each) => sum + each.length, 0));
      let at = 0;
      for (const { x, y } of found.flat()) {
        points[at++] = x;
        points[at++] = y;
      }
      return [points, new Int32Array(found.map((each) => each.length))];
    },
    /** @param {any[]} sections */
    union: (sections) => CrossSection.union(sections),
    /** @param {number} height @param {number} low @param {number} high @param {number} sides */
    cylinder: (height, low, high, sides) => Manifold.cylinder(height, low, high, sides),
    /** @param {any[]} solids */
    joined: (solids) => Manifold.union(solids),
    /** @param {any[]} solids */
    composed: (solids) => Manifold.compose(solids),
    /** Points, numbers of a point, and corners of triangles. @param {any} solid */
    mesh(solid) {
      const { vertProperties, numProp, triVerts } = solid.getMesh();
      return [vertProperties, numProp, triVerts];
    },
  };
}
