"""`aidl eval study`: people rank pictures on a local page, without knowing what language drew which."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from aidl_lang.common.prose import counted
from aidl_lang.tools.cli import files, serving
from aidl_lang.tools.cli.files import say, show

if TYPE_CHECKING:
    from aidl_eval.store import Store, StoreError


def register(parser: argparse.ArgumentParser) -> None:
    parser.description = __doc__
    parser.epilog = (
        "Answers go to study.jsonl in the folder, one line each, and into the tables of `aidl eval --report "
        "--out FOLDER`. Only this machine, and who has the address that is printed, can see the page."
    )
    parser.add_argument("folder", metavar="FOLDER", help="that of the results: `--out` of `aidl eval`")
    parser.add_argument(
        "--export", metavar="FILE", help="serve nothing: write all answers as CSV (`-`: standard output)"
    )
    parser.add_argument(
        "--pictures",
        choices=("neutral", "own"),
        default="neutral",
        help="in the one style of all languages, or each in its own colours, which may tell it "
        "(default: neutral)",
    )
    serving.add_options(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    from aidl_eval.store import Store

    store = Store(Path(arguments.folder))
    return _export(store, arguments.export) if arguments.export else _serve(store, arguments)


def _export(store: Store, name: str) -> int:
    from aidl_eval.judgements import Answers, sheets
    from aidl_eval.preference import exported

    answers = Answers(store.folder)
    given = answers.all()
    files.write(name, exported(given, sheets(store.records())).encode("utf-8-sig"))
    say(f"{name}: {counted(len(given), 'answer')} of {answers.path}")
    return 0


def _serve(store: Store, arguments: argparse.Namespace) -> int:
    """Runs until interrupted."""
    serving.require("the study", "aidl_server")
    from aidl_eval.study import session, site
    from aidl_server.preview.local import Door

    served = session.opened(store, arguments.pictures)
    hint = "without `--port` a free one is taken"
    door = Door(serving.listen(arguments.host, arguments.port, "E0953", hint))
    count = sum(sheet.is_shown for sheet in served.sheets)
    say(f"{store.folder}: {counted(count, 'sheet')} to rank, {door.url} (stop with Ctrl-C)")
    if not arguments.no_open:
        serving.open_browser(door.url)
    door.serve(site.site(served, door.token, door.addresses, _tell), site.CONNECTIONS)
    return 0


def _tell(reason: StoreError) -> None:
    show([reason.diagnostic])
