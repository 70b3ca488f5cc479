"""What `aidl doc` finds of the command itself: its verbs and their options, with the formats."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from importlib import import_module

from aidl_lang.tools.reference.searching import stems

_PLAIN = {
    "compile": "export save convert output file",
    "--output": "export save format svg pdf png dxf step stl stp 3mf json csv",
    "--kerf": "laser burn width beam",
    "--nest": "pack arrange layout",
    "--sheet": "plywood material layout",
    "--tile": "paper print pages",
    "--dimension": "measurements sizes",
}
"""Words that somebody new asks with, by verb or option."""


def commands_about(query: str, verbs: dict[str, str]) -> list[tuple[str, str]]:
    """Returns the verbs and options that have every word of a query, each with its line; those named so
    first.
    """
    wanted = set(stems(query))
    found = []
    for name, usage, line in _all(verbs):
        named = set(stems(f"{name} {_PLAIN.get(name, '')}"))
        if wanted and wanted <= named | set(stems(line)):
            found.append((not wanted <= set(stems(name)), not wanted <= named, usage, line))
    return [(usage, line) for *_, usage, line in sorted(found, key=lambda each: each[:2])]


def _all(verbs: dict[str, str]) -> Iterator[tuple[str, str, str]]:
    """Yields the verbs, and each option once, at the first verb that has it: name, usage and line."""
    seen: set[str] = set()
    for verb, line in verbs.items():
        yield verb, f"aidl {verb}", line
        parser = argparse.ArgumentParser(add_help=False)
        import_module(f"aidl_lang.tools.cli.{verb.replace('-', '_')}").register(parser)
        for action in parser._actions:
            name = action.option_strings[-1] if action.option_strings else ""
            if name and action.help and name not in seen:
                seen.add(name)
                yield name, f"aidl {verb} {name}", " ".join(action.help.split())
