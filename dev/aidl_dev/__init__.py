"""Writes the files of a checkout that are generated: the reference, the guide, what editors read."""
