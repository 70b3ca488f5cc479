"""Pictures for a model: whole files of known formats, no larger than a model looks at."""

from __future__ import annotations

import errno
import io
import struct
import warnings
import zlib
from pathlib import Path
from typing import TYPE_CHECKING

from aidl_lang.common.diagnostics import Diagnostic
from aidl_lang.common.reading import Reads
from aidl_lang.tools.llm.messages import Image

if TYPE_CHECKING:
    from PIL.Image import Image as Picture

MAX_FILE = 50_000_000
MAX_SENT = 3_500_000
"""Most bytes; base64 makes them a third more, and 5 MB is what providers take."""

MAX_SIDE = 2048
"""Largest side in pixels; the models themselves look at fewer."""

_TYPES = {"PNG": "image/png", "JPEG": "image/jpeg", "WEBP": "image/webp", "GIF": "image/gif"}
_ORIENTATION = 0x0112
_BROKEN = (OSError, ValueError, SyntaxError, EOFError, IndexError, OverflowError, struct.error, zlib.error)
"""Errors of pillow for broken files."""


class ImageError(Exception):
    """Raised if the picture cannot be used."""

    def __init__(self, message: str, *hints: str) -> None:
        super().__init__(message)
        self.diagnostic = Diagnostic("E0939", message, hints=hints)


def read_image(name: str, reads: Reads | None = None) -> Image:
    """Returns the picture in a file, scaled down and turned upright if needed; raises ImageError."""
    try:
        data = (reads or Reads()).contents(name, MAX_FILE)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        hints = ["scale it down"] if getattr(error, "errno", 0) == errno.EFBIG else []
        raise ImageError(
            f"the image `{name}` cannot be read: {reason[:1].lower()}{reason[1:]}", *hints
        ) from None
    return to_image(data, name)


def to_image(data: bytes, name: str) -> Image:
    """Does as `read_image`, with the file's content, which tells the format rather than the name."""
    import PIL.Image

    bomb = (PIL.Image.DecompressionBombError, PIL.Image.DecompressionBombWarning)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            warnings.simplefilter("error", PIL.Image.DecompressionBombWarning)
            with PIL.Image.open(io.BytesIO(data), formats=tuple(_TYPES)) as picture:
                picture.load()
                return _fitting(picture, data)
    except PIL.UnidentifiedImageError:
        raise ImageError(f"`{name}` is no PNG, JPEG, WebP or GIF", *_remedy(name)) from None
    except bomb:
        raise ImageError(f"the image `{name}` has too many pixels", "scale it down") from None
    except _BROKEN as error:
        raise ImageError(f"the image `{name}` is broken: {error}", "save it again") from None


def _remedy(name: str) -> list[str]:
    if Path(name).suffix in (".aidl", ".svg"):
        return [f"draw the program first: aidl compile {Path(name).with_suffix('.aidl')} -o picture.png"]
    return ["save it as PNG"]


def _fitting(picture: Picture, data: bytes) -> Image:
    """Returns the file itself if it is small enough, else its first frame as PNG or, when that is too long,
    JPEG.
    """
    from PIL import ImageOps

    is_upright = picture.getexif().get(_ORIENTATION, 1) == 1
    if is_upright and max(picture.size) <= MAX_SIDE and len(data) <= MAX_SENT and picture.format:
        return Image(_TYPES[picture.format], data)
    upright = ImageOps.exif_transpose(picture)
    upright = upright.convert("RGBA" if upright.has_transparency_data else "RGB")
    upright.thumbnail((MAX_SIDE, MAX_SIDE))
    as_png = _saved(upright, "PNG")
    return as_png if len(as_png.data) <= MAX_SENT else _saved(_on_white(upright), "JPEG")


def _on_white(picture: Picture) -> Picture:
    import PIL.Image

    paper = PIL.Image.new("RGBA", picture.size, "white")
    return PIL.Image.alpha_composite(paper, picture.convert("RGBA")).convert("RGB")


def _saved(picture: Picture, kind: str) -> Image:
    file = io.BytesIO()
    picture.save(file, kind, quality=85)
    return Image(_TYPES[kind], file.getvalue())
