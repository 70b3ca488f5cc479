"""The picture protocols of a terminal, chosen by its environment.

A terminal that is taken for another fills the screen with garbage, so a protocol is chosen only where a
terminal names itself and nothing speaks against it. Variables are inherited: in a multiplexer, or in a
terminal that was started from another one, those of the outer terminal are still there.
"""

from __future__ import annotations

from collections.abc import Mapping

GRAPHICS = ("kitty", "iterm", "sixel")
"""Protocols that take pixels; the others take characters."""
PROTOCOLS = (*GRAPHICS, "blocks", "braille", "ascii")

_MULTIPLEXERS = ("TMUX", "STY", "ZELLIJ")
_MULTIPLEXED = ("tmux", "screen")
"""Beginnings of TERM; it crosses a remote shell where variables do not."""

_BY_TERM = (
    ("xterm-kitty", "kitty"),
    ("xterm-ghostty", "kitty"),
    ("foot", "sixel"),
    ("mlterm", "sixel"),
    ("yaft", "sixel"),
)
_BY_PROGRAM = {"kitty": "kitty", "ghostty": "kitty", "WezTerm": "iterm", "iTerm.app": "iterm"}
"""WezTerm follows the protocol of iTerm2 more closely than that of kitty, which can be switched off there."""
_OTHERS = (
    "VTE_VERSION",
    "XTERM_VERSION",
    "KONSOLE_VERSION",
    "ALACRITTY_WINDOW_ID",
    "WT_SESSION",
    "INSIDE_EMACS",
    "VIM_TERMINAL",
    "NVIM",
)
"""Set by terminals that show no pictures, or only if told to."""
_TRUE_COLOUR = ("truecolor", "24bit")


def protocol(environment: Mapping[str, str], encoding: str, *, is_terminal: bool, has_colour: bool) -> str:
    """Returns the best of `PROTOCOLS` for standard output.

    `has_colour` is false where colour is not wanted (NO_COLOR, TERM=dumb); escape codes are not wanted then.
    """
    if not has_colour:
        return _encodable("braille", "\u28ff", encoding)
    found = _graphics(environment) if is_terminal else None
    return found or _encodable("blocks", "▀", encoding)


def has_true_colour(environment: Mapping[str, str]) -> bool:
    """True if colours may be given as red, green and blue; else they are of the 256 of xterm."""
    if environment.get("STY"):
        return False  # GNU screen shows other colours then, whatever the terminal around it says
    return environment.get("COLORTERM") in _TRUE_COLOUR or bool(environment.get("WT_SESSION"))


def _graphics(environment: Mapping[str, str]) -> str | None:
    term, program = environment.get("TERM", ""), environment.get("TERM_PROGRAM", "")
    if any(map(environment.get, _MULTIPLEXERS)) or term.startswith(_MULTIPLEXED):
        return None
    for start, name in _BY_TERM:
        if term.startswith(start):
            return name
    if term.endswith("-sixel"):
        return "sixel"
    is_common = not term or term.startswith(("xterm", "wezterm"))
    if not is_common or any(map(environment.get, _OTHERS)):
        return None
    if program:
        return _BY_PROGRAM.get(program)
    if environment.get("KITTY_WINDOW_ID"):
        return "kitty"
    return "iterm" if environment.get("LC_TERMINAL") == "iTerm2" else None


def _encodable(name: str, sample: str, encoding: str) -> str:
    try:
        sample.encode(encoding)
    except (UnicodeEncodeError, LookupError):
        return "ascii"
    return name
