"""Parts of the static check: facts about expressions, calls, conditions, validity. `typecheck` is the pass."""
