"""What is in the extension's package, and that its version is AIDL's."""

from __future__ import annotations

import json
import zipfile
from pathlib import Path

import pytest

from aidl_lang.version import __version__
from tests.documents import ROOT

EXTENSION = ROOT / "editors" / "vscode"
PANE = ROOT / "server" / "aidl_server" / "preview" / "pane"


def test_the_version_is_that_of_aidl():
    manifest = json.loads((EXTENSION / "package.json").read_text())
    lock = json.loads((EXTENSION / "package-lock.json").read_text())
    assert manifest["version"] == lock["version"] == lock["packages"][""]["version"] == __version__
    assert f"## {__version__}" in (EXTENSION / "CHANGELOG.md").read_text()


@pytest.fixture(scope="module")
def package(vsix: Path) -> dict[str, bytes]:
    """Content by name."""
    with zipfile.ZipFile(vsix) as archive:
        return {name: archive.read(name) for name in archive.namelist() if not name.endswith("/")}


def test_it_holds_what_the_manifest_names(package):
    manifest = json.loads(package["extension/package.json"])
    assert manifest["version"] == __version__
    contributes = manifest["contributes"]
    (language,) = contributes["languages"]
    named = [manifest["main"], manifest["icon"], language["configuration"], *language["icon"].values()]
    named += [each["path"] for kind in ("grammars", "snippets") for each in contributes[kind]]
    assert {f"extension/{name.removeprefix('./')}" for name in named} <= package.keys()


def test_the_pane_in_it_is_the_one_in_the_tree(package):
    own = {file.name: file.read_bytes() for file in PANE.iterdir() if not file.name.endswith(".d.ts")}
    for name in ("editor.js", "editor.LICENSES.txt", "words.js"):  # the text is in VS Code's own editor
        del own[name]
    prefix = "extension/media/pane/"
    packed = {name.removeprefix(prefix): data for name, data in package.items() if name.startswith(prefix)}
    assert packed == own


def test_the_licence_is_that_of_aidl(package):
    assert package["extension/LICENSE.txt"] == (ROOT / "LICENSE").read_bytes()


def test_it_holds_nothing_else_and_stays_small(package):
    folders = {name.split("/")[1] for name in package if name.count("/") > 1}
    assert folders == {"dist", "icons", "images", "media", "snippets", "syntaxes"}
    assert [name for name in package if name.startswith("extension/dist/")] == ["extension/dist/extension.js"]
    assert not [name for name in package if name.endswith((".ts", ".map", ".mjs"))]
    assert sum(map(len, package.values())) < 1_500_000


def test_it_knows_no_path_of_the_machine_that_built_it(package):
    assert not [name for name, data in package.items() if str(ROOT).encode() in data]
