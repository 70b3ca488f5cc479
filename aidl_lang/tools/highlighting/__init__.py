"""Syntax colours: the class of each token, and the grammars for editors and for Pygments made from these."""
