"""The results of trying the ends of params."""

from __future__ import annotations

from aidl_lang.building.model import Knob
from aidl_lang.common.records import record
from aidl_lang.tools.ends.values import Value


@record()
class Fault:
    """A diagnostic of a compile without its sources.

    text   the source text at its place, in one line
    file   the file of its place, with its line; None without a place
    """

    code: str
    message: str
    label: str = ""
    text: str = ""
    file: str | None = None
    line: int | None = None

    @property
    def is_error(self) -> bool:
        return self.code.startswith("E")

    @property
    def place(self) -> tuple[str, str | None, int | None]:
        """Returns the key by which it is recognised at another value."""
        return self.code, self.file, self.line


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
