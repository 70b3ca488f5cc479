"""Parts of name resolution: symbols and scopes, declarations, imports. `resolve` is the pass."""
