"""Files are read below the root of a project, and nowhere else."""

from __future__ import annotations

from pathlib import Path

import pytest

from aidl_lang.common.world import DiskWorld, FileError, MemoryWorld, ReadFailure, Reads, World


@pytest.fixture(params=["disk", "memory"])
def world(request: pytest.FixtureRequest, tmp_path: Path) -> World:
    files = {"main.aidl": "main", "parts/bolt.aidl": "bolt"}
    if request.param == "memory":
        return MemoryWorld(files)
    for path, text in files.items():
        (tmp_path / "root" / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "root" / path).write_text(text)
    (tmp_path / "secret").write_text("secret")
    return DiskWorld(tmp_path / "root")


def refused(world: World, path: str) -> ReadFailure:
    with pytest.raises(FileError) as caught:
        world.read(path)
    assert caught.value.path == path
    return caught.value.reason


@pytest.mark.parametrize(
    ("path", "reason"),
    [
        ("nut.aidl", ReadFailure.MISSING),
        ("../secret", ReadFailure.OUTSIDE),
        ("parts/../../secret", ReadFailure.OUTSIDE),
        ("/etc/passwd", ReadFailure.OUTSIDE),
        ("..\\secret", ReadFailure.OUTSIDE),
        ("C:\\secret", ReadFailure.OUTSIDE),
        ("", ReadFailure.MISSING),
    ],
)
def test_what_cannot_be_read(world: World, path: str, reason: ReadFailure) -> None:
    assert refused(world, path) is reason


def test_links_lead_nowhere_else(tmp_path: Path) -> None:
    root = tmp_path / "root"
    root.mkdir()
    (tmp_path / "secret").write_text("secret")
    (root / "link").symlink_to(tmp_path / "secret")
    (root / "folder").symlink_to(tmp_path)
    (root / "loop").symlink_to(root / "loop")
    world = DiskWorld(root)
    for path in ("link", "folder/secret"):
        assert refused(world, path) is ReadFailure.OUTSIDE
    for path in ("loop", "a\0b"):
        assert refused(world, path)


def test_a_link_leads_to_no_other_kind_of_file(tmp_path: Path) -> None:
    (tmp_path / ".env").write_text("secret")
    (tmp_path / "bolt.aidl").write_text("bolt")
    (tmp_path / "link.aidl").symlink_to(tmp_path / ".env")
    (tmp_path / "other.aidl").symlink_to(tmp_path / "bolt.aidl")
    assert DiskWorld(tmp_path).read("other.aidl") == "bolt"
    assert refused(DiskWorld(tmp_path), "link.aidl") is ReadFailure.ANOTHER_KIND


def test_a_link_that_comes_between_look_and_read_is_not_followed(tmp_path: Path) -> None:
    root, other = tmp_path / "root", tmp_path / "other"
    for folder in (root / "a" / "b", other):
        folder.mkdir(parents=True)
        (folder / "x.aidl").write_text(folder.name)
    assert Reads().contents(root / "a" / "b" / "x.aidl", below=root) == b"b"
    (root / "a" / "b" / "x.aidl").unlink()
    (root / "a" / "b" / "x.aidl").symlink_to(other / "x.aidl")
    with pytest.raises(OSError, match="symbolic links"):
        Reads().contents(root / "a" / "b" / "x.aidl", below=root)
    (root / "a" / "b").rename(root / "a" / "c")
    (root / "a" / "b").symlink_to(other)
    with pytest.raises(NotADirectoryError):
        Reads().contents(root / "a" / "b" / "x.aidl", below=root)
    assert Reads().contents(root / "a" / "b" / "x.aidl") == b"other"


def test_only_text_is_read(tmp_path: Path) -> None:
    (tmp_path / "bytes").write_bytes(b"\xff\xfe")
    assert refused(DiskWorld(tmp_path), "bytes") is ReadFailure.NOT_TEXT
