"""`aidl explain`: what a code such as E0301 means, with the mistake and the mended program."""

from __future__ import annotations

import argparse

from aidl_lang.tools.cli.report import UseError


def register(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("code", nargs="?", metavar="CODE", help="as E0301; without it, all are listed")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    from aidl_lang.common import resources

    if arguments.code is None:
        for code in resources.codes():
            print(f"{code}  {resources.title(code)}")
        return 0
    code = arguments.code.strip("[]").upper()
    if code not in resources.codes():
        raise UseError("E0907", f"there is no code `{arguments.code}`", *_suggestions(resources.near(code)))
    print(resources.page(code).rstrip())
    return 0


def _suggestions(codes: list[str]) -> list[str]:
    listed = "`aidl explain` lists all codes"
    return [f"did you mean {' or '.join(codes)}?", listed] if codes else [listed]
