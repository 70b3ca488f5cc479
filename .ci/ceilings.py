"""Compares the lines of Python in each room, comments and docstrings among them, with the ceilings in
`[tool.aidl.ceilings]` of `pyproject.toml`. Fails if a room is above its own, or has none.

    .venv/bin/python .ci/ceilings.py [--set]

`--set` lowers ceilings to what there is today and raises none: they only fall.
"""

from __future__ import annotations

import re
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PROJECT = ROOT / "pyproject.toml"
PACKAGES = (
    "aidl_lang",
    "dev/aidl_dev",
    "dev/aidl_site",
    "eval/aidl_eval",
    "server/aidl_server",
    "web/aidl_web",
)


def lines(root: Path) -> dict[str, int]:
    """Returns the lines of each room below the root of a checkout."""
    rooms = dict[str, int]()
    for package in PACKAGES:
        for path in sorted((root / package).rglob("*.py")):
            room = _room(path.relative_to(root).parent.as_posix())
            rooms[room] = rooms.get(room, 0) + len(path.read_text("utf-8").splitlines())
    return rooms


def _room(folder: str) -> str:
    """Returns the folder of a package that a folder lies in; of tools and of the server, the one below."""
    parts = folder.split("/")
    return "/".join(parts[: 3 if parts[:2] in (["aidl_lang", "tools"], ["server", "aidl_server"]) else 2])


def told(rooms: dict[str, int], ceilings: dict[str, int]) -> list[str]:
    """Returns a line for each room that is above its ceiling, and for each that is on one side only."""
    above = [
        f"{room}: {rooms[room]} lines, {rooms[room] - most} above the ceiling of {most}"
        for room, most in ceilings.items()
        if rooms.get(room, 0) > most
    ]
    bare = [f"{room}: {count} lines and no ceiling" for room, count in rooms.items() if room not in ceilings]
    gone = [f"{room}: it has a ceiling and no lines" for room in ceilings if room not in rooms]
    return above + bare + gone


def lowered(text: str, rooms: dict[str, int]) -> str:
    """Returns the project file with each ceiling that is above its room lowered to it."""

    def lower(line: re.Match[str]) -> str:
        return f'"{line[1]}" = {min(int(line[2]), rooms.get(line[1], int(line[2])))}'

    head, table, rest = text.partition("[tool.aidl.ceilings]\n")
    ours, bracket, others = rest.partition("\n[")
    return head + table + re.sub(r'^"([^"]+)" = (\d+)', lower, ours, flags=re.MULTILINE) + bracket + others


def main() -> None:
    rooms = lines(ROOT)
    if sys.argv[1:] == ["--set"]:
        PROJECT.write_text(lowered(PROJECT.read_text("utf-8"), rooms), "utf-8")
    ceilings: dict[str, int] = tomllib.loads(PROJECT.read_text("utf-8"))["tool"]["aidl"]["ceilings"]
    if found := told(rooms, ceilings):
        sys.exit("\n".join([*found, "the ceilings are in [tool.aidl.ceilings] of pyproject.toml"]))
    print(f"{sum(rooms.values())} lines in {len(rooms)} rooms, none above its ceiling")


if __name__ == "__main__":
    main()
