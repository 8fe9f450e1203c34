"""Picture files as arrays of colours, light or heights. Each file is decoded once, and again when it has changed.

Pictures may come from strangers. Pillow decodes them, in a few raster formats; regular files alone are read, and bytes,
pixels and memory are limited before anything is decoded. XPM and Radiance pictures are read in Python.
"""

from __future__ import annotations

import io
import os
import re
import warnings
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from functools import cache, wraps
from pathlib import Path
from typing import Any

import numpy as np

from minirt.errors import FileError
from minirt.fields import PictureFile
from minirt.helpers import file_io, system
from minirt.helpers.system import TooLargeError

SIDE = 8192  # pixels
FORMATS = ("PNG", "JPEG", "BMP", "GIF", "TIFF", "PPM", "TGA", "WEBP")  # raster formats: no programs, no fonts
RADIANCE, XPM = b"#?", b"/* XPM */"  # how these files begin
MOST_PARTS = 1_000_000  # of a file; a TIFF of 8192x8192 pixels has 262,144 tiles of 16x16
MOST_SCANS = 200  # of a JPEG, each of which takes up to 0.1 s; usual ones have a dozen
SCAN = b"\xff\xda"
PLAIN_PNM = (b"P1", b"P2", b"P3")  # text, in which Pillow takes 3 us for a comment
COMMENTS = re.compile(rb"(?:#[^\r\n]*+[\r\n]*+)++")
DEEP_MODES = ("I", "I;16", "I;16L", "I;16B")  # of Pillow, grey of 16 or 32 bits; all others become red, green and blue
DEEP = 65535  # the highest level of 16 bits
LUMINANCE = np.array([0.2126, 0.7152, 0.0722], np.float32)  # of linear red, green and blue (ITU-R BT.709)
DECODING = 8  # bytes of a pixel while a picture is decoded and converted
TEXEL = 4  # bytes of a channel of a pixel in the arrays of the kernel

Read = Callable[[Path], np.ndarray]


def cached(read: Read) -> Callable[[str | os.PathLike[str]], np.ndarray]:
    """Decorate a reader of a picture file: its array is read-only, and read again only if the file has changed.

    FileError where the array would take too much memory.
    """

    @wraps(read)
    def read_and_check(path: Path) -> np.ndarray:
        try:
            array = read(path)
            check_textures([array])
        except TooLargeError as error:
            raise FileError(path, str(error)) from None
        array.flags.writeable = False
        return array

    return file_io.read_once(read_and_check)


@cached
def picture(path: Path) -> np.ndarray:
    """Red, green and blue of a picture file, uint8 (h, w, 3), the upper row first; read-only. FileError."""
    pixels = decode(path)
    if pixels.dtype != np.uint8:
        pixels = np.rint(pixels / 257).astype(np.uint8)
    return np.ascontiguousarray(pixels if pixels.ndim == 3 else np.repeat(pixels[..., None], 3, axis=2))


@cached
def sky(path: Path) -> np.ndarray:
    """A picture file as a sky: as `picture`, or of a Radiance picture its light, float32 (h, w, 3); read-only."""
    data = file_io.read(path, file_io.LARGEST_ASSET)
    if not data.startswith(RADIANCE):
        return picture(path)
    from minirt.materials import radiance

    try:
        header = radiance.read_header(data)
        check_size(path, header.width, header.height)
        return radiance.read_pixels(data, header)
    except radiance.RadianceError as error:
        raise FileError(path, f"is a damaged Radiance picture: {error}") from None


@cached
def heights(path: Path) -> np.ndarray:
    """A picture file as a height map, float32 (h, w): its luminance from 0 to 1, with up to 16 bits; read-only."""
    pixels = decode(path)
    grey = pixels.astype(np.float32)
    if pixels.ndim == 3:
        grey = grey @ LUMINANCE
    return np.clip(grey / np.iinfo(pixels.dtype).max, 0, 1)


def reader(file: PictureFile) -> Callable[[Path], np.ndarray]:
    """The function that reads a picture file as a height map, as a sky, or as colours."""
    return heights if file.heights else sky if file.sky else picture


def check_textures(arrays: list[np.ndarray]) -> None:
    """Check that there is room for the texels of these arrays, which a kernel reads; `TooLargeError` otherwise."""
    need = TEXEL * sum(array.size for array in arrays)
    system.check_memory(need, "the textures need", "smaller pictures need less")


def check_size(path: Path, width: int, height: int) -> None:
    """Check the size of a picture that is not decoded yet; FileError when it has no pixels or too many."""
    if max(width, height) > SIDE:
        raise FileError(path, f"has {width}x{height} pixels, more than {SIDE}x{SIDE}")
    if not width or not height:
        raise FileError(path, f"has {width}x{height} pixels")
    need = DECODING * width * height
    system.check_memory(need, f"a picture of {width}x{height} pixels needs", "smaller pictures need less")


def check_headers(paths: Iterable[Path]) -> None:
    """Check picture files by their headers, and that there is room for all of them together; FileError,
    `TooLargeError`."""
    pixels = 0
    for path in paths:
        data = file_io.read(path, file_io.LARGEST_ASSET)
        if not data.startswith(XPM):
            with opened_by_pillow(path, data) as image:
                pixels += image.width * image.height
    system.check_memory(3 * (1 + TEXEL) * pixels, "the pictures need", "smaller ones need less")


def decode(path: Path) -> np.ndarray:
    """Decode a file: uint8 (h, w, 3), or uint16 (h, w) for 16-bit grey. FileError if it holds no picture."""
    data = file_io.read(path, file_io.LARGEST_ASSET)
    if not data:
        raise FileError(path, "is empty")
    if data.startswith(RADIANCE):
        raise FileError(path, "is a Radiance picture, which only a sky may be: 'bg file'")
    return decode_xpm(path, data) if data.startswith(XPM) else decode_by_pillow(path, data)


def decode_xpm(path: Path, data: bytes) -> np.ndarray:
    """Red, green and blue of an XPM file, uint8 (h, w, 3); transparent pixels are black. FileError."""
    from minirt.formats import xpm

    strings = xpm.strings_of(data)
    try:
        header = xpm.read_header(strings)
        check_size(path, header.width, header.height)
        pixels = xpm.read_pixels(strings, header)
        note_transparency(path, int(pixels[..., 3].min()))
        return pixels[..., 2::-1]
    except xpm.XpmError as error:
        raise FileError(path, f"is a damaged XPM picture: {error}") from None


transparent: set[str] = set()  # absolute paths of the pictures read last that are not wholly opaque


def note_transparency(path: Path, alpha: int) -> None:
    """Note the least alpha of a picture, from 0 to 255."""
    (transparent.add if alpha < 255 else transparent.discard)(os.path.abspath(path))  # noqa: PTH100


class Parts(io.BytesIO):
    """The bytes of a file. Pillow takes 1 us for each part of it, and a file may have a part for each byte."""

    reads = 0

    def read(self, size: int | None = -1) -> bytes:
        """Return the next bytes; TooLargeError after `MOST_PARTS` calls."""
        self.reads += 1
        if self.reads > MOST_PARTS:
            raise TooLargeError(f"is a damaged picture (it has more than {MOST_PARTS:,} parts)")
        return super().read(size)


def decode_by_pillow(path: Path, data: bytes) -> np.ndarray:
    """Decode the bytes of a file, as `decode`; FileError."""
    from PIL import ImageOps

    with opened_by_pillow(path, data) as opened:
        if opened.format == "JPEG" and data.count(SCAN) > MOST_SCANS:
            raise TooLargeError(f"is a damaged picture (it has more than {MOST_SCANS:,} scans)")
        image: Any = ImageOps.exif_transpose(opened)
        note_transparency(path, image.convert("RGBA").getextrema()[3][0] if image.has_transparency_data else 255)
        pixels = np.asarray(image if image.mode in DEEP_MODES else image.convert("RGB"))
    return pixels if pixels.ndim == 3 else np.clip(pixels, 0, DEEP).astype(np.uint16)


@contextmanager
def opened_by_pillow(path: Path, data: bytes) -> Iterator[Any]:
    """Give the block the Pillow image of the bytes of a file, of which only the header is read, and the size checked.

    FileError where the bytes are no picture, or too large a one, and for all that goes wrong in the block, except for
    TooLargeError.
    """
    from PIL import Image as pillow  # noqa: N813
    from PIL import UnidentifiedImageError

    silence_decoders()
    if data.startswith(PLAIN_PNM):
        data = COMMENTS.sub(b"\n", data)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about oddities of a file that is decoded
            warnings.simplefilter("error", pillow.DecompressionBombWarning)
            image = pillow.open(Parts(data), formats=FORMATS)
            check_size(path, *image.size)
            yield image
    except (FileError, TooLargeError):
        raise
    except (pillow.DecompressionBombError, pillow.DecompressionBombWarning):
        raise FileError(path, f"has more than {SIDE}x{SIDE} pixels") from None
    except UnidentifiedImageError:
        raise FileError(path, "is not a picture") from None
    except MemoryError:
        raise FileError(path, "needs more memory than there is to decode it") from None
    except Exception as error:  # damaged files make decoders raise anything, and quote what they have read
        is_cut = isinstance(error, EOFError) or "truncated" in str(error)
        why = ": the file ends too early" if is_cut else ""
        raise FileError(path, f"is a damaged picture{why}") from None


@cache
def silence_decoders() -> None:
    """Keep libtiff and Pillow from writing to standard error about damaged files, whose errors are raised anyway."""
    import ctypes
    import logging

    from PIL import _imaging

    logging.getLogger("PIL").addHandler(logging.NullHandler())  # without one, its errors go there
    with suppress(AttributeError, OSError):  # Windows shows no functions of a library within another
        for setter in ("TIFFSetErrorHandler", "TIFFSetWarningHandler"):
            function = getattr(ctypes.CDLL(_imaging.__file__), setter)
            function.argtypes, function.restype = [ctypes.c_void_p], ctypes.c_void_p
            function(None)
