"""A comparison as plain dicts and lists, for programs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from aidl_lang.common.prose import rounded
from aidl_lang.export.comparison.changes import Comparison, Fields, GeometryChange, Move, StructureChange
from aidl_lang.geometry.contacts import Contact

VERSION = 1
Json = dict[str, Any]


def to_dict(comparison: Comparison) -> Json:
    """Returns a comparison as plain data. In every pair, the first value is from before, the second from
    after; numbers have 12 digits.
    """
    document: Json = {
        "aidl_diff": VERSION,
        "units": "mm",
        "equal": comparison.is_equal,
        "status": list(comparison.status),
        "dof": list(comparison.degrees),
        "freed": list(comparison.freed),
        "held": list(comparison.held),
        "structures": [_structure(s) for s in comparison.structures],
        "contacts": [
            {"a": c.a, "b": c.b, "before": _contact(c.before), "after": _contact(c.after)}
            for c in comparison.contacts
        ],
    }
    result: Json = rounded(document)
    return result


def _structure(s: StructureChange) -> Json:
    entry: Json = {"path": s.path, "kind": s.kind, "change": s.sort}
    entry |= _went(s.was, s.move)
    fields = {"sizes": s.sizes, "params": s.params, "settings": s.settings}
    entry |= {name: _fields(found) for name, found in fields.items() if found}
    if s.geometry:
        entry["geometry"] = [_geometry(g) for g in s.geometry]
    return entry


def _geometry(g: GeometryChange) -> Json:
    entry: Json = {"name": g.name, "type": g.type, "change": g.sort} | _went(g.was, g.move)
    if g.fields:
        entry["fields"] = _fields(g.fields)
    if g.is_outline_changed:
        entry["outline"] = "changed"
    return entry


def _went(was: str | None, move: Move | None) -> Json:
    entry: Json = {} if was is None else {"was": was}
    if move is not None:
        entry["move"] = {"dx": move.dx, "dy": move.dy, "turn": move.turn, "mirrored": move.mirrored}
    return entry


def _fields(fields: Fields) -> Mapping[str, list[object]]:
    return {name: list(pair) for name, pair in fields.items()}


def _contact(contact: Contact | None) -> Json | None:
    if contact is None:
        return None
    entry = {"relation": contact.relation, "gap": contact.gap, "area": contact.area}
    return {name: value for name, value in entry.items() if value is not None}
