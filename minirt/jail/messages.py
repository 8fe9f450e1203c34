"""Limits of the helper process, and the messages between it and the program, on a pipe in each direction.

A request is a length and the bytes of a file. An answer is a header and the pixels, or the reason for which the file
cannot be decoded.
"""

from __future__ import annotations

from collections.abc import Callable
from struct import Struct

from minirt.jail.decoder import BYTES, SIDE, Decoded, DecodingError

MEMORY = 2 * 2**30  # bytes of addresses; a WebP picture of 8192x8192 pixels takes 1.3 GiB
CPU_TIME = 60  # seconds; that picture takes 9
REQUEST = Struct("<Q")  # bytes of the file
ANSWER = Struct("<?5sHHI")  # whether the decoder was silent, mode or REASON, width, height, bytes that follow
REASON = b"error"
LONGEST_REASON = 400  # bytes


class BrokenAnswerError(Exception):
    """An answer that ends too early, or that no helper gives unless something has gone wrong in it."""


def pack_answer(answer: Decoded | DecodingError, silent: bool) -> tuple[bytes, bytes | bytearray]:
    """Return the header of an answer and what follows it."""
    if isinstance(answer, DecodingError):
        reason = str(answer).encode("utf-8", "replace")[:LONGEST_REASON]
        return ANSWER.pack(silent, REASON, 0, 0, len(reason)), reason
    mode, width, height, pixels = answer
    return ANSWER.pack(silent, mode.encode(), width, height, len(pixels)), pixels


def read_answer(read: Callable[[int], bytearray]) -> tuple[Decoded | DecodingError, bool]:
    """Read an answer, which may come from a process that an attacker controls, and whether the decoder was silent.

    `read` returns as many bytes as it is asked for, or fewer where there are no more.
    BrokenAnswerError for any but a good one: no more bytes are read than the largest picture has.
    """
    header = read(ANSWER.size)
    if len(header) < ANSWER.size:
        raise BrokenAnswerError
    silent, mode, width, height, size = ANSWER.unpack(header)
    name = mode.rstrip(b"\0").decode("latin-1")
    if mode == REASON:
        expected = min(size, LONGEST_REASON)
    elif name in BYTES and 0 < width <= SIDE and 0 < height <= SIDE:
        expected = BYTES[name] * width * height
    else:
        raise BrokenAnswerError
    if size != expected:
        raise BrokenAnswerError
    content = read(size)
    if len(content) != size:
        raise BrokenAnswerError
    if mode == REASON:
        return DecodingError(content.decode("utf-8", "replace")), silent
    return Decoded(name, width, height, content), silent
