"""The standard library and its cache."""

from __future__ import annotations

import os
import pickle
from pathlib import Path

import pytest

from aidl_lang import ast, library, parser, resources
from aidl_lang.resolve import resolve
from aidl_lang.source import SourceFile
from aidl_lang.typecheck import check

SMALL = """
let half = 0.5
alias box = rectangle
shape rectangle(width: length, height: length) { edge = line((0, 0), (width, height * half)) }
shape rectangle(size: length) { inner = rectangle(width: size, height: size) }
constraint above(a: box, b: box, gap = 0) { a.bottom == b.top + gap }
solid washer(outer = 3) { rim = circle(radius: outer) }
"""


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty cache, and a small library beside it."""
    stdlib = tmp_path / "stdlib"
    stdlib.mkdir()
    (stdlib / "small.aidl").write_text(SMALL)
    real = resources.resource
    monkeypatch.setattr(resources, "resource", lambda name: stdlib if name == "stdlib" else real(name))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path / "aidl"


def fresh() -> library.Library:
    return library.load.__wrapped__()


def files(cache: Path) -> list[Path]:
    return sorted(cache.glob("library-*"))


def test_the_library_itself_checks_clean() -> None:
    """As one program, since its files use each other."""
    text = "\n".join(source.text for source in library.load().sources)
    parsed = parser.parse(SourceFile("stdlib", text))
    program = check(resolve(parsed.module, None, library.from_modules([])))
    found = [*parsed.diagnostics, *program.diagnostics, *(v.diagnostic({}) for v in program.violations)]
    assert [(d.message, d.span and d.span.source.line(d.span.line)) for d in found] == []


def test_what_was_kept_is_what_was_parsed(cache: Path) -> None:
    cold, warm = fresh(), fresh()
    assert len(files(cache)) == 1
    assert isinstance(cold.callables, dict)
    assert not isinstance(warm.callables, dict)
    assert list(cold.callables) == list(warm.callables)
    assert (dict(cold.aliases), list(cold.constants)) == (dict(warm.aliases), list(warm.constants))
    for name, overloads in cold.callables.items():
        for a, b in zip(overloads, warm.callables[name], strict=True):
            assert (a.name, a.parameters) == (b.name, b.parameters)
            assert ast.same(a.node, b.node)
            assert a.node is not None
            assert b.node is not None
            assert (a.node.span.start, b.node.span.source.name) == (
                b.node.span.start,
                a.node.span.source.name,
            )
    assert ast.same(cold.modules[0], warm.modules[0])


def test_definitions_are_decoded_once_and_when_asked_for(cache: Path) -> None:
    fresh()
    warm = fresh()
    assert warm.callables["rectangle"] is warm.callables["rectangle"]


def test_a_changed_library_is_parsed_anew(cache: Path) -> None:
    fresh()
    (old,) = files(cache)
    (cache.parent / "stdlib" / "more.aidl").write_text("fn more(n) = n + 1")
    assert "more" in fresh().callables
    (new,) = files(cache)
    assert old != new


def test_a_warm_start_parses_nothing(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    known = set(fresh().callables)
    monkeypatch.setattr(library, "_parse", None)
    assert known
    assert set(fresh().callables) == known


@pytest.mark.parametrize("damage", [b"", b"nonsense", None])
def test_a_damaged_cache_is_parsed_anew(cache: Path, damage: bytes | None) -> None:
    fresh()
    (kept,) = files(cache)
    whole = kept.read_bytes()
    kept.write_bytes(whole[: len(whole) // 2] if damage is None else damage)
    assert "rectangle" in fresh().callables
    assert kept.read_bytes() == whole


def test_a_damaged_tree_is_parsed_anew(cache: Path) -> None:
    fresh()
    (kept,) = files(cache)
    whole = bytearray(kept.read_bytes())
    for place in range(len(whole) // 2, len(whole)):  # the trees, not the index before them
        whole[place] ^= 1
    kept.write_bytes(whole)
    damaged = fresh()
    parsed = library.from_modules(damaged.modules)
    for name, overloads in parsed.callables.items():
        assert [str(s) for s in damaged.callables[name]] == [str(s) for s in overloads]
    for name, constant in parsed.constants.items():
        assert ast.same(damaged.constants[name], constant)


def test_a_cache_that_others_can_write_is_not_opened(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    fresh()
    (kept,) = files(cache)
    kept.chmod(0o666)
    opened: list[bytes] = []
    monkeypatch.setattr(library, "_from_cache", lambda blob, sources: opened.append(blob))
    fresh()
    assert opened == []
    cache.chmod(0o777)
    fresh()
    assert opened == []


def test_a_link_in_place_of_the_cache_is_not_followed(cache: Path, tmp_path: Path) -> None:
    fresh()
    (kept,) = files(cache)
    elsewhere = tmp_path / "elsewhere"
    kept.rename(elsewhere)
    kept.symlink_to(elsewhere)
    assert isinstance(fresh().callables, dict)


class _Harm:
    def __reduce__(self) -> tuple[object, tuple[str]]:
        return os.system, ("exit 1",)


def test_only_syntax_trees_are_decoded() -> None:
    with pytest.raises(pickle.UnpicklingError):
        library._Trees(pickle.dumps(_Harm()), ()).load()


def test_no_place_for_a_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(blocked))
    assert "rectangle" in fresh().callables
