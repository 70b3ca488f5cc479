"""What the programs of a conversation meant, one after another, and what was lost on the way."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import field, replace

from aidl_lang.common.records import record
from aidl_lang.common.source import SourceFile
from aidl_lang.common.world import World
from aidl_lang.pipeline import Compiled, Settings, front
from aidl_lang.tools.llm.intent.canonical import Path, names_in
from aidl_lang.tools.llm.intent.changes import Changes, Fate, compare, strength
from aidl_lang.tools.llm.intent.inventory import Inventory, Item, Kind, unnumbered
from aidl_lang.tools.llm.intent.loss import Loss
from aidl_lang.tools.llm.intent.probing import Prober, State, new_errors, stands
from aidl_lang.tools.llm.intent.taking import inventory
from aidl_lang.tools.llm.intent.wording import named

_PROBES = 12
"""Times that a program is compiled to try what it lost."""
_RESTORING = 30
"""The same for putting back what fits."""
_THINGS = frozenset({Kind.STRUCTURE, Kind.GEOMETRY})
_UNREAD = ("E01", "E08")
"""Errors after which a part of a program may not have been read."""
_ORDER = tuple(Kind)
"""In which losses are put back: what is spoken of before what speaks of it."""


@record()
class Restored:
    """A program with what fits back into it, and the phrases of what was put back."""

    text: str
    items: tuple[str, ...]


@record(eq=False)
class _Noted:
    """A program of the conversation, and the items for which it is the last that had them; for each, what
    stood in its place in the next program, if anything did.
    """

    inventory: Inventory
    last: dict[Item, Item | None] = field(default_factory=dict)


class Ledger:
    """Remembers what the programs of one conversation meant. `note` each in turn; `missing` is then what any
    earlier one had and the last one lacks.

    A program that is to be edited is noted first: what was asked to go will be missing as well.
    """

    def __init__(self, world: World | None = None, settings: Settings | None = None) -> None:
        self._world, self._settings = world, settings or Settings()
        self._noted: list[_Noted] = []
        self._clashed: set[Item] = set()
        self._text = ""
        self._known: tuple[Loss, ...] = ()

    @property
    def missing(self) -> tuple[Loss, ...]:
        """What is lost now, in the order of the programs and of writing."""
        return tuple(loss for loss in self._known if _counts(loss))

    def note(self, source: SourceFile, compiled: Compiled | None) -> None:
        """Take down a program, and what came of it (None if it was not compiled)."""
        here = self.inventory(source, compiled)
        prober = self._prober(source, _PROBES)
        self._known = tuple(_probed(loss, c, prober, compiled) for loss, c in self.losses(here, compiled))
        self._text = source.text
        accepted = {k.item for k in self._known if not _counts(k) and k.finding.state is not State.UNTRIED}
        for noted in self._noted:
            fates = compare(noted.inventory, here).fates
            self._clashed.update(now for i, (_, now) in fates.items() if now and i in self._clashed)
            heirs = {item: heir or fates[item][1] for item, heir in noted.last.items()}
            noted.last.clear()
            noted.last.update((i, h) for i, h in heirs.items() if not _is_there(i, fates[i][0], accepted))
        self._clashed.update(item for item in here.items if item.clashes)
        self._noted.append(_Noted(here, dict.fromkeys(here.items)))

    def restore(self, source: SourceFile) -> Restored:
        """Put back what an earlier program had and this one lacks, as far as it fits with everything: one
        after another, each kept only if the program still solves, without new errors or failed asserts.
        """
        settled = (State.IMPLIED, State.CONFLICTS, State.MENDED)
        known = self._known if source.text == self._text else ()
        prober = self._prober(source, _RESTORING)
        return _Restoring(self, prober, source).run({k.item for k in known if k.finding.state in settled})

    def _prober(self, source: SourceFile, most: int) -> Prober:
        return Prober(source.name, self._world, self._settings, most, self._clashed)

    def inventory(self, source: SourceFile, compiled: Compiled | None) -> Inventory:
        """What a program means to have."""
        program, found = front(source, self._world, self._settings)
        if compiled is None:
            return inventory(program.resolution, found)
        return inventory(program.resolution, compiled.diagnostics, compiled.model)

    def losses(self, here: Inventory, compiled: Compiled | None) -> Iterator[tuple[Loss, Changes]]:
        """What noted programs had and another lacks, with the changes since."""
        reports: list[tuple[Loss, Changes]] = []
        for noted in self._noted:
            changes = compare(noted.inventory, here)
            reports += ((loss, changes) for loss in _losses(noted, changes))
        items = {loss.item for loss, _ in reports}
        heirs = {item: heir for noted in self._noted for item, heir in noted.last.items()}
        unread = compiled is None or any(d.code.startswith(_UNREAD) for d in compiled.diagnostics)
        text = _squeezed(here.source.text) if unread else ""
        twice = {_lesser(item, heir) for item in items if (heir := heirs[item]) in items and heir is not None}
        for loss, changes in reports:
            if loss.item not in twice and not (unread and _mark(loss.item) in text):
                yield loss, changes


def _losses(noted: _Noted, changes: Changes) -> Iterator[Loss]:
    """What another program lacks of what one was the last to have. What goes with a structure, or with what
    it speaks of, is told with that.
    """
    lost = [i for i in noted.last if _is_missing(i, *changes.fates[i])]
    gone = {i.thing: i for i in lost if i.kind in _THINGS and changes.fates[i][0] is Fate.GONE}
    params = {i.thing[-1]: i for i in lost if i.kind is Kind.PARAM}
    dependents: dict[Item, list[Item]] = {}
    told: list[Item] = []

    def taken_along(path: Path) -> Item | None:
        """The outermost that is gone of what holds a thing, and of the thing itself."""
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
    for item in told:
        fate, now = changes.fates[item]
        yield Loss(
            item,
            noted.inventory,
            fate,
            now,
            dependents=tuple(dependents.get(item, ())),
            counts=(_count(changes.before, item), _count(changes.after, now)),
        )


def _count(inventory: Inventory, item: Item | None) -> int:
    return inventory.counts[unnumbered(item.thing)] if item is not None else 0


def _lesser(item: Item, heir: Item) -> Item:
    """Which of a statement and what it became is not told when both are lost: the older, but for a wish."""
    return heir if strength(heir) < strength(item) else item


def _is_missing(item: Item, fate: Fate, now: Item | None) -> bool:
    """Whether something is to be told, or to be tried: a statement that was right may not have been rewritten
    to one that says less. What a diagnostic offered is no loss.
    """
    match fate:
        case Fate.GONE:
            return not item.may_go
        case Fate.WEAKENED:
            return not (item.may_go or item.may_bend)
        case Fate.REWRITTEN:
            return not item.wrong and item.kind is Kind.CONSTRAINT
    return fate is Fate.FEWER


def _is_there(item: Item, fate: Fate, accepted: set[Item]) -> bool:
    """Whether what an item meant need not be looked for any more."""
    if fate is Fate.REWRITTEN:
        return item.wrong or item in accepted or item.kind is not Kind.CONSTRAINT
    return fate not in (Fate.GONE, Fate.WEAKENED, Fate.FEWER)


def _counts(loss: Loss) -> bool:
    """A loss, and not what other words may say as well."""
    if loss.fate is Fate.REWRITTEN:
        return loss.finding.state in (State.FITS, State.CONFLICTS)
    return loss.finding.state is not State.IMPLIED


def _probed(loss: Loss, changes: Changes, prober: Prober, base: Compiled | None) -> Loss:
    """A loss with what comes of putting it back, unless something may stand in its place."""
    if loss.kind is Kind.PARAM or not _has_room(loss, changes):
        return loss
    trial = prober.tried(loss.item, changes, base, is_first=bool(loss.dependents))
    return replace(loss, finding=trial.finding)


def _squeezed(text: str) -> str:
    """A program without comments and white space."""
    return "".join("".join(line.split("//")[0].split()) for line in text.splitlines())


def _mark(item: Item) -> str:
    """What an item leaves in a text that could not be read."""
    node = item.node
    if item.kind is Kind.STRUCTURE:
        return "".join(item.span.text.split("{")[0].split())
    return _squeezed(node.span.text)


class _Restoring:
    """A program into which losses are put back one after another."""

    def __init__(self, ledger: Ledger, prober: Prober, source: SourceFile) -> None:
        self.ledger, self.prober, self.source = ledger, prober, source
        self.base = prober.compiled(source)
        self.here = ledger.inventory(source, self.base)
        self.done: list[str] = []

    def run(self, settled: set[Item]) -> Restored:
        found = self.ledger.losses(self.here, self.base) if stands(self.base) else ()
        lost = [(loss, changes) for loss, changes in found if loss.item not in settled]
        for loss, changes in sorted(lost, key=lambda pair: _ORDER.index(pair[0].kind)):
            if loss.kind in _THINGS or loss.kind is Kind.PARAM:
                if _has_room(loss, changes):
                    self._put_thing(loss)
            elif self._put(loss.item, loss.inventory):
                self.done.append(named(loss.item, loss.inventory))
        return Restored(self.source.text, tuple(self.done))

    def _put(self, item: Item, inventory: Inventory, is_first: bool = False) -> bool:
        """Whether an item could be put back."""
        trial = self.prober.tried(item, compare(inventory, self.here), self.base, is_first)
        if trial.compiled is None or trial.finding.state is not State.FITS:
            return False
        self.source, self.base = trial.source, trial.compiled
        self.here = self.ledger.inventory(self.source, self.base)
        return True

    def _put_thing(self, loss: Loss) -> None:
        """Put back a structure, geometry or parameter, and what spoke of it; alone it makes no sense if
        anything did, and a parameter never does. Of statements that did not hold together nobody knows which
        one was right.
        """
        before = self.source, self.base, self.here
        clear = [item for item in loss.dependents if not item.clashes]
        if not self._put(loss.item, loss.inventory, is_first=bool(clear)):
            return
        kept = [item for item in clear if self._put(item, loss.inventory)]
        is_idle = not kept and (clear or loss.kind is Kind.PARAM)
        if is_idle or any(new_errors(loss.inventory, before[1], self.base)):
            self.source, self.base, self.here = before
            return
        self.done += [named(item, loss.inventory) for item in (loss.item, *kept)]


def _has_room(loss: Loss, changes: Changes) -> bool:
    """Whether something can be put back as it was: it is not there at all, and where a structure or geometry
    was stands nothing new, perhaps in its place.
    """
    if loss.fate is Fate.FEWER or loss.kind not in _THINGS:
        return loss.fate is not Fate.FEWER
    home = changes.paths.get(loss.item.home, loss.item.home)
    known = set(changes.paths.values())
    return not any(o.home == home and path not in known for path, o in changes.after.things.items())
