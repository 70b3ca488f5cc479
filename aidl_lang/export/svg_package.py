"""Loads `svgwrite` without the modules that drawings do not use, which triple its loading time."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib import import_module
from types import ModuleType
from typing import Any


def svgwrite() -> Any:
    """Loads the package `svgwrite` when the first drawing is written.

    It imports the protocols of the web, to embed fonts and style sheets by their address, and a parser that
    checks the values of attributes (`debug=True`); both are loaded if they are ever called.
    """
    if "svgwrite" not in sys.modules:
        values = ("is_valid_transferlist", "is_valid_pathdata", "is_valid_animation_timing")
        with _loaded_later("urllib.request", "urlopen"), _loaded_later("svgwrite.data.svgparser", *values):
            import_module("svgwrite")
    return import_module("svgwrite")


@contextmanager
def _loaded_later(name: str, *functions: str) -> Iterator[None]:
    """Replaces a module that is not loaded: functions imported from it meanwhile load it when they are
    called.
    """
    if name in sys.modules:
        yield
        return
    stand_in = _StandIn(name)
    for function in functions:
        setattr(stand_in, function, _calling(name, function))
    sys.modules[name] = stand_in
    try:
        yield
    finally:
        _remove(stand_in)


def _calling(name: str, function: str) -> Callable[..., Any]:
    def call(*args: Any, **named: Any) -> Any:
        return getattr(import_module(name), function)(*args, **named)

    return call


class _StandIn(ModuleType):
    """A placeholder module that gives way to the real one when another thread asks for anything else in
    it.
    """

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        _remove(self)
        return getattr(import_module(self.__name__), name)


def _remove(stand_in: ModuleType) -> None:
    if sys.modules.get(stand_in.__name__) is stand_in:
        del sys.modules[stand_in.__name__]
