"""Documentation generated from the sources: the library's own comments, the sections on built-ins.

`collect` gathers, `signatures` reads definitions; here stand the entries as Markdown and as data, pictures of
their examples, and the guide.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cache

from aidl_lang.checking.subset import Variant
from aidl_lang.common.resources import resource
from aidl_lang.syntax import ast
from aidl_lang.tools.reference.collect import Entry, Overload, reference
from aidl_lang.tools.reference.signatures import exactness, held, parts

# --- An entry of the reference as plain data, for JSON.


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
        data["held"] = held(node).replace("`", "") or None
        data["measures"] = exactness(node)
    return data


_MEANT = {"exactly": "met exactly", "at least": "what there is at least", "at most": "what there is at most"}


def picture(entry: Entry) -> bytes:
    """Returns the drawing of an entry's example as SVG. Raises ValueError if it does not compile."""
    return picture_of(f"the example of `{entry.name}` ({entry.where})", entry.doc.example)


def picture_of(name: str, program: str, theme: str = "colour", *, dimension: bool = False) -> bytes:
    """Returns the drawing of a program as SVG. Raises ValueError if it does not compile."""
    from aidl_lang import pipeline  # a page in the terminal needs no solver
    from aidl_lang.common.render import render
    from aidl_lang.common.source import SourceFile
    from aidl_lang.export.job import Options

    compiled = pipeline.compile(SourceFile(name, program))
    if not compiled.ok:
        why = "\n".join(render(d) for d in compiled.diagnostics)
        raise ValueError(f"{name} does not compile\n{why}")
    return compiled.export(".svg", Options(compiled.show, dimension, theme=theme))


def entry_blocks(entry: Entry, level: str = "##") -> Iterator[str]:
    """Yields an entry in paragraphs, its example last."""
    yield f"{level} {entry.name}"
    yield "```text\n" + "\n".join(forms(entry)) + "\n```"
    yield entry.doc.line
    if entry.doc.text:
        yield entry.doc.text
    yield from facts(entry)
    if entry.doc.example:
        yield f"```aidl\n{entry.doc.example}```"


def forms(entry: Entry) -> list[str]:
    """Returns every form of a name, each with a comment on it alone after it."""
    lines: dict[str, str] = {}
    for overload in entry.overloads:
        own = overload.doc.line if overload.doc is not entry.doc else ""
        lines.setdefault(overload.form, f"{overload.form}    // {own}" if own else overload.form)
    return list(lines.values())


def facts(entry: Entry) -> Iterator[str]:
    """Yields facts read off the definitions, and the synonyms."""
    if named := parts_of(entry):
        yield f"Parts: {', '.join(f'`{part}`' for part in named)}."
    placing = _placing(entry)
    if placing:
        yield placing
    if entry.synonyms:
        yield f"Also: {', '.join(f'`{name}`' for name in entry.synonyms)}."


def parts_of(entry: Entry) -> list[str]:
    return list(dict.fromkeys(str(part) for node in entry.nodes for part in parts(node)))


def _placing(entry: Entry) -> str:
    if entry.sort not in ("relation", "constraint"):
        return ""
    sentences = [f"Held: {' or '.join(kept)}."] if (kept := held_of(entry)) else []
    measures = exactness_of(entry)
    sentences += [f"`{name}` is {_MEANT[word]}." for name, word in measures.items()]
    reads = "Relates boxes." if entry.sort == "relation" else ""
    return " ".join(filter(None, [reads, *sentences]))


def held_of(entry: Entry) -> list[str]:
    return list(dict.fromkeys(filter(None, map(held, entry.nodes))))


def exactness_of(entry: Entry) -> dict[str, str]:
    return {name: word for node in entry.nodes for name, word in exactness(node).items()}


# --- The guide: the language on a few pages, a page for each variant (`docs/guide.md`, `docs/guides`).


@cache
def guide(variant: Variant = Variant.FULL) -> str:
    name = "docs/guide.md" if variant is Variant.FULL else f"docs/guides/{variant}.md"
    return resource(name).read_text("utf-8")


def guide_with(topics: Sequence[str]) -> str:
    """Returns the guide and the entries of some topics, without pictures. Raises KeyError."""
    known = {topic.name: topic for topic in reference().topics}
    blocks = [guide().strip(), "# Reference"]
    for name in topics:
        blocks.append(f"## {known[name].title}")
        for entry in reference().of_topic(name):
            blocks += entry_blocks(entry, "###")
    return "\n\n".join(blocks) + "\n"


def full_guide() -> str:
    return guide_with([topic.name for topic in reference().topics])
