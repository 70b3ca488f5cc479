"""`aidl guide`: the language on a few pages, for a reader or a model that has never seen it."""

from __future__ import annotations

import argparse

from aidl_lang.common.names import nearest
from aidl_lang.common.prose import did_you_mean
from aidl_lang.tools.cli.options import add_variant
from aidl_lang.tools.cli.report import UseError


def register(parser: argparse.ArgumentParser) -> None:
    kind = parser.add_mutually_exclusive_group()
    kind.add_argument("--full", action="store_true", help="with the whole reference after it")
    kind.add_argument(
        "--with",
        dest="topics",
        metavar="TOPICS",
        help="with the reference of some topics after it, as joints,hardware",
    )
    add_variant(kind)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    from aidl_lang.tools.reference.pages import full_guide, guide, guide_with

    if arguments.topics is not None:
        print(guide_with(_topics(arguments.topics)), end="")
    else:
        print(full_guide() if arguments.full else guide(arguments.variant), end="")
    return 0


def _topics(written: str) -> list[str]:
    """Returns the names of the topics that are asked for."""
    from aidl_lang.tools.reference.collect import reference

    known = [topic.name for topic in reference().topics]
    topics = [topic.strip() for topic in written.split(",")]
    for topic in topics:
        if topic not in known:
            raise UseError(
                "E0912",
                f"the reference has no topic `{topic}`",
                *did_you_mean(nearest(topic, known, 2)),
                f"topics: {', '.join(known)}",
            )
    return topics
