"""`aidl doc`: what a name of the library or a word of the language is, with its signature and an example.
Other words list the names that speak of them.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

from aidl_lang.common.prose import did_you_mean, listed, ticked
from aidl_lang.tools.cli import files
from aidl_lang.tools.cli.report import UseError, say

if TYPE_CHECKING:
    from aidl_lang.common.render import TerminalStyle
    from aidl_lang.tools.reference.collect import Entry, Reference


_FEW = 3
"""Names that a message lists."""


def register(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "name",
        nargs="*",
        metavar="NAME",
        help="as rectangle; other words, as finger joint, list the names that speak of them; without it, all "
        "are listed",
    )
    parser.add_argument("--json", action="store_true", help="print as JSON")
    parser.add_argument("--picture", metavar="OUT.svg", help="draw the example of NAME; - is standard output")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    from aidl_lang.common.render import TerminalStyle, wants_colour
    from aidl_lang.tools.reference.collect import reference
    from aidl_lang.tools.reference.pages import to_dict

    known, words = reference(), " ".join(arguments.name)
    if not words and arguments.picture:
        raise UseError("E0912", "`--picture` draws the example of one name", "`aidl doc` lists all names")
    style = TerminalStyle(wants_colour(sys.stdout, os.environ))
    commands: list[tuple[str, str]] = []
    found: Entry | list[Entry] = list(known.entries.values())
    if words:
        found, commands = _found(known, words)
    if isinstance(found, list):
        if arguments.picture:
            names = ticked([e.name for e in found[:_FEW]] or [usage for usage, _ in commands])
            raise UseError("E0912", f"`{words}` is no name; `--picture` draws one of these: {listed(names)}")
        if arguments.json:
            of_command = [{"name": usage, "sort": "command", "line": line} for usage, line in commands]
            _print_json([*(to_dict(entry) for entry in found), *of_command])
        elif words:
            print(f"`{words}` is no name. These speak of it:")
            entries = [(e.name, e.doc.line) for e in found]
            is_named = any(words.casefold() == usage.split()[-1].lstrip("-") for usage, _ in commands)
            for lines in (commands, entries) if is_named else (entries, commands):
                if lines:
                    print()
                    _list(lines, style)
        else:
            _list_all(known, style)
    elif arguments.picture:
        return _draw(found, arguments.picture)
    elif arguments.json:
        _print_json(to_dict(found))
    else:
        _show(found, known, words, style)
    return 0


def _found(known: Reference, words: str) -> tuple[Entry | list[Entry], list[tuple[str, str]]]:
    """Returns the entry of a name, else all that speak of the words, and verbs and options with their lines
    that do, else, with a note, the one misspelt.
    """
    if (entry := known.find(words)) is not None:
        return entry, []
    from aidl_lang.common.render import escape
    from aidl_lang.tools.cli import VERBS
    from aidl_lang.tools.cli.doc_commands import commands_about
    from aidl_lang.tools.reference.searching import speaking_of

    found, commands = speaking_of(words), commands_about(words, VERBS)
    if found or commands:
        return found, commands
    if (entry := known.misspelt(words)) is not None:
        say(f"there is no `{escape(words)}`; this is `{entry.name}`")
        return entry, []
    hints = did_you_mean(known.near(words))
    raise UseError("E0912", f"there is no `{words}` to tell about", *hints, "`aidl doc` lists all names")


def _list_all(known: Reference, style: TerminalStyle) -> None:
    for number, topic in enumerate(known.topics):
        print(("\n" if number else "") + style.strong(topic.title))
        _list([(entry.name, entry.doc.line) for entry in known.of_topic(topic.name)], style)


def _list(lines: Sequence[tuple[str, str]], style: TerminalStyle) -> None:
    width = max(len(name) for name, _ in lines)
    for name, line in lines:
        print(f"  {style.gutter(name)}{' ' * (width - len(name))}  {line}")


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


def _print_json(found: object) -> None:
    import json

    print(json.dumps(found, indent=2, ensure_ascii=False))


def _draw(entry: Entry, output: str) -> int:
    from aidl_lang.tools.reference.pages import picture

    files.require_directory(output)
    files.write(output, picture(entry))
    if output != files.STANDARD:
        say(f"{output}: the example of `{entry.name}`")
    return 0
