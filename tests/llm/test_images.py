"""Pictures for a model."""

from __future__ import annotations

import io
import struct
import zlib
from pathlib import Path

import numpy
import PIL.Image
import pytest

from aidl_lang.tools.llm import messages
from aidl_lang.tools.llm.messages import MAX_FILE, ImageError, read_image


def encoded(picture: PIL.Image.Image, kind: str, **more: object) -> bytes:
    file = io.BytesIO()
    picture.save(file, kind, **more)
    return file.getvalue()


def failure(path: Path) -> tuple[str, tuple[str, ...]]:
    with pytest.raises(ImageError) as caught:
        read_image(str(path))
    assert caught.value.diagnostic.code == "E0939"
    return caught.value.diagnostic.message, caught.value.diagnostic.hints


@pytest.mark.parametrize(
    ("kind", "media"),
    [("PNG", "image/png"), ("JPEG", "image/jpeg"), ("WEBP", "image/webp"), ("GIF", "image/gif")],
)
def test_small_pictures_are_sent_as_they_are(tmp_path: Path, kind: str, media: str) -> None:
    data = encoded(PIL.Image.new("RGB", (40, 30), "red"), kind)
    path = tmp_path / "picture.txt"  # the content tells
    path.write_bytes(data)
    image = read_image(str(path))
    assert (image.media_type, image.data) == (media, data)


def test_what_is_long_becomes_jpeg(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(messages, "MAX_SENT", 100_000)
    noise = numpy.random.default_rng(1).integers(0, 256, (200, 200, 3), dtype=numpy.uint8)
    path = tmp_path / "noise.png"
    path.write_bytes(encoded(PIL.Image.fromarray(noise), "PNG"))
    assert path.stat().st_size > 100_000
    image = read_image(str(path))
    assert image.media_type == "image/jpeg"
    assert len(image.data) <= 100_000


def test_photos_are_turned_upright(tmp_path: Path) -> None:
    picture = PIL.Image.new("RGB", (40, 20), "blue")
    picture.paste("yellow", (0, 0, 20, 20))
    turned = PIL.Image.Exif()
    turned[0x0112] = 6  # the camera lay on its side: the left is up
    path = tmp_path / "photo.jpg"
    path.write_bytes(encoded(picture, "JPEG", exif=turned, quality=100))
    with PIL.Image.open(io.BytesIO(read_image(str(path)).data)) as sent:
        assert sent.size == (20, 40)
        top, bottom = sent.getpixel((10, 5)), sent.getpixel((10, 35))
        assert top == pytest.approx((255, 255, 0), abs=20)
        assert bottom == pytest.approx((0, 0, 255), abs=20)


def test_files_that_are_no_pictures(tmp_path: Path) -> None:
    program = tmp_path / "part.svg"
    program.write_text("<svg/>")
    message, hints = failure(program)
    assert message == f"`{program}` is no PNG, JPEG, WebP or GIF"
    assert hints == (f"draw the program first: aidl compile {tmp_path / 'part.aidl'} -o picture.png",)
    bitmap = tmp_path / "part.bmp"
    bitmap.write_bytes(encoded(PIL.Image.new("RGB", (4, 4)), "BMP"))
    assert failure(bitmap) == (f"`{bitmap}` is no PNG, JPEG, WebP or GIF", ("save it as PNG",))
    empty = tmp_path / "empty.png"
    empty.touch()
    assert failure(empty)[0] == f"`{empty}` is no PNG, JPEG, WebP or GIF"


@pytest.mark.parametrize("kind", ["PNG", "JPEG", "WEBP", "GIF"])
def test_broken_pictures(tmp_path: Path, kind: str) -> None:
    noise = numpy.random.default_rng(1).integers(0, 256, (60, 60, 3), dtype=numpy.uint8)
    data = encoded(PIL.Image.fromarray(noise), kind)
    path = tmp_path / "half"
    for end in range(12, len(data) * 9 // 10, len(data) // 20):
        path.write_bytes(data[:end])
        message, _ = failure(path)
        assert message.startswith((f"the image `{path}` is broken: ", f"`{path}` is no PNG"))


def test_bombs(tmp_path: Path) -> None:
    def chunk(name: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    header = chunk(b"IHDR", struct.pack(">IIBBBBB", 60_000, 60_000, 8, 2, 0, 0, 0))
    path = tmp_path / "bomb.png"
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + header + chunk(b"IDAT", zlib.compress(b"")) + chunk(b"IEND", b""))
    assert failure(path) == (f"the image `{path}` has too many pixels", ("scale it down",))


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    missing = tmp_path / "missing.png"
    assert failure(missing) == (f"the image `{missing}` cannot be read: no such file or directory", ())
    assert failure(tmp_path) == (f"the image `{tmp_path}` cannot be read: is a directory", ())
    long = tmp_path / "long.png"
    with long.open("wb") as file:
        file.truncate(MAX_FILE + 1)
    assert failure(long) == (f"the image `{long}` cannot be read: it has more than 50 MB", ("scale it down",))
    with pytest.raises(ImageError, match="embedded null byte"):
        read_image("a\0b")
