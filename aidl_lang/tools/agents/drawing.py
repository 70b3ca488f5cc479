"""The result of a compiled program: status, bodies, contacts, motions, and files."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from typing import cast

from aidl_lang import pipeline
from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.names import nearest
from aidl_lang.common.prose import did_you_mean, short
from aidl_lang.common.render import compact
from aidl_lang.geometry.survey import Part, some_of
from aidl_lang.pipeline import Compiled
from aidl_lang.tools.agents import model as models
from aidl_lang.tools.agents.results import Body, Contact, Drawn, Export, Knob, Status, findings, joined
from aidl_lang.tools.agents.workspace import Limits, refusal
from aidl_lang.tools.discretion import Reader

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
) -> Drawn:
    """Returns the result of a program in some formats, for its reader. Raises RefusalError for an unknown
    `path`.
    """
    making = _Making(compiled, limits, dimensioned)
    model, shortened = making.model(path) if "model" in formats else (None, None)
    files = [f for f in dict.fromkeys(formats) if f not in ("png", "model")]
    exports = [export for f in files if (export := making.export(f)) is not None]
    png = making.png() if "png" in formats else None
    bodies, contacts = _bodies(compiled), _contacts(compiled)
    left = _left_out(compiled)
    diagnostics = [*compiled.diagnostics, *reader.diagnostics(making.notes)]
    return Drawn(
        compiled.ok,
        status(compiled),
        findings(diagnostics),
        [_knob(k) for k in compiled.knobs[:MOST_LISTED]],
        compiled.model.degrees if compiled.model else None,
        motions(compiled),
        bodies,
        contacts,
        model,
        shortened,
        exports,
        left,
        png,
        report=joined(
            [
                _headline(compiled, png is not None),
                compact(diagnostics),
                freedom(compiled),
                "\n".join(map(_body, bodies)),
                "\n".join(map(contact, contacts)),
                "\n".join(left),
                "" if model is None else models.text(model),
                shortened or "",
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

    def model(self, path: str | None) -> tuple[models.Json | None, str | None]:
        from aidl_lang.export.json import to_dict

        compiled = self.compiled
        if compiled.model is None or compiled.drawing is None:
            return None, None
        document = to_dict(compiled.model, compiled.drawing, compiled.diagnostics)
        if path is not None:
            document = self._restricted(document, path)
        return models.shortened(document, self.limits.text)

    def _restricted(self, document: models.Json, path: str) -> models.Json:
        root, known = document["root"]["path"], models.paths(document)
        for wanted in (path, f"{root}.{path}"):
            if wanted in known:
                return models.restricted(document, wanted)
        short_names = {name.removeprefix(f"{root}."): name for name in known}
        near = [hint for name in nearest(path, short_names) for hint in did_you_mean([short_names[name]])]
        message = f"there is no structure `{path[:200]}` in the model"
        raise refusal("E0919", message, *near, f"there is {some_of(known)}")

    def png(self) -> bytes | None:
        """Returns the picture; of a program that did not solve, its last state."""
        return self._made("png") if self.compiled.drawing is not None else None

    def export(self, name: str) -> Export | None:
        """Returns a file of a program that is right."""
        content = self._made(name) if self.compiled.ok else None
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
        return Export(name, "text" if is_text else "base64", text)

    def _made(self, name: str) -> bytes | None:
        from aidl_lang.export import ExportError, Options

        options = Options(dimension=self.dimensioned, pixels=self.limits.pixels)
        try:
            made = self.compiled.exported(f".{name}", options)
        except ExportError as reason:
            self.notes.append(reason.diagnostic)
            return None
        self.notes += made.notes
        return made.data


def status(compiled: Compiled) -> Status:
    return cast(Status, compiled.status)


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


def _knob(knob: pipeline.Knob) -> Knob:
    return Knob(
        knob.path, knob.value, knob.low, knob.high, list(knob.choices), knob.step, knob.unit, knob.doc
    )


def _bodies(compiled: Compiled) -> list[Body]:
    drawing = compiled.drawing
    if drawing is None:
        return []
    return [Body(b.path, *b.box, area=drawing.measures[b.path].area) for b in drawing.bodies[:MOST_LISTED]]


def _body(body: Body) -> str:
    width, height = short(body.right - body.left), short(body.top - body.bottom)
    at = f"({short(body.left)}, {short(body.bottom)}) to ({short(body.right)}, {short(body.top)})"
    return f"{body.path}: {width} × {height} mm, {at}, area {short(body.area)} mm²"


def _contacts(compiled: Compiled) -> list[Contact]:
    pairs = compiled.drawing.pairs if compiled.drawing is not None else ()
    return [Contact(p.a, p.b, p.relation, p.gap, p.area) for p in pairs[:MOST_LISTED]]


def contact(pair: Contact) -> str:
    how = {
        "touching": "touch",
        "apart": f"are {short(pair.gap or 0.0)} mm apart",
        "overlapping": f"overlap by {short(pair.area or 0.0)} mm²",
    }
    return f"{pair.a} and {pair.b} {how[pair.relation]}"


def _file(export: Export) -> str:
    """Returns a file as text for a reader, to whom bytes say nothing."""
    if export.encoding == "base64":
        return f"{export.format}: made, {len(export.content)} characters in base64, which only the data has"
    return f"{export.format}:\n{export.content}"


def _left_out(compiled: Compiled) -> list[str]:
    drawing = compiled.drawing
    counts = {
        "params": len(compiled.knobs),
        "bodies": len(drawing.bodies) if drawing else 0,
        "contacts": len(drawing.pairs) if drawing else 0,
    }
    return [said for what, count in counts.items() if (said := left_out(what, count - MOST_LISTED))]


def left_out(what: str, count: int) -> str:
    """Returns the note at the end of a shortened list."""
    return f"{count} more {what} are not listed" if count > 0 else ""


def measured(part: Part) -> str:
    """Returns a part in a line."""
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
