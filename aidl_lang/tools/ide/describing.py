"""Descriptions of names, in Markdown."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from aidl_lang.checking.types import AnyType, Signature
from aidl_lang.common.records import record
from aidl_lang.syntax import ast
from aidl_lang.tools.reference.collect import Doc, Entry, doc, reference
from aidl_lang.tools.reference.pages import facts, forms
from aidl_lang.tools.reference.signatures import split_items, written

MOST_FORMS = 6
_FEWEST_WORDS = 2
"""Fewest blanks of a useful sentence: a list of names describes none of them."""
_SENTENCE_END = re.compile(r"(?<=[.!?])\s+(?=[A-Z`(])|\n\n+")
_NAME = re.compile(r"\W")
_CLAUSE_END = re.compile(r";\s+|,\s+(?=`)")


def fenced(code: str) -> str:
    return f"```aidl\n{code.rstrip()}\n```"


def joined(blocks: Iterable[str]) -> str:
    """Joins paragraphs, without empty ones."""
    return "\n\n".join(block.strip("\n") for block in blocks if block.strip())


def of_entry(entry: Entry, *, example: bool = True) -> str:
    """Describes a public name of the library, a built-in or a keyword: its form, its effect, its use."""
    listed = forms(entry)
    more = [f"// and {len(listed) - MOST_FORMS} more forms"] if len(listed) > MOST_FORMS else []
    head = fenced("\n".join([*listed[:MOST_FORMS], *more]))
    shown = [fenced(entry.doc.example)] if example and entry.doc.example else []
    return joined([head, entry.doc.line, entry.doc.text, *facts(entry), *shown])


def of_public(name: str) -> str:
    """Describes a name or word by its entry in the reference; returns "" without one."""
    entry = reference().entries.get(name)
    return of_entry(entry) if entry is not None else ""


def of_definition(node: ast.Node) -> str:
    """Describes a definition of a program by its head and its `///` comment."""
    return joined([fenced(head(node)), of_comment(getattr(node, "doc", None))])


def of_comment(comment: str | None) -> str:
    return of_doc(doc(comment or ""))


def of_doc(about: Doc) -> str:
    return joined([about.line, about.text, fenced(about.example) if about.example else ""])


def head(node: ast.Node) -> str:
    """Returns the first line of a definition, as `solid bolt(size = 4)`."""
    match node:
        case ast.FunctionDefinition():
            return f"fn {written(node)} = {_short(node.value.span.one_line)}"
        case ast.ShapeDefinition():
            return f"shape {written(node)}"
        case ast.ConstraintDefinition():
            return f"constraint {written(node)}"
        case ast.Structure(parameters=None):
            return f"{node.kind_word.text} {_target(node)}"
        case ast.Structure():
            return f"{node.kind_word.text} {written(node)}"
        case (
            ast.Parameter() | ast.Param() | ast.Let() | ast.Var() | ast.Assign() | ast.Alias() | ast.Import()
        ):
            return _short(node.span.one_line)
        case ast.For() | ast.ForArguments():
            names = ", ".join(v.text for v in node.variables)
            return f"for {names} in {_short(node.iterable.span.one_line)}"
        case _:
            return _short(node.span.one_line)


def _target(node: ast.Structure) -> str:
    return node.name.text + "".join(f"[{index.span.one_line}]" for index in node.indices)


def _short(text: str, most: int = 100) -> str:
    return text if len(text) <= most else text[: most - 1] + "…"


def of_callable(name: str, signatures: Sequence[Signature]) -> str:
    """Describes all definitions that a name may call."""
    nodes = [s.node for s in signatures if not s.standard and s.node is not None]
    blocks = [fenced("\n".join(map(head, nodes))), *(of_comment(n.doc) for n in nodes)] if nodes else []
    standard = next((s for s in signatures if s.standard), None)
    entry = reference().entries.get(standard.name) if standard is not None else None
    if entry is not None:
        blocks.append(of_entry(entry))
    elif standard is not None and not nodes:
        blocks.append(fenced("\n".join(label_of(s).text for s in signatures[:MOST_FORMS])))
    return joined(dict.fromkeys(blocks))


def is_public(signature: Signature) -> bool:
    """Tells whether an overload is meant for programs, and not for the library itself."""
    node = signature.node
    if not signature.standard or node is None:
        return True
    entry = reference().entries.get(signature.name)
    return entry is not None and any(node is known for known in entry.nodes)


def doc_of(signature: Signature) -> Doc:
    """Returns the comment of one overload, else that of its name."""
    node = signature.node
    if node is not None and node.doc:
        return doc(node.doc)
    entry = reference().entries.get(signature.name) if signature.standard else None
    return entry.doc if entry is not None else doc("")


@record()
class Label:
    """An overload in one line; `parameters` are their places in it."""

    text: str
    parameters: tuple[tuple[int, int], ...]


def label_of(signature: Signature) -> Label:
    text = f"{signature.name}("
    places = []
    for number, item in enumerate(_items(signature)):
        text += ", " * (number > 0)
        places.append((len(text), len(text) + len(item)))
        text += item
    if signature.takes_any:
        text += ", " * bool(places) + "name: value, …"
    return Label(text + ")", tuple(places))


def _items(signature: Signature) -> list[str]:
    node = signature.node
    if node is not None:
        return [p.span.one_line for p in node.parameters or ()]
    names = [name for name, _, _ in signature.parameters]
    entry = reference().entries.get(signature.name)
    for overload in entry.overloads if entry is not None else ():
        items = split_items(overload.form.partition("(")[2].removesuffix(")"))
        if [_NAME.split(item)[0] for item in items] == names:
            return items
    return [
        name + ("?" if optional else "") + ("" if isinstance(kind, AnyType) else f": {kind}")
        for name, kind, optional in signature.parameters
    ]


def of_parameter(signature: Signature, name: str) -> str:
    """Returns the sentences of a definition's comment that name the parameter."""
    about = doc_of(signature)
    said = [
        sentence
        for sentence in _SENTENCE_END.split(f"{about.line}\n\n{about.text}")
        if re.search(rf"`{re.escape(name)}\b", sentence)
    ]
    clauses = [" ".join(_clause(sentence, name).split()) for sentence in said]
    return " ".join(clause for clause in clauses if clause.count(" ") >= _FEWEST_WORDS)


def _clause(sentence: str, name: str) -> str:
    """Returns the part of a sentence about a name, if it describes several one by one."""
    parts = _CLAUSE_END.split(sentence)
    told = [part for part in parts if f"`{name}`" in part]
    return told[0] if len(parts) > 1 and len(told) == 1 else sentence
