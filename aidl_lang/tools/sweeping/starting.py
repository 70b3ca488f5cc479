"""The beginnings of a sweep that the command line and Python have in common: the program, and the engine by
name.
"""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from pathlib import PurePath

from aidl_lang import pipeline
from aidl_lang.building.model import Knob
from aidl_lang.common.diagnostics import AidlError, Diagnostic, has_errors
from aidl_lang.common.processes import Engine, Guarded, count
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import World
from aidl_lang.tools.sweeping.axes import Value, spelled
from aidl_lang.tools.sweeping.bundle import Bundle, Gathering
from aidl_lang.tools.sweeping.plan import Plan, Variant

LOCAL = "local"
_WORKING = "aidl_lang.tools.sweeping.working"
_WARM = "aidl_lang.tools.sweeping.warm"


def opened(
    source: SourceFile, world: World | None, settings: pipeline.Settings
) -> tuple[Bundle, Gathering, tuple[Knob, ...]]:
    """Returns a program as it travels, the files that it may ask for, and its params. Raises AidlError for a
    program that is wrong as written.
    """
    from aidl_lang.common.world import MemoryWorld

    gathering = Gathering(world or MemoryWorld({}))
    knobs, found = pipeline.knobs(source, gathering, settings)
    if has_errors(found):
        raise AidlError(*(d for d in found if d.is_error))
    return Bundle(source.name, source.text, dict(gathering.files), settings), gathering, knobs


_PACKAGES = {".dxf": "ezdxf", ".pdf": "reportlab.pdfgen.canvas", ".png": "resvg_py"}
"""Packages that take long to load, by what is written with them."""


def preloads(names: Sequence[str]) -> list[str]:
    """Returns the modules that workers load at the start, for outputs of some names."""
    suffixes = {PurePath(name).suffix.lower() for name in names}
    if suffixes & {".html", ".pdf", ".png"}:
        suffixes.add(".png")  # the pictures on a sheet
    return [_WORKING, _WARM, *(package for suffix, package in _PACKAGES.items() if suffix in suffixes)]


def engine(
    name: str, jobs: int | None = None, most: int | None = None, outputs: Sequence[str] = ()
) -> Engine:
    """Returns an engine: `local` for processes of this machine, or the address of a scheduler of Dask. `jobs`
    says how many processes, `most` how many there is work for, `outputs` what they write. Raises AidlError.
    """
    if name == LOCAL:
        wanted = jobs or count()
        return Guarded(max(1, min(wanted, most or wanted)), preloads(outputs))
    from aidl_lang.common.cluster import Cluster

    if jobs is not None:
        message = "the workers of a cluster are as many as it has"
        raise AidlError(Diagnostic("E0976", message, hints=("leave out the number of jobs",)))
    return Cluster(name, _WORKING)


def reproducing(
    program: str,
    plan: Plan,
    variant: Variant,
    name: str,
    options: Sequence[str] = (),
    *,
    verb: str = "compile",
) -> str:
    """Returns the command that makes one variant alone, for a POSIX shell."""
    words = ["aidl", verb, f"./{program}" if program.startswith("-") else program]
    for path, given in variant.values.items():
        words += ["-D", f"{path}={_written(spelled(plan.knobs.get(path), given))}"]
    words += options
    return joined([*words, "-o", name] if name else [*words, "-o", "variant.svg"])


def _written(given: Value) -> str:
    from aidl_lang.tools.sweeping.axes import shown

    return repr(given) if isinstance(given, float) and not given.is_integer() else shown(given)


def joined(words: Sequence[str]) -> str:
    """Returns words as a shell reads them; one with characters that a terminal does not show is written
    `$'…'`.
    """
    return " ".join(shlex.quote(word) if word.isprintable() else _escaped(word) for word in words)


def _escaped(word: str) -> str:
    def one(character: str) -> str:
        if character in "'\\":
            return f"\\{character}"
        if character.isprintable():
            return character
        return "".join(f"\\x{byte:02x}" for byte in character.encode("utf-8", "surrogateescape"))

    # bash takes as many hexadecimal digits after \x as there are, at most two
    return "$'" + "".join(map(one, word)) + "'"
