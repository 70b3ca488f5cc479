"""Completion: the texts that may follow at a place, the likeliest first."""

from aidl_lang.tools.ide.completion.complete import complete
from aidl_lang.tools.ide.completion.drafts import MOST, Completion

__all__ = ["MOST", "Completion", "complete"]
