"""Reader of plain PGM and PPM pictures, whose levels are text. Pillow takes three times as long."""

from __future__ import annotations

import sys

CHUNK = 2**16  # bytes of text that are split at once
LONGEST = 10  # characters of a level
MOST_KNOWN = 2**16  # texts whose levels are kept


class Levels(dict[bytes, bytes]):
    """Bytes of a level by its text, computed when they are first needed."""

    def __init__(self, greatest: int, white: int, size: int) -> None:
        super().__init__()
        self.greatest, self.white, self.size = greatest, white, size

    def __missing__(self, text: bytes) -> bytes:
        level = int(text) if len(text) <= LONGEST and text.isdigit() else -1
        if not 0 <= level <= self.greatest:
            raise ValueError(f"expected a level from 0 to {self.greatest}, got {text[:20]!r}")
        packed = round(level / self.greatest * self.white).to_bytes(self.size, sys.byteorder)
        if len(self) < MOST_KNOWN:
            self[text] = packed
        return packed


def read_levels(data: bytes, at: int, count: int, levels: Levels) -> bytes:
    """Return so many levels as bytes, from the text that begins at a place of a file without comments; ValueError."""
    if len(data) - at < 2 * count - 1:  # a digit and a space for each
        raise ValueError(f"it ends before its {count:,} levels")
    parts, missing = [], count
    while missing:
        chunk = data[at : at + CHUNK]
        at += CHUNK
        texts = chunk.split()
        if at < len(data) and not chunk[-1:].isspace():  # the last level may go on in the next chunk
            at -= len(texts.pop()) if len(texts) > 1 or chunk[:1].isspace() else 0
        elif not chunk:
            raise ValueError(f"it ends {missing:,} levels before its last one")
        texts = texts[:missing]
        parts.append(b"".join(map(levels.__getitem__, texts)))
        missing -= len(texts)
    return b"".join(parts)
