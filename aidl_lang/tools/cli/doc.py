"""`aidl doc`: what a name of the library or a word of the language is, with its signature and an example."""

from __future__ import annotations

import argparse
import os
import sys
from typing import TYPE_CHECKING

from aidl_lang.common.prose import did_you_mean
from aidl_lang.tools.cli import files
from aidl_lang.tools.cli.report import UseError, say

if TYPE_CHECKING:
    from aidl_lang.common.render import TerminalStyle
    from aidl_lang.tools.reference.collect import Entry, Reference


def register(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("name", nargs="?", metavar="NAME", help="as rectangle; without it, all are listed")
    parser.add_argument("--json", action="store_true", help="print as JSON")
    parser.add_argument("--picture", metavar="OUT.svg", help="draw the example of NAME; - is standard output")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    from aidl_lang.common.render import TerminalStyle, wants_colour
    from aidl_lang.tools.reference.collect import reference

    known = reference()
    if arguments.name is None and arguments.picture:
        raise UseError("E0912", "`--picture` draws the example of one name", "`aidl doc` lists all names")
    style = TerminalStyle(wants_colour(sys.stdout, os.environ))
    entries = [_found(known, arguments.name)] if arguments.name is not None else list(known.entries.values())
    if arguments.picture:
        return _draw(entries[0], arguments.picture)
    if arguments.json:
        _print_json(entries, single=arguments.name is not None)
    elif arguments.name is None:
        _list(known, style)
    else:
        _show(entries[0], known, arguments.name, style)
    return 0


def _found(known: Reference, name: str) -> Entry:
    """Returns the entry of a name, or, with a note, of the one that it seems to misspell."""
    if (entry := known.find(name)) is not None:
        return entry
    from aidl_lang.common.render import escape

    if (entry := known.misspelt(name)) is not None:
        say(f"there is no `{escape(name)}`; this is `{entry.name}`")
        return entry
    hints = did_you_mean(known.near(name))
    raise UseError("E0912", f"there is no `{name}` to tell about", *hints, "`aidl doc` lists all names")


def _list(known: Reference, style: TerminalStyle) -> None:
    for number, topic in enumerate(known.topics):
        entries = known.of_topic(topic.name)
        width = max(len(entry.name) for entry in entries)
        print(("\n" if number else "") + style.strong(topic.title))
        for entry in entries:
            print(f"  {style.gutter(entry.name)}{' ' * (width - len(entry.name))}  {entry.doc.line}")


def _show(entry: Entry, known: Reference, asked: str, style: TerminalStyle) -> None:
    from aidl_lang.common.names import find
    from aidl_lang.tools.reference.pages import facts, forms

    if (synonym := find(asked, known.aliases)) is not None and asked not in known.entries:
        print(f"`{synonym}` is another name for {style.strong(entry.name)}.\n")
    for form in forms(entry):
        head, slashes, comment = form.partition("    //")
        print(style.strong(head) + style.gutter(slashes + comment))
    for paragraph in filter(None, (entry.doc.line, entry.doc.text, *facts(entry))):
        print(f"\n{paragraph}")
    if entry.doc.example:
        print("\n" + style.gutter("Example:"))
        print("".join(f"    {line}\n" for line in entry.doc.example.splitlines()), end="")
    print(f"\n{style.gutter('Defined in')} {entry.where}")


def _print_json(entries: list[Entry], *, single: bool) -> None:
    import json

    from aidl_lang.tools.reference.data import to_dict

    found = [to_dict(entry) for entry in entries]
    print(json.dumps(found[0] if single else found, indent=2, ensure_ascii=False))


def _draw(entry: Entry, output: str) -> int:
    from aidl_lang.tools.reference.pages import picture

    files.require_directory(output)
    files.write(output, picture(entry))
    if output != files.STANDARD:
        say(f"{output}: the example of `{entry.name}`")
    return 0
