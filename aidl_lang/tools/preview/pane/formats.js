// Made by `make colours` from aidl_lang/export/__init__.py; do not edit.

export const FORMATS = /** @type {const} */ ([
  ["svg", "SVG drawing"],
  ["pdf", "PDF, true to scale"],
  ["png", "PNG picture"],
  ["dxf", "DXF for cutters"],
  ["step", "STEP solid"],
  ["stl", "STL mesh"],
  ["3mf", "3MF for printers"],
]);
