"""Dragging: which points of a drawing can be moved, where all goes then, what that changes in the text."""

from aidl_lang.tools.ide.dragging.drag import MOST_HANDLES, Dragged, Handle, drag, handles
from aidl_lang.tools.ide.dragging.grips import grips, is_somewhere

__all__ = ["MOST_HANDLES", "Dragged", "Handle", "drag", "grips", "handles", "is_somewhere"]
