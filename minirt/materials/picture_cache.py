"""Cache of decoded picture files: each file is decoded once, and again when it has changed."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from weakref import WeakValueDictionary

import numpy as np

from minirt.errors import FileError
from minirt.helpers import file_io, system
from minirt.helpers.system import ForkSafeLock, TooLargeError

TEXEL = 4  # bytes of a channel of a pixel in the arrays of the kernel

Stamp = tuple[int, int, int, int]  # device, inode, size and time of change of a file

entries: dict[tuple[Callable[[Path], np.ndarray], str], tuple[Stamp, np.ndarray]] = {}
shared: WeakValueDictionary[tuple[Callable[[Path], np.ndarray], Stamp], np.ndarray] = WeakValueDictionary()
lock = ForkSafeLock()


def picture(path: str | os.PathLike[str]) -> np.ndarray:
    """Red, green and blue of a picture file, uint8 (h, w, 3), the upper row first; read-only. FileError if
    unreadable."""
    from minirt.materials.picture_files import colours

    return cached(colours, path)


def sky(path: str | os.PathLike[str]) -> np.ndarray:
    """A picture file as a sky: as `picture`, or of a Radiance picture its light, float32 (h, w, 3); read-only."""
    from minirt.materials.picture_files import light_or_colours

    return cached(light_or_colours, path)


def heights(path: str | os.PathLike[str]) -> np.ndarray:
    """A picture file as a height map, float32 (h, w): its luminance from 0 to 1, with up to 16 bits; read-only."""
    from minirt.materials.picture_files import brightness

    return cached(brightness, path)


def reader(heights_wanted: bool, sky_wanted: bool) -> Callable[[Path], np.ndarray]:
    """The function that reads a picture file as a height map, as a sky, or as colours."""
    return heights if heights_wanted else sky if sky_wanted else picture


def identity(path: str | os.PathLike[str]) -> tuple[int, int]:
    """The device and the inode of a picture file, which all links to it share. FileError if it cannot be read."""
    status = file_io.status(path, file_io.LARGEST_ASSET)
    return status.st_dev, status.st_ino


def cached(read: Callable[[Path], np.ndarray], path: str | os.PathLike[str]) -> np.ndarray:
    """The array that `read` makes from a file, read again only if the file has changed; one for all links to it."""
    path = Path(path)
    status = file_io.status(path, file_io.LARGEST_ASSET)
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
    system.check_memory(TEXEL * sum(array.size for array in arrays), "the textures need", "smaller pictures need less")
