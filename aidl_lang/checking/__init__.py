"""The checks before a program is run: the definition that each name means, types, dimensions and validity.

`typecheck` is the door; `resolve` comes before it. The standard library stands here, checked (`library`).
"""
