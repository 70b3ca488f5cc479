"""What a program says of a part in words: threads, how holes are sunk, notes, general tolerances."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from textwrap import wrap

from aidl_lang.common.numbers import fixed
from aidl_lang.geometry.curves import Circle, Piece, Vec
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.evaluate import point
from aidl_lang.geometry.solved import Scalar, SolvedModel, SolvedStructure

Attributes = Mapping[str, tuple[Scalar, ...]]
Labels = list[tuple[Circle, str, str]]
Notes = tuple[tuple[str, tuple[Piece, ...]], ...]

_GENERAL = {"tolerance": "General tolerances", "finish": "Surface"}
_LINE, _BESIDE = 80, 28
"""Characters of a line of the table of notes, and of a note that stands beside what it is about."""


def said_of(model: SolvedModel, drawing: Drawing) -> tuple[Labels, Notes, list[str]]:
    """Returns the circles of which something is said, with what stands in place of their diameter; notes on
    anything else, with its outline; and those that are too long for a place beside it.
    """
    lines: list[str] = []

    def shortened(words: str) -> str:
        if len(words) <= _BESIDE:
            return words
        line = next((k for k, known in enumerate(lines, 1) if known == words), len(lines) + 1)
        lines[line - 1 :] = [words] if line > len(lines) else lines[line - 1 :]
        return f"note {line}"

    bodies = {model.root.path, *(body.path for body in drawing.bodies)}
    drawn = {_middle(piece) for body in drawing.bodies for piece in body.region.pieces}
    drawn |= {_middle(piece) for stroke in drawing.strokes for piece in stroke.pieces}
    around = {child.path: parent for parent in model.root.walk() for child in parent.structures}
    labels: Labels = []
    notes: list[tuple[str, tuple[Piece, ...]]] = []
    for structure in model.root.walk():
        is_part = structure.path in bodies
        said = [] if is_part else [*_texts(structure.attributes, "note")]
        depth = _depth(structure)
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
    long = [part for n, words in enumerate(lines, 1) for part in wrap(f"Note {n}: {words}", _LINE)]
    return labels, tuple(notes), long


def _middle(piece: Piece) -> Vec:
    x, y = point(piece, 0.5)
    return round(x, 6), round(y, 6)


def _of_circle(circle: Circle, thread: str, depth: Sequence[str], *, is_bored: bool) -> str:
    """Returns the thread or the diameter of a round hole, and how it is sunk."""
    size = thread or f"⌀{fixed(2 * circle.radius, 2)}"
    if len(depth) > 1:
        return f"{size} × {depth[1]}° countersunk"
    return f"{size}{' counterbored' if is_bored else ''}, {depth[0]} deep" if depth else size


def _depth(hole: SolvedStructure) -> list[str]:
    """Returns how deep a hole is that ends in its solid, and the angle of a cone."""
    return [
        fixed(float(value), 2) for value in hole.attributes.get("depth", ()) if not isinstance(value, str)
    ]


def _texts(attributes: Attributes, name: str) -> Iterator[str]:
    return (str(value) for value in attributes.get(name, ()))


def general(root: SolvedStructure, subject: SolvedStructure) -> Iterator[str]:
    """Yields the lines that are said of a whole part, or else of all parts."""
    for name, words in _GENERAL.items():
        for value in list(_texts(subject.attributes, name)) or _texts(root.attributes, name):
            yield from wrap(f"{words}: {value}", _LINE)
    for value in _texts(subject.attributes, "note"):
        yield from wrap(value, _LINE)
