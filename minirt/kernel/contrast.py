"""Contrast of the packets of a picture: how far neighbouring pixels differ."""

from __future__ import annotations

from typing import Any

from minirt.kernel.atomic_counter import fetch_add
from minirt.kernel.stored_light import PACKET_HEIGHT

CHANNELS = 4  # bytes of a pixel


def classify(next_row: Any, lines: Any, seen: Any, words: Any, class_of: Any, classes: Any, counts: Any) -> None:
    """Find the contrast classes of rows of packets, taking the next one from the counter `next_row` until none is left.

    Any number of threads may do so at the same time, each with its own `seen`, `words` and `counts`. `lines` are the
    bytes of a picture that consists of whole packets, (lines, bytes). `classes` (rows, columns) receives for each
    packet the number, by the table `class_of`, that belongs to the greatest difference of a byte from that of a
    neighbour above, below, left or right, and `counts` has the packets with each number added, of those that this
    thread saw. `seen` (2, bytes), in the same memory as the uint64 `words` (2, bytes / 8), is overwritten.
    """
    height = lines.shape[0]
    rows, columns = classes.shape
    each = words.shape[1] // columns
    while True:
        row = fetch_add(next_row, 1)
        if row >= rows:
            return
        y = row * PACKET_HEIGHT
        above, below = lines[max(y - 1, 0)], lines[min(y + PACKET_HEIGHT, height - 1)]
        differences_upright(above, lines[y], lines[y + 1], lines[y + 2], lines[y + 3], below, seen[0])
        differences_beside(lines[y], lines[y + 1], lines[y + 2], lines[y + 3], seen[1])
        for column in range(columns):
            # The last pixel of the packet before differs from the first of this one.
            found = words[1, max(column * each - 1, 0)] >> 32
            for i in range(column * each, (column + 1) * each):
                found |= words[0, i] | words[1, i]
            # The highest bit of all differences is that of the greatest.
            found |= found >> 32
            found |= found >> 16
            found |= found >> 8
            number = class_of[found & 255]
            classes[row, column] = number
            counts[number] += 1


def differences_upright(above: Any, a: Any, b: Any, c: Any, d: Any, below: Any, seen: Any) -> None:
    """Collect the bits of the differences of the lines a to d of a row of packets from those above and below them."""
    for i in range(a.shape[0]):
        inner = difference(a[i], b[i]) | difference(b[i], c[i]) | difference(c[i], d[i])
        seen[i] = difference(above[i], a[i]) | inner | difference(d[i], below[i])


def differences_beside(a: Any, b: Any, c: Any, d: Any, seen: Any) -> None:
    """Collect the bits of the differences of the pixels of the lines a to d from those to the right of them."""
    last = a.shape[0] - CHANNELS
    for i in range(last):
        k = i + CHANNELS
        upper = difference(a[i], a[k]) | difference(b[i], b[k])
        seen[i] = upper | difference(c[i], c[k]) | difference(d[i], d[k])
    for i in range(last, a.shape[0]):
        seen[i] = 0


def difference(a: Any, b: Any) -> Any:
    """The difference of two bytes, without its sign."""
    return max(a, b) - min(a, b)
