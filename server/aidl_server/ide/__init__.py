"""The answers to an editor's questions about a program, one file for each kind of question.

Each answer is a pure function of a `View`: one text of a program with all that is known of it. Places are
offsets in code points and spans; protocols convert them.
"""
