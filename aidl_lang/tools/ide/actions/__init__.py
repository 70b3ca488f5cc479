"""Code actions: fixes, and changes that keep the drawing.

Each action is found cheaply and carried out when it is chosen; those that could go wrong try the changed
program first, and refuse if the result is not what the title promises.
"""

from __future__ import annotations

from aidl_lang.tools.ide.actions.action import Action
from aidl_lang.tools.ide.actions.allowing import allowances
from aidl_lang.tools.ide.actions.constraining import missing_constraints
from aidl_lang.tools.ide.actions.extracting import extractions
from aidl_lang.tools.ide.actions.fixes import fixes
from aidl_lang.tools.ide.actions.naming import namings
from aidl_lang.tools.ide.actions.writing import writings
from aidl_lang.tools.ide.view import View

__all__ = ["Action", "actions"]


def actions(view: View, start: int, end: int) -> list[Action]:
    """Returns the actions for a selection of the text, or for the cursor if both ends are the same."""
    return [
        *fixes(view, start, end),
        *allowances(view, start, end),
        *missing_constraints(view, start),
        *namings(view, start, end),
        *extractions(view, start),
        *writings(view, start, end),
    ]
