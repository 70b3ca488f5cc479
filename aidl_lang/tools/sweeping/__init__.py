"""Tries a program with many settings of its params, on this machine or on a cluster."""
