"""Table of the picture and film formats: extensions, largest side, bits a channel.

Only formats that hold the colours of a picture of any size are in it. Pillow also writes others, which are grey, have
256 pixels at most or depend on the file name: `tests/formats/test_table.py` reads back what each format here holds.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

from minirt.errors import RenderError, nearest

FLOAT = 32  # bits of a channel of floating-point numbers
DEEP_MEMORY = 49  # bytes a pixel of a picture with 16 bits while it is rendered and written


class Format(NamedTuple):
    """A picture or film format."""

    suffixes: tuple[str, ...]
    largest: int = 2**31 - 1  # pixels of a side
    bits: tuple[int, ...] = (8,)  # that a channel can have, the default first
    is_lossy: bool = False  # whether it has a quality from 1 to 100
    is_film: bool = False  # whether it can hold several pictures in one file
    is_still: bool = True  # whether it can hold a single picture
    memory: int = 12  # bytes a pixel while a picture is rendered and written with the default bits, as measured


FORMATS = {  # by Pillow's name, where Pillow writes the format
    "PNG": Format((".png",), bits=(8, 16)),
    "APNG": Format((".apng",), is_film=True),
    "JPEG": Format((".jpg", ".jpeg", ".jpe", ".jfif"), 65_500, is_lossy=True),
    "WEBP": Format((".webp",), 16_383, is_lossy=True, is_film=True, memory=18),
    "AVIF": Format((".avif",), 65_536, is_lossy=True, memory=33),
    "GIF": Format((".gif",), 65_535, is_film=True, memory=18),
    "TIFF": Format((".tif", ".tiff"), bits=(8, 16, FLOAT)),
    "BMP": Format((".bmp", ".dib")),
    "PPM": Format((".ppm", ".pnm")),
    "TGA": Format((".tga",), 65_535),
    "JPEG2000": Format((".jp2", ".j2k", ".jpx"), memory=45),
    "PCX": Format((".pcx",), 65_535),
    "SGI": Format((".sgi", ".rgb"), 65_535, memory=13),
    "QOI": Format((".qoi",), memory=11),
    "EXR": Format((".exr",), bits=(FLOAT,), memory=56),
    "HDR": Format((".hdr", ".pic"), 32_767, bits=(FLOAT,), memory=40),
    "PFM": Format((".pfm",), bits=(FLOAT,), memory=56),
    "MP4": Format((".mp4", ".m4v"), 16_384, is_lossy=True, is_film=True, is_still=False),
    "WEBM": Format((".webm",), 16_384, is_lossy=True, is_film=True, is_still=False),
}
BY_SUFFIX = {suffix: name for name, each in FORMATS.items() for suffix in each.suffixes}
COMMON = (".png", ".jpg", ".jpeg", ".webp", ".tiff", ".exr", ".hdr", ".pfm", ".gif", ".webm")  # to suggest
OWN = {"PNG", "EXR", "HDR", "PFM"}  # written without Pillow
FILMS_BY_PYAV = {"MP4", "WEBM"}
NO_PYAV = ": install PyAV (pip install 'minirt[video]') for .mp4 and .webm, or try .gif, .webp or .apng"
VIDEOS = (".avi", ".mov", ".qt", ".mkv", ".mpg", ".mpeg", ".wmv", ".flv", ".ogv", ".3gp")  # of other programs


def format_of(path: str | os.PathLike[str]) -> str:
    """Return the name of the format of a file extension; RenderError for an unknown one."""
    suffix = Path(path).suffix.lower()
    name = BY_SUFFIX.get(suffix)
    if name is None or not is_installed(name):
        raise RenderError(f"{os.fspath(path)}: {refusal(suffix, name)}")
    return name


def memory_of(name: str, bits: int | None) -> int:
    """Return the bytes of memory a pixel that a picture takes while it is rendered and written."""
    return DEEP_MEMORY if bits == 16 and 16 in FORMATS[name].bits else FORMATS[name].memory


def is_installed(name: str) -> bool:
    """Whether the library that writes a format is there, and was built with it."""
    if name in OWN:  # without Pillow, which loads the plug-ins of all formats to answer
        return True
    if name in FILMS_BY_PYAV:
        return find_spec("av") is not None
    from PIL import Image as pillow  # noqa: N813

    pillow.init()
    return {"APNG": "PNG"}.get(name, name) in pillow.SAVE


def refusal(suffix: str, name: str | None) -> str:
    """Return why pictures or films with an extension cannot be written, and what to do."""
    if not suffix:
        return "the name of a picture ends in its format, such as .png or .jpg"
    is_film = suffix in VIDEOS or name in FILMS_BY_PYAV
    cannot = f"cannot write {'films' if is_film else 'pictures'} with the extension '{suffix}'"
    if is_film:
        return cannot + (", try .mp4, .webm or .gif" if is_installed("MP4") else NO_PYAV)
    if name:
        return f"{cannot}: this Pillow was built without it, try .png"
    if suffix in (".pbm", ".pgm", ".ico", ".icns"):
        return f"{cannot}: it cannot hold {'colours' if suffix in ('.pbm', '.pgm') else 'large pictures'}, try .png"
    return f"{cannot}, try {next(iter(nearest(suffix, COMMON, 0.7)), COMMON[0])}"


def check_size(path: str | os.PathLike[str], name: str, width: int, height: int) -> None:
    """Check that a format can hold a picture of this size; RenderError otherwise."""
    largest = FORMATS[name].largest
    if max(width, height) > largest:
        raise RenderError(f"{os.fspath(path)}: {name} holds at most {largest:,} pixels a side, got {width}x{height}")


def check_bits(name: str, bits: int | None) -> int:
    """Return the bits a channel, those of the format when `bits` is None; RenderError where it cannot have them."""
    can = FORMATS[name].bits
    if bits is not None and bits not in can:
        others = [other for other, each in FORMATS.items() if bits in each.bits]
        advice = f"try {' or '.join(others)}" if 0 < len(others) < 5 else "leave them out"
        raise RenderError(f"{name} has {' or '.join(map(str, can))} bits a channel, got {bits}: {advice}")
    return can[0] if bits is None else bits


def check_quality(name: str, quality: int | None) -> None:
    """Check that a quality from 1 to 100 is given to a lossy format alone; RenderError otherwise."""
    if quality is None:
        return
    if not FORMATS[name].is_lossy:
        raise RenderError(f"{name} has no quality: it keeps all pixels as they are; .jpg and .webp have one")
    if not 1 <= quality <= 100:
        raise RenderError(f"the quality is a number from 1 to 100, got {quality}")


@contextmanager
def told_encoding_errors(what: str, name: str) -> Iterator[None]:
    """Raise the errors of Pillow and PyAV as RenderError: a format cannot hold `what`, a picture or a film."""
    errors: tuple[type[Exception], ...] = (OSError, ValueError, KeyError, OverflowError)
    if name in FILMS_BY_PYAV:
        import av

        errors += (av.FFmpegError,)
    try:
        yield
    except errors as error:
        raise RenderError(f"cannot write this {what} as {name}: {error}") from None
