"""What is worked out once: an installation brings it along, a checkout keeps it until its sources change."""

from __future__ import annotations

import os
import subprocess
import sys
from hashlib import sha256
from pathlib import Path

import pytest

from aidl_lang.checking import library
from aidl_lang.common import resources
from aidl_lang.syntax import tables
from tests.documents import ROOT

DERIVED = "squares.json"


class Checkout:
    """A folder that stands for a checkout, with one source file and a count of how often it was read."""

    def __init__(self, root: Path) -> None:
        self.root = root
        self.source = root / "source.txt"
        self.source.write_text("first")
        self.made = 0

    def derive(self) -> bytes:
        return resources.derived(DERIVED, lambda: [self.source], self._make)

    def _make(self) -> bytes:
        self.made += 1
        return self.source.read_bytes().upper()

    @property
    def kept(self) -> list[Path]:
        return sorted((self.root / "build" / "derived").iterdir())


@pytest.fixture
def checkout(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Checkout:
    monkeypatch.setattr(resources, "_CHECKOUT", tmp_path)
    monkeypatch.setattr(resources, "_SHIPPED", tmp_path / "_data")
    return Checkout(tmp_path)


def test_it_is_made_again_when_a_source_changes(checkout: Checkout) -> None:
    checkout.derive()
    (old,) = checkout.kept
    checkout.source.write_text("second")
    assert [checkout.derive(), checkout.made] == [b"SECOND", 2]
    (new,) = checkout.kept
    assert new != old


def test_nothing_is_kept_of_what_cannot_be_made(checkout: Checkout) -> None:
    def fail() -> bytes:
        raise ValueError("no")

    with pytest.raises(ValueError, match="no"):
        resources.derived(DERIVED, lambda: [checkout.source], fail)
    assert not (checkout.root / "build").exists()


def test_an_installation_uses_what_it_brings(checkout: Checkout) -> None:
    shipped = checkout.root / "_data" / "derived" / DERIVED
    shipped.parent.mkdir(parents=True)
    shipped.write_text("SHIPPED")
    checkout.source.write_text("changed since")
    assert [checkout.derive(), checkout.made] == [b"SHIPPED", 0]


def test_an_installation_without_it_says_so(checkout: Checkout) -> None:
    (checkout.root / "_data").mkdir()
    resources.resource.cache_clear()
    with pytest.raises(FileNotFoundError, match=r"derived/squares\.json is missing from this installation"):
        checkout.derive()
    assert not (checkout.root / "build").exists()


def test_a_package_is_built_the_same_each_time() -> None:
    """Whatever the order of Python's sets, which Lark works with: as this checkout has it."""
    kept = [resources.derived(part.DERIVED, part._inputs, part.built) for part in (tables, library)]
    program = (
        "from hashlib import sha256; from aidl_lang.checking import library;"
        "from aidl_lang.syntax import tables;"
        "print(*(sha256(part.built()).hexdigest() for part in (tables, library)))"
    )
    made = subprocess.run(
        [sys.executable, "-c", program],
        env={**os.environ, "PYTHONPATH": str(ROOT), "PYTHONHASHSEED": "1"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert made.stdout.split() == [sha256(data).hexdigest() for data in kept]


def test_nothing_is_kept_in_the_home_of_a_user(tmp_path: Path) -> None:
    home = tmp_path / "home"
    home.mkdir()
    (tmp_path / "part.aidl").write_text("solid part { rim = circle(radius: 5) }")
    program = (
        "import sys; from aidl_lang.tools.cli import main; verbs = sys.argv[1:];"
        "sys.exit(any([main(verb.split()) for verb in verbs]))"
    )
    subprocess.run(
        [sys.executable, "-c", program, "compile part.aidl", "check part.aidl", "guide", "doc ring"],
        cwd=tmp_path,
        env={"PATH": os.environ["PATH"], "HOME": str(home), "PYTHONPATH": str(ROOT)},
        capture_output=True,
        check=True,
    )
    assert list(home.iterdir()) == []
