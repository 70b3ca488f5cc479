"""Builds the folder of the playground, which any static host serves."""

from __future__ import annotations

import gzip
import hashlib
import html
import json
import re
import shutil
import struct
import subprocess
import sys
import tarfile
import urllib.request
import zipfile
from base64 import b64encode
from collections.abc import Iterable, Iterator, Mapping
from importlib.metadata import distribution
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
WEB = ROOT / "web"
PANE = ROOT / "server" / "aidl_server" / "preview" / "pane"

PYODIDE = "0.27.7"
CDN = f"https://cdn.jsdelivr.net/pyodide/v{PYODIDE}/full/"
MANIFOLD = "3.5.4"
_MANIFOLD_DIGEST = (
    "sha512-WWsme5HabwLHVcWPHT9m+s7mdmDVSEvCny+uXH1E7jEc8FbFUgM75C3Dh6NVw57Eeh3Ow7+xHCuXfxDMOemi9A=="
)
_CORE = ("pyodide.mjs", "pyodide.asm.js", "pyodide.asm.wasm", "python_stdlib.zip", "pyodide-lock.json")
"""The files of Python itself."""
_BINARY = {"numpy": "later", "pillow": "exports"}
"""The packages of Pyodide's that are packed, each with the pack of what is not used by the first drawing."""
_LARGE = ("scipy", "openblas")
"""Those that large programs ask for: they stay as they are."""
_PURE = {
    **dict.fromkeys(("lark", "svgwrite", "attrs", "cattrs", "lsprotocol", "pygls"), "later"),
    **dict.fromkeys(("typing-extensions", "fonttools", "rectpack"), "later"),
    **dict.fromkeys(("ezdxf", "reportlab", "pyparsing", "charset-normalizer"), "exports"),
}
"""The packages that are taken as this environment has them."""
_LEFT_OUT = re.compile(
    r"(^|/)(tests|distutils|_pyinstaller|include|__pycache__)/|\.(pyi|c|h|typed|pxd|a|js|html)$"
    r"|^aidl_server/preview/pane/|^reportlab/(fonts|graphics)/|^ezdxf/addons/(dxf2code|drawing|browser|odafc)"
)
"""What nobody asks for in a browser."""
BARE = ("lsprotocol", "pygls", "ezdxf", "fontTools")
"""Packages that are compiled without their docstrings."""


_PATIENCE = 120
"""Seconds for a file from elsewhere."""


class BuildError(Exception):
    """Why there is no playground."""


def built(into: Path, pyodide: str, work: Path) -> None:
    """Builds the playground into a folder. Raises BuildError.

    `pyodide` is a folder or an address with Python for browsers; `work` keeps what was made on the way.
    """
    work.mkdir(parents=True, exist_ok=True)
    is_folder = not pyodide.startswith(("http:", "https:"))
    core = Path(pyodide).resolve() if is_folder else _fetched(pyodide, work)
    manifold = _manifold(work)
    tree, owners = _tree(core, work)
    first = _prepared(core, manifold, tree)
    shutil.rmtree(into, ignore_errors=True)
    into.mkdir(parents=True)
    _write_packs(into, tree, owners, first)
    for name in ("manifold.js", "manifold.wasm"):
        shutil.copyfile(manifold / name, into / name)
    if is_folder:
        _copy_python(core, into / "pyodide")
    _write_licenses(into, tree, manifold)
    _write_page(into, "pyodide/" if is_folder else pyodide.removesuffix("/") + "/")


# --- What others made


def needed(core: Path) -> list[str]:
    """Returns the names of the files of Pyodide's that the playground takes, by the lock in a folder."""
    return [*_CORE, *(_locked(core)[name]["file_name"] for name in (*_BINARY, *_LARGE))]


def _fetched(address: str, work: Path) -> Path:
    """Returns a folder with Python for browsers from an address. Raises BuildError."""
    address = address.removesuffix("/") + "/"
    folder = work / f"pyodide-{hashlib.sha256(address.encode()).hexdigest()[:16]}"
    folder.mkdir(parents=True, exist_ok=True)
    _download(address + "pyodide-lock.json", folder / "pyodide-lock.json")
    for name in needed(folder):
        _download(address + name, folder / name)
    return folder


def _download(address: str, file: Path) -> None:
    if file.exists():
        return
    try:
        with urllib.request.urlopen(address, timeout=_PATIENCE) as answer:
            data = answer.read()
    except OSError as reason:
        raise BuildError(f"{address} cannot be fetched ({reason}): give a folder, PYODIDE=folder") from None
    part = file.with_suffix(".part")
    part.write_bytes(data)
    part.replace(file)


def _locked(core: Path) -> dict[str, dict[str, str]]:
    """Returns what Pyodide's lock says of its packages. Raises BuildError for another version."""
    try:
        lock = json.loads((core / "pyodide-lock.json").read_text("utf-8"))
    except OSError as reason:
        raise BuildError(f"{core} has no Pyodide in it: {reason}") from None
    if (found := lock["info"]["version"]) != PYODIDE:
        raise BuildError(f"{core} has Pyodide {found}; this playground is for {PYODIDE}")
    packages: dict[str, dict[str, str]] = lock["packages"]
    return packages


def _archive(core: Path, name: str) -> Path:
    """Returns a package of Pyodide's, whose digest is that of the lock."""
    known = _locked(core)[name]
    file = core / known["file_name"]
    if hashlib.sha256(file.read_bytes()).hexdigest() != known["sha256"]:
        raise BuildError(f"{file} is not what Pyodide's lock says")
    return file


def _manifold(work: Path) -> Path:
    """Returns the folder of the npm package `manifold-3d`, whose digest is the known one."""
    folder = work / f"manifold-3d-{MANIFOLD}"
    if folder.exists():
        return folder
    command = ["npm", "pack", f"manifold-3d@{MANIFOLD}", "--silent", "--pack-destination", str(work)]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, cwd=work)
    archive = work / f"manifold-3d-{MANIFOLD}.tgz"
    if "sha512-" + b64encode(hashlib.sha512(archive.read_bytes()).digest()).decode() != _MANIFOLD_DIGEST:
        raise BuildError(f"{archive} is not the package that is meant")
    part = work / "manifold.part"
    part.mkdir(exist_ok=True)
    with tarfile.open(archive) as package:
        for name in ("manifold.js", "manifold.wasm", "LICENSE"):
            member = package.extractfile(f"package/{name}")
            assert member is not None
            (part / name).write_bytes(member.read())
    part.rename(folder)
    return folder


def _installed(name: str) -> Iterator[tuple[str, Path]]:
    """Yields the files of a package of this environment, which is the lock's, each with its name in it: the
    Python ones, as compiled ones are for this machine.
    """
    for file in distribution(name).files or ():
        inner = file.as_posix()
        if not (inner.startswith("../") or inner.endswith((".so", ".pyd", ".pyx", ".pyc"))):
            yield inner, Path(str(file.locate()))


def _own_wheels(work: Path) -> list[Path]:
    """Returns the wheels of the product and of its server, built now."""
    folder = work / "own"
    shutil.rmtree(folder, ignore_errors=True)
    command = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    for project in (ROOT, ROOT / "server"):
        subprocess.run(command, check=True, cwd=project, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return sorted(folder.glob("*.whl"))


# --- The packs


def _tree(core: Path, work: Path) -> tuple[Path, dict[str, str]]:
    """Returns a folder with all Python of the page, and the pack of each of its packages."""
    tree = work / "tree"
    shutil.rmtree(tree, ignore_errors=True)
    owners: dict[str, str] = {"aidl_web": "later"}
    for name, pack in _PURE.items():
        for inner, file in _installed(name):
            if not _LEFT_OUT.search(inner):
                owners[re.split(r"[/.]", inner)[0]] = pack
                _put(tree / inner, file.read_bytes())
    wheels = [(_archive(core, name), pack) for name, pack in _BINARY.items()]
    for wheel, pack in [*wheels, *((own, "later") for own in _own_wheels(work))]:
        with zipfile.ZipFile(wheel) as archive:
            for inner in archive.namelist():
                if not (inner.endswith("/") or _LEFT_OUT.search(inner)):
                    owners[re.split(r"[/.]", inner)[0]] = pack
                    _put(tree / inner, archive.read(inner))
    inside = WEB / "aidl_web"
    for file in [inside / "__init__.py", *(inside / "inside").glob("*.py")]:
        _put(tree / "aidl_web" / file.relative_to(inside), file.read_bytes())
    return tree, owners


def _put(file: Path, data: bytes) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_bytes(data)


def _prepared(core: Path, manifold: Path, tree: Path) -> set[str]:
    """Compiles the modules of a tree, and returns those that a first drawing takes."""
    script = [str(WEB / "node" / "prepare.mjs"), str(core), str(manifold), str(tree)]
    done = subprocess.run(["node", *script, *BARE], capture_output=True, text=True, check=False)
    if done.returncode:
        raise BuildError(f"the example is not drawn in Node: {done.stderr[-2000:]}")
    return set(done.stdout.split())


def _write_packs(into: Path, tree: Path, owners: Mapping[str, str], first: set[str]) -> None:
    packs: dict[str, list[str]] = {"first": [], "later": [], "exports": []}
    for file in sorted(path for path in tree.rglob("*") if path.is_file()):
        name = file.relative_to(tree).as_posix()
        top = name.partition("/")[0].partition(".")[0]
        if ".dist-info/" in name or (name.startswith("aidl_lang/_data/examples/") and name.endswith(".aidl")):
            continue
        is_own = name.startswith(("aidl_lang/", "aidl_server/"))
        is_first = name in first or (is_own and not name.endswith(".pyc"))
        packs["first" if is_first else owners.get(top, "later")].append(name)
    for pack, names in packs.items():
        (into / f"{pack}.pack").write_bytes(gzip.compress(_packed(tree, names), 9, mtime=0))


def _packed(tree: Path, names: Iterable[str]) -> bytes:
    """Returns files as one: the length of their table, the table, and the files one after the other."""
    contents = [(name, (tree / name).read_bytes()) for name in names]
    table = json.dumps([(name, len(data)) for name, data in contents], separators=(",", ":")).encode()
    return struct.pack("<I", len(table)) + table + b"".join(data for _, data in contents)


def _copy_python(core: Path, into: Path) -> None:
    into.mkdir()
    for name in _CORE:
        shutil.copyfile(core / name, into / name)
    for name in _LARGE:
        file = _archive(core, name)
        shutil.copyfile(file, into / file.name)


# --- The page

_GROUPS = {"examples": "Examples", "examples/gallery": "Gallery", "examples/workshop": "Workshop"}
_NONCE = "aidl"
"""Of the style sheet that the editor of the text makes for itself."""
_POLICY = (
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; "
    "style-src 'self' 'nonce-{nonce}'; connect-src 'self'; img-src 'self' data: blob:; font-src 'self'; "
    "base-uri 'none'; form-action 'none'"
)
"""What the page may load: nothing of others. Python from elsewhere is loaded by the worker, which has no
policy.
"""


def _write_page(into: Path, python: str) -> None:
    """Writes the page, its scripts and its examples. `python` is the address of Python, relative to the
    page.
    """
    shutil.copytree(PANE, into / "pane", ignore=shutil.ignore_patterns("index.html", "*.d.ts"))
    for file in sorted((WEB / "page").iterdir()):
        if file.suffix in (".js", ".css") and file.name != "service.js":
            shutil.copyfile(file, into / file.name)
    _write(into / "place.js", f"/** Where Python is. */\nexport const PYTHON = {json.dumps(python)};\n")
    _write(into / "index.html", _index())
    _write(into / "examples.json", json.dumps(list(_examples(into)), ensure_ascii=False))
    names = sorted(path.relative_to(into).as_posix() for path in into.rglob("*") if path.is_file())
    kept = [name for name in names if not re.search(r"/(scipy|openblas)-", name)]
    digest = hashlib.sha256()
    for name in kept:
        digest.update(f"{name}\n".encode() + (into / name).read_bytes())
    values = {"version": digest.hexdigest()[:16], "files": json.dumps(["./", *kept]), "python": python}
    _write(into / "service.js", _filled((WEB / "page" / "service.js").read_text("utf-8"), values))


def _index() -> str:
    """Returns the page: the pane's, with what the playground has beside it."""
    text = (PANE / "index.html").read_text("utf-8")
    pieces = dict(
        re.findall(
            r"<!-- (\w+) -->\n(.*?)(?=<!-- |\Z)", (WEB / "page" / "pieces.html").read_text("utf-8"), re.DOTALL
        )
    )
    for mark, piece in (
        ('    <script type="module" nonce="{{nonce}}" src="{{root}}main.js"></script>\n', pieces["head"]),
        ('      <h1 id="name" class="name">', pieces["programs"]),
        ('      <div id="history" class="group end" hidden>\n', pieces["stop"]),
        ('        <div class="menu">\n          <button id="export-button"', pieces["share"]),
        ('        <div class="scale" aria-hidden="true">', pieces["starting"]),
        ('        <div id="stale" class="banner warning"', pieces["held"]),
        ("    </svg>\n\n    <header", pieces["symbols"]),
    ):
        if text.count(mark) != 1:
            raise BuildError(f"the pane's page has no place for {mark.strip()!r}")
        text = text.replace(mark, piece if "main.js" in mark else piece + mark)
    text = text.replace('class="name">AIDL<', 'class="name">Playground<')
    values = {"csp": _POLICY.format(nonce=_NONCE), "root": "pane/", "nonce": _NONCE, "socket": "", "uri": ""}
    return _filled(text, {name: html.escape(value) for name, value in values.items()})


def _filled(text: str, values: Mapping[str, str]) -> str:
    for name, value in values.items():
        text = text.replace(f"{{{{{name}}}}}", value)
    return text


def _examples(into: Path) -> Iterator[dict[str, str]]:
    """Copies the examples, and yields what the menu tells of each."""
    for folder, group in _GROUPS.items():
        for file in sorted((ROOT / folder).glob("*.aidl")):
            target = f"{folder}/{file.name}"
            _put(into / target, file.read_bytes())
            yield {"group": group, "name": file.stem, "title": file.stem.replace("_", " "), "file": target}


def _write(file: Path, text: str) -> None:
    file.write_text(text, "utf-8", newline="\n")


def _write_licenses(into: Path, tree: Path, manifold: Path) -> None:
    """Writes the licenses of what others made, one after the other."""
    parts = [("manifold-3d", manifold / "LICENSE")]
    for file in sorted(tree.glob("*.dist-info/**/*")):
        if file.is_file() and re.match(r"licen[sc]e|copying|notice", file.name, re.IGNORECASE):
            parts.append((file.relative_to(tree).parts[0].partition("-")[0], file))
    texts = [
        f"{name}\n{'=' * len(name)}\n\n{file.read_text('utf-8', 'replace').strip()}\n" for name, file in parts
    ]
    python = "Python for browsers: Pyodide, Mozilla Public License 2.0, https://github.com/pyodide/pyodide\n"
    _write(into / "licenses.txt", "\n\n".join([python, *texts]))
