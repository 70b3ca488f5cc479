"""Hover: what a word means, its type, and what it came out as."""

from aidl_lang.tools.ide.hover.hover import Hover, hover

__all__ = ["Hover", "hover"]
