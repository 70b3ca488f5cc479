"""Loads what every variant needs, by compiling one: processes that are forked from one that has imported this
are ready when they begin.
"""

from __future__ import annotations

from aidl_lang.tools.sweeping.bundle import Bundle
from aidl_lang.tools.sweeping.working import Making, variant

_PROGRAM = """\
solid warm {
    param width = 30 in 20..40
    body = rectangle(width: width, height: 10)
    hole bore { rim = circle(radius: 2) }
    constrain bore.centered_in(body)
    assert body.width > 4
}
"""

variant(Bundle("warm.aidl", _PROGRAM, {}), {"width": 25.0}, Making())
