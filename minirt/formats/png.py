"""PNG files of RGB pictures (ISO/IEC 15948), without Pillow, whose import takes as long as to draw a small picture.

They can carry texts, each with a keyword: the scene of a picture, say. Their reader limits sizes and checks sums, since
files may come from anybody.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator, Mapping

import numpy as np

NONE, SUB, UP = 0, 1, 2  # filters of a row: its bytes, less those of the pixel before, less those of the row above
LEVEL = 6  # of compression
ROWS, BLOCK = 256, 2**18  # rows filtered at once, and their bytes, at most: filtering takes eight times the memory
LARGEST_SIDE = 2**31 - 1  # pixels
SIGNATURE = b"\x89PNG\r\n\x1a\n"


def encode(array: np.ndarray, texts: Mapping[str, str] | None = None) -> bytes:
    """Return the PNG file of a picture, (h, w, 3) uint8 or uint16; ValueError when it has no or too many pixels.

    The keywords of `texts` have at most 79 letters of ASCII.
    """
    height, width = array.shape[:2]
    if not (0 < width <= LARGEST_SIDE and 0 < height <= LARGEST_SIDE):
        raise ValueError(f"a picture of {width}x{height} pixels")
    header = struct.pack(">IIBBBBB", width, height, 8 * array.dtype.itemsize, 2, 0, 0, 0)  # RGB, not interlaced
    parts = [SIGNATURE, chunk(b"IHDR", header)]
    for keyword, text in (texts or {}).items():  # compressed, with neither a language nor a translated keyword
        parts.append(chunk(b"iTXt", keyword.encode("ascii") + b"\0\1\0\0\0" + zlib.compress(text.encode(), LEVEL)))
    compressor = zlib.compressobj(LEVEL, strategy=zlib.Z_FILTERED)
    blocks = filtered(array.reshape(height, -1), 3 * array.dtype.itemsize)
    parts += [chunk(b"IDAT", part) for block in blocks if (part := compressor.compress(block))]
    return b"".join([*parts, chunk(b"IDAT", compressor.flush()), chunk(b"IEND", b"")])


def chunk(kind: bytes, data: bytes) -> bytes:
    """Return a chunk of the file: length, kind, data and checksum."""
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(data, zlib.crc32(kind)))


def filtered(rows: np.ndarray, step: int = 3) -> Iterator[bytes]:
    """Yield the bytes of rows (h, n), uint8 or uint16, block by block: for each row the number of its filter, then the
    differences. A pixel has `step` bytes.

    The filter of a row is the one whose differences have the least sum. Pillow chooses so among five filters; the other
    two make files 4 % smaller and take twice the time.
    """
    length = rows.shape[1] * rows.dtype.itemsize
    above = np.zeros((1, length), np.uint8)
    count = max(1, min(ROWS, BLOCK // length))
    for start in range(0, len(rows), count):
        block = rows[start : start + count]
        if rows.dtype.itemsize > 1:  # the high byte comes first
            block = block.astype(">u2").view(np.uint8)
        candidates = np.stack([block, block, block])
        candidates[SUB, :, step:] -= block[:, :-step]
        candidates[UP] -= np.concatenate([above, block[:-1]])
        sizes = np.abs(candidates.view(np.int8)).view(np.uint8)  # of differences with signs; 128 for -128
        best = sizes.sum(axis=2, dtype=np.int64).argmin(axis=0)
        chosen = np.empty((len(block), 1 + length), np.uint8)
        chosen[:, 0] = best
        chosen[:, 1:] = candidates[best, np.arange(len(block))]
        yield chosen.tobytes()
        above = block[-1:]


BEFORE = 12  # bytes of a chunk besides its data: length, kind, checksum


class PngError(ValueError):
    """The file is no PNG picture, or its text is damaged."""


def text(data: bytes, keyword: str, longest: int) -> bytes | None:
    """Return the text with a keyword, of at most `longest` bytes, in UTF-8 unless the writer erred; None where the file
    has none before its pixels, where `encode` writes it; PngError.
    """
    if not data.startswith(SIGNATURE):
        raise PngError("is not a PNG picture")
    found, start = None, keyword.encode() + b"\0"
    for kind, content in chunks(data):
        if kind == b"iTXt" and content.startswith(start):
            found = text_of(content.removeprefix(start), longest)
    return found


def chunks(data: bytes) -> Iterator[tuple[bytes, bytes]]:
    """Yield kind and data of the chunks before the pixels; PngError where the file ends or a checksum is wrong."""
    at = len(SIGNATURE)
    while (kind := data[at + 4 : at + 8]) not in (b"IDAT", b"IEND"):
        end = at + BEFORE + int.from_bytes(data[at : at + 4], "big")
        if at + BEFORE > len(data) or end > len(data):
            raise PngError("the PNG picture ends before its pixels")
        if zlib.crc32(data[at + 4 : end - 4]) != int.from_bytes(data[end - 4 : end], "big"):
            raise PngError("the PNG picture is damaged: a checksum is wrong")
        yield kind, data[at + 8 : end - 4]
        at = end


def text_of(data: bytes, longest: int) -> bytes:
    """Return the text of an iTXt chunk, behind its keyword; PngError where it is damaged or too long."""
    *_, text = data[2:].split(b"\0", 2)  # behind the language and the translated keyword
    if data[:1] == b"\1":
        try:
            text = zlib.decompressobj().decompress(text, longest + 1)
        except zlib.error:
            raise PngError("the PNG picture is damaged: its text cannot be decompressed") from None
    if len(text) > longest:
        raise PngError(f"the text in the PNG picture is larger than {longest // 2**10:,} KiB")
    return text
