"""The picture beside the text: what is drawn and where it is written, what can be set, what is wrong."""

from aidl_lang.tools.ide.preview.elements import elements_at
from aidl_lang.tools.ide.preview.making import preview, tried, with_handles
from aidl_lang.tools.ide.preview.protocol import Writer
from aidl_lang.tools.ide.preview.sliders import set_knob
from aidl_lang.tools.ide.preview.values import LAYERS, Preview

__all__ = ["LAYERS", "Preview", "Writer", "elements_at", "preview", "set_knob", "tried", "with_handles"]
