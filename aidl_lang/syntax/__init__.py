"""The syntax: text becomes a tree (`ast`), and a tree its canonical text (`printer`). `parser` is the
door.
"""
