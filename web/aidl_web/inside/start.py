"""Begins: completes the platform, then loads the language server."""

from __future__ import annotations

from typing import TYPE_CHECKING

import aidl_outside  # what the page gives: see `page/engine.js`

from aidl_web.inside import fetching, platform

if TYPE_CHECKING:
    from aidl_web.inside.hosting import Desk


def begin() -> Desk:
    """Returns the desk of the page."""
    platform.complete(aidl_outside.kernel, aidl_outside.busy)
    fetching.install(aidl_outside)
    from aidl_web.inside.hosting import Desk

    return Desk(aidl_outside)
