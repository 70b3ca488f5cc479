"""SVG files as outlines: millimetres, y up, the lower left corner of the page at the origin.

The tree is walked as a browser would draw it: groups, `use` with what it refers to, nested `svg` and `symbol`
with their view boxes, transforms, and style as far as it decides what is there (`display`, `visibility`,
`fill`, `fill-rule`). Fills are no outlines: what a shape encloses follows from its curves.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from fontTools.misc.transform import Identity, Offset, Transform

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.drawings import Collector, DrawingError, Engraving, Stroke, ends, mapped
from aidl_lang.common.drawings import svg_values as xml
from aidl_lang.common.drawings.svg_values import SHAPES, Node, ValueMistake, outline, transform
from aidl_lang.common.prose import first_few, ticked
from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint

_MOST_USES = 20_000
_DEEPEST = 150
_PAGE = (300.0, 150.0)
"""Width and height, in pixels, of a page that states none."""

_UNSEEN = frozenset(
    """
    defs symbol clipPath mask marker pattern linearGradient radialGradient filter style script title
    desc metadata view font cursor
    """.split()
)
"""Elements that draw nothing where they stand."""
_GROUPS = frozenset({"svg", "g", "a", "switch"})
_OTHERS = {"text": "text", "image": "image", "foreignObject": "foreign object"}
"""What can be seen and is no outline."""
_ENGRAVED = ("fill", "engrave", "score")
_INHERITED = ("fill", "fill-rule", "visibility", "stroke")


@record()
class _Place:
    """The circumstances of an element: how its coordinates go to the page's, what is inherited, the names
    of the groups around it, and what it stands in, directly or by being used; in a file of AIDL the
    operation that is said of it, `` for what a picture has drawn on a part, None for material.
    """

    matrix: Transform
    page: tuple[float, float]
    style: Mapping[str, str]
    names: tuple[str, ...] = ()
    around: tuple[Node, ...] = ()
    operation: str | None = None
    layer: str | None = None


def read(data: bytes, name: str) -> tuple[Collector, list[Diagnostic]]:
    """Returns the elements of an SVG file and what there is to be told of it. Raises DrawingError."""
    return _Walk(xml.read(data, name), name).run()


class _Walk:
    def __init__(self, root: Node, name: str) -> None:
        self.root = root
        self.name = name
        self.found = Collector(name)
        self.by_id: dict[str, Node] = {}
        self.rules: list[tuple[str, dict[str, str]]] = []
        self.broken: list[str] = []
        self.circular: list[str] = []
        self.uses = 0
        self.is_own = any("data-path" in node.attributes for node in root.walk())
        for node in root.walk():
            if "id" in node.attributes:
                self.by_id.setdefault(node.attributes["id"], node)
            if node.tag == "style":
                self.rules += _rules(node.text)

    def run(self) -> tuple[Collector, list[Diagnostic]]:
        width, height, matrix = self._page()
        flip = Transform(xml.MM_PER_PIXEL, 0.0, 0.0, -xml.MM_PER_PIXEL, 0.0, height * xml.MM_PER_PIXEL)
        place = _Place(flip.transform(matrix), (width, height), {})
        style = self._style(self.root, {})
        if style.get("display") != "none":
            self._children(self.root, replace(place, style=style))
        return self.found, list(self._remarks())

    def _page(self) -> tuple[float, float, Transform]:
        """Returns width and height of the page in pixels, and the map of its coordinates to these."""
        box = self._view_box(self.root)
        full = (box[2], box[3]) if box else _PAGE
        width, height = map(self._page_length, ("width", "height"), full)
        given = [name for name in ("width", "height") if _states(self.root, name)]
        if box and len(given) == 1:  # the other follows
            if given == ["width"]:
                height = width * box[3] / box[2]
            else:
                width = height * box[2] / box[3]
        return width, height, self._fitted(self.root, box, width, height)

    def _page_length(self, name: str, full: float) -> float:
        stated = (
            self._length(self.root, self.root.attributes[name], full) if _states(self.root, name) else 0.0
        )
        return stated if stated > 0.0 else full

    # --- Elements ------------------------------------------------------------------------------

    def _children(self, node: Node, place: _Place) -> None:
        children = node.children
        if node.tag == "switch":  # its first choice that can be drawn; conditions are not looked at
            children = [c for c in children if c.tag in _GROUPS or c.tag in SHAPES or c.tag == "use"][:1]
        for child in children:
            self._node(child, place)

    def _node(self, node: Node, place: _Place) -> None:
        checkpoint()
        if node.tag in _UNSEEN or node.tag == "":
            return
        style = self._style(node, place.style)
        explains = {"overlay", "dimension", "seam"}.intersection(node.attributes.get("class", "").split())
        if style.get("display") == "none" or (self.is_own and explains):
            return
        if any(style.get(way, "none") != "none" for way in ("clip-path", "mask")):
            self.found.left_out["clipped or masked shape"] += 1
        try:
            matrix = place.matrix.transform(transform(node.attributes.get("transform", "")))
        except (ValueMistake, ArithmeticError):
            self.broken.append(_called(node))
            matrix = place.matrix
        names, around = (*place.names, *_names(node)), (*place.around, node)
        place = _Place(matrix, place.page, style, names, around, *_engraved(node, place))
        if node.tag == "use":
            self._use(node, place)
        elif node.tag == "svg":
            self._inner_page(node, place, node.attributes)
        elif node.tag in _GROUPS:
            self._children(node, place)
        elif node.tag in SHAPES:
            self._shape(node, place)
        elif node.tag in _OTHERS:
            self.found.left_out[_OTHERS[node.tag]] += 1
        else:
            self.found.left_out[f"`{node.tag[:20]}` element"] += 1

    def _shape(self, node: Node, place: _Place) -> None:
        if place.style.get("visibility", "visible") in ("hidden", "collapse"):
            return
        self.found.count_numbers(node.attributes.get("d", "") + node.attributes.get("points", ""))
        try:
            strokes, is_whole = outline(node, place.page)
        except ValueMistake:
            strokes, is_whole = [], False
        if not is_whole:
            self.broken.append(_called(node))
        a, b, c, d, _, _ = place.matrix
        if a * d == b * c:  # all on one line
            return
        is_filled = place.style.get("fill", "black") != "none"
        is_winding = is_filled and place.style.get("fill-rule", "nonzero") != "evenodd"
        if is_filled and place.style.get("stroke", "none") == "none":
            strokes = list(_closed(strokes))
        engraving = None
        if place.operation is not None:
            color = place.style.get("fill" if is_filled else "stroke") if place.operation == "" else None
            engraving = Engraving(place.layer, color, is_filled)
        placed = (mapped(stroke, place.matrix) for stroke in strokes)
        self.found.add(place.names, placed, is_winding=is_winding, engraving=engraving)

    def _use(self, node: Node, place: _Place) -> None:
        target = self.by_id.get(node.attributes.get("href", "").strip().removeprefix("#"))
        if target is None:
            self.found.left_out["dangling `use` element"] += 1
            return
        if target in place.around or len(place.around) > _DEEPEST or target is self.root:
            self.circular.append(_called(node))
            return
        self.uses += 1
        if self.uses > _MOST_USES:
            hint = "save it anew as plain SVG, or in several files"
            raise DrawingError(
                "E0363", f"`{self.name}` is refused: its `use` elements grow beyond {_MOST_USES:,}", hint
            )
        place = replace(place, matrix=place.matrix.transform(self._corner(node, place.page)))
        if target.tag in ("symbol", "svg"):
            style = self._style(target, place.style)
            if style.get("display") == "none":
                return
            names = (*place.names, *_names(target))
            sizes = target.attributes | {k: v for k, v in node.attributes.items() if k in ("width", "height")}
            around = (*place.around, target)
            self._inner_page(target, replace(place, style=style, names=names, around=around), sizes)
        else:
            self._node(target, place)

    def _inner_page(self, node: Node, place: _Place, sizes: Mapping[str, str]) -> None:
        """Draws a `svg` in another, or a symbol, in a page of its own."""
        width, height = (
            self._length(node, sizes.get(name, "100%"), whole, whole)
            for name, whole in zip(("width", "height"), place.page, strict=True)
        )
        if width <= 0.0 or height <= 0.0:
            return
        box = self._view_box(node)
        corner = self._corner(node, place.page) if node.tag == "svg" else Identity
        inner = corner.transform(self._fitted(node, box, width, height))
        page = (box[2], box[3]) if box else (width, height)
        self._children(node, replace(place, matrix=place.matrix.transform(inner), page=page))

    # --- Attributes ----------------------------------------------------------------------------

    def _style(self, node: Node, around: Mapping[str, str]) -> dict[str, str]:
        """Returns the properties of an element that count here, inherited ones included."""
        style = {name: around[name] for name in _INHERITED if name in around}
        for name in (*_INHERITED, "display", "clip-path", "mask"):
            if name in node.attributes:
                style[name] = node.attributes[name].strip()
        kinds = {"*", node.tag, f"#{node.attributes.get('id', '')}"}
        classes = [f".{word}" for word in node.attributes.get("class", "").split()]
        kinds |= {*classes, *(f"{node.tag}{word}" for word in classes)}
        for selector, properties in self.rules:
            if selector in kinds:
                style |= properties
        style |= dict(xml.declarations(node.attributes.get("style", "")))
        return {name: value for name, value in style.items() if value != "inherit"}

    def _length(self, node: Node, text: str, whole: float, otherwise: float = 0.0) -> float:
        try:
            return xml.pixels(text, whole)
        except ValueMistake:
            self.broken.append(_called(node))
            return otherwise

    def _corner(self, node: Node, page: tuple[float, float]) -> Transform:
        at = zip("xy", page, strict=True)
        return Offset(*(self._length(node, node.attributes.get(name, "0"), whole) for name, whole in at))

    def _view_box(self, node: Node) -> tuple[float, float, float, float] | None:
        if "viewBox" not in node.attributes:
            return None
        try:
            x, y, width, height = xml.numbers(node.attributes["viewBox"])
        except ValueError:
            self.broken.append(_called(node))
            return None
        return (x, y, width, height) if width > 0.0 and height > 0.0 else None

    def _fitted(
        self, node: Node, box: tuple[float, float, float, float] | None, width: float, height: float
    ) -> Transform:
        """Returns the map of a view box to its page (SVG 2, 8.2)."""
        if box is None:
            return Identity
        x, y, w, h = box
        across, up = width / w, height / h
        align, *meet = node.attributes.get("preserveAspectRatio", "xMidYMid").split() or ["xMidYMid"]
        if align != "none":
            across = up = max(across, up) if meet == ["slice"] else min(across, up)
        shares = {"Min": 0.0, "Mid": 0.5, "Max": 1.0}
        dx = (width - w * across) * shares.get(align[1:4], 0.0)
        dy = (height - h * up) * shares.get(align[5:8], 0.0)
        return Transform(across, 0.0, 0.0, up, dx - x * across, dy - y * up)

    # --- What is to be told --------------------------------------------------------------------

    def _remarks(self) -> Iterator[Diagnostic]:
        broken, circular = (ticked(dict.fromkeys(names)) for names in (self.broken, self.circular))
        if broken:
            message = f"`{self.name}` has attributes that cannot be read, in {first_few(broken, 5)}"
            hint = "paths are taken as far as they are readable; save it anew in the program that drew it"
            yield Diagnostic("W0752", message, hints=(hint,))
        if circular:
            message = f"`{self.name}` refers to itself in {first_few(circular, 5)}, where nothing is drawn"
            hint = "a `use` element may not stand in what it refers to"
            yield Diagnostic("W0752", message, hints=(hint,))


def _states(node: Node, name: str) -> bool:
    text = node.attributes.get(name, "auto").strip()
    return text not in ("", "auto") and not text.endswith("%")


def _engraved(node: Node, around: _Place) -> tuple[str | None, str | None]:
    """Returns what AIDL says of a group: the operation along its lines, and the layer of the program."""
    said = node.attributes
    if "data-path" not in said:
        return around.operation, around.layer
    operation = said.get("data-operation")
    if operation is not None:
        is_layer = operation in ("fill", "score")
        return (operation, operation if is_layer else None) if operation in _ENGRAVED else (None, None)
    is_drawn = said.get("data-kind") == "drawing"
    return ("", said.get("data-layer")) if is_drawn else (None, None)


def _names(node: Node) -> tuple[str, ...]:
    """Returns what an element is called: the label that Inkscape shows of it, and its id."""
    label, own = node.attributes.get("inkscape:label", ""), node.attributes.get("id", "")
    return tuple(dict.fromkeys(name for name in (label, own) if name.strip()))


def _called(node: Node) -> str:
    return node.attributes.get("id", node.tag)[:40]


_RULE = re.compile(r"([^{}]+)\{([^{}]*)\}")
_COMMENT = re.compile(r"/\*.*?\*/|<!--|-->", re.S)


def _rules(text: str) -> Iterator[tuple[str, dict[str, str]]]:
    """Yields the rules of a style sheet with simple selectors: a tag, a class, an id."""
    for found in _RULE.finditer(_COMMENT.sub("", text)):
        properties = dict(xml.declarations(found[2]))
        for selector in found[1].split(","):
            yield selector.strip(), properties


def _closed(strokes: Sequence[Stroke]) -> Iterator[Stroke]:
    """Yields strokes with each contour closed, as what is only filled is."""
    first = 0
    for k, stroke in enumerate(strokes):
        yield stroke
        start, end = ends(strokes[first])[0], ends(stroke)[1]
        if k + 1 == len(strokes) or ends(strokes[k + 1])[0] != end:
            if start != end:
                yield end, start
            first = k + 1
