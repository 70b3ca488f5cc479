"""XML of unknown origin as a tree of plain nodes: how many there are, how deep they lie, and what their DTD
defines is bounded while it is read, and nothing outside of the text is looked at.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import field
from xml.parsers import expat

from aidl_lang.common.drawings.drawing import DrawingError
from aidl_lang.common.records import record
from aidl_lang.common.running import checkpoint

MOST_NODES = 100_000
DEEPEST = 100
_MOST_ENTITIES = 100
_LONGEST_ENTITY = 1_000


@record(frozen=False, eq=False, slots=True)
class Node:
    """An element: its name without the namespace ("" for one of another namespace than SVG's)."""

    tag: str
    attributes: dict[str, str]
    children: list[Node] = field(default_factory=list)
    text: str = ""

    def walk(self) -> Iterator[Node]:
        yield self
        for child in self.children:
            yield from child.walk()


def read(data: bytes, path: str) -> Node:
    """Returns the root of an SVG document. Raises DrawingError."""
    reader = _Reader(path)
    try:
        reader.parser.Parse(data, True)
    except expat.ExpatError as reason:
        what = expat.ErrorString(reason.code)
        raise DrawingError(
            "E0362",
            f"`{path}` is not well-formed: {what} in line {reason.lineno}",
            "save it anew as plain SVG in the program that drew it",
        ) from None
    except (LookupError, ValueError):  # an encoding that is unknown, or takes several bytes
        raise DrawingError(
            "E0362", f"`{path}` is in an encoding that is not known", "save it anew as UTF-8"
        ) from None
    if reader.root is None or reader.root.tag != "svg":
        raise DrawingError(
            "E0362", f"`{path}` is no SVG: it does not begin with an `svg` element", "export it as SVG"
        )
    return reader.root


class _Reader:
    def __init__(self, path: str) -> None:
        self.path = path
        self.root: Node | None = None
        self.open: list[Node] = []
        self.count = self.entities = 0
        self.parser = expat.ParserCreate(namespace_separator=" ")
        self.parser.buffer_text = True
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end
        self.parser.CharacterDataHandler = self._text
        self.parser.EntityDeclHandler = self._entity

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        self.count += 1
        if self.count % 1_000 == 0:
            checkpoint()
        if self.count > MOST_NODES:
            raise self._refused(f"it has more than {MOST_NODES:,} elements")
        if len(self.open) >= DEEPEST:
            raise self._refused(f"its elements lie more than {DEEPEST} deep in one another")
        space, _, local = name.rpartition(" ")
        node = Node(local if space in ("", "http://www.w3.org/2000/svg") else "", _plain(attributes))
        if self.open:
            self.open[-1].children.append(node)
        else:
            self.root = node
        self.open.append(node)

    def _end(self, name: str) -> None:
        self.open.pop()

    def _text(self, data: str) -> None:
        if self.open and self.open[-1].tag == "style":
            self.open[-1].text += data

    def _entity(self, name: str, is_parameter: bool, value: str | None, *other: str | None) -> None:
        """Takes the abbreviations that some programs write, and nothing that would grow or reach out."""
        self.entities += 1
        if value is None or is_parameter or "&" in value or len(value) > _LONGEST_ENTITY:
            raise self._refused(f"its entity `{name[:30]}` is no plain abbreviation")
        if self.entities > _MOST_ENTITIES:
            raise self._refused(f"it defines more than {_MOST_ENTITIES} entities")

    def _refused(self, reason: str) -> DrawingError:
        return DrawingError(
            "E0363", f"`{self.path}` is refused: {reason}", "save it anew as plain SVG, or in several files"
        )


def _plain(attributes: dict[str, str]) -> dict[str, str]:
    """Returns attributes by their local names; those of Inkscape keep a mark, as in `inkscape:label`."""
    found = {}
    for name, value in attributes.items():
        space, _, local = name.rpartition(" ")
        found[f"inkscape:{local}" if "inkscape" in space else local] = value
    return found
