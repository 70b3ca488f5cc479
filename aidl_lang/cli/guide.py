"""`aidl guide`: the language on a few pages, for a reader or a model that has never seen it."""

from __future__ import annotations

import argparse


def register(verbs: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    parser = verbs.add_parser("guide", help="print the language on a few pages", description=__doc__)
    parser.add_argument("--full", action="store_true", help="with the whole reference after it")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    from aidl_lang.reference.guide import full_guide, guide

    print((full_guide if arguments.full else guide)(), end="")
    return 0
