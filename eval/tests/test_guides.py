"""The guides of all languages: alike in what they have, with programs that run, none of them of a prompt."""

from __future__ import annotations

import re
from argparse import ArgumentParser

import pytest

from aidl_eval import plan
from aidl_eval.plan import VARIANTS
from aidl_eval.rendering import RenderedLanguage
from aidl_lang.common.source import SourceFile
from aidl_lang.pipeline import compile
from aidl_lang.tools.cli.generate import register_eval
from aidl_lang.tools.llm import generation
from aidl_lang.tools.llm.aidl import Aidl
from eval.tests.asked import prompts
from tests.amount import TRIES_ALL

THINGS = ("storm lantern", "excavator", "city tram")
_FILLING = {"a", "an", "and", "of", "old", "school", "pair", "with", "the"}


def programs(name: str) -> list[str]:
    fences = "|".join(VARIANTS[name].fences)
    found = re.findall(rf"^```(?:{fences})\n(.*?)^```", VARIANTS[name].guide(), re.S | re.M)
    return [program for program in found if any(thing in program for thing in THINGS)]


@pytest.mark.parametrize("name", VARIANTS)
def test_each_guide_has_the_same_two_things(name: str) -> None:
    found = programs(name)
    first = "excavator" if name == "full" else "storm lantern"
    assert [next(t for t in THINGS if t in program) for program in found] == [first, "city tram"]
    for program in found:
        assert 30 <= len(program.splitlines()) <= 115


@pytest.mark.parametrize("name", ["full", "openscad", "build123d", "cadquery", "svg"])
def test_its_programs_run(name: str) -> None:
    """Those of the guides to subsets of AIDL are run in `tests/test_variants.py`."""
    language = VARIANTS[name]
    if isinstance(language, RenderedLanguage) and (why := language.missing()) is not None:
        pytest.skip(f"{name}: {why}")
    is_dear = isinstance(language, RenderedLanguage) and not TRIES_ALL  # engines of others take seconds
    for program in programs(name)[: 1 if is_dear else None]:
        if isinstance(language, RenderedLanguage):
            rendered = language.run(program)[0] if TRIES_ALL else language.judged(program)
            assert (rendered.errors, rendered.warnings) == ((), ())
            assert not TRIES_ALL or len(rendered.regions.parts) >= 12  # each is run by itself
        else:
            assert compile(SourceFile("a.aidl", program)).ok


@pytest.mark.parametrize("name", VARIANTS)
def test_no_guide_draws_what_is_asked_for(name: str) -> None:
    for program in re.findall(r"```\w*\n(.*?)```", VARIANTS[name].guide(), re.S):
        titles = re.findall(r"^\s*(?:///?|#|<!--) (.*)|^(?:assembly|solid|module|def) (\w+)", program, re.M)
        heads = " ".join(" ".join(title) for title in titles[:2]).casefold()
        for prompt in prompts().values():
            words = set(re.findall(r"[a-z]+", prompt.text.casefold())) - _FILLING
            if prompt.name not in ("house", "table_lamp"):  # a house's roof is no house
                assert not words <= set(re.findall(r"[a-z]+", heads)), (name, prompt.text)


def test_a_plan_has_help_or_none() -> None:
    for has_help in (True, False):
        language = plan.asked((), ("full",), 1, generation.Settings(), has_help).language("full")
        assert language == Aidl(helps=has_help)


def test_help_can_be_switched_off() -> None:
    slip = "solid a { c = circle(radus: 3) }"
    helped = Aidl().conversation().judge(slip)
    bare = Aidl(helps=False).conversation().judge(slip)
    assert (helped.ok, bare.ok, bare.fixes, bare.program) == (True, False, (), slip)
    plan = "assembly a { solid b { todo } solid c { d = circle(radius: 3) } }"
    assert Aidl().conversation().judge(plan).is_partial
    taken = Aidl(helps=False).conversation().judge(plan)
    assert (taken.ok, taken.is_partial) == (True, False)
    first = "assembly a { solid b { c = circle(radius: 3) } solid d { e = circle(radius: 4) } }"
    last = "assembly a { solid b { c = circle(radius: 3) } }"
    for language, restored in ((Aidl(), True), (Aidl(helps=False), False)):
        conversation = language.conversation()
        conversation.judge(first)
        verdict = conversation.finish(conversation.judge(last))
        assert ("solid d" in verdict.program) == restored


def test_the_command_knows_the_same_variants() -> None:
    """It repeats their names, so that it starts without the languages."""
    parser = ArgumentParser()
    register_eval(parser)
    choices = next(action.choices for action in parser._actions if action.dest == "variants")
    assert sorted(choices or ()) == sorted(VARIANTS)
