"""The plan of an evaluation: every prompt in every language variant, several times."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from aidl_eval.openscad import OpenScad
from aidl_eval.python_cad import PythonCad
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


GUIDE = "guide of "
"""What names of settings begin with that tell the guide of a language, or of a conversation."""


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
    """The conversations to be had. `settings.sampling.seed` is that of the first run; each further one counts
    up from it. Without help no program in AIDL is mended, added to, or taken as a plan. `facts` are what
    results in one folder have in common besides, and what their readers must know.
    """

    prompts: Sequence[Prompt]
    jobs: Sequence[Job]
    settings: Settings
    has_help: bool
    facts: Mapping[str, str]

    def language(self, variant: str) -> Language:
        """Returns a language with the help that this plan gives."""
        language = VARIANTS[variant]
        return replace(language, helps=self.has_help) if isinstance(language, Aidl) else language

    def prompt(self, job: Job) -> Prompt:
        return next(prompt for prompt in self.prompts if prompt.name == job.prompt)

    def sampled(self, job: Job) -> Settings:
        """Returns the settings of a job, with its own seed."""
        first = self.settings.sampling.seed
        seed = None if first is None else first + job.run - 1
        return replace(self.settings, sampling=replace(self.settings.sampling, seed=seed))


def asked(
    prompts: Sequence[Prompt], variants: Sequence[str], runs: int, settings: Settings, has_help: bool
) -> Plan:
    """Returns the plan to ask a model, the first run of everything first."""
    jobs = [Job(p.name, v, run) for run in range(1, runs + 1) for p in prompts for v in variants]
    guides = {f"{GUIDE}{name}": digest(VARIANTS[name].guide()) for name in variants}
    return Plan(prompts, jobs, settings, has_help, guides)


def digest(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()[:16]
