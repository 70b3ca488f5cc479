"""The results of a compiled program: status, bodies, contacts, motions, conflicts, its model, and files."""

from __future__ import annotations

import base64
import json
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, TypeAlias, cast

from aidl_lang import pipeline
from aidl_lang.common.diagnostics import Diagnostic, Fix, apply_fixes
from aidl_lang.common.names import nearest
from aidl_lang.common.prose import did_you_mean, short
from aidl_lang.common.render import compact
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import World
from aidl_lang.explaining import failures
from aidl_lang.geometry.boolean import Contact
from aidl_lang.geometry.survey import Part, some_of
from aidl_lang.pipeline import Compiled, Settings
from aidl_lang.tools.agents import results
from aidl_lang.tools.agents.workspace import Limits, refusal
from aidl_lang.tools.discretion import Reader

# --- The solved model as JSON in a size that a language model can read.
#
# Every form is one that `docs/model.schema.json` allows.

Json = dict[str, Any]


def restricted(document: Json, path: str) -> Json:
    """Returns the document with the structure at a path, with or without the name of the root, as its root,
    and only its data. Raises RefusalError.
    """
    whole = document["root"]["path"]
    known = {s["path"]: s for s in _walk(document["root"])}
    root = known.get(path) or known.get(f"{whole}.{path}")
    if root is None:
        short_names = {name.removeprefix(f"{whole}."): name for name in known}
        near = did_you_mean(short_names[name] for name in nearest(path, short_names))
        message = f"there is no structure `{path[:200]}` in the model"
        raise refusal("E0919", message, *near, f"there is {some_of(list(known))}")
    path = root["path"]

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


def shortened(document: Json, most: int) -> tuple[Json, str | None]:
    """Returns the document in at most `most` characters, and a note on what was left out; None if nothing
    was.

    Data that follow from the rest, or can be asked for by a path, go first.
    """
    left_out: list[str] = []
    ways = _shortened(document)
    while len(text(document)) > most and (words := next(ways, None)) is not None:
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
    return json.dumps(document, ensure_ascii=False, allow_nan=False, separators=(",", ":"))


def _walk(structure: Json) -> Iterator[Json]:
    yield structure
    for child in structure["structures"]:
        yield from _walk(child)


def _shortened(document: Json) -> Iterator[str]:
    """Takes out more and more, and yields each time what."""
    for region in document["regions"].values():
        region["faces"] = []
        region["geometry"] = {"type": "MultiPolygon", "coordinates": []}
    yield "outlines of regions"
    document["constraints"] = [c for c in document["constraints"] if not c["satisfied"]]
    yield "constraints that hold"
    for structure in _walk(document["root"]):
        for geometry in structure["geometry"].values():
            if "parts" in geometry:
                geometry["parts"] = {}
    yield "parts of shapes"
    for child in document["root"]["structures"]:
        child["structures"] = []
    yield "structures in structures"
    document["root"]["structures"] = []
    document["regions"] = {}
    document["free"], document["motions"] = [], []
    yield "all structures but the root"


# --- Conflicts of a program: the constraints, the change that each would need, and whether that helps.

CODES = ("E0601", "E0602", "E0603", "E0605")
"""Codes of the diagnostics about conflicts."""
Params: TypeAlias = Mapping[str, float | str | bool] | None
_OUTCOMES = {
    True: ", and the program solves",
    False: ", but the program does not solve by that alone",
    None: "",
}
_MOST_TRIED = 12
"""Most remedies that are tried: each is a program to be solved."""


class Remedies:
    """Tries edits on one program."""

    def __init__(self, source: SourceFile, world: World, params: Params, settings: Settings) -> None:
        self.source, self.world, self.params, self.settings = source, world, params, settings
        self.tried = 0

    def conflict(self, found: failures.Conflict) -> results.Conflict:
        parties, givens = list(map(self._party, found.parties)), list(map(self._given, found.givens))
        return results.Conflict(found.headline, found.is_minimal, parties, givens)

    def _given(self, given: failures.ExactNumber) -> results.Given:
        return results.Given(
            given.name,
            results.place(given.span),
            given.would_fit,
            results.repair(given.fix),
            self._solves(given.fix),
        )

    def _party(self, party: failures.Party) -> results.Party:
        return results.Party(
            party.text,
            party.path,
            results.place(party.span),
            party.off if math.isfinite(party.off) else None,
            party.would_fit,
            results.repair(party.fix) if party.fix else None,
            self._solves(party.fix) if party.fix else None,
        )

    def _solves(self, fix: Fix) -> bool | None:
        """True if the program solves with an edit; None if that was not tried."""
        if self.tried == _MOST_TRIED:
            return None
        self.tried += 1
        text, applied = apply_fixes(self.source, [Diagnostic("E0601", "", fix=fix)])
        if not applied:
            return None
        changed = SourceFile(self.source.name, text)
        return pipeline.compile(changed, self.world, self.params, self.settings).status == "solved"


def in_lines(conflict: results.Conflict) -> str:
    lead = "without any one of these the others hold" if conflict.is_minimal else "these do not hold"
    told = [line for p in conflict.parties for line in _told(p)]
    return "\n".join([f"{conflict.headline}; {lead}:", *told, *map(_exact, conflict.givens)])


def _told(party: results.Party) -> Iterator[str]:
    off = f"off by {short(party.off)}" if party.off else ""
    words = "; ".join(filter(None, (party.would_fit, off)))
    yield f"- line {party.place.line}, in {party.held_by}: {party.constraint}{f' ({words})' if words else ''}"
    if party.remedy is not None:
        edits = " and ".join(map(_edit, party.remedy.replacements))
        yield f"    {party.remedy.title}: {edits}{_OUTCOMES[party.solves]}"


def _exact(given: results.Given) -> str:
    name = f" `{given.name}`" if given.name else ""
    return f"- line {given.place.line}: exact{name}; {given.would_fit}{_OUTCOMES[given.solves]}"


def _edit(edit: results.Replacement) -> str:
    where = f"line {edit.place.line}, column {edit.place.column}"
    return f"{where}: `{edit.old}` becomes `{edit.new}`" if edit.old else f"{where}: insert `{edit.new}`"


MOST_LISTED = 40
"""Most bodies, contacts, parameters and motions that are listed."""
_TEXTS = ("svg", "dxf")
"""Formats that are text."""


def drawn(
    compiled: Compiled,
    reader: Reader,
    formats: Sequence[str],
    path: str | None,
    limits: Limits,
    *,
    dimensioned: bool,
) -> results.Drawn:
    """Returns a program's result in some formats, for its reader. Raises RefusalError: an unknown `path`."""
    from aidl_lang.export.json import to_dict

    making, drawing = _Making(compiled, limits, dimensioned), compiled.drawing
    model = remark = None
    if "model" in formats and compiled.model is not None and drawing is not None:
        whole = to_dict(compiled.model, drawing, compiled.diagnostics)
        model, remark = shortened(whole if path is None else restricted(whole, path), limits.text)
    files = [f for f in dict.fromkeys(formats) if f not in ("png", "model")]
    exports = [export for f in files if (export := making.export(f)) is not None]
    png = making.made("png") if "png" in formats and drawing is not None else None
    bodies = _bodies(compiled)
    pairs = drawing.pairs if drawing else ()
    contacts = list(pairs[:MOST_LISTED])
    counts = {
        "params": len(compiled.knobs),
        "bodies": len(drawing.bodies) if drawing else 0,
        "contacts": len(pairs),
    }
    left = [said for what, count in counts.items() if (said := left_out(what, count - MOST_LISTED))]
    diagnostics = [*compiled.diagnostics, *reader.diagnostics(making.notes)]
    return results.Drawn(
        compiled.ok,
        status(compiled),
        results.findings(diagnostics),
        [
            results.Knob(k.path, k.value, k.low, k.high, list(k.choices), k.step, k.unit, k.doc)
            for k in compiled.knobs[:MOST_LISTED]
        ],
        compiled.model.degrees if compiled.model else None,
        motions(compiled),
        bodies,
        contacts,
        model,
        remark,
        exports,
        left,
        pictures=() if png is None else (png,),
        text=results.joined(
            [
                _headline(compiled, png is not None),
                compact(diagnostics),
                freedom(compiled),
                "\n".join(map(_body, bodies)),
                "\n".join(map(contact, contacts)),
                "\n".join(left),
                "" if model is None else text(model),
                remark or "",
                *map(_file, exports),
            ]
        ),
    )


class _Making:
    """Makes the files; a note gives the reason for a missing one."""

    def __init__(self, compiled: Compiled, limits: Limits, dimensioned: bool) -> None:
        self.compiled, self.limits, self.dimensioned = compiled, limits, dimensioned
        self.notes: list[Diagnostic] = []
        self.room = limits.text

    def export(self, name: str) -> results.Export | None:
        """Returns a file of a program that is right."""
        content = self.made(name) if self.compiled.ok else None
        if content is None:
            return None
        is_text = name in _TEXTS
        text = content.decode() if is_text else base64.b64encode(content).decode()
        if len(text) > self.room:
            message = f"the {name} file has {len(text):,} characters, more than there is room for"
            self.notes.append(
                Diagnostic("E0944", message, hints=("`aidl compile` on the command line writes files",))
            )
            return None
        self.room -= len(text)
        return results.Export(name, "text" if is_text else "base64", text)

    def made(self, name: str) -> bytes | None:
        """Returns a file, of a program that did not solve with its last state; None if it cannot be made."""
        from aidl_lang.export.job import ExportError, Options

        options = Options(dimension=self.dimensioned, pixels=self.limits.pixels)
        try:
            made = self.compiled.exported(f".{name}", options)
        except ExportError as reason:
            self.notes.append(reason.diagnostic)
            return None
        self.notes += made.notes
        return made.data


def status(compiled: Compiled) -> results.Status:
    return cast(results.Status, compiled.status)


def _headline(compiled: Compiled, has_picture: bool) -> str:
    if compiled.ok:
        return "solved: every constraint and assertion holds"
    if compiled.status == "solved":
        return "solved, but with errors"
    if compiled.status == "wrong":
        return "the program is wrong before solving, so there is no drawing"
    shown = "; the picture shows how far the solver came" if has_picture else ""
    return f"{compiled.status}: not every constraint holds{shown}"


def freedom(compiled: Compiled) -> str:
    """Returns degrees of freedom and their motions, in lines; "" for a program that was not solved."""
    if compiled.model is None:
        return ""
    degrees = compiled.model.degrees
    count = "an unknown number of degrees" if degrees is None else f"{degrees} degree{'s' * (degrees != 1)}"
    return "\n".join([f"{count} of freedom left", *(f"- {sentence}" for sentence in motions(compiled))])


def motions(compiled: Compiled) -> list[str]:
    """Returns the remaining motions, a sentence each."""
    from aidl_lang.geometry.freedom import report

    return [] if compiled.model is None else report(compiled.model, MOST_LISTED)


def _bodies(compiled: Compiled) -> list[results.Body]:
    drawing = compiled.drawing
    if drawing is None:
        return []
    return [
        results.Body(b.path, *b.box, area=drawing.measures[b.path].area) for b in drawing.bodies[:MOST_LISTED]
    ]


def _body(body: results.Body) -> str:
    width, height = short(body.right - body.left), short(body.top - body.bottom)
    at = f"({short(body.left)}, {short(body.bottom)}) to ({short(body.right)}, {short(body.top)})"
    return f"{body.path}: {width} × {height} mm, {at}, area {short(body.area)} mm²"


def contact(pair: Contact) -> str:
    how = {
        "touching": "touch",
        "apart": f"are {short(pair.gap or 0.0)} mm apart",
        "overlapping": f"overlap by {short(pair.area or 0.0)} mm²",
    }
    return f"{pair.a} and {pair.b} {how[pair.relation]}"


def _file(export: results.Export) -> str:
    if export.encoding == "base64":
        return f"{export.format}: made, {len(export.content)} characters in base64, which only the data has"
    return f"{export.format}:\n{export.content}"


def left_out(what: str, count: int) -> str:
    """Returns the note at the end of a shortened list."""
    return f"{count} more {what} are not listed" if count > 0 else ""


def measured(part: Part) -> str:
    left, bottom, right, top = part.box
    facts = [
        f"area {short(part.area)} mm²",
        f"perimeter {short(part.perimeter)} mm",
        f"size {short(right - left)} × {short(top - bottom)} mm",
        f"centroid ({short(part.centroid[0])}, {short(part.centroid[1])})",
    ]
    facts += [f"{name} {short(w.length)} mm" for name, w in (("wall", part.wall), ("gap", part.gap)) if w]
    facts += [f"mass {short(part.mass)} g"] if part.mass is not None else []
    facts += [f"made {part.quantity} times"] if part.quantity > 1 else []
    return f"{part.path}: {', '.join(facts)}"
