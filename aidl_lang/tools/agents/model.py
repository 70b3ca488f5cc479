"""The solved model as JSON in a size that a language model can read: one structure of it, without long parts.

Every form is one that `docs/model.schema.json` allows.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from typing import Any

Json = dict[str, Any]


def restricted(document: Json, path: str) -> Json:
    """Returns the document with the structure at a path as its root, and only its data. Raises KeyError."""
    root = next((s for s in _walk(document["root"]) if s["path"] == path), None)
    if root is None:
        raise KeyError(path)

    def is_inside(other: str) -> bool:
        return other == path or other.startswith(f"{path}.")

    bodies = document["bodies"]
    return document | {
        "root": root,
        "constraints": [c for c in document["constraints"] if is_inside(c["path"])],
        "dof": root["dof"],
        "free": [free for free in document["free"] if is_inside(free)],
        "motions": [m for m in document["motions"] if any(map(is_inside, m["things"]))],
        "changed": [c for c in document["changed"] if is_inside(c["path"])],
        "bodies": [body for body in bodies if is_inside(body)],
        "regions": {name: region for name, region in document["regions"].items() if is_inside(name)},
        "pairs": [p for p in document["pairs"] if is_inside(p["a"]) or is_inside(p["b"])],
    }


def paths(document: Json) -> list[str]:
    """Returns the paths of all structures, in order of writing."""
    return [s["path"] for s in _walk(document["root"])]


def shortened(document: Json, most: int) -> tuple[Json, str | None]:
    """Returns the document in at most `most` characters, and a note on what was left out; None if nothing
    was.

    Data that follow from the rest, or can be asked for by a path, go first.
    """
    left_out: list[str] = []
    for words, shorten in _WAYS:
        if len(text(document)) <= most:
            break
        shorten(document)
        left_out.append(words)
    if len(text(document)) > most:
        document = {
            name: [] if isinstance(value, list) else {} if name == "regions" else value
            for name, value in document.items()
        }
        left_out = ["everything but the root"]
    if not left_out:
        return document, None
    return document, f"{', '.join(left_out)} left out: ask for one structure by its `path`"


def text(document: Json) -> str:
    """Returns the document as it is sent."""
    return json.dumps(document, ensure_ascii=False, allow_nan=False, separators=(",", ":"))


def _walk(structure: Json) -> Iterator[Json]:
    yield structure
    for child in structure["structures"]:
        yield from _walk(child)


def _drop_outlines(document: Json) -> None:
    for region in document["regions"].values():
        region["faces"] = []
        region["geometry"] = {"type": "MultiPolygon", "coordinates": []}


def _drop_satisfied(document: Json) -> None:
    document["constraints"] = [c for c in document["constraints"] if not c["satisfied"]]


def _drop_parts(document: Json) -> None:
    for structure in _walk(document["root"]):
        for geometry in structure["geometry"].values():
            if "parts" in geometry:
                geometry["parts"] = {}


def _drop_inner_structures(document: Json) -> None:
    for child in document["root"]["structures"]:
        child["structures"] = []


def _drop_structures(document: Json) -> None:
    document["root"]["structures"] = []
    document["regions"] = {}
    document["free"], document["motions"] = [], []


_WAYS: tuple[tuple[str, Callable[[Json], None]], ...] = (
    ("outlines of regions", _drop_outlines),
    ("constraints that hold", _drop_satisfied),
    ("parts of shapes", _drop_parts),
    ("structures in structures", _drop_inner_structures),
    ("all structures but the root", _drop_structures),
)
