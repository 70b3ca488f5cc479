"""The generated files for editors and decoders in a checkout: grammars, lists of words, snippets, and
expectations of tests.
"""

from __future__ import annotations

import json
from pathlib import Path

from aidl_dev import write_changed
from aidl_dev.grammars import formats
from aidl_dev.highlighting.codemirror import words
from aidl_dev.highlighting.scopes import SCOPES
from aidl_dev.highlighting.textmate import grammar, markdown
from aidl_dev.highlighting.tree_sitter import queries
from aidl_lang.tools.highlighting import classify
from aidl_lang.tools.vocabulary import SNIPPETS

SAMPLES = "tests/editors/classes.json"


def texts(root: Path) -> dict[str, str]:
    """Returns every generated text by its path below the root of a checkout."""
    return {
        "editors/vscode/syntaxes/aidl.tmLanguage.json": _json(grammar()),
        "editors/vscode/syntaxes/markdown-aidl.tmLanguage.json": _json(markdown()),
        "editors/vscode/snippets/aidl.json": _json(_snippets()),
        "editors/codemirror/src/words.ts": words(),
        "server/aidl_server/preview/pane/words.js": words(typed=False),
        **queries(),
        **formats.texts(),
        SAMPLES: _samples(root),
    }


def write(root: Path) -> None:
    """Updates the generated files. A file that is right already is not touched."""
    write_changed(root, {path: text.encode() for path, text in texts(root).items()})


def _json(data: object) -> str:
    return json.dumps(data, indent=2, ensure_ascii=False) + "\n"


def _snippets() -> dict[str, object]:
    return {
        snippet.title: {
            "prefix": snippet.prefix,
            "body": snippet.body.split("\n"),
            "description": snippet.title,
        }
        for snippet in SNIPPETS
    }


def _samples(root: Path) -> str:
    """Returns the class of every piece of the examples and of one program that has them all, for tests that
    run without Python: [start, end, class], in units of UTF-16, a line for each line of the program.
    """
    files = [*sorted((root / "examples").glob("*.aidl")), root / "tests/editors/classes.aidl"]
    programs = ",\n".join(
        f'"{path.relative_to(root).as_posix()}": [\n{_pieces(path.read_text("utf-8"))}\n]' for path in files
    )
    return f'{{"scopes": {json.dumps(SCOPES, indent=1)},\n"programs": {{\n{programs}\n}}}}\n'


def _pieces(text: str) -> str:
    lines: dict[int, list[str]] = {}
    for start, end, kind in classify(text):
        piece = json.dumps([_units(text[:start]), _units(text[:end]), kind], separators=(",", ":"))
        lines.setdefault(text.count("\n", 0, start), []).append(piece)
    return ",\n".join(",".join(pieces) for pieces in lines.values())


def _units(text: str) -> int:
    return len(text.encode("utf-16-le")) // 2
