"""Raters and their sheets: who is asked what in which order, and what becomes of an answer."""

from __future__ import annotations

import hashlib
import io
from base64 import b64encode
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import zip_longest
from pathlib import Path
from typing import Any

from PIL import Image

from aidl_eval.judgements import FEWEST, STYLES, Answer, Answers, Sheet, now, sheets
from aidl_eval.store import Store, StoreError

Groups = tuple[tuple[int, ...], ...]
_LARGEST = 4096
"""Most pixels of a side of a picture."""


class RefusedError(Exception):
    """Raised for an answer that cannot be taken; the message is for the rater."""


@dataclass
class Session:
    """The sheets of a folder and the answers to them."""

    folder: Path
    pictures: str
    sheets: tuple[Sheet, ...]
    answers: Answers

    @cached_property
    def _prompts(self) -> dict[str, list[Sheet]]:
        found: dict[str, list[Sheet]] = {}
        for sheet in self.sheets:
            found.setdefault(sheet.prompt, []).append(sheet)
        return found

    # --- asking -----------------------------------------------------------------------------------

    def order(self, rater: str) -> list[Sheet]:
        """Returns all sheets as a rater meets them: every prompt once in an order of the rater's own, then
        every prompt once more with another run. Who stops has seen as many prompts as can be.
        """
        mine = [
            sorted(own, key=lambda sheet: _drawn_lot(rater, sheet.prompt, sheet.run))
            for own in self._prompts.values()
        ]
        rounds = [[sheet for sheet in runs if sheet is not None] for runs in zip_longest(*mine)]
        return [
            sheet
            for number, found in enumerate(rounds)
            for sheet in sorted(found, key=lambda sheet: _drawn_lot(rater, sheet.prompt, f"round {number}"))
        ]

    def shown(self, rater: str, sheet: Sheet) -> list[str]:
        """Returns the languages of a sheet in the order in which a rater sees their pictures."""
        return sorted(sheet.drawn, key=lambda name: _drawn_lot(rater, sheet.prompt, sheet.run, name))

    def asked(self, rater: str, number: int | None) -> dict[str, Any]:
        """Returns what the page shows: the sheet of a number, else the first without an answer, or that all
        is done. Nothing in it tells of a language. Raises RefusedError and StoreError.
        """
        order = [sheet for sheet in self.order(rater) if sheet.is_shown]
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
            "pictures": [self._picture(sheet, name) for name in names],
            "answer": None if before is None else _answered(before, names),
        }

    def _given(self, rater: str) -> dict[str, Answer]:
        return {answer.sheet: answer for answer in self.answers.all() if answer.rater == rater}

    def _picture(self, sheet: Sheet, language: str) -> str:
        """Returns a picture as a `data:` address: pixels on white and nothing of the file they come from."""
        path = picture_of(self.folder, self.pictures, sheet, language)
        try:
            with Image.open(path, formats=["PNG"]) as image:
                _require_small(image)
                drawn = image.convert("RGBA")
        except (OSError, ValueError, SyntaxError):
            raise StoreError("E0987", f"`{path}` is no picture of a run") from None
        plain = Image.new("RGBA", drawn.size, "white")
        plain.alpha_composite(drawn)
        out = io.BytesIO()
        plain.convert("RGB").save(out, "PNG")
        return f"data:image/png;base64,{b64encode(out.getvalue()).decode()}"

    # --- answering --------------------------------------------------------------------------------

    def answer(self, rater: str, number: int, sheet_id: str, ranking: Groups | None) -> None:
        """Keeps an answer, with those that are plain on the way to the next question: places on the screen
        from best to worst, None if the rater could not tell. Raises RefusedError and StoreError.
        """
        order = self.order(rater)
        asked = [sheet for sheet in order if sheet.is_shown]
        if not 0 <= number < len(asked) or asked[number].id != sheet_id:
            raise RefusedError("The pictures have changed: load this page again.")
        sheet = asked[number]
        names = self.shown(rater, sheet)
        if ranking is not None and sorted(n for group in ranking for n in group) != list(range(len(names))):
            raise RefusedError("Every picture needs one place.")
        given = self._given(rater)
        if any(earlier.id not in given for earlier in asked[:number]):
            raise RefusedError("There is no such page yet.")
        said = None if ranking is None else tuple(tuple(names[n] for n in group) for group in ranking)
        about = rater, sheet.prompt, sheet.run, sheet.id, self.pictures, tuple(names), sheet.undrawn
        base = Answer(*about, said, number + 1, len(asked), now())
        plain = [self._plain(base, each) for each in _passed(order, sheet) if each.id not in given]
        self.answers.add([*plain, base])

    def _plain(self, base: Answer, sheet: Sheet) -> Answer:
        """Returns the answer to a sheet that nobody needs to be asked about."""
        ranking = (sheet.drawn,) if sheet.drawn else ()
        return replace(
            base,
            prompt=sheet.prompt,
            run=sheet.run,
            sheet=sheet.id,
            shown=sheet.drawn,
            undrawn=sheet.undrawn,
            ranking=ranking,
            number=0,
        )


def _passed(order: Sequence[Sheet], sheet: Sheet) -> Iterator[Sheet]:
    """Yields the sheets without a question before one and, up to the next question, behind it."""
    at = order.index(sheet)
    yield from (each for each in order[:at] if not each.is_shown)
    for each in order[at + 1 :]:
        if each.is_shown:
            return
        yield each


def _answered(before: Answer, names: Sequence[str]) -> dict[str, Any]:
    groups = before.ranking
    places = None if groups is None else [[names.index(name) for name in group] for group in groups]
    return {"ranking": places}


def _drawn_lot(*of: object) -> bytes:
    """Returns a number drawn at random, the same whenever it is drawn for the same."""
    return hashlib.sha256("\0".join(map(str, of)).encode("utf-8", "surrogatepass")).digest()


def _require_small(image: Image.Image) -> None:
    if max(image.size) > _LARGEST:
        raise ValueError("the picture is too large")


# --- the folder -----------------------------------------------------------------------------------


def picture_of(folder: Path, pictures: str, sheet: Sheet, language: str) -> Path:
    return folder / STYLES[pictures](f"{sheet.prompt}/{language}/{sheet.run}")


def opened(store: Store, pictures: str) -> Session:
    """Returns the session of a folder. Raises StoreError if there is nothing to rank, a picture is missing,
    or its answers are about pictures of the other style.
    """
    folder = store.folder
    found = sheets(store.records())
    if not any(sheet.is_shown for sheet in found):
        raise StoreError(
            "E0987",
            f"there is nothing to rank in `{folder}`: no prompt has pictures in {FEWEST} languages",
            "name the folder of an evaluation, `--out` of `aidl eval`",
        )
    for sheet in found:
        for language in sheet.drawn:
            _require_picture(folder, picture_of(folder, pictures, sheet, language))
    answers = Answers(folder)
    others = {answer.pictures for answer in answers.all()} - {pictures}
    for other in others:
        raise StoreError(
            "E0989",
            f"`{answers.path}` has answers to pictures in style `{other}`, not `{pictures}`",
            f"go on with `--pictures {other}`",
            "or give that file another name, and a study begins anew",
        )
    return Session(folder, pictures, tuple(found), answers)


def _require_picture(folder: Path, path: Path) -> None:
    try:
        with Image.open(path, formats=["PNG"]) as image:
            _require_small(image)
    except (OSError, ValueError, SyntaxError):
        again = f"aidl eval --replay {folder / 'recording.jsonl'} --out NEW"
        raise StoreError(
            "E0987",
            f"`{path}` is no picture, and its program is valid",
            f"`{again}` draws all again without asking a model",
        ) from None
