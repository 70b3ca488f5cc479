"""The distribution is of the version that it stands on, and brings along what it reads."""

from __future__ import annotations

import tomllib
from pathlib import Path

import aidl_eval
import aidl_lang
from tests.documents import ROOT


def test_it_is_of_the_version_that_it_stands_on() -> None:
    """It uses more of it than the public names."""
    for place in ("eval", "dev"):
        project = tomllib.loads((ROOT / place / "pyproject.toml").read_text("utf-8"))["project"]
        assert project["version"] == aidl_lang.__version__
        assert f"aidl-lang=={aidl_lang.__version__}" in project["dependencies"]


def test_what_it_reads_lies_in_the_package() -> None:
    package = Path(aidl_eval.__file__).parent
    assert len([*package.glob("prompts/*.aidl")]) == 36
    assert len([*package.glob("guides/*.md")]) == 4
    assert package.joinpath("study/page/index.html").is_file()
