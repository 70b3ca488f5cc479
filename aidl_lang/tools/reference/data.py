"""An entry of the reference as plain data, for JSON."""

from __future__ import annotations

from aidl_lang.checking import library
from aidl_lang.syntax import ast
from aidl_lang.tools.reference.collect import Entry, Overload
from aidl_lang.tools.reference.signatures import exactness, held, parts


def to_dict(entry: Entry) -> dict[str, object]:
    return {
        "name": entry.name,
        "sort": entry.sort,
        "topic": entry.topic,
        "line": entry.doc.line,
        "text": entry.doc.text,
        "forms": [_form(overload) for overload in entry.overloads],
        "synonyms": list(entry.synonyms),
        "example": entry.doc.example,
        "defined": entry.where,
    }


def _form(overload: Overload) -> dict[str, object]:
    data: dict[str, object] = {"form": overload.form, "line": overload.doc.line, "defined": overload.where}
    node = overload.node
    if node is None or isinstance(node, ast.Let):
        return data
    callables = library.load().callables
    data["arguments"] = [
        {
            "name": p.name.text,
            "type": p.type.text if p.type is not None else "any",
            "default": p.default.span.one_line if p.default is not None else None,
        }
        for p in node.parameters or ()
    ]
    if isinstance(node, ast.ShapeDefinition | ast.Structure):
        data["parts"] = [{"name": part.name, "type": part.type or None} for part in parts(node)]
    if isinstance(node, ast.ConstraintDefinition):
        data["held"] = held(node, callables).replace("`", "") or None
        data["measures"] = exactness(node, callables)
    return data
