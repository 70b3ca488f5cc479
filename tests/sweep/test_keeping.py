"""The cache of outcomes: what it keeps, and what it does not let another do."""

from __future__ import annotations

import multiprocessing
import pickle
import sqlite3
import zlib
from collections.abc import Callable
from pathlib import Path

import pytest

from aidl_lang.common.diagnostics import AidlError
from aidl_lang.tools.sweeping import keeping
from aidl_lang.tools.sweeping.bundle import Bundle, Change, Fault, Outcome
from aidl_lang.tools.sweeping.keeping import Store
from aidl_lang.tools.sweeping.working import Making

MAKING = Making((".dxf",))
OUTCOME = Outcome(
    "solved",
    True,
    (Fault("W0714", "a piece", "label", "text", "lib.aidl", 3),),
    {"width": 60.0, "name": "Ada", "hollow": False},
    {"area": 12.5, "bodies": 1, "wall": None},
    (Change("s.body.width", 3.0, 4.0),),
    2,
    0,
    0.25,
    {".dxf": (b"\0\xff" * 40_000, b"two")},
    b"\x89PNG",
)


def nothing_read(path: str) -> str:
    raise AssertionError(path)


def test_it_holds_only_while_the_files_are_as_they_were(tmp_path: Path) -> None:
    store = Store(tmp_path / "cache")
    store.put("key", OUTCOME, {"lib.aidl": "digest"})
    assert store.get("key", lambda path: "digest") == OUTCOME
    assert store.get("key", lambda path: "another") is None


class Planted:
    def __reduce__(self) -> tuple[object, ...]:
        return Path.touch, (Path(str(marker)),)


marker = ""


@pytest.mark.parametrize(
    "kind", ["pickle in the value", "pickle in a file", "pickled key", "no JSON", "other JSON", "bomb"]
)
def test_what_somebody_plants_is_not_believed(
    tmp_path: Path, kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    global marker
    monkeypatch.setattr(keeping, "_LONGEST", 1 << 20)
    marker = str(tmp_path / "ran")
    folder = tmp_path / "cache"
    store = Store(folder)
    store.put("key", OUTCOME, {})
    store.close()
    evil = pickle.dumps(Planted())
    (tmp_path / "evil.val").write_bytes(evil)
    values = {
        "pickle in the value": (4, None, evil),
        "pickle in a file": (4, "../evil.val", None),
        "pickled key": (4, None, evil),
        "no JSON": (1, None, b"hello"),
        "other JSON": (1, None, zlib.compress(b'{"reads": {}, "outcome": {"status": 3}}')),
        "bomb": (1, None, zlib.compress(b" " * (2 << 20))),
    }
    mode, filename, value = values[kind]
    with sqlite3.connect(folder / "cache.db") as database:
        database.execute("UPDATE Cache SET mode = ?, filename = ?, value = ?", (mode, filename, value))
        if kind == "pickled key":
            database.execute("UPDATE Cache SET key = ?, raw = 0", (evil,))
    database.close()
    store = Store(folder)
    assert store.get("key", nothing_read) is None
    assert not (tmp_path / "ran").exists()
    store.put("key", OUTCOME, {})
    assert store.get("key", nothing_read) == OUTCOME
    assert (tmp_path / "evil.val").exists()


def test_dropping_removes_no_file_outside(tmp_path: Path) -> None:
    victim = tmp_path / "precious.txt"
    victim.write_text("mine")
    store = Store(tmp_path / "cache", size=50_000)
    store.put("key", OUTCOME, {})
    with sqlite3.connect(tmp_path / "cache" / "cache.db") as database:
        database.execute("UPDATE Cache SET filename = '../precious.txt', size = 1000000")
    database.close()
    for number in range(4):
        store.put(f"{number}", OUTCOME, {})
    assert store.get("key", nothing_read) is None
    assert victim.read_text() == "mine"


def _fill(folder: str, first: int, begin: Callable[[], object]) -> None:
    store = Store(Path(folder))
    begin()
    for number in range(first, first + 10):
        store.put(f"{number}", Outcome("solved", True, asserts=number), {})


def test_processes_share_it(tmp_path: Path) -> None:
    """This one and another, at the same time."""
    context, folder = multiprocessing.get_context("spawn"), str(tmp_path / "cache")
    begun = context.Event()
    other = context.Process(target=_fill, args=(folder, 0, begun.set))
    other.start()
    _fill(folder, 5, lambda: begun.wait(60))
    other.join()
    assert other.exitcode == 0
    store = Store(tmp_path / "cache")
    found = [store.get(f"{number}", nothing_read) for number in range(15)]
    assert [each and each.asserts for each in found] == list(range(15))


def test_folders_that_are_no_cache_are_left_alone(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(AidlError) as raised:
        Store(tmp_path)
    assert raised.value.diagnostic.message == f"`{tmp_path}` cannot keep outcomes: it holds other files"
    with pytest.raises(AidlError):
        keeping.remove(tmp_path)
    (tmp_path / "link").symlink_to(tmp_path / "cache")
    Store(tmp_path / "cache").close()
    with pytest.raises(AidlError):
        keeping.remove(tmp_path / "link")
    (tmp_path / "broken").mkdir()
    (tmp_path / "broken" / "cache.db").write_bytes(b"no database" * 100)
    with pytest.raises(AidlError) as raised:
        Store(tmp_path / "broken")
    assert raised.value.diagnostic.code == "E0974"
    with pytest.raises(AidlError):
        Store(tmp_path / "notes.txt" / "cache")


def test_the_key_has_all_that_an_outcome_depends_on() -> None:
    from aidl_lang.export.job import Options

    def made(text: str = "a", making: Making = MAKING, **params: float | str | bool) -> str:
        return keeping.key(Bundle("p.aidl", text, {}), params, making)

    keys = [
        made(),
        made("b"),
        made(w=1.0),
        made(w="1.0"),
        made(w=2.0),
        made(v=1.0),
        made(making=Making((".svg",))),
        made(making=Making((".dxf",), Options(kerf=0.1))),
        made(making=Making((".dxf",), Options(show=frozenset(["dof", "names"])))),
        made(making=Making((".dxf",), best_effort=True)),
        made(making=Making((".dxf",), picture=10)),
    ]
    assert len(set(keys)) == len(keys)
    assert made(making=Making((), Options(show=frozenset(["a", "b"])))) == made(
        making=Making((), Options(show=frozenset(["b", "a"])))
    )
