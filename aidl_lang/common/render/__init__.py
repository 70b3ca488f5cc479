"""Diagnostics as people and programs read them: an excerpt for the terminal, a dictionary for JSON."""

from aidl_lang.common.render.excerpt import TerminalStyle, escape, wants_colour
from aidl_lang.common.render.terminal import compact, one_line, render, summary, to_dict

__all__ = ["TerminalStyle", "compact", "escape", "one_line", "render", "summary", "to_dict", "wants_colour"]
