"""Completion of definitions in other files of the workspace, each with its import."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache, partial

from aidl_lang.checking.library import signature
from aidl_lang.checking.resolving.declare import is_definition
from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import FileError
from aidl_lang.parser import parse
from aidl_lang.syntax import ast
from aidl_lang.tools.ide.completion import names
from aidl_lang.tools.ide.completion.context import Context, Use
from aidl_lang.tools.ide.completion.draft import Draft
from aidl_lang.tools.ide.completion.words import Files, importable
from aidl_lang.tools.ide.describing import of_definition
from aidl_lang.tools.ide.edits import insert

MOST_FILES = 40
"""Most files that are read."""
_TIER = 8.5


def importing(context: Context, files: Files | None) -> Iterator[Draft]:
    """Yields the definitions of other programs that this one does not import yet."""
    if context.use is Use.CONSTANT or context.site.following.startswith("("):
        return
    view = context.site.original
    for name in importable(view.path, files)[:MOST_FILES]:
        try:
            text = view.world.read(name)
        except FileError:
            continue  # gone since, or unreadable: an import of it would report that
        for node in definitions(name, text):
            if context.scope.called(node.name.text) is None and _may_stand(context, node):
                yield _draft(context, name, node)


@lru_cache(maxsize=128)
def definitions(name: str, text: str) -> tuple[ast.Callable, ...]:
    """Returns the callable definitions of a file."""
    module = parse(SourceFile(name, text)).module
    return tuple(
        s
        for s in module.statements
        if isinstance(
            s, ast.FunctionDefinition | ast.ShapeDefinition | ast.ConstraintDefinition | ast.Structure
        )
        and is_definition(s)
    )


def _may_stand(context: Context, node: ast.Callable) -> bool:
    """Tells whether a definition fits the place: constraints among constraints, elsewhere callables that give
    a value.
    """
    is_demand = context.use is Use.CONSTRAINT
    return isinstance(node, ast.ConstraintDefinition) == is_demand or isinstance(node, ast.FunctionDefinition)


def _draft(context: Context, file: str, node: ast.Callable) -> Draft:
    name = node.name.text
    made = signature(node)
    text, is_snippet = names.called(context, name, [made])
    return Draft(
        name,
        str(names.kind_of(made)),
        _TIER,
        text,
        f'{names.brief([made])} from "{file}"',
        is_snippet,
        (_import(context, file, name),),
        partial(of_definition, node),
    )


def _import(context: Context, file: str, name: str) -> Edit:
    """Adds the import after the existing ones, or at the head of the file below its first comments."""
    view = context.site.original
    imports = [s for s in view.module.statements if isinstance(s, ast.Import)]
    known = next((s for s in imports if s.names and s.path.value == file), None)
    if known is not None:
        end = known.names[-1].span.end
        return insert(view.source, end, f", {name}")
    statement = f'import {name} from "{file}"'
    if imports:
        end = imports[-1].span.end
        return insert(view.source, end, f"\n{statement}")
    return insert(view.source, int(_has_mark(view.source.text)), f"{statement}\n")


def _has_mark(text: str) -> bool:
    """True for a text that begins with a byte order mark, which stays first."""
    return text.startswith("\ufeff")
