"""What `aidl preview` does; the verb with its options is in `aidl_lang.tools.cli.serving`."""

from __future__ import annotations

import argparse
import socket
from pathlib import Path

from aidl_lang.tools.cli import files
from aidl_lang.tools.cli.files import UseError, say
from aidl_lang.tools.cli.serving import open_browser
from aidl_server.ide.references import CannotError
from aidl_server.preview.host import Host
from aidl_server.preview.local import Door
from aidl_server.preview.site import serve


def preview(arguments: argparse.Namespace, listener: socket.socket) -> None:
    """Serves the pane until it is interrupted."""
    host, door = Host(Path(arguments.file).resolve(), _write), Door(listener)
    say(f"{arguments.file}: {door.url} (stop with Ctrl-C)")
    if not arguments.no_open:
        open_browser(door.url)
    try:
        serve(host, door)
    finally:
        _rescue(host)


def _rescue(host: Host) -> None:
    """Keeps what was typed and not saved, and tells where."""
    try:
        kept = host.text.rescue()
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
