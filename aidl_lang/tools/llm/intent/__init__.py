"""The intents of the programs of a conversation, one after another: what got lost, and puts it back."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace

from aidl_lang.common.prose import counted, listed, shortened
from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import World
from aidl_lang.pipeline import Compiled, Settings, front
from aidl_lang.tools.llm.intent.changes import Changes, Fate, compare, strength
from aidl_lang.tools.llm.intent.inventory import Inventory, Item, Kind, Path, inventory, names_in
from aidl_lang.tools.llm.intent.placing import UNTRIED, Finding, Prober, State, dotted, new_errors, stands

# --- A loss of a conversation.


@record(eq=False)
class Loss:
    """An intent of an earlier program that the present one lacks.

    item        the lost item
    changes     from its program to the present one
    finding     whether it would fit again, and its conflicts
    dependents  for structures and geometry: the items that mentioned them and went with them
    """

    item: Item
    changes: Changes
    finding: Finding = UNTRIED
    dependents: tuple[Item, ...] = ()

    @property
    def kind(self) -> Kind:
        return self.item.kind

    @property
    def fate(self) -> Fate:
        return self.changes.fates[self.item][0]

    @property
    def now(self) -> Item | None:
        """Its replacement, if any."""
        return self.changes.fates[self.item][1]

    @property
    def is_doubtful(self) -> bool:
        """True if it may well be meant: asking for it once is enough."""
        return self.fate is Fate.FEWER

    @property
    def phrase(self) -> str:
        """The loss in a sentence without its full stop."""
        before, after = self.changes.before, self.changes.after
        if self.fate is Fate.FEWER and self.now is not None:
            many, few = before.count(self.item), after.count(self.now)
            fewer = f"{many} `{dotted(self.item.thing)}` became {few}"
            return f"{fewer}: unless fewer are meant, make as many again"
        words = f"{named(self.item, before)} {_fate(self)}"
        if self.dependents:
            words += f", and with it {listed([quoted(item.text) for item in self.dependents], _TOLD)}"
        reason = _reason(self)
        return f"{words}: {reason}" if reason else words


# --- Losses in words, for a language model and for reports.

_QUOTED = 100
"""Most characters of a statement that are quoted."""
_NAMED = 3
"""Most things that a list names."""
_TOLD = 12
"""Most losses that a request names one by one."""


def request(losses: Sequence[Loss]) -> str:
    """Returns a paragraph that asks to bring losses back; "" without any."""
    if not losses:
        return ""
    lines = [f"- {loss.phrase}" for loss in losses[:_TOLD]]
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
    return f"`{shortened(text, _QUOTED)}`"


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


_PROBES = 12
"""Most compiles of a program to try its losses."""
_RESTORING = 30
"""The same for putting back what fits."""
_THINGS = frozenset({Kind.STRUCTURE, Kind.GEOMETRY})
_UNREAD = ("E01", "E08")
"""Errors after which a part of a program may not have been read."""
_ORDER = tuple(Kind)
"""The order in which losses are put back: things before their mentions."""


class Ledger:
    """Remembers what the programs of one conversation meant. `note` each in turn; `missing` is then what any
    earlier one had and the last one lacks.

    A program that is to be edited is noted first: what was asked to go will be missing as well.
    """

    def __init__(self, world: World | None = None, settings: Settings | None = None) -> None:
        self._world, self._settings = world, settings or Settings()
        self._noted: list[tuple[Inventory, dict[Item, Item | None]]] = []
        """Programs with the items that no later one has, each with its replacement in the next, if any."""
        self._clashed: set[Item] = set()
        self._text = ""
        self._known: tuple[Loss, ...] = ()

    @property
    def missing(self) -> tuple[Loss, ...]:
        """The present losses, in the order of the programs and of writing."""
        return tuple(loss for loss in self._known if _counts(loss))

    def note(self, source: SourceFile, compiled: Compiled | None) -> None:
        """Notes a program, and its outcome (None if it was not compiled)."""
        here = self.inventory(source, compiled)
        prober = Prober(self._world, self._settings, _PROBES, self._clashed)
        self._known = tuple(_probed(loss, prober, compiled) for loss in self.losses(here, compiled))
        self._text = source.text
        accepted = {k.item for k in self._known if not _counts(k) and k.finding.state is not State.UNTRIED}
        for before, last in self._noted:
            fates = compare(before, here).fates
            self._clashed.update(now for i, (_, now) in fates.items() if now and i in self._clashed)
            heirs = {item: heir or fates[item][1] for item, heir in last.items()}
            last.clear()
            last.update((i, h) for i, h in heirs.items() if not _is_there(i, fates[i][0], accepted))
        self._clashed.update(item for item in here.items if item.clashes)
        self._noted.append((here, dict.fromkeys(here.items)))

    def restore(self, source: SourceFile) -> tuple[str, tuple[str, ...]]:
        """Puts back what an earlier program had, one by one, as long as no error or failed assert comes.
        Returns the text, and the phrases of what was put back.
        """
        settled = (State.IMPLIED, State.CONFLICTS, State.MENDED)
        known = self._known if source.text == self._text else ()
        prober = Prober(self._world, self._settings, _RESTORING, self._clashed)
        return _Restoring(self, prober, source).run({k.item for k in known if k.finding.state in settled})

    def inventory(self, source: SourceFile, compiled: Compiled | None) -> Inventory:
        program, found = front(source, self._world, self._settings)
        if compiled is None:
            return inventory(program.resolution, found)
        return inventory(program.resolution, compiled.diagnostics, compiled.model)

    def losses(self, here: Inventory, compiled: Compiled | None) -> Iterator[Loss]:
        """Yields items of noted programs that another lacks."""
        lost = [loss for before, last in self._noted for loss in _losses(last, compare(before, here))]
        items = {loss.item for loss in lost}
        heirs = {item: heir for _, last in self._noted for item, heir in last.items()}
        unread = compiled is None or any(d.code.startswith(_UNREAD) for d in compiled.diagnostics)
        text = _squeezed(here.source.text) if unread else ""
        # of a lost statement and its lost replacement the older is left out, or a wish
        both = ((item, heir) for item in items if (heir := heirs[item]) is not None and heir in items)
        twice = {heir if strength(heir) < strength(item) else item for item, heir in both}
        for loss in lost:
            if loss.item not in twice and not (unread and _mark(loss.item) in text):
                yield loss


def _losses(last: Collection[Item], changes: Changes) -> Iterator[Loss]:
    """Yields the items that a program was the last to have. Losses that follow from that of a structure, or
    of a thing they mention, are reported with it.
    """
    lost = [i for i in last if _is_missing(i, *changes.fates[i])]
    gone = {i.thing: i for i in lost if i.kind in _THINGS and changes.fates[i][0] is Fate.GONE}
    params = {i.thing[-1]: i for i in lost if i.kind is Kind.PARAM}
    dependents: dict[Item, list[Item]] = {}
    told: list[Item] = []

    def taken_along(path: Path) -> Item | None:
        """Returns the outermost lost holder of a thing, or the thing itself."""
        return next((gone[path[:k]] for k in range(1, len(path) + 1) if path[:k] in gone), None)

    for item in lost:
        if (taken_along(item.home) or gone.get(item.thing, item)) is not item:
            continue
        if item.home and item.home not in changes.before.things and item.home not in changes.after.bodies:
            continue  # in a definition that is not there, so that nothing uses it
        owner = next(filter(None, map(taken_along, sorted(item.things))), None)
        owner = owner or next((params[name] for name in sorted(names_in(item.key)) if name in params), None)
        if owner is not None and item.kind not in _THINGS:
            dependents.setdefault(owner, []).append(item)
        else:
            told.append(item)
    yield from (Loss(item, changes, dependents=tuple(dependents.get(item, ()))) for item in told)


def _is_missing(item: Item, fate: Fate, now: Item | None) -> bool:
    """True for a loss to report or try, as a rewritten statement may be; what diagnostics offer is none."""
    match fate:
        case Fate.GONE:
            return not item.may_go
        case Fate.WEAKENED:
            return not (item.may_go or item.may_bend)
        case Fate.REWRITTEN:
            return not item.wrong and item.kind is Kind.CONSTRAINT
    return fate is Fate.FEWER


def _is_there(item: Item, fate: Fate, accepted: set[Item]) -> bool:
    """True if the meaning of an item need not be looked for any more."""
    if fate is Fate.REWRITTEN:
        return item.wrong or item in accepted or item.kind is not Kind.CONSTRAINT
    return fate is Fate.KEPT


def _counts(loss: Loss) -> bool:
    """True for a loss, and not for a meaning that other words may have."""
    if loss.fate is Fate.REWRITTEN:
        return loss.finding.state in (State.FITS, State.CONFLICTS)
    return loss.finding.state is not State.IMPLIED


def _probed(loss: Loss, prober: Prober, base: Compiled | None) -> Loss:
    """Returns a loss with the result of putting it back, unless it may have been replaced."""
    if loss.kind is Kind.PARAM or not _has_room(loss):
        return loss
    finding, _ = prober.tried(loss.item, loss.changes, base, is_first=bool(loss.dependents))
    return replace(loss, finding=finding)


def _squeezed(text: str) -> str:
    """Returns a program without comments and white space."""
    return "".join("".join(line.split("//")[0].split()) for line in text.splitlines())


def _mark(item: Item) -> str:
    if item.kind is Kind.STRUCTURE:
        return "".join(item.span.text.split("{")[0].split())
    return _squeezed(item.node.span.text)


class _Restoring:
    """A program into which losses are put back one after another."""

    def __init__(self, ledger: Ledger, prober: Prober, source: SourceFile) -> None:
        self.ledger, self.prober, self.source = ledger, prober, source
        self.base = prober.compiled(source)
        self.here = ledger.inventory(source, self.base)
        self.done: list[str] = []

    def run(self, settled: set[Item]) -> tuple[str, tuple[str, ...]]:
        found = self.ledger.losses(self.here, self.base) if stands(self.base) else ()
        lost = [loss for loss in found if loss.item not in settled]
        for loss in sorted(lost, key=lambda loss: _ORDER.index(loss.kind)):
            if loss.kind in _THINGS or loss.kind is Kind.PARAM:
                if _has_room(loss):
                    self._put_thing(loss)
            elif self._put(loss.item, loss.changes.before):
                self.done.append(named(loss.item, loss.changes.before))
        return self.source.text, tuple(self.done)

    def _put(self, item: Item, inventory: Inventory, is_first: bool = False) -> bool:
        """Puts back an item; returns False if that fails."""
        finding, tried = self.prober.tried(item, compare(inventory, self.here), self.base, is_first)
        if tried is None or finding.state is not State.FITS:
            return False
        self.source, self.base = tried
        self.here = self.ledger.inventory(self.source, self.base)
        return True

    def _put_thing(self, loss: Loss) -> None:
        """Puts back a structure, geometry or parameter, with its mentions; alone it makes no sense if there
        were any, and a parameter never does. Of conflicting statements nobody knows which one was right.
        """
        now, inventory = (self.source, self.base, self.here), loss.changes.before
        clear = [item for item in loss.dependents if not item.clashes]
        if not self._put(loss.item, inventory, is_first=bool(clear)):
            return
        kept = [item for item in clear if self._put(item, inventory)]
        is_idle = not kept and (clear or loss.kind is Kind.PARAM)
        if is_idle or any(new_errors(inventory, now[1], self.base)):
            self.source, self.base, self.here = now
            return
        self.done += [named(item, inventory) for item in (loss.item, *kept)]


def _has_room(loss: Loss) -> bool:
    """True if something can be put back as it was: nothing new stands in the place of the thing itself."""
    if loss.fate is Fate.FEWER or loss.kind not in _THINGS:
        return loss.fate is not Fate.FEWER
    paths = loss.changes.paths
    home, known = paths.get(loss.item.home, loss.item.home), set(paths.values())
    things = loss.changes.after.things
    return not any(other.home == home and path not in known for path, other in things.items())


__all__ = ["Kind", "Ledger", "Loss", "request"]
