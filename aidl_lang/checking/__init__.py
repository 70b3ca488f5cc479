"""Parts of the static check: facts about expressions, conditions, validity. `typecheck` is the pass."""
