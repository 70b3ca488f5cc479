"""`aidl tool-schema`: the tools for agents as JSON, to be put into a request to a language model."""

from __future__ import annotations

import argparse

_STYLES = ("openai", "anthropic", "mcp")


def register(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--style",
        choices=_STYLES,
        default=_STYLES[0],
        help="the API that they are for (default: openai, and servers that speak like it)",
    )
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    import json

    from aidl_lang.tools.agents.schema import STYLES

    print(json.dumps(STYLES[arguments.style](), indent=2, ensure_ascii=False))
    return 0
