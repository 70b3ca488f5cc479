"""The plan of an evaluation: every prompt in every language variant, several times."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from aidl_eval.openscad import OpenScad
from aidl_eval.python_cad import PythonCad
from aidl_eval.rendering import Wrapped
from aidl_eval.requirements import Prompt
from aidl_eval.svg import Svg
from aidl_lang.checking.subset import Variant
from aidl_lang.tools.llm.aidl import Aidl
from aidl_lang.tools.llm.generation import Settings
from aidl_lang.tools.llm.messages import Language

VARIANTS: dict[str, Language] = {
    **{str(variant): Aidl(variant) for variant in Variant},
    "openscad": OpenScad(),
    "build123d": PythonCad("build123d"),
    "cadquery": PythonCad("cadquery"),
    "svg": Svg(),
}
"""All languages by name. To add one, see `rendering.RenderedLanguage`."""


@dataclass(frozen=True)
class Switches:
    """The help that a conversation has. Without a guide a model is told the name of the language alone."""

    guide: bool = True
    mends: bool = True
    recovers: bool = True
    plans: bool = True


class Guideless(Wrapped):
    """A language without its guide."""

    def guide(self) -> str:
        name = _NAMES.get(self.name, "AIDL")
        fence = self.fences[0]
        block = f"Answer with the whole program in one ```{fence} block."
        return f"You write programs in {name} that draw flat parts. {block}\n"


_NAMES = {
    "openscad": "OpenSCAD",
    "build123d": "Python with build123d",
    "cadquery": "Python with CadQuery",
    "svg": "SVG",
}


@dataclass(frozen=True, order=True)
class Job:
    """One conversation: prompt and variant by name, runs counted from 1."""

    prompt: str
    variant: str
    run: int

    @property
    def key(self) -> str:
        return f"{self.prompt}/{self.variant}/{self.run}"


def key_of(record: Mapping[str, Any]) -> str:
    """Returns the key of the job that a record is about."""
    return Job(record["prompt"], record["variant"], record["run"]).key


@dataclass(frozen=True)
class Plan:
    """`settings.sampling.seed` is that of the first run; each further one counts up from it."""

    prompts: tuple[Prompt, ...]
    variants: tuple[str, ...]
    runs: int
    settings: Settings
    switches: Switches = field(default_factory=Switches)

    def language(self, variant: str) -> Language:
        """Returns a language with the help that this plan gives."""
        language, on = VARIANTS[variant], self.switches
        if isinstance(language, Aidl):
            language = replace(language, mends=on.mends, recovers=on.recovers, plans=on.plans)
        return language if on.guide else Guideless(language)

    def jobs(self) -> Iterator[Job]:
        """Yields all jobs, the first run of everything first."""
        for run in range(1, self.runs + 1):
            for prompt in self.prompts:
                for variant in self.variants:
                    yield Job(prompt.name, variant, run)

    def prompt(self, job: Job) -> Prompt:
        return next(prompt for prompt in self.prompts if prompt.name == job.prompt)

    def sampled(self, job: Job) -> Settings:
        """Returns the settings of a job, with its own seed."""
        first = self.settings.sampling.seed
        seed = None if first is None else first + job.run - 1
        return replace(self.settings, sampling=replace(self.settings.sampling, seed=seed))
