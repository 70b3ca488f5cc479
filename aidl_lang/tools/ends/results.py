"""The results of trying the ends of params."""

from __future__ import annotations

from aidl_lang.building.model import Knob
from aidl_lang.common.records import record
from aidl_lang.tools.ends.values import Value
from aidl_lang.tools.sweeping.faults import Fault


@record()
class Tried:
    """The result of one value. `faults` has its errors, or else its warnings."""

    ok: bool
    faults: tuple[Fault, ...] = ()
    seconds: float = 0.0
    was_given_up: bool = False


@record()
class Turned:
    """A param at one end of its range, or with another choice.

    works     the last good value on the way there
    beyond    the next value, with its result; None if there are no values in between
    """

    knob: Knob
    value: Value
    tried: Tried
    works: float | None = None
    beyond: tuple[float, Tried] | None = None

    @property
    def ok(self) -> bool:
        return self.tried.ok


@record()
class Sweep:
    """The results at the ends of all params.

    turned     in the order of the params, the lower end before the upper
    rangeless  params without a range or choices, which have nothing to try
    left       ends that were not tried, for want of time or because there are too many
    compiled   number of programs compiled for it
    """

    turned: tuple[Turned, ...]
    rangeless: tuple[Knob, ...]
    left: int
    compiled: int
    seconds: float

    @property
    def ok(self) -> bool:
        return not self.left and all(each.ok for each in self.turned)
