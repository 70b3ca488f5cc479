"""Which definition each name means, and whether all is right that can be known before the program is run.

`typecheck` is the door; `resolve` comes before it. The standard library stands here, checked (`library`).
"""
