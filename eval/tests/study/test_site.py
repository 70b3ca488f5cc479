"""The page of a study: that it gives no language away, and what it refuses."""

from __future__ import annotations

import base64
import json
import re
from collections.abc import Iterator
from pathlib import Path
from random import Random
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from starlette.testclient import TestClient

from aidl_eval.judgements import rater_named
from aidl_eval.plan import VARIANTS
from aidl_eval.store import Store, StoreError
from aidl_eval.study.session import opened
from aidl_eval.study.site import site
from eval.tests.study import results
from tests.amount import tries

TOKEN, ADDRESS = "tok-En_123", "127.0.0.1:8123"
TELLING = re.compile("|".join([*VARIANTS, "aidl", "neutral", "undrawn", "python", "scad"]), re.IGNORECASE)
"""Words of which each tells something of what drew a picture."""
DATA = re.compile(r'"data:image/png;base64,([\w+/=]+)"')


class Site:
    """A client, and what whoever runs the study was told."""

    def __init__(self, store: Store) -> None:
        self.told: list[StoreError] = []
        app = site(opened(store), TOKEN, [ADDRESS, "localhost:8123"], self.told.append)
        self.client = TestClient(app, base_url=f"http://{ADDRESS}")

    def post(self, what: str, **said: Any) -> Any:
        return self.client.post(f"/{TOKEN}/{what}", json=said)

    def raw(self, what: str, content: bytes, **headers: str) -> int:
        given = {"content-type": "application/json", **headers}
        return self.client.post(f"/{TOKEN}/{what}", content=content, headers=given).status_code


@pytest.fixture(scope="module")
def store(tmp_path_factory: pytest.TempPathFactory) -> Store:
    return results.write(tmp_path_factory.mktemp("out"), states={("old key", "svg", 1): "none"})


@pytest.fixture(scope="module")
def page(store: Store) -> Iterator[Site]:
    """The page of a study that nobody's answer is kept of."""
    found = Site(store)
    yield found
    assert found.told == []


def chunks(png: bytes) -> list[bytes]:
    """The kinds of chunks of a PNG."""
    found, at = [], 8
    while at < len(png):
        found.append(png[at + 4 : at + 8])
        at += 12 + int.from_bytes(png[at : at + 4], "big")
    return found


@pytest.fixture(scope="module")
def many(tmp_path_factory: pytest.TempPathFactory) -> Site:
    """A study of all languages, that goes on through the examples of a property."""
    states = {("old key", "svg", 1): "none", ("tall mug", "full", 1): "broken"}
    return Site(results.write(tmp_path_factory.mktemp("many"), languages=list(VARIANTS), states=states))


_RATERS = st.text("bcmnqz0123456789 .-_李é", min_size=1, max_size=12).filter(
    lambda t: rater_named(t) is not None
)


@tries(30)
@given(rater=_RATERS, seed=st.integers(0, 9999))
def test_nothing_tells_the_language(many: Site, rater: str, seed: int) -> None:
    """Neither what is sent, nor its headers, nor the files of the pictures.

    A rater met twice goes on where it stopped: a seed is drawn, and no choice that hangs on what is shown.
    """
    chance = Random(seed)
    answer = many.post("sheet", rater=rater)
    for _number in range(3):
        said = answer.json()
        found = DATA.findall(answer.text)
        assert len(found) == len(said.get("pictures", ()))
        assert TELLING.search(DATA.sub("", answer.text)) is None
        assert TELLING.search(str(answer.headers)) is None
        for picture in map(base64.b64decode, found):
            assert set(chunks(picture)) == {b"IHDR", b"IDAT", b"IEND"}
        if "id" not in said:
            return
        places = chance.sample(range(len(found)), len(found))
        ranking = chance.choice([None, [[place] for place in places], [list(places)]])
        answer = many.post("answer", rater=rater, number=said["number"], id=said["id"], ranking=ranking)
        assert answer.status_code == 200


def test_the_page_and_its_files_name_no_language(page: Site) -> None:
    answer = page.client.get(f"/{TOKEN}/")
    assert answer.status_code == 200
    assert "{{" not in answer.text
    links = re.findall(r'(?:href|src)="([^"]+)"', answer.text)
    assert len(links) == 4
    names = re.compile(rf"\b({'|'.join(VARIANTS)})\b(?!\+xml)", re.IGNORECASE)
    assert names.findall(answer.text.replace(".svg", "").replace("image/svg+xml", "")) == []
    for link in links:
        assert page.client.get(f"/{TOKEN}/{link}").status_code == 200
    assert names.search(page.client.get(f"/{TOKEN}/page/study.js").text) is None
    policy = answer.headers["content-security-policy"]
    assert "script-src 'self';" in policy
    assert "'unsafe" not in policy
    assert "form-action 'none'" in policy


def test_pictures_stand_in_the_order_of_the_rater(page: Site, store: Store) -> None:
    session = opened(store)
    for rater in ("north", "south", "west"):
        said = page.post("sheet", rater=rater).json()
        sheet = next(sheet for sheet in session.sheets if sheet.id == said["id"])
        widths = [
            int.from_bytes(base64.b64decode(picture.partition(",")[2])[16:20], "big")
            for picture in said["pictures"]
        ]
        assert widths == [results.width_of(name) for name in session.shown(rater, sheet)]


# --- guards ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "path",
    [
        "/",
        "/wrong/",
        f"/{TOKEN}/study.jsonl",
        f"/{TOKEN}/pictures/old_key/full/1.png",
        f"/{TOKEN}/page/index.html",
        f"/{TOKEN}/page/main.js",
        f"/{TOKEN}/page/..%2fsite.py",
        f"/{TOKEN}/page/%2fetc%2fpasswd",
    ],
)
def test_there_is_nothing_else(page: Site, path: str) -> None:
    assert page.client.get(path).status_code == 404


def test_strangers_are_refused(page: Site) -> None:
    said = {"rater": "north"}
    for what in ("sheet", "answer"):
        assert page.client.get(f"/{TOKEN}/{what}").status_code == 405
        assert page.client.post(f"/wrong/{what}", json=said).status_code == 404
        for headers, code in (
            ({"host": "evil.example"}, 421),
            ({"host": f"{ADDRESS}.evil.example"}, 421),
            ({"origin": "http://evil.example"}, 403),
            ({"origin": "null"}, 403),
            ({"origin": "http://127.0.0.1:9"}, 403),
        ):
            found = page.client.post(f"/{TOKEN}/{what}", json=said, headers=headers)
            assert found.status_code == code
    assert (
        page.client.post(f"/{TOKEN}/sheet", json=said, headers={"origin": f"http://{ADDRESS}"}).status_code
        == 200
    )


@pytest.mark.parametrize(
    "content",
    [
        *(b"", b"null", b"[]", b"7", b"{", b"\xff", b"[" * 4000, b'{"a":' * 800),
        b'{"rater": "north"}' + b" " * 5000,
    ],
)
@pytest.mark.parametrize("what", ["sheet", "answer"])
def test_noise_is_refused(page: Site, store: Store, what: str, content: bytes) -> None:
    assert page.raw(what, content) == 400
    assert not (store.folder / "study.jsonl").exists()


def test_forms_of_other_pages_are_refused(page: Site) -> None:
    content = json.dumps({"rater": "north"}).encode()
    assert page.raw("sheet", content) == 200
    for kind in ("text/plain", "application/x-www-form-urlencoded", ""):
        assert page.raw("sheet", content, **{"content-type": kind}) == 400


@pytest.mark.parametrize("rater", [None, 7, "", "=cmd", "<b>", "a" * 41, ["north"]])
def test_hostile_names_are_refused(page: Site, rater: object) -> None:
    answer = page.post("sheet", rater=rater)
    assert answer.status_code == 400
    assert "1 to 40 letters or digits" in answer.json()["reason"]


@pytest.mark.parametrize(
    "change",
    [
        *({"number": number} for number in (None, True, 0.0, -1, 10**30)),
        *({"id": sheet} for sheet in (None, "0" * 16)),
        *({"ranking": ranking} for ranking in (7, [], [[0, 1, 2], []], [[0], [1]], [[0], [1], [1]])),
        *({"ranking": [[0], [1], [last]]} for last in (True, 2.0)),
        *({"ranking": ranking} for ranking in ([["0"], ["1"], ["2"]], {"0": 1})),
        {"rater": "\u202e"},
    ],
)
def test_hostile_answers_are_refused(page: Site, store: Store, change: dict[str, object]) -> None:
    first = page.post("sheet", rater="north").json()
    said = {"rater": "north", "number": 0, "id": first["id"], "ranking": [[0], [1], [2]]}
    answer = page.post("answer", **{**said, **change})
    assert answer.status_code == 400
    assert answer.json()["reason"]
    assert not (store.folder / "study.jsonl").exists()


def test_what_goes_wrong_with_the_folder_is_not_told_to_raters(tmp_path: Path) -> None:
    store = results.write(tmp_path)
    page = Site(store)
    for picture in store.folder.rglob("*.png"):
        picture.write_bytes(b"\x89PNG\r\n\x1a\n")
    answer = page.post("sheet", rater="north")
    assert answer.status_code == 500
    assert TELLING.search(answer.text) is None
    assert "no picture" in page.told[0].diagnostic.message


def test_an_answer_that_cannot_be_kept_is_told(tmp_path: Path) -> None:
    page = Site(results.write(tmp_path))
    first = page.post("sheet", rater="north").json()
    (tmp_path / "study.jsonl").mkdir()
    answer = page.post("answer", rater="north", number=0, id=first["id"], ranking=None)
    assert answer.status_code == 500
    assert [reason.diagnostic.code for reason in page.told] == ["E0988"]
