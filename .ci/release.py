"""Looks whether a version can be published: it is the same wherever it is written, and the changelog tells
of it.

    python .ci/release.py [TAG] [--notes FILE]

With a TAG (`v1.2.3`) this has to be that version, and its section in the changelog has to have a date.
Writes the section to FILE.
"""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PLACES = {
    "aidl_lang/version.py": r'__version__ = "([^"]+)"',
    "dev/pyproject.toml": r'^version = "([^"]+)"',
    "eval/pyproject.toml": r'^version = "([^"]+)"',
    "server/pyproject.toml": r'^version = "([^"]+)"',
    "editors/codemirror/package.json": r'"version": "([^"]+)"',
    "editors/tree-sitter-aidl/package.json": r'"version": "([^"]+)"',
    "editors/tree-sitter-aidl/tree-sitter.json": r'"version": "([^"]+)"',
    "editors/vscode/package.json": r'"version": "([^"]+)"',
    "CITATION.cff": r"^version: (\S+)",
}
"""Files that say the version, with the first place in each."""
_SECTION = re.compile(r"^## \[([^\]]+)\] - (\S+)\n(.*?)(?=^## |\Z)", re.MULTILINE | re.DOTALL)


def versions(root: Path) -> dict[str, str]:
    """Returns what each file says."""
    found = {}
    for path, pattern in PLACES.items():
        said = re.search(pattern, (root / path).read_text("utf-8"), re.MULTILINE)
        found[path] = said[1] if said else "no version"
    return found


def section(changelog: str, version: str) -> tuple[str, str] | None:
    """Returns the date of a version in the changelog, and what it tells; None if there is no such section."""
    for name, date, text in _SECTION.findall(changelog):
        if name == version:
            return date, text.strip()
    return None


def faults(tag: str | None, said: dict[str, str], told: tuple[str, str] | None) -> list[str]:
    """Returns what stands in the way."""
    version = said["aidl_lang/version.py"]
    found = [f"{path} says {other}, not {version}" for path, other in said.items() if other != version]
    if tag is not None and tag != f"v{version}":
        found.append(f"the tag is {tag}, and the version {version}")
    if told is None or not told[1]:
        found.append(f"CHANGELOG.md has no section `## [{version}] - DATE`")
    elif tag is not None and not re.fullmatch(r"\d{4}-\d\d-\d\d", told[0]):
        found.append(f"CHANGELOG.md says `{told[0]}` where the date of {version} belongs")
    return found


def main() -> int:
    """Returns the exit code."""
    parser = argparse.ArgumentParser(description="Look whether a version can be published.")
    parser.add_argument("tag", nargs="?")
    parser.add_argument("--notes", type=Path, metavar="FILE")
    asked = parser.parse_args()
    said = versions(ROOT)
    told = section((ROOT / "CHANGELOG.md").read_text("utf-8"), said["aidl_lang/version.py"])
    found = faults(asked.tag, said, told)
    for fault in found:
        print(fault, file=sys.stderr)
    if told is not None and asked.notes is not None:
        asked.notes.write_text(f"{told[1]}\n", "utf-8")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())
