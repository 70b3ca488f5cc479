"""Explanations of a solution: conflicts, sizes that gave way, numbers that would fit, assertions that fail.

A remedy is tried on the program before it is offered (`trials`). `outcome` explains a drawing that solved.
"""
