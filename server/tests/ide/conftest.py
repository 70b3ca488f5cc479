from __future__ import annotations

from collections.abc import Mapping
from functools import cache, lru_cache
from pathlib import Path

import pytest

from aidl_lang.syntax.tables import tokenize
from aidl_server.ide.workspace import Project, View, Workspace, look, run
from tests.compiled import LIGHTER


def cursor(marked: str) -> tuple[str, int]:
    """A text without the `¦` in it, and where that was."""
    offset = marked.index("¦")
    return marked.replace("¦", "", 1), offset


def opened(files: Mapping[str, str], folder: Path = Path("/project")) -> Project:
    """A project whose files are all open in the editor."""
    return Project(Workspace(open={folder / name: text for name, text in files.items()}))


@lru_cache(maxsize=64)
def seen(text: str, *, solved: bool = False, **files: str) -> View:
    """A program, with others beside it, as an editor sees it; once for tests that look at the same."""
    project = opened({"part.aidl": text, **{f"{name}.aidl": other for name, other in files.items()}})
    view = look(Path("/project/part.aidl"), text, project.workspace.world(Path("/project/part.aidl")))
    return run(view) if solved else view


def besides_numbers(text: str) -> list[str]:
    """The words and signs of a program."""
    words = [text[t.start : t.end] for t in tokenize(seen(text).source).tokens]
    return [w for w in words if not w[:1].isdigit() and w != "-"]


@cache
def checked_at(path: Path) -> View:
    """A file, checked and not solved."""
    return look(path, path.read_text("utf-8"), Workspace([path.parent]).world(path))


@cache
def solved_at(path: Path) -> View:
    return run(checked_at(path))


@pytest.fixture(params=LIGHTER)
def example(request: pytest.FixtureRequest) -> View:
    """Each example, checked and not solved."""
    return checked_at(request.param)
