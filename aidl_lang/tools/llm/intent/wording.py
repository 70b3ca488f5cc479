"""Losses in words, for a language model and for reports."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from aidl_lang.common.prose import counted, listed
from aidl_lang.tools.llm.intent.changes import Fate
from aidl_lang.tools.llm.intent.inventory import Inventory, Item, Kind
from aidl_lang.tools.llm.intent.loss import Loss
from aidl_lang.tools.llm.intent.placing import dotted
from aidl_lang.tools.llm.intent.probing import State

_QUOTED = 100
"""Most characters of a statement that are quoted."""
_NAMED = 3
"""Most things that a list names."""
_TOLD = 12
"""Most losses that a request names one by one."""


def phrase(loss: Loss) -> str:
    """Returns one loss in a sentence without its full stop."""
    if loss.fate is Fate.FEWER:
        many, few = loss.counts
        return f"{many} `{dotted(loss.item.thing)}` became {few}: unless fewer are meant, make as many again"
    words = f"{named(loss.item, loss.inventory)} {_fate(loss)}"
    if loss.dependents:
        words += f", and with it {listed([quoted(item.text) for item in loss.dependents], _TOLD)}"
    reason = _reason(loss)
    return f"{words}: {reason}" if reason else words


def request(losses: Sequence[Loss]) -> str:
    """Returns a paragraph that asks to bring losses back; "" without any."""
    if not losses:
        return ""
    lines = [f"- {phrase(loss)}" for loss in losses[:_TOLD]]
    if len(losses) > _TOLD:
        lines.append(f"- and {len(losses) - _TOLD} more")
    return "\n".join(
        [
            "Earlier programs of this conversation meant more than the last one says. Removing what an error"
            " speaks of is no repair. Bring each of these back, as it was or in other words, and keep what is"
            " right now:",
            *lines,
        ]
    )


def quoted(text: str) -> str:
    """Returns a statement between backticks, shortened."""
    return f"`{text if len(text) <= _QUOTED else text[: _QUOTED - 1] + '…'}`"


def named(item: Item, inventory: Inventory) -> str:
    """Returns the name and the former place of an item."""
    where = f" (in `{dotted(item.home)}`)" if item.home else ""
    match item.kind:
        case Kind.STRUCTURE:
            return f"structure `{dotted(item.thing)}` ({_content(inventory, item)})"
        case Kind.ROTATION if item.word:
            return f"the rotation {quoted(item.text)} of `{dotted(item.thing)}`"
        case Kind.PARAM | Kind.ASSERT:
            return f"{quoted(item.text)}{where}"
    said = quoted(f"prefer {item.text}" if item.wish else item.text)
    return f"{said}{where}"


def _content(inventory: Inventory, item: Item) -> str:
    """Returns `solid, 3 geometries, 2 constraints`."""
    counts = Counter(i.kind for i in inventory.inside(item.thing))
    parts = [
        counted(counts[kind], one, many)
        for kind, one, many in (
            (Kind.STRUCTURE, "structure", ""),
            (Kind.GEOMETRY, "geometry", "geometries"),
            (Kind.CONSTRAINT, "constraint", ""),
        )
        if counts[kind]
    ]
    return ", ".join([item.word, *parts])


def _fate(loss: Loss) -> str:
    now = loss.now
    if loss.fate is Fate.WEAKENED and now is not None:
        return "is only checked now, by an `assert`" if now.kind is Kind.ASSERT else "became a wish"
    if loss.fate is Fate.REWRITTEN and now is not None:
        less = "otherwise" if now.text in loss.finding.parties else "less"
        return f"was replaced by {quoted(now.text)}, which says {less}"
    return "is gone"


def _reason(loss: Loss) -> str:
    finding, is_thing = loss.finding, loss.kind in (Kind.STRUCTURE, Kind.GEOMETRY)
    if loss.kind is Kind.PARAM:
        return "what it set is written as numbers now, or not at all; use it there again"
    if loss.item.wrong and finding.state is not State.FITS:
        return "it was written wrongly; say it in a way that is right"
    match finding.state:
        case State.CONFLICTS if finding.parties:
            with_ = listed(map(quoted, finding.parties), _NAMED)
            return f"as it was it conflicts with {with_}; say it in another way, or mend one of those"
        case State.CONFLICTS:
            why = f" ({finding.reason})" if finding.reason else ""
            return f"as it was it does not fit any more{why}; say it in another way"
        case State.FITS:
            clashing = [quoted(item.text) for item in loss.dependents if item.clashes]
            if clashing:
                return f"put it back, but say {listed(clashing, _TOLD)} in a way that holds"
            return "it fits as it was; put it back"
        case State.HOMELESS if not is_thing:
            return "what it speaks of is not there any more; say it of what is there now"
    return ""
