"""Dragging: the movable points of a drawing, their motion, and the edits it makes in the text."""

from aidl_lang.tools.ide.dragging.drag import MOST_HANDLES, Dragged, Handle, drag, handles
from aidl_lang.tools.ide.dragging.mobility import grips, is_somewhere

__all__ = ["MOST_HANDLES", "Dragged", "Handle", "drag", "grips", "handles", "is_somewhere"]
