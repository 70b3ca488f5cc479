"""The guide: the language on a few pages. Its prose stands in `guide.md`; what can drift is put in from the
library, the grammar and the examples, where that file has a placeholder.

    {{calls TOPIC …}}      how the names of those topics are called, and the parts of shapes
    {{forms TOPIC …}}      the same without parts
    {{names TOPIC …}}      those names alone; after `rare` also those that `calls` leaves out
    {{fields}}             what each primitive can be asked for
    {{reserved}}           the words that cannot be names
    {{example NAME}}       the program `examples/NAME.aidl`

What stands between `{{in VARIANT …}}` and `{{end}}`, in a line or on lines of its own, is for these alone.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import groupby, zip_longest
from pathlib import Path

from aidl_dev.reference.short import short_calls
from aidl_lang.checking.builtins import CUTS
from aidl_lang.checking.subset import Variant
from aidl_lang.checking.types import PRIMITIVES, PUBLIC
from aidl_lang.common.resources import resource
from aidl_lang.syntax import ast
from aidl_lang.syntax.tables import load_tables
from aidl_lang.tools.reference.collect import Entry, reference
from aidl_lang.tools.reference.signatures import parts

_PLACED = re.compile(r"\(center\?, (.*), angle\?\)$")
_WITH = re.compile(r"^with (its |the |a )?")
_ALTERNATIVES = re.compile(r"\b(\w+)/\w+(/\w+){2,}")
_PLACEHOLDER = re.compile(r"\{\{(\w+) ?([^}]*)\}\}")
_BLOCKS = (
    re.compile(r"^\{\{in ([^}]*)\}\}\n(.*?)^\{\{end\}\}\n", re.MULTILINE | re.DOTALL),
    re.compile(r"\{\{in ([^}]*)\}\}(.*?)\{\{end\}\}", re.DOTALL),
)

_WITHOUT: Mapping[Variant, type[ast.Callable]] = {
    Variant.NO_HIERARCHY: ast.Structure,
    Variant.NO_CONSTRAINTS: ast.ConstraintDefinition,
}
"""Definitions of the library that a variant cannot use."""

_UNSAID: Mapping[Variant, tuple[str, ...]] = {Variant.NO_CONSTRAINTS: ("smooth",)}
"""Parameters with a meaning for the solver only; `rotatable`, which most shapes have, is told of once."""


GENERATED = {
    Variant.FULL: "docs/guide.md",
    Variant.NO_HIERARCHY: "docs/guides/no-hierarchy.md",
    Variant.NO_CONSTRAINTS: "docs/guides/no-constraints.md",
}
"""The page of each variant. That of the paper is written by hand: too little of the rest is left in it."""


def guide(variant: Variant = Variant.FULL) -> str:
    """Returns the guide as Markdown. Raises KeyError for an unknown placeholder or topic."""
    text = template()
    for block in _BLOCKS:
        text = block.sub(lambda m: m[2] if str(variant) in m[1].split() else "", text)
    return _PLACEHOLDER.sub(lambda m: _MAKERS[m[1]](variant, *m[2].split()), text)


def template() -> str:
    return Path(__file__).with_name("guide.md").read_text("utf-8")


def _entries(variant: Variant, topics: tuple[str, ...]) -> list[Entry]:
    """Returns the names of topics, with their forms in a variant."""
    known = {topic.name for topic in reference().topics}
    if unknown := [topic for topic in topics if topic not in known]:
        raise KeyError(f"the guide asks for topics that do not exist: {', '.join(unknown)}")
    absent = _WITHOUT.get(variant, ())
    entries = [entry for topic in topics for entry in reference().of_topic(topic)]

    def is_told(entry: Entry, node: object) -> bool:
        # A cut is a hole or an outline by its place, and takes the same arguments.
        return not isinstance(node, absent) and not (entry.name in CUTS and isinstance(node, ast.Structure))

    kept = [tuple(o for o in entry.overloads if is_told(entry, o.node)) for entry in entries]
    return [replace(e, overloads=forms) for e, forms in zip(entries, kept, strict=True) if forms]


def _calls(variant: Variant, *topics: str) -> str:
    """Returns a line for each name, with its parts (those shared with an earlier shape by that one's name;
    without the Béziers of a figure, to which nothing is joined) and how it lies.
    """
    lines, told = [], dict[str, set[str]]()
    for entry in [e for e in _entries(variant, topics) if e.name not in _RARE]:
        told_of = (part for node in entry.nodes for part in parts(node) if part.type != "bezier")
        named = _gathered(dict.fromkeys(part.name for part in told_of))
        like = next((n for n, known in told.items() if len(known) > 3 and known <= set(named)), None)
        more = [part for part in named if like is None or part not in told[like]]
        if named:
            told[entry.name] = set(named)
        shown = " ".join(([f"as {like}"] if like else []) + more)
        lies = _WITH.sub("", entry.doc.lies.replace("`", ""))
        about = (f" → {shown}" if shown else "") + (f"  // {lies}" if lies else "")
        lines.append((entry.name, _arguments(variant, entry) + about))
    return _joined(lines)


_OF_ALL = {"patterns": ("angle", "margin")}
"""Arguments that the prose tells of for all names of a topic."""
_OPTIONAL = re.compile(r", \w+\?")

_GATHERED: Mapping[str, tuple[str, ...]] = {
    "corner": ("bottom_left", "bottom_right", "top_right", "top_left"),
    "edge": ("bottom", "right", "top", "left"),
}
"""Lists of parts, with the names that their members may have besides."""


def _gathered(names: Iterable[str]) -> list[str]:
    """Returns the names of parts: a list that has several by one of them, `corners[i]`, and as `corners` one
    whose members have the usual names besides.
    """
    found = list(names)
    for word, members in _GATHERED.items():
        lists = [name for name in found if name.removesuffix("[i]").removesuffix("s") == word]
        if lists:
            is_usual = set(members) <= set(found)
            gone = {*lists, *(members if is_usual else ())}
            found = [f"{word}s" if is_usual else f"{word}s[i]", *(n for n in found if n not in gone)]
    return found


def _forms(variant: Variant, *topics: str) -> str:
    return _joined([(entry.name, _arguments(variant, entry)) for entry in _entries(variant, topics)])


def _joined(lines: Sequence[tuple[str, str]]) -> str:
    """Joins adjacent names with the same call to one line: `sin, cos(angle)`."""
    groups = groupby(lines, key=lambda line: line[1])
    return "\n".join(", ".join(name for name, _ in group) + arguments for arguments, group in groups)


def _arguments(variant: Variant, entry: Entry) -> str:
    """Returns the forms of a name without the name, as short as possible: `…` for the arguments that most
    shapes have, `a/…` for one of several names, a measure to compare without the option to set it, and what
    all forms share once.
    """
    calls = [call for call in short_calls(entry) if call.startswith(f"{entry.name}(")]
    forms = [call.removeprefix(entry.name) for call in calls]
    if all(overload.form.endswith("(of: list)") for overload in entry.overloads):
        forms = ["(a, b, …)"]  # as calls that gather their arguments are written
    forms = [f for f in forms if not any(other.startswith(f[:-1] + ", value") for other in forms)]
    forms = [f for f in forms if not any(f == _OPTIONAL.sub("", o) for o in forms if o != f)]
    forms = [f for f in forms if not any(_is_laxer(o, f) for o in forms if o != f)]
    for name in ("rotatable", *_UNSAID.get(variant, ()), *_OF_ALL.get(entry.topic, ())):
        forms = [re.sub(rf"(, )?\b{name}\?(?(1)|(, )?)", "", form) for form in forms]
    forms = [_PLACED.sub(r"(…, \1)", _ALTERNATIVES.sub(r"\1/…", form)) for form in forms]
    return _factored(forms) if entry.sort != "constant" else ""


def _is_laxer(one: str, other: str) -> bool:
    """Tells whether a form has the arguments of another, and lets more of them out."""
    return all(a in (b, f"{b}?") for a, b in zip_longest(one.split(", "), other.split(", ")))


def _factored(forms: Sequence[str]) -> str:
    """Returns forms with the arguments that all begin or end with written once: `(a, {b | c, d}, e)`; failing
    that with those that neighbours begin with.
    """
    lists = _held_elsewhere([form[1:-1].split(", ") for form in dict.fromkeys(forms)])
    if (whole := _as_one(lists)) is not None:
        return whole
    groups = [list(alike) for _, alike in groupby(lists, key=lambda each: each[:_SHARED])]
    return " | ".join(_as_one(g) or " | ".join(f"({', '.join(each)})" for each in g) for g in groups)


def _held_elsewhere(lists: Sequence[list[str]]) -> list[list[str]]:
    """Returns forms with the other places by which a shape may be held beside the `…` of its first form."""
    kept: list[list[str]] = []
    for held in lists:
        same = next((each for each in kept if [held[0], *each[1:], "angle?"] == held), None)
        if same is not None and same[0].startswith("…"):
            same[0] += f"/{held[0]}"
        elif kept and kept[-1][:-1] == held:  # the last argument of the form before is none that it needs
            kept[-1] = [*held, f"{kept[-1][-1].removesuffix('?')}?"]
        else:
            kept.append(held)
    return kept


_SHARED = 2
"""Arguments at the beginning by which forms beside each other are written as one."""


def _as_one(lists: Sequence[list[str]]) -> str | None:
    """Returns several forms as one; None if they have no argument in common, or if there is only one."""
    shortest = min(map(len, lists), default=0)
    first = next((n for n in range(shortest) if len({each[n] for each in lists}) > 1), shortest)
    last = next((n for n in range(shortest - first) if len({each[-1 - n] for each in lists}) > 1), None)
    last = shortest - first if last is None else last
    between = sorted((each[first : len(each) - last] for each in lists), key=len)
    if len(between) > 1 and not between[0] and all(len(each) == 1 for each in between[1:]):
        middle = f"{'/'.join(each[0].removesuffix('?') for each in between[1:])}?"
    elif len(lists) > 1 and 0 < first + last < shortest:
        middle = f"{{{' | '.join(', '.join(each[first : len(each) - last]) for each in lists)}}}"
    else:
        return None
    return f"({', '.join([*lists[0][:first], middle, *lists[0][len(lists[0]) - last :]])})"


_RARE = ["arc_slot", "checkers", "circumcenter", "crescent", "d_shape", "double_arrow", "double_d"]
_RARE += ["equilateral_triangle", "heart", "house", "keyhole", "kite", "leaf", "mesh", "mirror_of", "octagon"]
_RARE += ["ogee_arch", "ogive", "pentagon", "pointed_arch", "quarter_circle", "rays", "reuleaux", "rhombus"]
_RARE += ["right_trapezoid", "rosette", "s_curve", "scales", "shield", "squircle", "tapered_slot", "tiled"]
"""Shapes whose names are told among those of `names` only, of whatever topic they are."""


def _names(variant: Variant, *topics: str) -> str:
    rare, topics = (_RARE, topics[1:]) if topics[0] == "rare" else ([], topics)
    return f"`{' '.join([*rare, *(entry.name for entry in _entries(variant, topics))])}`"


def _fields(variant: Variant) -> str:
    kinds = (PRIMITIVES[name] for name in reference().entries if name in PUBLIC)
    return "\n".join(f"{each.kind}: {' '.join(each.names)}" for each in kinds)


def _reserved(variant: Variant) -> str:
    return " ".join(sorted(load_tables().reserved))


_MAKERS: Mapping[str, Callable[..., str]] = {
    "calls": _calls,
    "forms": _forms,
    "names": _names,
    "fields": _fields,
    "reserved": _reserved,
    "example": lambda _, name: f"```aidl\n{resource(f'examples/{name}.aidl').read_text('utf-8')}```",
}
