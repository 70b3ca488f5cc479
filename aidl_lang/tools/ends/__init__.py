"""Tries a program at the ends of its params: each is set alone, to both ends of its range."""

from aidl_lang.tools.ends.results import Sweep, Turned
from aidl_lang.tools.ends.searching import sweep
from aidl_lang.tools.ends.trying import SweepJob
from aidl_lang.tools.ends.values import has_range
from aidl_lang.tools.ends.wording import described, sentence

__all__ = ["Sweep", "SweepJob", "Turned", "described", "has_range", "sentence", "sweep"]
