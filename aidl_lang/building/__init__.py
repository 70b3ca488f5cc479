"""The run of a program: it becomes a tree of structures with constraints, and that the solver's problem.

`interp` is the door from a checked program to its model, and the way there from a text; `lower` is the last
step.
"""
