"""Modules that all rooms share: text and places in it, diagnostics, files, time, names, letters."""
