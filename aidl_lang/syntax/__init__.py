"""The syntax: text becomes a tree (`ast`), a tree its canonical text (`printer`). `parser` is the door."""
