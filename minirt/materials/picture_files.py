"""Picture files -> arrays of colours, light or heights. Pillow decodes them, but XPM and Radiance are read here."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from minirt import jail
from minirt.errors import FileError, printable
from minirt.helpers import file_io
from minirt.jail.decoder import DecodingError, check_size
from minirt.materials import radiance, xpm

DEEP = 65535  # the highest level of 16 bits
LEVELS = {"RGB": "u1", "I": "=i4", "I;16": "<u2", "I;16L": "<u2", "I;16B": ">u2"}  # by the mode of decoded pixels
LUMINANCE = np.array([0.2126, 0.7152, 0.0722], np.float32)  # of linear red, green and blue (ITU-R BT.709)


def colours(path: Path) -> np.ndarray:
    """Red, green and blue of a file, uint8 (h, w, 3)."""
    pixels = decode(path)
    if pixels.dtype != np.uint8:
        pixels = np.rint(pixels / 257).astype(np.uint8)
    return np.ascontiguousarray(pixels if pixels.ndim == 3 else np.repeat(pixels[..., None], 3, axis=2))


def light_or_colours(path: Path) -> np.ndarray:
    """The light of a Radiance picture; red, green and blue of any other file."""
    data = file_io.read(path, file_io.LARGEST_ASSET)
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
    data = file_io.read(path, file_io.LARGEST_ASSET)
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
