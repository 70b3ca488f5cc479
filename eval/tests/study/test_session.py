"""Who is asked what: orders, answers, what is kept of them, and folders that cannot be studied."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import replace
from pathlib import Path

import pytest

from aidl_eval.judgements import STUDY, Answer, Answers, rater_named, sheets, study_of
from aidl_eval.store import Store, StoreError
from aidl_eval.study.session import RefusedError, Session, opened
from aidl_lang.tools.cli import main
from eval.tests.study import results
from eval.tests.study.results import PROMPTS


@pytest.fixture
def store(tmp_path: Path) -> Store:
    return results.write(tmp_path / "out", runs=2)


@pytest.fixture
def session(store: Store) -> Session:
    return opened(store)


def answer(session: Session, rater: str, ranking: tuple[tuple[int, ...], ...] | None) -> None:
    """Answer the next sheet of a rater."""
    asked = session.asked(rater, None)
    session.answer(rater, asked["number"], asked["id"], ranking)


# --- orders ---------------------------------------------------------------------------------------


def test_every_prompt_comes_once_before_any_comes_twice(session: Session) -> None:
    for rater in ("north", "south", "7"):
        order = session.order(rater)
        assert len({sheet.id for sheet in order}) == len(order) == 2 * len(PROMPTS)
        first, second = order[: len(PROMPTS)], order[len(PROMPTS) :]
        assert len({sheet.prompt for sheet in first}) == len({sheet.prompt for sheet in second}) == 4
        assert session.order(rater) == order
    assert len({tuple(s.id for s in session.order(str(n))) for n in range(20)}) == 20


def test_each_place_on_the_screen_and_in_the_order_is_drawn_by_lot(session: Session) -> None:
    from scipy import stats

    first = [session.order(str(n))[0] for n in range(600)]
    runs = Counter(sheet.run for sheet in first)
    prompts = Counter(sheet.prompt for sheet in first)
    shown = Counter(tuple(session.shown(str(n), session.sheets[0])) for n in range(600))
    assert (len(prompts), len(runs), len(shown)) == (4, 2, 6)
    for counts in (runs, prompts, shown):
        assert stats.chisquare(list(counts.values())).pvalue > 0.01


def test_the_order_on_the_screen_is_kept(session: Session, store: Store) -> None:
    answer(session, "north", ((2,), (0, 1)))
    (line,) = results.lines(store.folder)
    names = session.shown("north", session.order("north")[0])
    assert line["shown"] == names
    assert line["ranking"] == [[names[2]], [names[0], names[1]]]


# --- answers --------------------------------------------------------------------------------------


def test_ranks_share_the_mean_of_theirs() -> None:
    given = ("r", "p", 1, "s", ("full", "svg", "openscad"), ("paper", "cadquery"))
    found = Answer(*given, (("svg",), ("full", "openscad")), "2026-01-31T12:00:00Z")
    assert found.ranks() == {"svg": 1, "full": 2.5, "openscad": 2.5, "paper": 4.5, "cadquery": 4.5}
    assert found.ranks_of_shown() == {"svg": 1, "full": 2.5, "openscad": 2.5}
    assert replace(found, ranking=None).ranks() == {}


def test_a_rater_goes_on_goes_back_and_changes_an_answer(session: Session, store: Store) -> None:
    for ranking in (((0,), (1,), (2,)), None, ((0, 1, 2),)):
        answer(session, "north", ranking)
    again = opened(Store(store.folder))
    asked = again.asked("north", None)
    assert (asked["number"], asked["answered"], asked["count"], asked["answer"]) == (3, 3, 8, None)
    assert again.asked("north", 1)["answer"] == {"ranking": None}
    before = again.asked("north", 0)
    assert before["answer"] == {"ranking": [[0], [1], [2]]}
    again.answer("north", 0, before["id"], ((2,), (1,), (0,)))
    assert again.asked("north", 0)["answer"] == {"ranking": [[2], [1], [0]]}
    assert again.asked("north", None)["number"] == 3
    study = study_of(store, store.records())
    assert study is not None
    assert (study.raters, study.judgements, study.skipped, study.outdated) == (1, 2, 1, 0)
    assert len(results.lines(store.folder)) == 4


def test_half_a_ranking_is_refused(session: Session) -> None:
    for ranking in ((), ((0,),), ((0,), (1,), (2,), (3,)), ((0, 1), (1, 2)), ((-1, 0, 1),)):
        with pytest.raises(RefusedError, match="one place"):
            answer(session, "north", ranking)
        assert session.answers.all() == []


def test_nobody_answers_ahead(session: Session) -> None:
    ahead = session.order("north")[2]
    with pytest.raises(RefusedError):
        session.asked("north", 1)
    with pytest.raises(RefusedError):
        session.answer("north", 2, ahead.id, ((0, 1, 2),))
    with pytest.raises(RefusedError, match="load this page again"):
        session.answer("north", 0, ahead.id, ((0, 1, 2),))


STATES = {
    ("lamp stand", "full", 1): "none",
    ("old key", "full", 1): "none",
    ("old key", "svg", 1): "slow",
    ("tall mug", "full", 1): "none",
    ("tall mug", "openscad", 1): "none",
    ("tall mug", "svg", 1): "none",
    ("wide fork", "full", 1): "broken",
}


def test_who_drew_nothing_is_last_and_who_broke_off_is_left_out(tmp_path: Path) -> None:
    store = results.write(tmp_path, states=STATES)
    session = opened(store)
    by_name = {sheet.text: (sheet.drawn, sheet.undrawn) for sheet in session.sheets}
    assert by_name == {
        "lamp stand": (("openscad", "svg"), ("full",)),
        "wide fork": (("openscad", "svg"), ()),
    }
    assert session.asked("north", None)["count"] == 2
    for _number in range(2):
        asked = session.asked("north", None)
        shown = session.shown("north", next(s for s in session.sheets if s.id == asked["id"]))
        best = shown.index("openscad")
        session.answer("north", asked["number"], asked["id"], ((best,), (1 - best,)))
    assert "pictures" not in session.asked("north", None)
    study = study_of(store, store.records())
    assert study is not None
    assert study.judgements == 2
    assert dict(study.ranks("full")) == {"lamp_stand": 3}
    assert dict(study.ranks("openscad")) == {"lamp_stand": 1, "wide_fork": 1}
    assert dict(study.ranks("svg")) == {"lamp_stand": 2, "wide_fork": 2}


def test_answers_to_what_has_changed_do_not_count(session: Session, store: Store) -> None:
    for _number in range(8):
        answer(session, "north", ((0,), (1,), (2,)))
    path = store.folder / "records/old_key/full/1.json"
    changed = json.loads(path.read_text("utf-8")) | {"program": "another"}
    path.write_text(json.dumps(changed), "utf-8")
    study = study_of(store, store.records())
    assert study is not None
    assert (study.judgements, study.outdated) == (7, 1)
    asked = opened(store).asked("north", None)
    assert (asked["answered"], asked["text"]) == (7, "old key")


# --- names of raters ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("typed", "name"),
    [
        ("North", "north"),
        ("  J.  de-Vries ", "j. de-vries"),
        ("7", "7"),
        ("Zoë", "zoë"),
        ("李", "李"),
        ("a_b", "a_b"),
    ],
)
def test_names(typed: str, name: str) -> None:
    assert rater_named(typed) == name
    assert rater_named(name) == name


@pytest.mark.parametrize(
    "typed",
    [
        *("", " ", "=1+1", "-a", "a-", "<b>", "a/b", "../a", "a\nb\x00", "a\u202eb"),
        *("a" * 41, "ﷺ" * 100, "🙂", 7, None),
    ],
)
def test_what_is_no_name(typed: object) -> None:
    assert rater_named(typed) is None


# --- files ----------------------------------------------------------------------------------------


def test_half_a_line_is_cut_and_nothing_else(session: Session, store: Store) -> None:
    answer(session, "north", None)
    whole = session.answers.path.read_bytes()
    session.answers.path.write_bytes(whole + whole[:70])
    assert opened(store).asked("north", None)["number"] == 1
    answer(opened(store), "south", None)
    assert session.answers.path.read_bytes().startswith(whole)
    assert [line["rater"] for line in results.lines(store.folder)] == ["north", "south"]
    session.answers.path.write_bytes(whole[:20])
    assert session.answers.all() == []


def test_two_servers_see_each_other(session: Session, store: Store) -> None:
    other = opened(store)
    answer(session, "north", None)
    assert other.asked("north", None)["number"] == 1


DAMAGES: list[dict[str, object]] = [
    *({"run": True}, {"prompt": 7}, {"more": 1}, {"aidl_study": 2}, {"ranking": 7}),
    *({"shown": ["full", "full", "svg"]}, {"undrawn": ["basic"]}),
    *({"ranking": [["full"]]}, {"ranking": [[["full"]]]}),
]


def test_damaged_lines_are_refused(session: Session, store: Store) -> None:
    for _number in range(2):
        answer(session, "north", ((0, 1), (2,)))
    first, second = session.answers.path.read_text("utf-8").splitlines()
    nameless = json.loads(second)
    del nameless["rater"]
    for line in (nameless, *(json.loads(second) | damage for damage in DAMAGES)):
        session.answers.path.write_text(f"{first}\n{json.dumps(line)}\n", "utf-8")
        with pytest.raises(StoreError, match=r"study\.jsonl:2` is no answer of a study"):
            opened(store)


def test_what_is_no_line_is_told(store: Store, capsys: pytest.CaptureFixture[str]) -> None:
    path = store.folder / STUDY
    for line in ("", "null", "[" * 100_000, "{", "\x00"):
        path.write_text(f"{line}\n", "utf-8")
        assert main(["eval", "study", str(store.folder), "--no-open"]) == 2
        assert capsys.readouterr().err == (
            f"error[E0988]: `{path}:1` is no answer of a study\n"
            "  = hint: remove that line: the rater is asked once more\n"
        )


def test_nothing_to_rank_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    results.write(tmp_path / "one", languages=["full"])
    for folder in (tmp_path / "one", tmp_path / "none"):
        assert main(["eval", "study", str(folder), "--no-open"]) == 2
        assert capsys.readouterr().err == (
            f"error[E0987]: there is nothing to rank in `{folder}`: no prompt has pictures in 2 languages\n"
            "  = hint: name the folder of an evaluation, `--out` of `aidl eval`\n"
        )


def test_a_picture_that_is_missing_is_told(store: Store) -> None:
    path = store.folder / "pictures/old_key/svg/2.png"
    for content in (None, b"", b"GIF89a", b"\x89PNG\r\n\x1a\n"):
        path.unlink(missing_ok=True)
        if content is not None:
            path.write_bytes(content)
        with pytest.raises(StoreError, match=r"svg/2\.png` is no picture"):
            opened(store)


def test_options_of_a_run_are_refused(store: Store, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stopped:
        main(["eval", "--report", "study", str(store.folder)])
    assert stopped.value.code == 2
    assert "`study` takes none of the options of a run" in capsys.readouterr().err


def test_sheets_without_a_second_language_are_none(tmp_path: Path) -> None:
    states = {("old key", name, 1): "broken" for name in ("full", "svg")}
    found = sheets(results.write(tmp_path, states=states).records())
    assert {sheet.text for sheet in found} == set(PROMPTS) - {"old key"}
    assert Answers(tmp_path).all() == []
