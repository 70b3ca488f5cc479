"""Colours for programs: what each token is, and the grammars for editors and for Pygments made from that."""
