"""The preview beside the text: the drawing with its places in the text, sliders, problems."""

from aidl_lang.tools.ide.preview.elements import elements_at
from aidl_lang.tools.ide.preview.making import preview, tried, with_handles
from aidl_lang.tools.ide.preview.protocol import LAYERS, Preview, Writer
from aidl_lang.tools.ide.preview.sliders import set_knob, worked_out

__all__ = [
    "LAYERS",
    "Preview",
    "Writer",
    "elements_at",
    "preview",
    "set_knob",
    "tried",
    "with_handles",
    "worked_out",
]
