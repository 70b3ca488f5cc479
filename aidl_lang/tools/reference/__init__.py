"""Documentation made from the sources: the library's own comments, the sections on what is built in.

`collect` gathers, `signatures` reads definitions, `pages` and `guide` write Markdown.
"""
