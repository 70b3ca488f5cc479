"""A loss of a conversation."""

from __future__ import annotations

from aidl_lang.common.records import record
from aidl_lang.tools.llm.intent.changes import Fate
from aidl_lang.tools.llm.intent.inventory import Inventory, Item, Kind
from aidl_lang.tools.llm.intent.placing import UNTRIED, Finding, dotted


@record(eq=False)
class Loss:
    """An intent of an earlier program that the present one lacks.

    item        the lost item, and `inventory` that of its program
    fate        gone, fewer, weakened to a wish or a check, or rewritten to something that says less
    now         its replacement, if any
    finding     whether it would fit again, and its conflicts
    dependents  for structures and geometry: the items that mentioned them and went with them
    counts      for something that is fewer now: the former and the present number
    """

    item: Item
    inventory: Inventory
    fate: Fate
    now: Item | None = None
    finding: Finding = UNTRIED
    dependents: tuple[Item, ...] = ()
    counts: tuple[int, int] = (0, 0)

    @property
    def kind(self) -> Kind:
        return self.item.kind

    @property
    def is_doubtful(self) -> bool:
        """True if it may well be meant: asking for it once is enough."""
        return self.fate is Fate.FEWER

    @property
    def path(self) -> str:
        """The dotted path of the structure that held it; "" for the outermost."""
        return dotted(self.item.home)

    @property
    def text(self) -> str:
        """The author's words, on one line; for a structure its name."""
        return self.item.text

    @property
    def phrase(self) -> str:
        """The loss in words."""
        from aidl_lang.tools.llm.intent.ledger import phrase

        return phrase(self)
