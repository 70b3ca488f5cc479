"""Hover: the meaning of a word, its type, and its solved value."""

from aidl_lang.tools.ide.hover.hover import Hover, hover

__all__ = ["Hover", "hover"]
