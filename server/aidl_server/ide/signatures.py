"""Descriptions of names and calls: the forms of a call, the one that is meant, and the current parameter."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from aidl_lang.checking.binding import PAIRS, PARAMETERS
from aidl_lang.checking.calls import arguments
from aidl_lang.checking.symbols import SymbolScope
from aidl_lang.checking.types import AnyType, ListType, NumberType, PointType, Signature, Type, accepts
from aidl_lang.common.names import fold
from aidl_lang.common.prose import shortened
from aidl_lang.common.records import record
from aidl_lang.parser import standing_before
from aidl_lang.syntax import ast
from aidl_lang.syntax.tables import Token
from aidl_lang.tools.reference import facts, forms
from aidl_lang.tools.reference.collect import Doc, Entry, doc, reference
from aidl_lang.tools.reference.signatures import split_items, written
from aidl_lang.typecheck import Program
from aidl_server.ide.site import around, innermost_brackets, scope_at, site_at, spot_at
from aidl_server.ide.workspace import View

MOST_FORMS = 6
_LONGEST = 100
"""Most characters of an expression in a head."""
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


def of_entry(entry: Entry) -> str:
    """Describes a public name of the library, a built-in or a keyword: its form, its effect, its use."""
    listed = forms(entry)
    more = [f"// and {len(listed) - MOST_FORMS} more forms"] if len(listed) > MOST_FORMS else []
    head = fenced("\n".join([*listed[:MOST_FORMS], *more]))
    shown = [fenced(entry.doc.example)] if entry.doc.example else []
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
            return f"fn {written(node)} = {shortened(node.value.span.one_line, _LONGEST)}"
        case ast.ShapeDefinition():
            return f"shape {written(node)}"
        case ast.ConstraintDefinition():
            return f"constraint {written(node)}"
        case ast.Structure(parameters=None):
            indices = "".join(f"[{index.span.one_line}]" for index in node.indices)
            return f"{node.kind_word.text} {node.name.text}{indices}"
        case ast.Structure():
            return f"{node.kind_word.text} {written(node)}"
        case ast.For() | ast.ForArguments():
            names = ", ".join(v.text for v in node.variables)
            return f"for {names} in {shortened(node.iterable.span.one_line, _LONGEST)}"
        case _:
            return shortened(node.span.one_line, _LONGEST)


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
    sentences = _SENTENCE_END.split(f"{about.line}\n\n{about.text}")
    said = [sentence for sentence in sentences if re.search(rf"`{re.escape(name)}\b", sentence)]
    clauses = [" ".join(_clause(sentence, name).split()) for sentence in said]
    return " ".join(clause for clause in clauses if clause.count(" ") >= _FEWEST_WORDS)


def _clause(sentence: str, name: str) -> str:
    """Returns the part of a sentence about a name, if it describes several one by one."""
    parts = _CLAUSE_END.split(sentence)
    told = [part for part in parts if f"`{name}`" in part]
    return told[0] if len(parts) > 1 and len(told) == 1 else sentence


# --- Matches the overloads of a call with its arguments so far, and finds the meant one.

_WRONG = 100
"""Cost of an argument that does not fit, against the conversions of those that do."""
_GATHERED = 1


@record()
class Reading:
    """An overload with the arguments of a call.

    taken  the parameter of each argument, the receiver first; None without one
    cost   distance of the arguments from the overload's types
    """

    signature: Signature
    taken: tuple[str | None, ...]
    cost: int

    @property
    def fits(self) -> bool:
        """True if no argument so far contradicts it."""
        return self.cost < _WRONG

    def filled_by(self, argument: int) -> str | None:
        """Returns the parameter that an argument fills; None for one that is not there, or fills none."""
        return self.taken[argument] if argument < len(self.taken) else None


def type_of(signature: Signature, parameter: str | None) -> Type | None:
    return next((kind for name, kind, _ in signature.parameters if name == parameter), None)


def readings(program: Program, scope: SymbolScope, call: ast.Call) -> list[Reading]:
    """Returns the readings of a call: those that fit, the nearest first; else all as they are defined."""
    candidates = program.resolution.candidates.get(call)
    if candidates is None:
        found = scope.called(call.callee.text)
        candidates = tuple(found[1]) if found is not None else ()
    nodes = arguments(program.inference, call)
    kinds = [program.inference.fact(node).type for node in nodes]
    words: list[str | None] = [None] * (len(nodes) - len(call.arguments))
    words += [a.name.text if a.name is not None else None for a in call.arguments]
    own = [c for c in candidates if not c.standard]
    found_all = [_read(candidate, words, kinds) for candidate in (own or candidates)]
    return sorted(found_all, key=lambda reading: reading.cost)


def _read(signature: Signature, words: Sequence[str | None], kinds: Sequence[Type]) -> Reading:
    positional = iter(_positional(signature, words, kinds))
    named = {signature.by_fold[fold(word)] for word in words if word and fold(word) in signature.by_fold}
    taken: list[str | None] = []
    cost = 0
    for word, kind in zip(words, kinds, strict=True):
        known = {*named, *filter(None, taken)}
        name = next(positional, None) if word is None else meant(signature, word, known)
        taken.append(name)
        if name is None and word is not None and (signature.takes_any or fold(word) in PAIRS):
            continue
        wanted = type_of(signature, name)
        gathered = word is None and _gathers(signature, words, kinds)
        distance = _GATHERED if gathered else accepts(wanted, kind) if wanted is not None else None
        cost += _WRONG if distance is None else distance
    return Reading(signature, tuple(taken), cost)


def meant(signature: Signature, word: str, taken: set[str]) -> str | None:
    """Returns the parameter of a named argument, by its name or as the only one it can mean."""
    if (name := signature.by_fold.get(fold(word))) is not None:
        return name
    names = (signature.by_fold.get(fold(m)) for m in PARAMETERS.get(fold(word), ()))
    open_names = [name for name in names if name is not None and name not in taken]
    return open_names[0] if len(open_names) == 1 else None


def _positional(signature: Signature, words: Sequence[str | None], kinds: Sequence[Type]) -> list[str]:
    """Returns the parameters of nameless arguments in order; those behind a named one fill what is left."""
    named = {meant(signature, word, set()) for word in words if word is not None}
    are_late = words[:1] != [None] and named != {None}
    names = [name for name, _, _ in signature.parameters if not (are_late and name in named)]
    count = sum(word is None for word in words)
    if _gathers(signature, words, kinds):
        return names[:1] * count
    first = next((kind for word, kind in zip(words, kinds, strict=True) if word is None), None)
    if signature.parameters and isinstance(first, NumberType):
        _, kind, is_optional = signature.parameters[0]
        if is_optional and isinstance(kind, PointType):  # `circle(5)`: sizes in order, without the centre
            names = names[1:]
    return names[:count]


def _gathers(signature: Signature, words: Sequence[str | None], kinds: Sequence[Type]) -> bool:
    """True if the arguments without a name are the members of the list that comes first."""
    first = [kind for word, kind in zip(words, kinds, strict=True) if word is None][:2]
    return signature.gathers and not (len(first) == 1 and isinstance(first[0], ListType))


# --- Signature help: the possible forms of the call at a place, and the current parameter.


@record()
class ParameterHelp:
    """`place` is its range in the label of its overload, in code points; `about` is Markdown."""

    place: tuple[int, int]
    about: str


@record()
class OverloadHelp:
    """`active` is the number of the current parameter; None if the overload has none for it."""

    label: str
    about: str
    parameters: tuple[ParameterHelp, ...]
    active: int | None


@record()
class SignatureHelp:
    """All overloads of a call, as they are defined; `active` is the number of the meant one."""

    overloads: tuple[OverloadHelp, ...]
    active: int


def signature_help(view: View, offset: int) -> SignatureHelp | None:
    """Returns help for the innermost call whose parentheses, closed or not, contain an offset."""
    spot = spot_at(view, offset)
    if spot.where == "comment":
        return None
    offset = spot.offset  # within the text
    brackets = innermost_brackets(standing_before(view.source, offset))
    opening = next((token for token in brackets if token.kind == "CALL"), None)
    if opening is None:
        return None
    found = _argument_at(view, opening, offset)
    if found is None and spot.where == "code":
        site = site_at(view, spot)
        view = site.view or view
        found = _argument_at(view, opening, spot.start + 1)
    if found is None:
        return None
    call, argument = found
    everything = readings(view.program, scope_at(view, call.span.start), call)
    ordered = [reading for reading in everything if is_public(reading.signature)] or everything
    if not ordered:
        return None
    alike = [r for r in ordered if r.cost == ordered[0].cost]
    having = [r for r in alike if _parameter(r, argument) is not None]
    best = (having or alike)[0]
    listed = sorted(ordered, key=_place)
    overloads = tuple(_told(reading, argument) for reading in listed)
    return SignatureHelp(overloads, listed.index(best))


def _argument_at(view: View, opening: Token, offset: int) -> tuple[ast.Call, int] | None:
    """Returns the call that begins with a token, and the number of the argument at an offset, the receiver
    counted. Returns None if it has arguments, and the offset lies in none.
    """
    for node in around(view.module, opening.start):
        if isinstance(node, ast.Call) and node.callee.span.start == opening.start:
            before = len(arguments(view.program.inference, node)) - len(node.arguments)
            for number, argument in enumerate(node.arguments):
                if argument.span.start <= offset <= argument.span.end:
                    return node, before + number
            return None if node.arguments else (node, before)
    return None


def _place(reading: Reading) -> tuple[int, str, int]:
    """Returns the sort key of definitions in the order of writing, built-ins first."""
    node = reading.signature.node
    return (0, "", 0) if node is None else (1, node.span.source.name, node.span.start)


def _parameter(reading: Reading, argument: int) -> int | None:
    """Returns the number of the parameter that an argument fills; the next one before it is written."""
    names = [name for name, _, _ in reading.signature.parameters]
    if argument >= len(reading.taken):
        return next((n for n, name in enumerate(names) if name not in reading.taken), None)
    taken = reading.filled_by(argument)
    return names.index(taken) if taken in names else None


def _told(reading: Reading, argument: int) -> OverloadHelp:
    signature = reading.signature
    label = label_of(signature)
    parameters = tuple(
        ParameterHelp(place, of_parameter(signature, name))
        for (name, _, _), place in zip(signature.parameters, label.parameters, strict=True)
    )
    about = of_doc(doc_of(signature))
    return OverloadHelp(label.text, about, parameters, _parameter(reading, argument))
