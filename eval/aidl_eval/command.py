"""`aidl eval`: how well a model does with the language and with subsets of it, over prompts and runs."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from aidl_lang.common.names import nearest
from aidl_lang.common.prose import counted, did_you_mean
from aidl_lang.tools.cli import files, serving
from aidl_lang.tools.cli.files import UseError, say, show
from aidl_lang.tools.cli.options import add_provider, count_to, flag, provider, sampling, value

if TYPE_CHECKING:
    from aidl_eval.plan import Plan
    from aidl_eval.requirements import Prompt
    from aidl_eval.run import Ask, Done
    from aidl_eval.store import Store
    from aidl_lang import SourceFile
    from aidl_lang.common.world import World

_USUAL = ("full", "no-hierarchy", "no-constraints", "openscad")
_VARIANTS = (*_USUAL, "paper", "build123d", "cadquery", "svg")
_RUNS = 3
_OF_MODELS = ("provider", "model", "base_url", "seed", "temperature", "max_tokens", "constrain", "price")
"""Options that a recording has no use for."""


def register(parser: argparse.ArgumentParser) -> None:
    value(parser, "--out", "DIR", "folder of the results (default: evaluation)", str, "evaluation")
    parser.add_argument("--prompts", nargs="+", metavar="NAME", help="those of that name (default: all)")
    about = "where prompts are read from (default: those that come along)"
    value(parser, "--prompt-folder", "DIR", about)
    parser.add_argument(
        "--variants",
        nargs="+",
        choices=_VARIANTS,
        default=list(_USUAL),
        metavar="NAME",
        help=f"some of {', '.join(_VARIANTS)} (default: the first four)",
    )
    many = count_to(10_000)
    value(parser, "--runs", "N", "of each prompt in each variant (default: 3; of a recording all)", many)
    value(parser, "--attempts", "N", "replies in a conversation (default: 5)", many, 5)
    value(parser, "--jobs", "N", "at a time (default: 4)", many, 4)
    about = "for judging a program, for drawing and for editing it (default: 60)"
    value(parser, "--time-limit", "SECONDS", about, many, 60)
    about = "the machine mends no program in AIDL, puts nothing back, and takes none as a plan"
    flag(parser, "--unaided", about)
    value(parser, "--clip-weights", "FILE", "weights of CLIP, ViT-B/32 (default: $AIDL_CLIP_WEIGHTS)")
    instead = parser.add_mutually_exclusive_group()
    flag(instead, "--report", "ask nothing: report on the runs that are there")
    about = "ask nothing: take the replies from a recording, a file of JSON Lines or a folder of such"
    value(instead, "--replay", "PLACE", about)
    about = "ask nothing: solve programs, or those of recordings, with parts of the solver left out as well"
    value(instead, "--solver", "PLACE", about, nargs="+")
    add_provider(parser)
    parser.set_defaults(run=run)
    _add_study(parser)


def _add_study(parser: argparse.ArgumentParser) -> None:
    """Adds `study`, which takes none of the options of a run."""
    own = parser.add_subparsers(title="instead of a run", metavar="[study]").add_parser(
        "study",
        help="have people rank the pictures on a local page: `aidl eval study --help`",
        description="`aidl eval study`: people rank pictures on a local page, without knowing what language "
        "drew which.",
        epilog="Answers go to study.jsonl in the folder, one line each, and into the tables of `aidl eval "
        "--report --out FOLDER`. Only this machine, and who has the address that is printed, sees the page.",
    )
    own.add_argument("folder", metavar="FOLDER", help="that of the results: `--out` of `aidl eval`")
    serving.add_options(own)
    known = {"run", *vars(own.parse_args(["FOLDER"]))}

    def apart(arguments: argparse.Namespace) -> int:
        for name, given in vars(arguments).items():
            if name not in known and given != parser.get_default(name):
                parser.error("`study` takes none of the options of a run")
        return _serve_study(arguments)

    own.set_defaults(run=apart)


def _serve_study(arguments: argparse.Namespace) -> int:
    """Runs until interrupted."""
    serving.require("the study", "aidl_server")
    from aidl_eval.store import Store
    from aidl_eval.study import session, site
    from aidl_server.preview.local import Door

    store = Store(Path(arguments.folder))
    served = session.opened(store)
    hint = "without `--port` a free one is taken"
    door = Door(serving.listen(arguments.host, arguments.port, "E0953", hint))
    say(f"{store.folder}: {counted(len(served.sheets), 'sheet')} to rank, {door.url} (stop with Ctrl-C)")
    if not arguments.no_open:
        serving.open_browser(door.url)
    page = site.site(served, door.token, door.addresses, lambda reason: show([reason.diagnostic]))
    door.serve(page, site.CONNECTIONS)
    return 0


def run(arguments: argparse.Namespace) -> int:
    from aidl_eval.gallery import report
    from aidl_eval.store import Store

    if arguments.solver:
        return _compare_ways(arguments.solver)
    store = Store(Path(arguments.out))
    left = _run(arguments, store)
    print(report(store, arguments.clip_weights), end="")
    say(f"{store.folder / 'index.html'}: the gallery; evaluation.md, .csv and .json beside it: the tables")
    return 1 if left else 0


def _compare_ways(names: list[str]) -> int:
    """Solves programs in all ways and prints the tables; 1 if a program is wrong. Raises RecordingError."""
    from aidl_eval import ablation
    from aidl_eval.recordings import SUFFIX

    programs: list[tuple[SourceFile, World | None, str]] = []
    for name in dict.fromkeys(names):
        place = Path(name)
        if place.is_dir() or place.suffix == SUFFIX:
            programs += [(source, None, thing) for source, thing in ablation.recorded(place)]
        else:
            programs.append((files.read(name), files.world(name), name))
    solves: list[ablation.Solved] = []
    for number, (source, world, thing) in enumerate(programs, 1):
        solves += ablation.compare(source, world, thing)
        say(f"{number}/{len(programs)} {source.name}")
    print(ablation.markdown(solves), end="")
    return 1 if any(solved.status == ablation.WRONG for solved in solves) else 0


def _run(arguments: argparse.Namespace, store: Store) -> int:
    """Does what is to be done; returns how many conversations are left. Raises AidlError."""
    from aidl_eval.run import run

    name, ask, plan = _replayed(arguments) if arguments.replay else _asked(arguments)
    if ask is not None:
        store.begin(plan, name)
    left, failure = run(plan, ask, store, arguments.jobs, float(arguments.time_limit), _progress)
    if failure is not None:
        show([failure])
        say(f"{left} conversations are left to be had: the same command goes on with them")
    return left


def _asked(arguments: argparse.Namespace) -> tuple[str, Ask | None, Plan]:
    """Returns the name of the model, what gives it, None for `--report`, and what it is to be asked."""
    from dataclasses import replace

    from aidl_eval.plan import asked
    from aidl_eval.run import Timed
    from aidl_lang.tools.llm.generation import Settings

    model = None if arguments.report else Timed.of(provider(arguments))
    chosen = sampling(arguments)
    if chosen.seed is None and model is not None and model.takes_seeds:
        chosen = replace(chosen, seed=1)
    settings = Settings(arguments.attempts, chosen)
    runs = arguments.runs or _RUNS
    plan = asked(_prompts(arguments), _variants(arguments), runs, settings, not arguments.unaided)
    return ("", None, plan) if model is None else (model.name, lambda job: model, plan)


def _replayed(arguments: argparse.Namespace) -> tuple[str, Ask, Plan]:
    """Returns the replies of a recording, and the plan of its conversations. Raises RecordingError."""
    from aidl_eval import recordings
    from aidl_lang.tools.llm.generation import Settings

    for option in _OF_MODELS:
        if getattr(arguments, option) not in (None, ""):
            raise UseError(
                "E0996",
                f"--{option.replace('_', '-')} is for a model, and --replay asks none",
                "leave one of the two out",
            )
    there = recordings.load(Path(arguments.replay))
    chosen = recordings.chosen(there.values(), arguments.prompts or (), _variants(arguments), arguments.runs)
    plan = recordings.plan(chosen, _known(arguments), Settings(arguments.attempts))
    return "recording", lambda job: recordings.Speaker(there[job]), plan


def _prompts(arguments: argparse.Namespace) -> tuple[Prompt, ...]:
    known = _known(arguments)
    for name in arguments.prompts or ():
        if name not in known:
            hints = did_you_mean(nearest(name, known)) or [f"there are {', '.join(known)}"]
            raise UseError("E0947", f"there is no prompt `{name}`", *hints)
    return tuple(known[name] for name in dict.fromkeys(arguments.prompts or known))


def _known(arguments: argparse.Namespace) -> dict[str, Prompt]:
    from aidl_eval.requirements import PromptError, load

    folder = arguments.prompt_folder
    try:
        known = {prompt.name: prompt for prompt in load(Path(folder) if folder else None)}
    except (PromptError, OSError) as error:
        raise UseError("E0947", f"the prompts cannot be read: {error}") from None
    if not known:
        raise UseError("E0947", f"there are no prompts in `{folder}`", "a prompt is a file `NAME.aidl`")
    return known


def _variants(arguments: argparse.Namespace) -> tuple[str, ...]:
    """Returns the languages that can be had, and says which of those asked for cannot."""
    from aidl_eval.plan import VARIANTS
    from aidl_eval.rendering import RenderedLanguage

    wanted = [name for name in _VARIANTS if name in arguments.variants]
    for name in list(wanted):
        language = VARIANTS[name]
        if not isinstance(language, RenderedLanguage):
            continue
        if why := language.missing():
            refusal = UseError("E0949", f"`{name}` cannot be run: {why}", f"leave out `--variants {name}`")
        elif arguments.constrain:
            why = "--constrain has the grammar of AIDL alone"
            refusal = UseError("E0950", f"--constrain has no grammar for `{name}`", "leave --constrain out")
        else:
            continue
        wanted.remove(name)
        if not wanted:
            raise refusal
        say(f"{name} is left out: {why}")
    return tuple(wanted)


def _progress(done: Done, number: int, count: int) -> None:
    job = done.job
    say(f"{number}/{count} {job.prompt}, {job.variant}, run {job.run}: {_came(done)}")


def _came(done: Done) -> str:
    if done.failure is not None:
        return f"broke off: {done.failure.message}"
    after = f"after {counted(len(done.record['attempts']), 'attempt')}"
    if not done.record["ok"]:
        return f"not valid {after}"
    lost = f", {len(done.record['missing'])} lost" if done.record["missing"] else ""
    results = done.record.get("requirements", ())
    met = sum(result["is_met"] for result in results)
    return f"valid {after}{lost}" + (f", {met}/{len(results)} requirements" if results else "")
