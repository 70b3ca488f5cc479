"""`aidl preview`: a program drawn in the browser beside any editor, again on every save."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from aidl_lang.tools.cli import files, listening
from aidl_lang.tools.cli.options import add_program
from aidl_lang.tools.cli.report import UseError, say

if TYPE_CHECKING:
    from aidl_lang.tools.preview.serving import Served

_NEEDED = ("pygls", "starlette", "uvicorn", "websockets")


def register(parser: argparse.ArgumentParser) -> None:
    parser.epilog = (
        "Sliders and points that are dragged change the text of the file. Only this machine, and who has the "
        "address that is printed, can see it."
    )
    add_program(parser)
    listening.add_options(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Runs until interrupted."""
    listening.require("the preview", *_NEEDED)
    if arguments.file == files.STANDARD:
        raise UseError("E0902", "standard input cannot be watched", "name a file")
    files.read(arguments.file)
    hint = "without `--port` a free one is taken"
    listener = listening.listener(arguments.host, arguments.port, "E0953", hint)

    from aidl_lang.tools.preview.serving import Served

    served = Served(Path(arguments.file).resolve(), _write, listener)
    say(f"{arguments.file}: {served.url} (stop with Ctrl-C)")
    if not arguments.no_open:
        listening.open_browser(served.url)
    try:
        served.run()
    finally:
        _rescue(served)
    return 0


def _rescue(served: Served) -> None:
    """Keeps what was typed and not saved, and tells where."""
    from aidl_lang.tools.ide.references import CannotError

    try:
        kept = served.rescue()
    except CannotError as reason:
        say(f"what was typed in the preview is not saved: {reason}")
        return
    if kept is not None:
        say(f"what was typed in the preview and not saved is in {kept}")


def _write(path: Path, data: bytes) -> None:
    try:
        files.rewrite(str(path), data)
    except UseError as reason:
        raise OSError(reason.diagnostic.message) from None
