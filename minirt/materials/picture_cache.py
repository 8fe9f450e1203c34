"""Cache of decoded picture files: each file is decoded once, and again when it has changed."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from weakref import WeakValueDictionary

import numpy as np

from minirt import jail, memory_limit, regular_files
from minirt.errors import FileError, printable
from minirt.fork_safety import ForkSafeLock
from minirt.jail.decoder import LARGEST, DecodingError, check_size
from minirt.materials import radiance, xpm
from minirt.memory_limit import TooLargeError

TEXEL = 4  # bytes of a channel of a pixel in the arrays of the kernel
DEEP = 65535  # the highest level of 16 bits
LEVELS = {"RGB": "u1", "I": "=i4", "I;16": "<u2", "I;16L": "<u2", "I;16B": ">u2"}  # by the mode of decoded pixels
LUMINANCE = np.array([0.2126, 0.7152, 0.0722], np.float32)  # of linear red, green and blue (ITU-R BT.709)

Stamp = tuple[int, int, int, int]  # device, inode, size and time of change of a file

entries: dict[tuple[Callable[[Path], np.ndarray], str], tuple[Stamp, np.ndarray]] = {}
shared: WeakValueDictionary[tuple[Callable[[Path], np.ndarray], Stamp], np.ndarray] = WeakValueDictionary()
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


def identity(path: str | os.PathLike[str]) -> tuple[int, int]:
    """The device and the inode of a picture file, which all links to it share. FileError if it cannot be read."""
    status = regular_files.status(path, LARGEST)
    return status.st_dev, status.st_ino


def cached(read: Callable[[Path], np.ndarray], path: str | os.PathLike[str]) -> np.ndarray:
    """The array that `read` makes from a file, read again only if the file has changed; one for all links to it."""
    path = Path(path)
    status = regular_files.status(path, LARGEST)
    stamp = (status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns)
    key = read, os.path.abspath(path)  # noqa: PTH100 - a link is not followed: its target may change
    with lock:
        if key not in entries or entries[key][0] != stamp:
            entries.pop(key, None)
            array = shared.get((read, stamp))
            if array is None:
                array = read(path)
                try:
                    check_textures([array])
                except TooLargeError as error:
                    raise FileError(path, str(error)) from None
                array.flags.writeable = False
                shared[read, stamp] = array
            entries[key] = stamp, array
        return entries[key][1]


def check_textures(arrays: list[np.ndarray]) -> None:
    """Check that there is room for the texels of these arrays, which a kernel reads; `TooLargeError` otherwise."""
    memory_limit.check(TEXEL * sum(array.size for array in arrays), "the textures need", "smaller pictures need less")


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
        check_size(header.width, header.height)
        return radiance.read_pixels(data, header)
    except DecodingError as error:
        raise FileError(path, str(error)) from None
    except radiance.RadianceError as error:
        raise FileError(path, f"is a damaged Radiance picture: {error}") from None


def brightness(path: Path) -> np.ndarray:
    """Luminance of a file from 0 to 1, float32 (h, w)."""
    pixels = decode(path)
    grey = pixels.astype(np.float32)
    if pixels.ndim == 3:
        grey = grey @ LUMINANCE
    return np.clip(grey / np.iinfo(pixels.dtype).max, 0, 1)


def decode(path: Path) -> np.ndarray:
    """Decode a file: uint8 (h, w, 3), or uint16 (h, w) for 16-bit grey. FileError if it holds no picture."""
    data = regular_files.read(path, LARGEST)
    if not data:
        raise FileError(path, "is empty")
    if data.startswith(radiance.MAGIC):
        raise FileError(path, "is a Radiance picture, which only a sky may be: 'bg file'")
    if data.startswith(xpm.MAGIC):
        return xpm_colours(path, data)
    try:
        mode, width, height, pixels = jail.decode(data)
    except DecodingError as error:
        raise FileError(path, printable(str(error))) from None
    array = np.frombuffer(pixels, LEVELS[mode]).reshape(height, width, -1)
    return array if mode == "RGB" else np.clip(array[..., 0], 0, DEEP).astype(np.uint16)


def xpm_colours(path: Path, data: bytes) -> np.ndarray:
    """Red, green and blue of an XPM file, uint8 (h, w, 3). FileError if it is damaged."""
    strings = xpm.strings_of(data)
    try:
        header = xpm.read_header(strings)
        check_size(header.width, header.height)
        return xpm.read_pixels(strings, header)
    except DecodingError as error:
        raise FileError(path, str(error)) from None
    except xpm.XpmError as error:
        raise FileError(path, f"is a damaged XPM picture: {error}") from None
