"""How well programs answer what was asked for: prompts, what their drawings must have, and runs over both."""
