"""Completion: the texts that may follow at a place, the likeliest first."""

from aidl_lang.tools.ide.completion.complete import complete
from aidl_lang.tools.ide.completion.draft import MOST, Completion

__all__ = ["MOST", "Completion", "complete"]
