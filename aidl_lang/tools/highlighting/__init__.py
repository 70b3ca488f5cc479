"""Syntax colours: the class of each token, and the lexer for Pygments made from these."""
