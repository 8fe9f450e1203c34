"""Reader of the texts in a PNG file, which may come from anybody: limited in size, and checked."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator

from minirt.png import SIGNATURE

BEFORE = 12  # bytes of a chunk besides its data: length, kind, checksum


class PngError(ValueError):
    """The file is no PNG picture, or its text is damaged."""


def texts(data: bytes, keywords: tuple[str, ...], longest: int) -> dict[str, bytes]:
    """Return the texts with some keywords, at most `longest` bytes each, in UTF-8 unless the writer erred; PngError.

    Only texts before the pixels are read, as `minirt.png` writes them.
    """
    if not data.startswith(SIGNATURE):
        raise PngError("is not a PNG picture")
    found: dict[str, bytes] = {}
    for kind, content in chunks(data):
        if kind == b"iTXt":
            keyword, _, rest = content.partition(b"\0")
            name = keyword.decode("latin-1")
            if name in keywords:
                found[name] = text_of(rest, longest)
    return found


def chunks(data: bytes) -> Iterator[tuple[bytes, bytes]]:
    """Yield kind and data of the chunks before the pixels; PngError where the file ends or a checksum is wrong."""
    at = len(SIGNATURE)
    while data[at + 4 : at + 8] not in (b"IDAT", b"IEND"):
        if at + BEFORE > len(data):
            raise PngError("the PNG picture ends before its pixels")
        (size,) = struct.unpack_from(">I", data, at)
        end = at + BEFORE + size
        if end > len(data):
            raise PngError("the PNG picture ends before its pixels")
        (checksum,) = struct.unpack_from(">I", data, end - 4)
        if zlib.crc32(data[at + 4 : end - 4]) != checksum:
            raise PngError("the PNG picture is damaged: a checksum is wrong")
        yield data[at + 4 : at + 8], data[at + 8 : end - 4]
        at = end


def text_of(data: bytes, longest: int) -> bytes:
    """Return the text of an iTXt chunk, behind its keyword; PngError where it is damaged or too long."""
    is_compressed, _, rest = data[:1] == b"\1", data[1:2], data[2:]
    _, _, rest = rest.partition(b"\0")  # the language
    _, _, text = rest.partition(b"\0")  # the translated keyword
    if is_compressed:
        inflater = zlib.decompressobj()
        try:
            text = inflater.decompress(text, longest + 1)
        except zlib.error:
            raise PngError("the PNG picture is damaged: its text cannot be decompressed") from None
    if len(text) > longest:
        raise PngError(f"the text in the PNG picture is larger than {longest // 2**20} MiB")
    return text
