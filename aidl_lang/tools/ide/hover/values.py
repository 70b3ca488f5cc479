"""The values shown on hovering, as lists in Markdown, or the reason why there are none."""

from __future__ import annotations

from collections.abc import Sequence

from aidl_lang.syntax import ast
from aidl_lang.tools.ide.describing import joined
from aidl_lang.tools.ide.hover.solved_values import Solved, solved_of
from aidl_lang.tools.ide.hover.telling import constraint_lines
from aidl_lang.tools.ide.view import View

_STATED = ast.ExpressionStatement | ast.Equation | ast.Prefer


def listed(told: Sequence[str]) -> str:
    return "\n".join(f"- `{line}`" for line in told)


def not_solved(view: View) -> str:
    """Returns the reason for a missing value; "" while the text is being worked on for the first time."""
    if view.outcome is not None:
        return "*There is no value: the program has errors.*"
    return "" if view.drawn is None else "*The value is being worked out.*"


def failed(solved: Solved) -> str:
    model = solved.outcome.model
    if model is None or model.status == "solved":
        return ""
    return "*The constraints do not hold together: this is where the solver came nearest.*"


def stated_at(view: View, node: ast.Node, path: Sequence[ast.Node]) -> str:
    """Tells how well the constraint holds whose head is a call or a sign."""
    solved = solved_of(view)
    if solved is None:
        return ""
    for each in reversed(path):
        may_be_one = isinstance(each, _STATED | ast.Comparison | ast.Call | ast.Membership)
        if may_be_one and (told := constraint_lines(solved, each.span)):
            return joined([*told, failed(solved)])
        if isinstance(each, ast.Block):
            break
    return ""
