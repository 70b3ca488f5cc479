"""Raters and their sheets: who is asked what in which order, and what becomes of an answer."""

from __future__ import annotations

import hashlib
import io
from base64 import b64encode
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from PIL import Image

from aidl_eval.judgements import FEWEST, Answer, Answers, Sheet, sheets
from aidl_eval.store import Store, StoreError, picture_path

Groups = tuple[tuple[int, ...], ...]


class RefusedError(Exception):
    """Raised for an answer that cannot be taken; the message is for the rater."""


@dataclass
class Session:
    """The sheets of a folder and the answers to them."""

    folder: Path
    sheets: tuple[Sheet, ...]
    answers: Answers

    def order(self, rater: str) -> list[Sheet]:
        """Returns all sheets as a rater meets them: every prompt once in an order of the rater's own, then
        every prompt once more with another run. Who stops has seen as many prompts as can be.
        """
        met, rounds = Counter[str](), list[tuple[int, bytes, Sheet]]()
        for sheet in sorted(self.sheets, key=lambda sheet: _drawn_lot(rater, sheet.prompt, sheet.run)):
            number = met[sheet.prompt]
            rounds.append((number, _drawn_lot(rater, sheet.prompt, f"round {number}"), sheet))
            met[sheet.prompt] += 1
        return [sheet for *_, sheet in sorted(rounds, key=lambda place: place[:2])]

    def shown(self, rater: str, sheet: Sheet) -> list[str]:
        """Returns the languages of a sheet in the order in which a rater sees their pictures."""
        return sorted(sheet.drawn, key=lambda name: _drawn_lot(rater, sheet.prompt, sheet.run, name))

    def asked(self, rater: str, number: int | None) -> dict[str, Any]:
        """Returns what the page shows: the sheet of a number, else the first without an answer, or that all
        is done. Nothing in it tells of a language. Raises RefusedError and StoreError.
        """
        order = self.order(rater)
        given = self._given(rater)
        first = next((n for n, sheet in enumerate(order) if sheet.id not in given), len(order))
        number = first if number is None else number
        if not 0 <= number <= first:
            raise RefusedError("There is no such page yet.")
        answered = sum(sheet.id in given for sheet in order)
        place = {"rater": rater, "number": number, "count": len(order), "answered": answered}
        if number == len(order):
            return place
        sheet = order[number]
        names = self.shown(rater, sheet)
        before = given.get(sheet.id)
        return {
            **place,
            "id": sheet.id,
            "text": sheet.text,
            "pictures": [_address(_picture(self.folder, sheet, name)) for name in names],
            "answer": None if before is None else _answered(before, names),
        }

    def _given(self, rater: str) -> dict[str, Answer]:
        return {answer.sheet: answer for answer in self.answers.all() if answer.rater == rater}

    def answer(self, rater: str, number: int, sheet_id: str, ranking: Groups | None) -> None:
        """Keeps an answer: places on the screen from best to worst, None if the rater could not tell. Raises
        RefusedError and StoreError.
        """
        order = self.order(rater)
        if not 0 <= number < len(order) or order[number].id != sheet_id:
            raise RefusedError("The pictures have changed: load this page again.")
        sheet = order[number]
        names = self.shown(rater, sheet)
        if ranking is not None and sorted(n for group in ranking for n in group) != list(range(len(names))):
            raise RefusedError("Every picture needs one place.")
        given = self._given(rater)
        if any(earlier.id not in given for earlier in order[:number]):
            raise RefusedError("There is no such page yet.")
        said = None if ranking is None else tuple(tuple(names[n] for n in group) for group in ranking)
        about = rater, sheet.prompt, sheet.run, sheet.id, tuple(names), sheet.undrawn
        self.answers.add(Answer(*about, said, datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")))


def _answered(before: Answer, names: Sequence[str]) -> dict[str, Any]:
    groups = before.ranking
    places = None if groups is None else [[names.index(name) for name in group] for group in groups]
    return {"ranking": places}


def _drawn_lot(*of: object) -> bytes:
    """Returns a number drawn at random, the same whenever it is drawn for the same."""
    return hashlib.sha256("\0".join(map(str, of)).encode("utf-8", "surrogatepass")).digest()


def opened(store: Store) -> Session:
    """Returns the session of a folder. Raises StoreError if there is nothing to rank, a picture is missing,
    or its answers cannot be read.
    """
    folder = store.folder
    found = sheets(store.records())
    if not found:
        raise StoreError(
            "E0987",
            f"there is nothing to rank in `{folder}`: no prompt has pictures in {FEWEST} languages",
            "name the folder of an evaluation, `--out` of `aidl eval`",
        )
    for sheet in found:
        for language in sheet.drawn:
            _picture(folder, sheet, language)
    answers = Answers(folder)
    answers.all()
    return Session(folder, tuple(found), answers)


def _picture(folder: Path, sheet: Sheet, language: str) -> Image.Image:
    path = folder / picture_path(f"{sheet.prompt}/{language}/{sheet.run}")
    try:
        with Image.open(path, formats=["PNG"]) as image:
            return image.convert("RGBA")
    except (OSError, ValueError, SyntaxError):
        again = f"aidl eval --replay {folder / 'recording.jsonl'} --out NEW"
        raise StoreError(
            "E0987",
            f"`{path}` is no picture, and its program is valid",
            f"`{again}` draws all again without asking a model",
        ) from None


def _address(picture: Image.Image) -> str:
    """Returns a picture as a `data:` address: pixels on white and nothing of the file they come from."""
    plain = Image.new("RGBA", picture.size, "white")
    plain.alpha_composite(picture)
    out = io.BytesIO()
    plain.convert("RGB").save(out, "PNG")
    return f"data:image/png;base64,{b64encode(out.getvalue()).decode()}"
