"""The result of a comparison as data. Lengths in mm, areas in mm², angles in degrees, in the root frame.

Of two values the first is from before, the second from after; None stands for nothing.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Literal, TypeAlias

from aidl_lang.common.records import record
from aidl_lang.export.comparison.move import Move
from aidl_lang.geometry.contacts import Contact
from aidl_lang.geometry.curves import Vec
from aidl_lang.geometry.drawing import Drawing
from aidl_lang.geometry.solved import Scalar, SolvedModel

Value: TypeAlias = Scalar | Vec | tuple[Scalar, ...] | None
Fields: TypeAlias = Mapping[str, tuple[Value, Value]]
Sort: TypeAlias = Literal["changed", "appeared", "vanished"]


@record()
class Version:
    """One side of a comparison: a solved model and its drawing."""

    model: SolvedModel
    drawing: Drawing


@record()
class GeometryChange:
    """The change of a named geometry. `fields` differ if it did not move as a whole
    (`is_outline_changed`).
    """

    name: str
    type: str
    sort: Sort = "changed"
    was: str | None = None
    move: Move | None = None
    fields: Fields = field(default_factory=dict)
    is_outline_changed: bool = False


@record()
class StructureChange:
    """The change of a structure.

    path      after; before for one that vanished
    was       its path before, if it was found by its shape under another name or elsewhere in the tree
    move      its motion as a whole; None if it stayed, or went with its parent
    middle    the middle of its box before; after for one that appeared
    sizes     width and height of its box; area, perimeter and centroid of its region
    settings  attributes as `@name`, finished corners as `fillet of NAME`, and `kind`
    """

    path: str
    kind: str
    sort: Sort = "changed"
    was: str | None = None
    move: Move | None = None
    middle: Vec | None = None
    sizes: Fields = field(default_factory=dict)
    params: Fields = field(default_factory=dict)
    settings: Fields = field(default_factory=dict)
    geometry: tuple[GeometryChange, ...] = ()

    @property
    def is_one(self) -> bool:
        """True if anything changed."""
        told = (self.was, self.move, self.sizes, self.params, self.settings, self.geometry)
        return self.sort != "changed" or any(told)


@record()
class ContactChange:
    """The contact of two bodies before and after, named by their paths after; None for bodies far apart."""

    a: str
    b: str
    before: Contact | None
    after: Contact | None


@record()
class Comparison:
    """The differences between two versions, in order of writing.

    freed, held  parameters that can move now and could not before, and the reverse, by their paths
    size         of the larger drawing, mm; `tolerance` is 1e-6 of it
    """

    before: Version
    after: Version
    structures: tuple[StructureChange, ...]
    contacts: tuple[ContactChange, ...]
    freed: tuple[str, ...]
    held: tuple[str, ...]
    size: float

    @property
    def status(self) -> tuple[str, str]:
        return self.before.model.status, self.after.model.status

    @property
    def degrees(self) -> tuple[int | None, int | None]:
        """Returns the degrees of freedom before and after."""
        return self.before.model.degrees, self.after.model.degrees

    @property
    def is_equal(self) -> bool:
        """True if the versions do not differ."""
        same = self.status[0] == self.status[1] and self.degrees[0] == self.degrees[1]
        return same and not (self.structures or self.contacts or self.freed or self.held)

    def __str__(self) -> str:
        from aidl_lang.export.comparison.wording import text

        return text(self)

    def to_dict(self) -> dict[str, object]:
        """Returns the comparison as plain dicts and lists, numbers to 12 digits."""
        from aidl_lang.export.comparison.data import to_dict

        return to_dict(self)
