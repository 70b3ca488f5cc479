"""Lengths and sizes of paper and sheets on the command line; see `checking/sizes.py`."""

from __future__ import annotations

from argparse import ArgumentTypeError


def size(text: str) -> tuple[float, float]:
    from aidl_lang.checking import sizes

    try:
        return sizes.size(text)
    except ValueError as reason:
        raise ArgumentTypeError(str(reason)) from None


def length(text: str) -> float:
    from aidl_lang.checking import sizes

    try:
        return sizes.length(text)
    except ValueError as reason:
        raise ArgumentTypeError(str(reason)) from None
