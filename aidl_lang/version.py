"""The version, in a module of its own so that `aidl --version` loads nothing else."""

__version__ = "0.2.0"
