"""Decoder of picture files, by Pillow, in the formats and sizes that a scene may have.

The helper process imports this module: it imports no numpy, which would take longer than most pictures.
"""

from __future__ import annotations

import io
import re
import warnings
from typing import TYPE_CHECKING, NamedTuple, cast

from minirt.jail.plain_pnm import Levels, read_levels

if TYPE_CHECKING:
    from PIL.Image import Image as PillowImage
    from PIL.ImageFile import ImageFile

SIDE = 8192  # pixels
FORMATS = ("PNG", "JPEG", "BMP", "GIF", "TIFF", "PPM", "TGA", "WEBP")  # raster formats: no programs, no fonts
READ_BY_PROGRAM = (b"#?", b"/* XPM */")  # how Radiance and XPM pictures begin, which are not decoded here
MOST_READS = 1_000_000  # of a file, by Pillow; a TIFF of 8192x8192 pixels has 262,144 tiles of 16x16
PLAIN_PNM = (b"P1", b"P2", b"P3")  # text, in which Pillow takes 3 us for a comment, 0.3 us for a level
COMMENTS = re.compile(rb"(?:#[^\r\n]*+[\r\n]*+)++")
BYTES = {"RGB": 3, "I": 4, "I;16": 2, "I;16L": 2, "I;16B": 2}  # of a pixel, by the mode in which Pillow decodes it


class DecodingError(Exception):
    """A file that cannot be decoded; the message goes on a sentence that begins with the name of the file."""


class File(io.BytesIO):
    """The bytes of a file. Pillow takes 1 us for each part of it, and a file may have a part for each byte."""

    reads = 0

    def read(self, size: int | None = -1) -> bytes:
        """Return the next bytes; DecodingError after `MOST_READS` calls."""
        self.reads += 1
        if self.reads > MOST_READS:
            raise DecodingError(f"is a damaged picture (it has more than {MOST_READS:,} parts)")
        return super().read(size)


class Decoded(NamedTuple):
    """The pixels of a picture: red, green and blue, or grey of 16 or 32 bits."""

    mode: str  # one of `BYTES`
    width: int
    height: int
    pixels: bytes | bytearray  # the upper row first


def check_size(width: int, height: int) -> None:
    """Check the size of a picture; DecodingError when it has no pixels or too many."""
    if max(width, height) > SIDE:
        raise DecodingError(f"has {width}x{height} pixels, more than {SIDE}x{SIDE}")
    if not width or not height:
        raise DecodingError(f"has {width}x{height} pixels")


def decode(data: bytes) -> Decoded:
    """Decode the bytes of a file in this process; DecodingError if it holds no picture."""
    from PIL import Image as pillow  # noqa: N813
    from PIL import UnidentifiedImageError

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the size is checked here
            if data.startswith(PLAIN_PNM):
                data = COMMENTS.sub(b"\n", data)
            image = pillow.open(File(data), formats=FORMATS)
            check_size(*image.size)
            return pixels_of(read_plain(image, data) if data.startswith(PLAIN_PNM) and image.mode != "1" else image)
    except DecodingError:
        raise
    except pillow.DecompressionBombError:
        raise DecodingError(f"has more than {SIDE}x{SIDE} pixels") from None
    except UnidentifiedImageError:
        raise DecodingError("is not a picture") from None
    except MemoryError:
        raise DecodingError("needs more memory than there is to decode it") from None
    except Exception as error:  # damaged files make decoders raise anything
        raise DecodingError(f"is a damaged picture ({error})") from None


def read_plain(image: ImageFile, data: bytes) -> PillowImage:
    """Return the picture of a plain PGM or PPM file, whose header Pillow has read; ValueError."""
    from PIL import Image as pillow  # noqa: N813

    header = image.tile[0]
    white, size = (65535, 4) if image.mode == "I" else (255, 1)
    levels = Levels(cast("tuple[str, int]", header.args)[1], white, size)
    count = image.width * image.height * len(image.getbands())
    return pillow.frombytes(image.mode, image.size, read_levels(data, header.offset, count, levels))


def pixels_of(image: PillowImage) -> Decoded:
    """Return the pixels of an image: grey of more than 8 bits as it is, all else as 8-bit red, green and blue."""
    if image.mode not in BYTES:
        image = image.convert("RGB")
    return Decoded(image.mode, *image.size, image.tobytes())
