"""Programs as the preview sees them."""

from __future__ import annotations

from pathlib import Path

from aidl_lang.tools.ide.workspace import View, Workspace, look, run


def view_of(text: str, last: View | None = None, files: dict[str, str] | None = None) -> View:
    folder = Path("/project")
    workspace = Workspace(open={folder / name: content for name, content in (files or {}).items()})
    path = folder / "part.aidl"
    workspace.open[path] = text
    return run(look(path, text, workspace.world(path)), last)
