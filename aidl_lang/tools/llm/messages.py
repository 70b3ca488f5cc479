"""Messages to and from a language model, and the interface to the language of its programs."""

from __future__ import annotations

import errno
import io
import re
import struct
import warnings
import zlib
from base64 import b64encode
from collections.abc import Callable, Mapping, Sequence
from dataclasses import field
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Literal, Protocol, TypeVar

from aidl_lang.common.diagnostics import AidlError, Diagnostic
from aidl_lang.common.records import record
from aidl_lang.common.world import Reads

if TYPE_CHECKING:
    from PIL.Image import Image as Picture

    from aidl_lang.pipeline import Compiled


# --- Pictures for a model: whole files of known formats, no larger than a model looks at.

MAX_FILE = 50_000_000
MAX_SENT = 3_500_000
"""Most bytes; base64 makes them a third more, and 5 MB is what providers take."""

MAX_SIDE = 2048
"""Largest side in pixels; the models themselves look at fewer."""

_TYPES = {"PNG": "image/png", "JPEG": "image/jpeg", "WEBP": "image/webp", "GIF": "image/gif"}
_ORIENTATION = 0x0112
_BROKEN = (OSError, ValueError, SyntaxError, EOFError, IndexError, OverflowError, struct.error, zlib.error)
"""Errors of pillow for broken files."""


class ImageError(AidlError):
    """Raised if the picture cannot be used."""

    def __init__(self, message: str, *hints: str) -> None:
        super().__init__(Diagnostic("E0939", message, hints=hints))


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
    from PIL import ImageOps

    bomb = (PIL.Image.DecompressionBombError, PIL.Image.DecompressionBombWarning)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            warnings.simplefilter("error", PIL.Image.DecompressionBombWarning)
            with PIL.Image.open(io.BytesIO(data), formats=tuple(_TYPES)) as picture:
                picture.load()
                is_upright = picture.getexif().get(_ORIENTATION, 1) == 1
                if is_upright and max(picture.size) <= MAX_SIDE and len(data) <= MAX_SENT and picture.format:
                    return Image(_TYPES[picture.format], data)
                upright = ImageOps.exif_transpose(picture)
                upright = upright.convert("RGBA" if upright.has_transparency_data else "RGB")
                upright.thumbnail((MAX_SIDE, MAX_SIDE))
                as_png = _saved(upright, "PNG")
                return as_png if len(as_png.data) <= MAX_SENT else _saved(_on_white(upright), "JPEG")
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


def _on_white(picture: Picture) -> Picture:
    import PIL.Image

    paper = PIL.Image.new("RGBA", picture.size, "white")
    return PIL.Image.alpha_composite(paper, picture.convert("RGBA")).convert("RGB")


def _saved(picture: Picture, kind: str) -> Image:
    file = io.BytesIO()
    picture.save(file, kind, quality=85)
    return Image(_TYPES[kind], file.getvalue())


Role = Literal["system", "user", "assistant"]


@record()
class Image:
    """A picture as part of a message, with its media type (`image/png`)."""

    media_type: str
    data: bytes

    @property
    def base64(self) -> str:
        return b64encode(self.data).decode()

    @property
    def uri(self) -> str:
        return f"data:{self.media_type};base64,{self.base64}"


@record()
class Message:
    role: Role
    text: str
    images: tuple[Image, ...] = ()


@record()
class Sampling:
    """Parameters of a reply. None leaves them to the server."""

    seed: int | None = None
    temperature: float | None = None
    max_tokens: int | None = None
    extra: Mapping[str, object] = field(default_factory=dict)
    """Further members of the request, as a grammar for servers that constrain decoding."""


@record()
class Usage:
    """Tokens, and dollars where they are known; None is unknown, and stays so in a sum."""

    input: int | None = 0
    output: int | None = 0
    cost: float | None = 0.0

    def __add__(self, other: Usage) -> Usage:
        counts = _total(self.input, other.input), _total(self.output, other.output)
        return Usage(*counts, _total(self.cost, other.cost))


N = TypeVar("N", int, float)


def _total(a: N | None, b: N | None) -> N | None:
    return None if a is None or b is None else a + b


class Finish(StrEnum):
    """The reason why a reply ended."""

    COMPLETE = "complete"
    CUT = "cut"  # at the limit on tokens
    REFUSED = "refused"


@record()
class Reply:
    """What a model has answered.

    model    as the server names it
    seconds  until the whole reply was there
    date     the day of the reply, as in 2026-01-31
    """

    text: str
    usage: Usage
    finish: Finish
    model: str
    seconds: float | None = None
    date: str | None = None


class ProviderError(AidlError):
    """Raised if no reply could be had after all retries; the diagnostic gives the reason and a remedy."""

    def __init__(self, code: str, message: str, *hints: str) -> None:
        super().__init__(Diagnostic(code, message, hints=hints))


class ConversationOver(Exception):  # noqa: N818 (what came of it, no error of ours)
    """Raised by a provider that has no further reply and is not to be asked again: a recording that ends."""


class Provider(Protocol):
    """The source of replies: a server or a command."""

    @property
    def name(self) -> str:
        """Its name for people and records: `openai:gpt-5`, `exec:./reply.py`; without any key."""

    @property
    def takes_seeds(self) -> bool:
        """True if a request may contain a seed."""

    @property
    def takes_grammars(self) -> bool:
        """True if a request may contain a grammar for the reply."""

    def reply(self, messages: Sequence[Message], sampling: Sampling, hear: Callable[[str], None]) -> Reply:
        """Ask for the next message. `hear` gets the pieces of the text as they arrive.

        A reply that breaks off is asked for again, and its pieces are heard from the beginning.

        Raises ProviderError or ConversationOver. May be called from several threads at once.
        """


# --- Finds the program in a model's reply.

_THOUGHT = re.compile(r"<(think|thinking|reasoning)>.*?(</\1>|\Z)", re.S)
_FENCE = re.compile(r"^[ \t]*(`{3,}|~{3,})[ \t]*([^\s`]*)[^\n`]*$", re.M)


def find_program(text: str, fences: Sequence[str], reads: Callable[[str], bool]) -> tuple[str | None, bool]:
    """Returns the last fenced block: of those with one of the names `fences` if there is one, else of all;
    None if there is none. With it comes whether the reply ends inside a block.

    A reply without a fence may be a program itself, which `reads` tells. Thoughts between tags are no part of
    the reply, and a block that is not closed holds no whole program.
    """
    spoken = _THOUGHT.sub("", text)
    blocks: list[tuple[str, str]] = []
    opened: re.Match[str] | None = None
    for fence in _FENCE.finditer(spoken):
        if opened is None:
            opened = fence
        elif fence[1].startswith(opened[1]) and not fence[2]:
            blocks.append((opened[2].lower(), spoken[opened.end() + 1 : fence.start()]))
            opened = None
    if not blocks:
        bare = spoken.strip()
        is_program = opened is None and bool(bare) and reads(bare)
        return f"{bare}\n" if is_program else None, opened is not None
    named = [program for name, program in blocks if name in fences]
    return named[-1] if named else blocks[-1][1], opened is not None


# --- The interface between a conversation and the language of its programs.


@record()
class Verdict:
    """The judgement of one program.

    stage       the stage that failed, or `done`
    feedback    for the model: the errors and their remedies; for a right program, remarks or nothing
    program     the program after mending
    fixes       the titles of the fixes that were made
    codes       the codes of the errors left
    is_partial  true for a program to be continued: the model is shown its state, and asked to go on
    images      pictures that go with the feedback
    missing     intents of earlier programs of the conversation that this one lost, a phrase each
    weight      distance from right, to choose the best of several: less is better
    numbers     counts of structures, constraints, degrees
    """

    ok: bool
    stage: str
    feedback: str
    program: str
    fixes: tuple[str, ...] = ()
    codes: tuple[str, ...] = ()
    is_partial: bool = False
    images: tuple[Image, ...] = ()
    missing: tuple[str, ...] = ()
    weight: tuple[int, ...] = ()
    numbers: Mapping[str, float] = field(default_factory=dict)
    compiled: Compiled | None = None


class Conversation(Protocol):
    """Judges the programs of one conversation in turn; remembers the intents of earlier ones."""

    def judge(self, program: str) -> Verdict: ...

    def finish(self, verdict: Verdict) -> Verdict:
        """Returns the last verdict on the kept program, with everything lost put back that fits."""


class Language(Protocol):
    @property
    def name(self) -> str:
        """`full`, `no-hierarchy`, `no-constraints`, `openscad`."""

    @property
    def suffix(self) -> str:
        """The suffix of its files: `.aidl`."""

    @property
    def fences(self) -> tuple[str, ...]:
        """Names after the opening fence of a block that may hold a program, in small letters."""

    def guide(self) -> str:
        """The system prompt."""

    def reads(self, text: str) -> bool:
        """Tells whether a text without a fence is a program."""

    def conversation(self, before: str | None = None) -> Conversation:
        """Returns a new conversation; `before` is the program to be changed, if any."""
