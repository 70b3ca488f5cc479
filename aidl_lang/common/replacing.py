"""Writes files whole or not at all."""

from __future__ import annotations

import errno
import os
import stat
from contextlib import suppress
from pathlib import Path

_WRITABLE = stat.S_IWUSR | stat.S_IWGRP | stat.S_IWOTH


def replace(path: Path, data: bytes) -> None:
    """Writes beside the file and moves into place once all is on the disk, so that whoever reads it has the
    old or the new one, also after a loss of power. Raises OSError, also for a file that is write-protected.
    """
    mode = path.stat().st_mode if path.exists() else None
    if mode is not None and not (stat.S_IMODE(mode) & _WRITABLE and os.access(path, os.W_OK)):
        raise PermissionError(errno.EACCES, "it is write-protected", str(path))
    temporary = path.with_name(f".{path.name}.{os.urandom(8).hex()}")
    try:
        with open(temporary, "xb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        if mode is not None:
            os.chmod(temporary, mode)
        os.replace(temporary, path)
    except BaseException:
        with suppress(OSError):
            os.unlink(temporary)
        raise
