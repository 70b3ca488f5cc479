"""What a drawing of some parts has to show, and what the program says of them in words."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from textwrap import wrap

from aidl_lang.common.prose import fixed
from aidl_lang.common.records import record
from aidl_lang.export.dimensioning import seen_on, visible
from aidl_lang.geometry.boolean import Contacts
from aidl_lang.geometry.curves import Circle, Piece, Vec, union_bounds
from aidl_lang.geometry.dimensions import completed, overall
from aidl_lang.geometry.drawing import Body, Drawing, Stroke
from aidl_lang.geometry.parts import engraved, gathered, shape_of
from aidl_lang.geometry.solved import Dimension, Length, Opening, Roundness, SolvedModel, SolvedStructure
from aidl_lang.geometry.styles import Attributes, Style

# --- What a program says of a part in words: threads, how holes are sunk, notes, general tolerances.

Labels = list[tuple[Circle, str, str]]
Notes = tuple[tuple[str, tuple[Piece, ...]], ...]

_GENERAL = {"tolerance": "General tolerances", "finish": "Surface"}
_LINE, _BESIDE = 80, 28
"""Characters of a line of the table of notes, and of a note that stands beside what it is about."""


def said_of(model: SolvedModel, drawing: Drawing) -> tuple[Labels, Notes, list[str]]:
    """Returns the circles of which something is said, with what stands in place of their diameter; notes on
    anything else, with its outline; and those that are too long for a place beside it.
    """
    lines: dict[str, int] = {}

    def shortened(words: str) -> str:
        return words if len(words) <= _BESIDE else f"note {lines.setdefault(words, len(lines) + 1)}"

    bodies = {model.root.path, *(body.path for body in drawing.bodies)}
    drawn = {_middle(piece) for body in drawing.bodies for piece in body.region.pieces}
    drawn |= {_middle(piece) for stroke in drawing.strokes for piece in stroke.pieces}
    around = {child.path: parent for parent in model.root.walk() for child in parent.structures}
    labels: Labels = []
    notes: list[tuple[str, tuple[Piece, ...]]] = []
    for structure in model.root.walk():
        is_part = structure.path in bodies
        said = [] if is_part else [*_texts(structure.attributes, "note")]
        depth = [fixed(float(d), 2) for d in structure.attributes.get("depth", ()) if not isinstance(d, str)]
        rest = [*said, *([f"{depth[0]} deep"] if depth else [])]
        is_bored = not is_part and around[structure.path].kind == "hole"
        for geometry in structure.geometry:
            curves, own = tuple(geometry.curves()), [*_texts(geometry.attributes, "note")]
            if len(curves) == 1 and isinstance(curves[0], Circle):
                thread = next(_texts(structure.attributes, "thread"), "")
                if thread or depth or said or own:
                    words = _of_circle(curves[0], thread, depth, is_bored=is_bored)
                    labels.append((curves[0], words, " ".join(map(shortened, (*said, *own)))))
            elif drawn.intersection(map(_middle, curves)) and (rest or own):
                notes.append((shortened(", ".join([*rest, *own])), curves))
                rest = []
    long = [part for words, n in lines.items() for part in wrap(f"Note {n}: {words}", _LINE)]
    return labels, tuple(notes), long


def _middle(piece: Piece) -> Vec:
    x, y = piece.point(0.5)
    return round(x, 6), round(y, 6)


def _of_circle(circle: Circle, thread: str, depth: Sequence[str], *, is_bored: bool) -> str:
    """Returns the thread or the diameter of a round hole, and how it is sunk."""
    size = thread or f"⌀{fixed(2 * circle.radius, 2)}"
    if len(depth) > 1:
        return f"{size} × {depth[1]}° countersunk"
    return f"{size}{' counterbored' if is_bored else ''}, {depth[0]} deep" if depth else size


def _texts(attributes: Attributes, name: str) -> Iterator[str]:
    return (str(value) for value in attributes.get(name, ()))


def general(root: SolvedStructure, subject: SolvedStructure) -> Iterator[str]:
    """Yields the lines that are said of a whole part, or else of all parts."""
    for name, words in _GENERAL.items():
        for value in list(_texts(subject.attributes, name)) or _texts(root.attributes, name):
            yield from wrap(f"{words}: {value}", _LINE)
    for value in _texts(subject.attributes, "note"):
        yield from wrap(value, _LINE)


# --- What a drawing of some parts has to show: the sheets, the views on each, the dimensions of each view.

Wanted = tuple[Dimension, ...]
"""Equal dimensions that are shown once."""

_ALIKE = 1e-6
_FILED = frozenset({"glyphs", "traced"})
"""Types of geometry whose outlines no dimensions tell: letters and imported drawings."""


@record()
class Hole:
    """A round hole of a table: a letter for its size and a number, and its place from the datum."""

    sign: str
    circle: Circle
    x: float
    y: float
    words: str


@record()
class View:
    """Parts seen from one side. `label` tells it from others of the sheet; `balloons`: numbers of the list of
    parts with the bodies that bear them; `free`: paths of bodies whose outline no dimensions tell;
    `holes`: those that a table tells, from `datum`; `notes`: what is said of something, with its outline;
    `lines`: longer notes.
    """

    label: str
    drawing: Drawing
    wanted: tuple[Wanted, ...]
    balloons: tuple[tuple[int, Body], ...] = ()
    free: tuple[str, ...] = ()
    holes: tuple[Hole, ...] = ()
    datum: Vec = (0.0, 0.0)
    notes: Notes = ()
    lines: tuple[str, ...] = ()


@record()
class Item:
    """Equal parts: an entry of the list of parts."""

    number: int
    bodies: tuple[Body, ...]
    name: str

    @property
    def style(self) -> Style:
        return self.bodies[0].style

    @property
    def count(self) -> int:
        """How many pieces are made of it."""
        return sum(body.style.quantity for body in self.bodies)

    @property
    def size(self) -> str:
        left, bottom, right, top = self.bodies[0].box
        sides = [right - left, top - bottom]
        sides += [self.style.thickness] if self.style.thickness is not None else []
        return " × ".join(fixed(side, 2) for side in sides)


@record()
class Content:
    """A sheet: what it is of, and its views. `items`: the list of parts that it bears; `lines`: its notes."""

    subject: SolvedStructure
    style: Style
    views: tuple[View, ...]
    items: tuple[Item, ...] = ()
    count: int = 1
    lines: tuple[str, ...] = ()


def contents(model: SolvedModel, drawing: Drawing) -> list[Content]:
    """Returns the sheets: one for a single part, else one of all with a list, and one per different part."""
    root, styles = model.root, drawing.styles
    if len(drawing.bodies) < 2:
        style = drawing.bodies[0].style if drawing.bodies else styles[root.path]
        subject = (root.find(drawing.bodies[0].path) if drawing.bodies else None) or root
        view = _view(model, drawing)
        lines = (*general(root, subject), *view.lines)
        return [Content(root, style, (view,), count=style.quantity, lines=lines)]
    items = tuple(
        Item(number, tuple(group), group[0].path.rpartition(".")[2].partition("[")[0])
        for number, group in enumerate(gathered(drawing.bodies, shape_of), 1)
    )
    parts = []
    on, _ = engraved(drawing.bodies, drawing.strokes)
    for item in items:
        body = item.bodies[0]
        alone = _only(drawing, [body], on.get(body.path, ()))
        subject = root.find(body.path) or root
        own = _of_body(model, alone, [b.path for b in drawing.bodies if b is not body])
        view = _view(own, alone)
        lines = (*general(root, subject), *view.lines)
        parts.append(Content(subject, body.style, (view,), count=item.count, lines=lines))
    shown = {d.group for content in parts for view in content.views for g in view.wanted for d in g}
    between = [size for size in model.sizes if size.origin == "hand" and size.group not in shown]
    views, lines = tuple(_overview(model, drawing, items, between)), tuple(general(root, root))
    return [Content(root, styles[root.path], views, items, lines=lines), *parts]


def _view(model: SolvedModel, drawing: Drawing) -> View:
    stated = visible(model, drawing)
    filed = (g for g in model.root.walk_geometry() if g.type in _FILED)
    labels, notes, lines = said_of(model, drawing)
    done = completed(drawing, stated, (curve for g in filed for curve in g.curves()), labels)
    holes = tuple(_holes(done.holes, done.datum, labels))
    return View("", drawing, done.groups, (), done.free, holes, done.datum, notes, tuple(lines))


def _holes(circles: Sequence[Circle], datum: Vec, labels: Labels) -> Iterator[Hole]:
    """Yields holes with their signs: equal ones of one letter, from left to right and upwards."""
    said = [
        next((" ".join(words).strip() for known, *words in labels if known == circle), "")
        for circle in circles
    ]
    keys = [(round(c.radius, 6), words) for c, words in zip(circles, said, strict=True)]
    for number, (size, words) in enumerate(sorted(set(keys))):
        own = sorted(
            (c for c, key in zip(circles, keys, strict=True) if key == (size, words)),
            key=lambda c: (round(c.center[0], 6), round(c.center[1], 6)),
        )
        for k, circle in enumerate(own, 1):
            x, y = circle.center
            shown = words or f"⌀{fixed(2 * circle.radius, 2)}"
            yield Hole(f"{_letters(number)}{k}", circle, x - datum[0], y - datum[1], shown)


def _letters(number: int) -> str:
    """Returns A, B, … Z, AA, AB, …"""
    more, last = divmod(number, 26)
    return (_letters(more - 1) if more else "") + chr(ord("A") + last)


def _overview(
    model: SolvedModel, drawing: Drawing, items: Sequence[Item], between: Sequence[Dimension]
) -> Iterator[View]:
    """Yields a view for each orientation that parts have, the first with the dimensions from part to part."""
    orientations = {s.path: s.orientation for s in model.root.walk()}
    seen = dict.fromkeys(orientations[body.path] for body in drawing.bodies)
    for orientation in seen:
        bodies = [b for b in drawing.bodies if orientations[b.path] == orientation]
        strokes = [s for s in drawing.strokes if orientations[s.path] == orientation]
        part = drawing if len(seen) == 1 else _only(drawing, bodies, strokes)
        label = f"Seen from the {orientation}" if len(seen) > 1 else ""
        balloons = tuple((item.number, b) for item in items for b in item.bodies[:1] if b in bodies)
        wanted = [*overall(part), *(between if orientation == next(iter(seen)) else ())]
        yield View(label, part, tuple((d,) for d in wanted), balloons)


def _only(drawing: Drawing, bodies: Sequence[Body], strokes: Sequence[Stroke]) -> Drawing:
    boxes = [b.box for b in bodies] + [p.box for s in strokes for p in s.pieces]
    paths = {b.path for b in bodies}
    return replace(
        drawing,
        bodies=tuple(bodies),
        strokes=tuple(strokes),
        seams=tuple(seam for seam in drawing.seams if seam.body in paths),
        plans=(),
        contacts=Contacts(),
        box=union_bounds(boxes),
    )


def _of_body(model: SolvedModel, alone: Drawing, others: Sequence[str]) -> SolvedModel:
    """Returns the model with the sizes that concern the one body of a drawing."""
    path = alone.bodies[0].path
    sheet = seen_on(alone)
    centers = [p.center for p in alone.bodies[0].region.pieces if isinstance(p, Circle)]

    def is_there(points: Sequence[Vec]) -> bool:
        near = any(
            abs(c[0] - p[0]) + abs(c[1] - p[1]) <= _ALIKE * alone.size for c in centers for p in points
        )
        return near or bool(sheet.seen(tuple(points)))

    def concerns(size: Dimension) -> bool:
        if size.origin != "constraint":
            if _is_of(size.of, path):
                return True
            if any(_is_of(size.of, other) for other in others):
                return False
        match size:
            case Length(start=start, end=end):
                return is_there(start) and is_there(end)
            case Roundness(curve=curve):
                return curve in alone.bodies[0].region.pieces
            case Opening(corner=corner):
                return is_there([corner])
        return False

    return replace(model, size_up=lambda _: tuple(size for size in model.sizes if concerns(size)))


def _is_of(of: str, path: str) -> bool:
    return of == path or of.startswith((f"{path}.", f"{path}:"))
