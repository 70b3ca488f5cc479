"""What came of a variant: data that goes between processes, into the cache and into tables."""

from __future__ import annotations

from base64 import b64decode, b64encode
from collections.abc import Mapping
from dataclasses import asdict, field
from typing import Any

from aidl_lang.common.records import record
from aidl_lang.tools.sweeping.faults import Fault

MEASURES = (
    "width",
    "height",
    "area",
    "perimeter",
    "bodies",
    "pieces",
    "holes",
    "wall",
    "gap",
    "volume",
    "mass",
)
"""The measures of the whole, in mm, mm², mm³ and g; None where there is none, or it is not known."""
ASSERT = "E0604"

Measures = Mapping[str, float | int | None]


@record()
class Change:
    """A kept size that had to change."""

    path: str
    written: float
    solved: float


@record()
class Outcome:
    """What came of a variant.

    status    `solved`, `partial`, `failed`, `wrong`; `broken` if it met a limit or ended its process
    ok        whether it solved, all asserts hold, and all files could be made
    faults    its errors, then its warnings
    params    all params with the values that they had
    asserts   the number of asserts that were looked at
    dof       degrees of freedom
    files     by suffix: the file, and further ones beside it
    picture   a small PNG, if it was asked for
    missing   files that it asked for and that did not travel with it
    """

    status: str
    ok: bool
    faults: tuple[Fault, ...] = ()
    params: Mapping[str, float | str | bool] = field(default_factory=dict)
    measures: Measures = field(default_factory=dict)
    changed: tuple[Change, ...] = ()
    asserts: int = 0
    dof: int | None = None
    seconds: float = 0.0
    files: Mapping[str, tuple[bytes, ...]] = field(default_factory=dict)
    picture: bytes = b""
    missing: tuple[str, ...] = ()

    @property
    def errors(self) -> tuple[Fault, ...]:
        return tuple(each for each in self.faults if each.is_error)

    @property
    def failed_asserts(self) -> tuple[Fault, ...]:
        return tuple(each for each in self.faults if each.code == ASSERT)


def to_data(outcome: Outcome) -> dict[str, Any]:
    """Returns an outcome as JSON has it."""
    return {
        "status": outcome.status,
        "ok": outcome.ok,
        "faults": [asdict(each) for each in outcome.faults],
        "params": dict(outcome.params),
        "measures": dict(outcome.measures),
        "changed": [asdict(each) for each in outcome.changed],
        "asserts": outcome.asserts,
        "dof": outcome.dof,
        "seconds": outcome.seconds,
        "files": {suffix: list(map(_packed, found)) for suffix, found in outcome.files.items()},
        "picture": _packed(outcome.picture),
    }


def from_data(data: Any) -> Outcome:
    """Reads an outcome from JSON that anybody may have written. Raises ValueError, TypeError or KeyError for
    data that is none.
    """
    faults = tuple(Fault(**each) for each in data["faults"])
    strings = [
        data["status"],
        *(text for each in faults for text in (each.code, each.message, each.label, each.text)),
    ]
    numbers = [data["asserts"], data["seconds"], *(data["measures"][name] for name in data["measures"])]
    if not all(isinstance(each, str) for each in strings) or not all(
        each is None or isinstance(each, int | float) for each in [*numbers, data["dof"]]
    ):
        raise ValueError("no outcome")
    if set(data["measures"]) - set(MEASURES) or type(data["ok"]) is not bool:
        raise ValueError("no outcome")
    return Outcome(
        data["status"],
        data["ok"],
        faults,
        {str(path): _plain(value) for path, value in data["params"].items()},
        dict(data["measures"]),
        tuple(
            Change(str(each["path"]), float(each["written"]), float(each["solved"]))
            for each in data["changed"]
        ),
        data["asserts"],
        data["dof"],
        data["seconds"],
        {str(suffix): tuple(map(_unpacked, found)) for suffix, found in data["files"].items()},
        _unpacked(data["picture"]),
    )


def _plain(value: object) -> float | str | bool:
    if not isinstance(value, float | int | str | bool):
        raise ValueError("no value of a param")
    return value


def _packed(data: bytes) -> str:
    return b64encode(data).decode()


def _unpacked(text: str) -> bytes:
    return b64decode(text, validate=True)
