"""`aidl guide`: the language on a few pages, for a reader or a model that has never seen it."""

from __future__ import annotations

import argparse

from aidl_lang.tools.cli.options import add_variant


def register(parser: argparse.ArgumentParser) -> None:
    kind = parser.add_mutually_exclusive_group()
    kind.add_argument("--full", action="store_true", help="with the whole reference after it")
    add_variant(kind)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    from aidl_lang.tools.reference.guide import full_guide, guide

    print(full_guide() if arguments.full else guide(arguments.variant), end="")
    return 0
