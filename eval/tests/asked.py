"""The prompts that come along: what they ask for at once, their requirements read once in a process."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path

import aidl_eval
from aidl_eval import requirements
from aidl_eval.requirements import Prompt

_FILES = sorted(Path(aidl_eval.__file__).with_name("prompts").glob("*.aidl"))
TEXTS = {
    path.stem.split("-", 1)[1]: path.read_text("utf-8").splitlines()[0].removeprefix("/// ")
    for path in _FILES
}
NAMES = tuple(TEXTS)
_load = requirements.load


@cache
def _prompts() -> tuple[Prompt, ...]:
    return _load()


def prompts() -> Mapping[str, Prompt]:
    return {prompt.name: prompt for prompt in _prompts()}


def load(folder: Path | None = None) -> tuple[Prompt, ...]:
    """As `requirements.load`, for many evaluations in one process."""
    return _prompts() if folder is None else _load(folder)
