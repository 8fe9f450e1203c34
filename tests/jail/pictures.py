"""Picture files in all formats that a scene may name."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
from PIL import Image

NOISE = np.random.default_rng(1).integers(0, 256, (13, 17, 3), np.uint8)
PICTURE = Image.fromarray(NOISE)
DEEP = Image.fromarray(np.arange(0, 65536, 512, np.uint16).reshape(8, 16))
EXIF = Image.Exif()
EXIF[0x0112] = 6  # the camera was turned


def encoded(image: Image.Image, form: str, **options: Any) -> bytes:
    """Return the file of a picture."""
    buffer = io.BytesIO()
    image.save(buffer, form, **options)
    return buffer.getvalue()


PNG = encoded(PICTURE, "PNG")
FILES = {
    **{form: encoded(PICTURE, form) for form in ("PNG", "JPEG", "BMP", "GIF", "TIFF", "PPM", "TGA", "WEBP")},
    **{f"TIFF {each}": encoded(PICTURE, "TIFF", compression=each) for each in ("tiff_lzw", "jpeg", "packbits")},
    "fax": encoded(PICTURE.convert("1"), "TIFF", compression="group4"),
    "several JPEGs": encoded(PICTURE, "MPO", save_all=True, append_images=[PICTURE]),
    "JPEG with Exif": encoded(PICTURE, "JPEG", exif=EXIF),
    "PNG with Exif": encoded(PICTURE, "PNG", exif=EXIF),
    "CMYK": encoded(PICTURE.convert("CMYK"), "JPEG"),
    "palette": encoded(PICTURE.convert("P"), "PNG"),
    "moving WEBP": encoded(PICTURE, "WEBP", save_all=True, append_images=[PICTURE.rotate(180)]),
    "16 bits": encoded(DEEP, "PNG"),
    "16 bits, PGM": b"P5 4 2 65535\n" + bytes(range(16)),
}


def changed(data: bytes, at: int, byte: int) -> bytes:
    """Return a file with another byte."""
    return data[:at] + bytes([byte]) + data[at + 1 :]


WITH_COMPLAINTS = changed(FILES["fax"], 24, 103)  # libtiff decodes it, and writes that a code word is wrong
