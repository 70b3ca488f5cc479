"""`aidl eval`: how well a model does with the language and with subsets of it, over prompts and runs."""

from __future__ import annotations

import argparse
from importlib import import_module
from importlib.util import find_spec

from aidl_lang.tools.cli.report import UseError

_PACKAGE = "aidl_eval"
"""A distribution of its own, which stands on this one; so it is known by its name alone."""


def register(parser: argparse.ArgumentParser) -> None:
    if find_spec(_PACKAGE) is None:
        raise UseError("E0913", "`aidl eval` needs a package that is not installed", "pip install aidl-eval")
    import_module(f"{_PACKAGE}.command").register(parser)
