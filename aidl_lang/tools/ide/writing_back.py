"""Writes solved values into the text in place of its first guesses, and of sizes that had to change.

Every proposal is tried: the edited text is solved again, and has to draw the same.
"""

from __future__ import annotations

from collections.abc import Mapping

from aidl_lang.common.diagnostics import Edit
from aidl_lang.common.numbers import shortest
from aidl_lang.common.records import record
from aidl_lang.common.source import Span
from aidl_lang.pipeline import Compiled
from aidl_lang.tools.ide.comparing import SAME, is_same
from aidl_lang.tools.ide.guesses import VISIBLE, Guess, as_kept, guesses
from aidl_lang.tools.ide.refusing import CannotError
from aidl_lang.tools.ide.view import View, edited

_PRECISIONS = (VISIBLE / 2, 1e-9, 0.0)
"""Errors of a number, as shares of it (or of one for smaller numbers): each is tried if the one before it was
too coarse. With none, all digits are written.
"""
_MOST_TRIES = 8


@record()
class Rewriting:
    """Tried edits that write solved values into the text; `view` is the result."""

    edits: tuple[Edit, ...]
    view: View


def can_write_back(view: View, span: Span | None = None, *, sizes: bool = False) -> bool:
    """Tells, without trying, whether there is anything to write."""
    return bool(_targets(view, span, sizes))


def write_back(view: View, span: Span | None = None, *, sizes: bool = False) -> Rewriting:
    """Returns the edits that write solved values as first guesses, in a part of the text or in all of it;
    with `sizes`, the values of the kept sizes that had to change. Raises CannotError.
    """
    targets = _targets(view, span, sizes)
    if not targets:
        what = "kept size had to change" if sizes else "first guess was solved to something else"
        raise CannotError(f"no {what} here")
    for chosen in (targets, {g: v for g, v in targets.items() if not g.is_shared}):
        if chosen and (found := _tried(view, chosen)) is not None:
            return Rewriting(*found)
    raise CannotError("with the solved values written there, the program would not draw the same")


def number_for(guess: Guess, value: float, precision: float = VISIBLE / 2) -> str:
    """Writes a value as a number of the text, with its unit: the shortest within a share of it."""
    return shortest(value, precision * max(1.0, abs(value))) + guess.unit


# --- Choosing ------------------------------------------------------------------------------------


def _targets(view: View, span: Span | None, sizes: bool) -> dict[Guess, float]:
    """Returns the numbers to write, with their values."""
    outcome, kept = view.outcome, as_kept(view)
    if outcome is None or outcome.evaluate is None or kept is None:
        return {}
    found: dict[Guess, float] = {}
    for guess in guesses(view):
        if span is not None and not (span.start <= guess.span.start and guess.span.end <= span.end):
            continue
        # With the sizes as written, or else they would be written by the way, as the end of a line is.
        value = guess.valued(outcome.evaluate if sizes else kept)
        if value is None or not guess.is_off(value):
            continue
        if not sizes and guess.is_kept:
            continue
        if sizes and not _holds_changed_size(guess):
            continue
        found[guess] = value
    return found


def _holds_changed_size(guess: Guess) -> bool:
    """True for the number of a kept size, by itself or as the place of a further point of a geometry."""
    return any(unknown.kept for unknown in guess.unknowns)


# --- Trying --------------------------------------------------------------------------------------


def _tried(view: View, targets: Mapping[Guess, float]) -> tuple[tuple[Edit, ...], View] | None:
    """Returns the shortest numbers that draw the same, with the resulting view.

    If the drawing is free to slide as a whole, it may: a position that the text does not say still begins
    where it
    did, and draws the rest along. The numbers follow until nothing moves any more.
    """
    assert view.outcome is not None
    order = {guess.span: index for index, guess in enumerate(guesses(view))}
    wanted, level = dict(targets), dict.fromkeys(targets, 0)
    for _ in range(_MOST_TRIES):
        edits = tuple(
            Edit(guess.span, number_for(guess, value, _PRECISIONS[level[guess]]))
            for guess, value in wanted.items()
        )
        again = edited(view, edits)
        assert again.outcome is not None
        is_slid = is_same(view.outcome, again.outcome, slid=True)
        moved = _moved(again, wanted, order)
        if is_slid and (not moved or is_same(view.outcome, again.outcome)):
            return (edits, again) if _is_no_worse(view.outcome, again.outcome) else None
        finest = 1 if is_slid else len(_PRECISIONS) - 1
        coarse = [guess for guess in moved or wanted if level[guess] < finest]
        if coarse:
            level |= {guess: level[guess] + 1 for guess in coarse}
        elif is_slid:
            wanted |= moved
        else:
            return None
    return None


def _moved(again: View, wanted: Mapping[Guess, float], order: Mapping[Span, int]) -> dict[Guess, float]:
    """Returns the numbers that solve to other values than intended, with these values."""
    now = guesses(again)
    if len(now) != len(order):
        return {}
    found: dict[Guess, float] = {}
    for guess, value in wanted.items():
        solved = now[order[guess.span]].solved
        if solved is not None and abs(solved - value) * guess.factor > SAME:
            found[guess] = solved
    return found


def _is_no_worse(before: Compiled, after: Compiled) -> bool:
    """True if the program has no diagnostics that it did not have before."""
    return {d.code for d in after.diagnostics} <= {d.code for d in before.diagnostics}
