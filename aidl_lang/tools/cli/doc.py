"""`aidl doc` and other verbs that tell of the language: its guide, grammar, codes, a starter program."""

from __future__ import annotations

import argparse
import os
import re
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from aidl_lang.common.names import nearest
from aidl_lang.common.prose import did_you_mean, listed, ticked
from aidl_lang.tools.cli import VERBS, files, registering
from aidl_lang.tools.cli.files import UseError, print_json, say
from aidl_lang.tools.cli.options import add_variant, choice, flag, value
from aidl_lang.tools.grammars import FENCED_FORMATS, FORMATS

if TYPE_CHECKING:
    from aidl_lang.common.render import TerminalStyle
    from aidl_lang.tools.reference.collect import Entry, Reference


# --- What `aidl doc` finds of the command itself: its verbs and their options, with the formats.

_PLAIN = {
    "compile": "export save convert output file",
    "--kerf": "laser burn width beam",
    "--nest": "pack arrange layout",
    "--sheet": "plywood material layout",
    "--tile": "paper print pages",
    "--dimension": "measurements sizes",
}
"""Words that somebody new asks with, by verb or option."""


def commands_about(query: str) -> list[tuple[str, str]]:
    """Returns the verbs and options with every word of a query, each with its line; those named so first."""
    from aidl_lang import export
    from aidl_lang.tools.reference.collect import stems

    wanted = set(stems(query))
    plain = {**_PLAIN, "--output": f"export save format {' '.join(export.FORMATS)}"}
    found = []
    for name, usage, line in _all():
        named = set(stems(f"{name} {plain.get(name, '')}"))
        if wanted and wanted <= named | set(stems(line)):
            found.append((not wanted <= set(stems(name)), not wanted <= named, usage, line))
    return [(usage, line) for *_, usage, line in sorted(found, key=lambda each: each[:2])]


def _all() -> Iterator[tuple[str, str, str]]:
    """Yields the verbs, and each option once, at the first verb that has it: name, usage and line."""
    seen: set[str] = set()
    for verb, line in VERBS.items():
        yield verb, f"aidl {verb}", line
        parser = argparse.ArgumentParser(add_help=False)
        registering(verb)(parser)
        for action in parser._actions:
            name = action.option_strings[-1] if action.option_strings else ""
            if name and action.help and name not in seen:
                seen.add(name)
                yield name, f"aidl {verb} {name}", " ".join(action.help.split())


def register_doc(parser: argparse.ArgumentParser) -> None:
    """`aidl doc`: what a name of the library or a word of the language is, with its signature and an example.
    Other words list the names that speak of them.
    """
    parser.add_argument(
        "name",
        nargs="*",
        metavar="NAME",
        help="as rectangle; other words, as finger joint, list the names that speak of them; without it, all "
        "are listed",
    )
    flag(parser, "--json", "print as JSON")
    value(parser, "--picture", "OUT.svg", "draw the example of NAME; - is standard output")


def run_doc(arguments: argparse.Namespace) -> int:
    from aidl_lang.common.render import TerminalStyle, wants_colour
    from aidl_lang.tools.reference import to_dict
    from aidl_lang.tools.reference.collect import reference

    known, words = reference(), " ".join(arguments.name)
    if not words and arguments.picture:
        raise UseError("E0912", "`--picture` draws the example of one name", "`aidl doc` lists all names")
    style = TerminalStyle(wants_colour(sys.stdout, os.environ))
    found, commands = _found(known, words)
    if isinstance(found, list):
        if arguments.picture:
            names = ticked([e.name for e in found[:3]] or [usage for usage, _ in commands])
            raise UseError("E0912", f"`{words}` is no name; `--picture` draws one of these: {listed(names)}")
        if arguments.json:
            of_command = [{"name": usage, "sort": "command", "line": line} for usage, line in commands]
            print_json([*(to_dict(entry) for entry in found), *of_command])
        elif words:
            print(f"`{words}` is no name. These speak of it:")
            entries = [(e.name, e.doc.line) for e in found]
            is_named = any(words.casefold() == usage.split()[-1].lstrip("-") for usage, _ in commands)
            for lines in (commands, entries) if is_named else (entries, commands):
                if lines:
                    print()
                    _list(lines, style)
        else:
            for number, topic in enumerate(known.topics):
                print(("\n" if number else "") + style.strong(topic.title))
                _list([(entry.name, entry.doc.line) for entry in known.of_topic(topic.name)], style)
    elif arguments.picture:
        from aidl_lang.export import suffix_of
        from aidl_lang.tools.reference import picture

        usual = "svg" if arguments.picture == files.STANDARD else None
        suffix_of(arguments.picture, usual, (".svg",), "an example is drawn as SVG, not as `{}`")
        files.require_directory(arguments.picture)
        files.write(arguments.picture, picture(found))
        if arguments.picture != files.STANDARD:
            say(f"{arguments.picture}: the example of `{found.name}`")
        return 0
    elif arguments.json:
        print_json(to_dict(found))
    else:
        _show(found, known, words, style)
    return 0


def _found(known: Reference, words: str) -> tuple[Entry | list[Entry], list[tuple[str, str]]]:
    """Returns the entry of a name, else all that speak of the words, and verbs and options with their lines
    that do, else, with a note, the one misspelt; without words all entries.
    """
    if not words:
        return list(known.entries.values()), []
    if (entry := known.find(words)) is not None:
        return entry, []
    from aidl_lang.common.render import escape
    from aidl_lang.tools.reference.collect import speaking_of

    found, commands = speaking_of(words), commands_about(words)
    if found or commands:
        return found, commands
    if (entry := known.misspelt(words)) is not None:
        say(f"there is no `{escape(words)}`; this is `{entry.name}`")
        return entry, []
    hints = did_you_mean(known.near(words))
    raise UseError("E0912", f"there is no `{words}` to tell about", *hints, "`aidl doc` lists all names")


def _list(lines: Sequence[tuple[str, str]], style: TerminalStyle) -> None:
    width = max(len(name) for name, _ in lines)
    for name, line in lines:
        print(f"  {style.gutter(name)}{' ' * (width - len(name))}  {line}")


def _show(entry: Entry, known: Reference, asked: str, style: TerminalStyle) -> None:
    from aidl_lang.common.names import find
    from aidl_lang.tools.reference import facts, forms

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


def register_guide(parser: argparse.ArgumentParser) -> None:
    """`aidl guide`: the language on a few pages, for a reader or a model that has never seen it."""
    kind = parser.add_mutually_exclusive_group()
    flag(kind, "--full", "with the whole reference after it")
    about = "with the reference of some topics after it, as joints,hardware"
    value(kind, "--with", "TOPICS", about, dest="topics")
    add_variant(kind)


def run_guide(arguments: argparse.Namespace) -> int:
    from aidl_lang.tools.reference import full_guide, guide, guide_with

    if arguments.topics is not None:
        print(guide_with(_topics(arguments.topics)), end="")
    else:
        print(full_guide() if arguments.full else guide(arguments.variant), end="")
    return 0


def _topics(written: str) -> list[str]:
    from aidl_lang.tools.reference.collect import reference

    known = [topic.name for topic in reference().topics]
    topics = [topic.strip() for topic in written.split(",")]
    for topic in topics:
        if topic not in known:
            hints = (*did_you_mean(nearest(topic, known, 2)), f"topics: {', '.join(known)}")
            raise UseError("E0912", f"the reference has no topic `{topic}`", *hints)
    return topics


def register_grammar(parser: argparse.ArgumentParser) -> None:
    """`aidl grammar`: the grammar, for servers that constrain what a model may write, and for readers."""
    value(parser, "--format", "FORMAT", f"{', '.join(FORMATS)} (default: lark)", str, "lark")
    flag(parser, "--fenced", "free text first, then the program in a block opened by ```aidl")
    about = "where to write (default: standard output)"
    parser.add_argument("-o", "--output", default=files.STANDARD, metavar="OUT", help=about)


def run_grammar(arguments: argparse.Namespace) -> int:
    from aidl_lang.tools.grammars import export

    if arguments.format not in FORMATS:
        raise UseError(
            "E0940", f"there is no format `{arguments.format}`", f"the formats: {', '.join(FORMATS)}"
        )
    if arguments.fenced and arguments.format not in FENCED_FORMATS:
        raise UseError(
            "E0941",
            f"`{arguments.format}` has no form for free text before a program",
            f"`--fenced` goes with {' and '.join(f'`--format {f}`' for f in FENCED_FORMATS)}",
        )
    files.require_directory(arguments.output)
    text = export(arguments.format, arguments.fenced)
    files.write(arguments.output, text.encode())
    if arguments.output != files.STANDARD:
        say(f"{arguments.output}: written")
    return 0


def register_explain(parser: argparse.ArgumentParser) -> None:
    """`aidl explain`: what a code such as E0301 means, with the mistake and the mended program."""
    parser.add_argument("code", nargs="?", metavar="CODE", help="as E0301; without it, all are listed")


def run_explain(arguments: argparse.Namespace) -> int:
    from aidl_lang.common import resources

    if arguments.code is None:
        for code in resources.codes():
            print(f"{code}  {resources.title(code)}")
        return 0
    code = arguments.code.strip("[]").upper()
    if code not in resources.codes():
        near = " or ".join(resources.near(code))
        hints = [f"did you mean {near}?"] * bool(near) + ["`aidl explain` lists all codes"]
        raise UseError("E0907", f"there is no code `{arguments.code}`", *hints)
    print(resources.page(code).rstrip())
    return 0


STARTER = """\
// A plate with two holes. `aidl compile {file}` draws it.
solid {name} {{
    param width = 80 in 40..200  // a knob: aidl compile {file} -D width=120

    plate = rounded_rectangle(center: origin, width: width, height: 40, radius: 5)

    hole left {{
        rim = circle(center: (-30, 0), radius: 4)
    }}
    hole right {{
        rim = circle(center: (30, 0), radius: 4)
    }}

    constrain {{
        left.rim.center == plate.center - (width / 2 - 12, 0)
        right.rim.center == plate.center + (width / 2 - 12, 0)
        equal(right.rim, left.rim)
    }}
}}
"""


def register_new(parser: argparse.ArgumentParser) -> None:
    """`aidl new`: a starter program to change."""
    parser.add_argument("name", metavar="NAME", help="what to make: NAME.aidl, never over an existing file")


def run_new(arguments: argparse.Namespace) -> int:
    path = Path(arguments.name)
    if path.suffix != ".aidl":
        path = path.with_name(f"{path.name}.aidl")
    files.require_directory(str(path))
    files.create(str(path), STARTER.format(name=structure_name(path.stem), file=path.name).encode())
    say(f"{path}: written. Draw it with: aidl compile {path}")
    return 0


def structure_name(stem: str) -> str:
    """Returns a valid name, as near to the file's as possible."""
    from aidl_lang.syntax.tables import load_tables

    name = re.sub(r"\W+", "_", stem.lower(), flags=re.ASCII).strip("_")
    unfit = not name or name[0].isdigit() or name in load_tables().reserved
    return f"part_{name}".rstrip("_") if unfit else name


def register_tool_schema(parser: argparse.ArgumentParser) -> None:
    """`aidl tool-schema`: the tools for agents as JSON, to be put into a request to a language model."""
    about = "the API that they are for (default: openai, and servers that speak like it)"
    choice(parser, "--style", ("openai", "anthropic", "mcp"), about)


def run_tool_schema(arguments: argparse.Namespace) -> int:
    from aidl_lang.tools.agents.calling import STYLES

    print_json(STYLES[arguments.style]())
    return 0
