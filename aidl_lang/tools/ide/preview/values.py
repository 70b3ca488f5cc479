"""The data of a preview. Coordinates in mm in the frame of the root, y upwards; places are spans."""

from __future__ import annotations

from aidl_lang.common.diagnostics import Fix
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.geometry.curves import Vec
from aidl_lang.geometry.evaluate import Bounds
from aidl_lang.tools.ide.dragging import Handle

FREEDOM = "freedom"
"""The layer of remaining motions, which are listed beside the picture and not drawn in it."""
LAYERS = ("names", "points", "bbox", "constraints", "dof", "plan", "dimensions")
"""Layers that may be drawn over the picture."""


@record()
class Element:
    """A drawn thing; its number in the picture is its index.

    kind  `structure` or `geometry`; `type` tells which of them
    span  its place in the present text; for a thing made by the library, the call. None if an edit removed it
    hint  a line about it
    """

    path: str
    kind: str
    type: str
    span: Span | None
    hint: str


@record()
class Slider:
    """A `param`: `span` is the place of its value; `editable` says whether that can be written."""

    path: str
    name: str
    kind: str
    """`number`, `choice`, `truth` or `text`"""
    value: float | str | bool
    unit: str
    low: float | None
    high: float | None
    step: float | None
    choices: tuple[float | str | bool, ...]
    doc: str
    span: Span | None
    editable: bool


@record()
class Problem:
    """A diagnostic with the numbers of its elements, and points of the drawing."""

    severity: str
    code: str
    message: str
    hints: tuple[str, ...]
    span: Span | None
    elements: tuple[int, ...]
    points: tuple[Vec, ...]
    fixes: tuple[Fix, ...]


@record()
class Party:
    """A constraint of a conflict; `off` is its residual, None if that has no value."""

    text: str
    span: Span
    elements: tuple[int, ...]
    off: float | None


@record()
class Conflict:
    headline: str
    parties: tuple[Party, ...]


@record()
class Arrow:
    start: Vec
    end: Vec


@record()
class Turn:
    """An arc about `center`; angles in degrees, counter-clockwise."""

    center: Vec
    radius: float
    first: float
    sweep: float


@record()
class Way:
    """A remaining motion of some elements: in words, and drawn."""

    words: str
    elements: tuple[int, ...]
    arrows: tuple[Arrow, ...]
    turns: tuple[Turn, ...]


@record()
class Preview:
    """A picture of a program with the data beside it.

    status  `solved`, `partial`, `failed` or `wrong`, of the present text, as are knobs and problems
    stale   True for the picture of an earlier text, since this one does not draw
    tried   True for a picture with other values than the text has
    handles the draggable points, as far as known
    svg     None if nothing was ever drawn, or painting it takes too long
    box     of the drawing
    """

    status: str
    stale: bool
    tried: bool
    seconds: float
    svg: str | None
    box: Bounds
    elements: tuple[Element, ...]
    knobs: tuple[Slider, ...]
    handles: tuple[Handle, ...]
    problems: tuple[Problem, ...]
    conflicts: tuple[Conflict, ...]
    ways: tuple[Way, ...]
    degrees: int | None
