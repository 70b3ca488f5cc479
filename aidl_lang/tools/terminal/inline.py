"""PNG as it is, in the envelopes of kitty and of iTerm2.

https://sw.kovidgoyal.net/kitty/graphics-protocol/, https://iterm2.com/documentation-images.html
"""

from __future__ import annotations

from base64 import standard_b64encode

_CHUNK = 4096


def kitty(png: bytes, columns: int, rows: int) -> str:
    """Returns the picture over so many cells, in chunks. A terminal answers unless told not to (`q=2`), and
    the shell would take the answer for typing.
    """
    text = standard_b64encode(png).decode()
    chunks = [text[k : k + _CHUNK] for k in range(0, len(text), _CHUNK)]
    heads = [f"a=T,f=100,q=2,c={columns},r={rows}"] + ["q=2"] * (len(chunks) - 1)
    more = [1] * (len(chunks) - 1) + [0]
    return "".join(
        f"\x1b_G{head},m={m};{chunk}\x1b\\" for head, m, chunk in zip(heads, more, chunks, strict=True)
    )


def iterm(png: bytes, columns: int, rows: int) -> str:
    """Returns the picture within so many cells."""
    head = f"inline=1;size={len(png)};width={columns};height={rows};preserveAspectRatio=1"
    return f"\x1b]1337;File={head}:{standard_b64encode(png).decode()}\x07"
