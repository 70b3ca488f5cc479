"""Untrusted Python, run in processes that can open nothing, start nothing and not go on for ever.

The scripts here import nothing of the project: an interpreter with another set of packages runs them.
"""
