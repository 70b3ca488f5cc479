"""A version is published only if it is the same everywhere and the changelog tells of it."""

from __future__ import annotations

import re
import sys

import aidl_lang
from tests.documents import ROOT

sys.path.insert(0, str(ROOT / ".ci"))
from release import PLACES, faults, section, versions

LOG = """\
# Changelog

## [0.3.0] - unreleased

- Later.

## [0.2.0] - 2026-12-01

- Now.

### More

- And this.
"""
SAME = dict.fromkeys(PLACES, "0.2.0")


def test_the_version_is_the_same_everywhere() -> None:
    said = versions(ROOT)
    assert set(said.values()) == {aidl_lang.__version__}
    assert (
        faults(None, said, section((ROOT / "CHANGELOG.md").read_text("utf-8"), aidl_lang.__version__)) == []
    )


def test_a_section_ends_at_the_next_version() -> None:
    assert section(LOG, "0.2.0") == ("2026-12-01", "- Now.\n\n### More\n\n- And this.")
    assert section(LOG, "0.3.0") == ("unreleased", "- Later.")
    assert section(LOG, "0.4.0") is None


def test_what_stands_in_the_way_is_told() -> None:
    assert faults("v0.2.0", SAME, section(LOG, "0.2.0")) == []
    assert faults("v0.2.1", SAME, section(LOG, "0.2.0")) == ["the tag is v0.2.1, and the version 0.2.0"]
    assert faults("v0.2.0", SAME | {"CITATION.cff": "0.1.0"}, ("2026-12-01", "x")) == [
        "CITATION.cff says 0.1.0, not 0.2.0"
    ]
    assert faults(None, SAME, None) == ["CHANGELOG.md has no section `## [0.2.0] - DATE`"]
    later = dict.fromkeys(PLACES, "0.3.0")
    assert faults(None, later, section(LOG, "0.3.0")) == []
    assert faults("v0.3.0", later, section(LOG, "0.3.0")) == [
        "CHANGELOG.md says `unreleased` where the date of 0.3.0 belongs"
    ]


def test_workflows_run_what_there_is() -> None:
    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text("utf-8"), re.MULTILINE))
    for path in (ROOT / ".github" / "workflows").glob("*.yml"):
        text = path.read_text("utf-8")
        runs = re.findall(r"(?:run: |^ {10,})(.*)$", text, re.MULTILINE)
        assert {target for run in runs for target in re.findall(r"\bmake ([a-z-]+)", run)} <= targets, path
        named = [
            word.strip("\"'") for run in runs for word in run.split() if re.match(r"\"?(\.ci|tests)/", word)
        ]
        assert [name for name in named if not (ROOT / name).exists()] == [], path
        modules = {module for run in runs for module in re.findall(r"-m (aidl_\w+(?:\.\w+)*)", run)}
        assert [m for m in modules if not (ROOT / "dev" / f"{m.replace('.', '/')}.py").is_file()] == []
        assert "permissions:\n  contents: read\n" in text, "no job may more than it says"


def test_reports_tell_the_version_and_the_program() -> None:
    for name in ("bug", "wish"):
        text = (ROOT / ".github" / "ISSUE_TEMPLATE" / f"{name}.yml").read_text("utf-8")
        assert "`aidl --version`" in text
        assert "id: program" in text
