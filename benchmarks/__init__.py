"""Measurements. Nothing in the package imports them."""
