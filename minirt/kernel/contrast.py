"""Contrast of the packets of a picture: how far neighbouring pixels differ."""

from __future__ import annotations

from typing import Any

from minirt.kernel.atomic_counter import fetch_add
from minirt.kernel.frame import PACKET_HEIGHT

EVERY_OTHER = 0x00FF00FF00FF00FF  # bytes of a word of 64 bits, the bits above which are free to calculate in
CARRIES = 0x0100010001000100


def classify(next_row: Any, lines: Any, seen: Any, class_of: Any, classes: Any, counts: Any) -> None:
    """Find the contrast classes of rows of packets, taking the next one from the counter `next_row` until none is left.

    Any number of threads may do so at the same time, each with its own `seen` and `counts`. `lines` (lines, words) are uint64, each
    two pixels of a picture that consists of whole packets. `classes` (rows, columns) receives for each packet the
    number, by the table `class_of`, that belongs to the greatest difference of a byte from that of a neighbour above,
    below, left or right, and `counts` (numbers,) has the packets with each number added, of those that this thread saw.
    `seen` (2, words + 1) is overwritten.
    """
    height, words = lines.shape
    rows, columns = classes.shape
    each = words // columns
    while True:
        row = fetch_add(next_row, 1)
        if row >= rows:
            return
        for i in range(words + 1):
            seen[0, i] = 0
            seen[1, i] = 0
        for y in range(row * PACKET_HEIGHT, (row + 1) * PACKET_HEIGHT):
            differences_beside(lines[y], seen[0])
            differences_below(lines[max(y - 1, 0)], lines[y], seen[1])
        end = (row + 1) * PACKET_HEIGHT
        differences_below(lines[end - 1], lines[min(end, height - 1)], seen[1])
        for column in range(columns):
            # The next packet's first pixel differs from the last of this one.
            found = seen[0, (column + 1) * each] << 32
            for i in range(column * each, (column + 1) * each):
                found |= seen[0, i] | seen[1, i]
            # The highest bit of all differences is that of the greatest.
            found |= found >> 32
            found |= found >> 16
            found |= found >> 8
            number = class_of[found & 255]
            classes[row, column] = number
            counts[number] += 1


def differences_beside(line: Any, seen: Any) -> None:
    """Add the bits of the differences of all pixels of a line from those to the left of them."""
    seen[0] |= differences(line[0], (line[0] << 32) | ((line[0] << 32) >> 32))
    for i in range(1, line.shape[0]):
        seen[i] |= differences(line[i], (line[i] << 32) | (line[i - 1] >> 32))


def differences_below(above: Any, line: Any, seen: Any) -> None:
    """Add the bits of the differences of all pixels of a line from those above them."""
    for i in range(line.shape[0]):
        seen[i] |= differences(above[i], line[i])


def differences(a: Any, b: Any) -> Any:
    """The differences of the bytes of two words, without their signs, in the bytes of a word."""
    even = differences_of_every_other(a & EVERY_OTHER, b & EVERY_OTHER)
    return even | (differences_of_every_other((a >> 8) & EVERY_OTHER, (b >> 8) & EVERY_OTHER) << 8)


def differences_of_every_other(a: Any, b: Any) -> Any:
    """The differences of every other byte; the others are 0."""
    difference = (a | CARRIES) - b  # plus 256
    is_negative = (~difference & CARRIES) >> 8
    return ((difference & EVERY_OTHER) ^ (is_negative * 255)) + is_negative
