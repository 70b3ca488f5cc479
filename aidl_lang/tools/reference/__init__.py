"""Documentation generated from the sources: the library's own comments, the sections on built-ins.

`collect` gathers, `signatures` reads definitions, `pages` words an entry, `guide` the whole language.
"""
