"""Cache of decoded picture files: each file is decoded once, and again when it has changed."""

from __future__ import annotations

import io
import os
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from minirt import regular_files
from minirt.errors import FileError
from minirt.fork_safety import ForkSafeLock
from minirt.materials import radiance

if TYPE_CHECKING:
    from PIL.Image import Image as PillowImage

LARGEST = 256 * 2**20  # bytes of a file
SIDE = 8192  # pixels
FORMATS = ("PNG", "JPEG", "BMP", "GIF", "TIFF", "PPM", "TGA", "WEBP", "XPM")  # raster formats: no programs, no fonts
LUMINANCE = np.array([0.2126, 0.7152, 0.0722], np.float32)  # of linear red, green and blue (ITU-R BT.709)

Stamp = tuple[int, int, int]  # inode, size and time of change of a file

entries: dict[tuple[Callable[[Path], np.ndarray], str], tuple[Stamp, np.ndarray]] = {}
lock = ForkSafeLock()


def picture(path: str | os.PathLike[str]) -> np.ndarray:
    """Red, green and blue of a picture file, uint8 (h, w, 3), the upper row first; read-only. FileError if
    unreadable."""
    return cached(colours, path)


def sky(path: str | os.PathLike[str]) -> np.ndarray:
    """A picture file as a sky: as `picture`, or of a Radiance picture its light, float32 (h, w, 3); read-only."""
    return cached(light_or_colours, path)


def heights(path: str | os.PathLike[str]) -> np.ndarray:
    """A picture file as a height map, float32 (h, w): its luminance from 0 to 1, with up to 16 bits; read-only."""
    return cached(brightness, path)


def reader(heights_wanted: bool, sky_wanted: bool) -> Callable[[Path], np.ndarray]:
    """The function that reads a picture file as a height map, as a sky, or as colours."""
    return heights if heights_wanted else sky if sky_wanted else picture


def cached(read: Callable[[Path], np.ndarray], path: str | os.PathLike[str]) -> np.ndarray:
    """The array that `read` makes from a file, read again only if the file has changed."""
    path = Path(path)
    status = regular_files.status(path, LARGEST)
    stamp = (status.st_ino, status.st_size, status.st_mtime_ns)
    key = read, os.path.abspath(path)  # noqa: PTH100 - a link is not followed: its target may change
    with lock:
        if key not in entries or entries[key][0] != stamp:
            entries.pop(key, None)
            array = read(path)
            array.flags.writeable = False
            entries[key] = stamp, array
        return entries[key][1]


def colours(path: Path) -> np.ndarray:
    """Red, green and blue of a file, uint8 (h, w, 3)."""
    pixels = decode(path)
    if pixels.dtype != np.uint8:
        pixels = np.rint(pixels / 257).astype(np.uint8)
    return np.ascontiguousarray(pixels if pixels.ndim == 3 else np.repeat(pixels[..., None], 3, axis=2))


def light_or_colours(path: Path) -> np.ndarray:
    """The light of a Radiance picture; red, green and blue of any other file."""
    data = regular_files.read(path, LARGEST)
    if not data.startswith(radiance.MAGIC):
        return colours(path)
    try:
        header = radiance.read_header(data)
        check_size(path, header.width, header.height)
        return radiance.read_pixels(data, header)
    except radiance.RadianceError as error:
        raise FileError(path, f"is a damaged Radiance picture: {error}") from None


def check_size(path: Path, width: int, height: int) -> None:
    """Check the size of a picture; FileError when it has no pixels or too many."""
    if max(width, height) > SIDE:
        raise FileError(path, f"has {width}x{height} pixels, more than {SIDE}x{SIDE}")
    if not width or not height:
        raise FileError(path, f"has {width}x{height} pixels")


def brightness(path: Path) -> np.ndarray:
    """Luminance of a file from 0 to 1, float32 (h, w)."""
    pixels = decode(path)
    grey = pixels.astype(np.float32)
    if pixels.ndim == 3:
        grey = grey @ LUMINANCE
    return np.clip(grey / np.iinfo(pixels.dtype).max, 0, 1)


def decode(path: Path) -> np.ndarray:
    """Decode a file: uint8 (h, w, 3), or uint16 (h, w) for 16-bit grey. FileError if it holds no picture."""
    from PIL import Image as pillow  # noqa: N813
    from PIL import UnidentifiedImageError

    data = regular_files.read(path, LARGEST)
    if not data:
        raise FileError(path, "is empty")
    if data.startswith(radiance.MAGIC):
        raise FileError(path, "is a Radiance picture, which only a sky may be: 'bg file'")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the size is checked here
            image = pillow.open(io.BytesIO(data), formats=FORMATS)
            check_size(path, *image.size)
            return shown_pixels(image)
    except FileError:
        raise
    except pillow.DecompressionBombError:
        raise FileError(path, f"has more than {SIDE}x{SIDE} pixels") from None
    except UnidentifiedImageError:
        raise FileError(path, "is not a picture") from None
    except Exception as error:  # damaged files make decoders raise anything
        raise FileError(path, f"is a damaged picture ({error})") from None


def shown_pixels(image: PillowImage) -> np.ndarray:
    """The pixels of a decoded image: 16-bit grey, or 8-bit red, green and blue."""
    if image.mode.startswith("I"):
        grey: np.ndarray = np.clip(np.asarray(image), 0, 65535).astype(np.uint16)
        return grey
    rgb: np.ndarray = np.asarray(image.convert("RGB"))
    return rgb
