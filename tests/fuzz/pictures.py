"""Fuzzer of pictures on surfaces and as skies: damaged files of each format give pixels, or an error about the file."""

from __future__ import annotations

import io
import random
import tempfile
from functools import cache
from pathlib import Path

import numpy as np
from PIL import Image

from minirt.errors import FileError
from minirt.jail.decoder import SIDE
from minirt.materials import picture_cache
from tests.fuzz.fuzzer import Fuzzer
from tests.fuzz.mutations import cut, flip, mutated

FORMATS = (
    *(("PNG", mode, {}) for mode in ("RGB", "RGBA", "L", "P", "1", "I;16", "LA")),
    *(("JPEG", mode, {}) for mode in ("RGB", "L", "CMYK")), ("BMP", "RGB", {}), ("GIF", "P", {}), ("PPM", "RGB", {}),
    *(("TIFF", "RGB", {"compression": name}) for name in ("raw", "tiff_lzw", "tiff_adobe_deflate", "packbits", "jpeg")),
    ("TGA", "RGB", {}), ("TGA", "RGB", {"compression": "tga_rle"}), ("WEBP", "RGB", {}), ("WEBP", "RGBA",
                                                                                        {"lossless": True}),
)  # fmt: skip
XPM = b'/* XPM */\nstatic char *a[] = {\n"2 2 2 1",\n"a c #FF8800",\n"b c #0000FF",\n"ab",\n"ba"\n};\n'
RADIANCE = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\n\n-Y 2 +X 8\n" + 2 * (b"\2\2\0\10" + 4 * b"\x88\x80")
SIZE = (9, 7)
READERS = (picture_cache.picture, picture_cache.heights, picture_cache.sky)
FOLDER = tempfile.TemporaryDirectory(prefix="minirt-fuzz-")


@cache
def originals() -> list[bytes]:
    """Return a small file of each format."""
    noise = Image.frombytes("RGB", SIZE, bytes(random.Random(1).randbytes(3 * SIZE[0] * SIZE[1])))
    files = [XPM, RADIANCE]
    for name, mode, options in FORMATS:
        file = io.BytesIO()
        noise.convert("L").convert(mode).save(file, name, **options) if mode == "I;16" else noise.convert(mode).save(
            file, name, **options
        )
        files.append(file.getvalue())
    return files


def make(chance: random.Random) -> bytes:
    """Make a picture; nine of ten are damaged, most of them by a few bits, so that decoders get far."""
    data = chance.choice(originals())
    kind = chance.random()
    if kind < 0.1:
        return data
    for _ in range(chance.randint(1, 4)):
        data = flip(data, chance)
    return data if kind < 0.6 else cut(data, chance) if kind < 0.7 else mutated(data, chance)


def check(data: bytes) -> str:
    """Read the picture in all ways; an original is accepted in at least one."""
    path = Path(FOLDER.name) / "picture"
    path.write_bytes(data)
    accepted = 0
    for read in READERS:
        try:
            pixels = read(path)
        except FileError as error:
            check_message(str(error), path)
            continue
        accepted += 1
        assert pixels.ndim == (2 if read is picture_cache.heights else 3)
        assert 0 < pixels.size <= 3 * SIDE**2
        assert np.isfinite(pixels).all()
    assert accepted or data not in originals(), "a good picture is refused"
    return "accepted" if accepted else "refused"


def check_message(message: str, path: Path) -> None:
    """Check that a message is one line that names the file."""
    assert str(path) in message
    assert "\n" not in message, f"an error of several lines: {message}"


FUZZER = Fuzzer(make, check, 150)
