"""One text of a program with all that is known of it, from which every question of an editor is answered."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import cached_property
from pathlib import Path

from aidl_lang import pipeline
from aidl_lang.checking.allowing import audible
from aidl_lang.checking.resolving.resolution import Resolution
from aidl_lang.common import resources
from aidl_lang.common.diagnostics import Diagnostic, Edit
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile, Span
from aidl_lang.common.world import World
from aidl_lang.pipeline import Compiled, Settings
from aidl_lang.solver.memory import Memory
from aidl_lang.syntax import ast
from aidl_lang.syntax.tokens import Tokens, tokenize
from aidl_lang.tools.ide.edits import applied
from aidl_lang.typecheck import Program

SETTINGS = Settings()


@record(eq=False)
class View:
    """A text of a program, checked and perhaps run.

    path      of the file, absolute
    program   the text as checked, however broken
    found     diagnostics of checking it, without building and solving
    outcome   the result of this very text; None until it was run
    drawn     the last outcome with a picture, which may be that of an earlier text
    params    values that were set from outside for `outcome`
    """

    path: Path
    source: SourceFile
    world: World
    program: Program
    found: list[Diagnostic]
    outcome: Compiled | None = None
    drawn: Compiled | None = None
    params: Mapping[str, str | float | bool] | None = None

    @property
    def module(self) -> ast.Module:
        return self.program.main

    @property
    def resolution(self) -> Resolution:
        return self.program.resolution

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """The diagnostics of the outcome, else those of checking."""
        if self.outcome is not None:
            return self.outcome.diagnostics
        return audible(self.found, self.program.resolution.allowances)

    @property
    def is_stale(self) -> bool:
        """True if the picture is that of another text."""
        return self.drawn is not self.outcome

    @cached_property
    def _library(self) -> frozenset[SourceFile]:
        return frozenset(self.program.library.sources)

    def is_library(self, source: SourceFile) -> bool:
        return source in self._library or source in self.resolution.drawings

    def file(self, source: SourceFile) -> Path | None:
        """Returns the file of a source; None for a built-in one."""
        if source is self.source:
            return self.path
        if source in self.resolution.drawings:
            return self.path.parent / source.name
        if self.is_library(source):
            return resources.resource(source.name)
        return self.path.parent / source.name if source in self._files else None

    @cached_property
    def _files(self) -> frozenset[SourceFile]:
        return frozenset(module.source for module in self.program.resolution.modules)

    @cached_property
    def params_written(self) -> Mapping[Span, ast.Param]:
        """The params of the text and of the files that it imports, by their places."""
        nodes = (node for module in self.resolution.modules for node in ast.walk(module))
        return {node.span: node for node in nodes if isinstance(node, ast.Param)}

    @cached_property
    def tokens(self) -> Tokens:
        """All tokens and comments of the text."""
        return tokenize(self.source)

    def span(self, start: int, end: int) -> Span:
        return Span(self.source, start, end)


def hasty(settings: Settings = SETTINGS) -> Settings:
    """Returns the settings for what is shown for a moment: why it does not hold is not searched for."""
    return replace(settings, solving=replace(settings.solving, explain=False))


def look(path: Path, text: str, world: World, settings: Settings = SETTINGS) -> View:
    """Checks a program. Never raises for its contents."""
    source = SourceFile(path.name, text)
    program, found = pipeline.front(source, world, settings)
    return View(path, source, world, program, found)


def run(
    view: View,
    last: View | None = None,
    memory: Memory | None = None,
    params: Mapping[str, str | float | bool] | None = None,
    settings: Settings = SETTINGS,
) -> View:
    """Returns the view with its outcome; if that has no picture, with the picture of the `last` view.

    Raises Cancelled where the run is given up (see `cancelling`).
    """
    outcome = pipeline.compile(
        view.source,
        view.world,
        params,
        settings,
        memory=memory,
        checked=(view.program, view.found),
    )
    drawn = outcome if outcome.drawing is not None else last.drawn if last is not None else None
    return replace(view, outcome=outcome, drawn=drawn, params=params)


def edited(view: View, edits: Iterable[Edit], settings: Settings = SETTINGS) -> View:
    """Returns the view of the text with edits made, run with the same values from outside."""
    changed = look(view.path, applied(view.source.text, edits), view.world)
    return run(changed, params=view.params, settings=settings)
