"""Fast path of the .obj reader: parse a block whose lines are all written alike, as programs write them.

It is about five times as fast as `minirt.meshes.diagnosing`, which gives the same for such a block.
"""

from __future__ import annotations

from itertools import chain

import numpy as np

from minirt.fields import FARTHEST
from minirt.fields.numerals import LONGEST
from minirt.meshes.block import Block, Counts
from minirt.meshes.diagnosing import SKIPPED

Rows = list[list[bytes]]  # words of lines


def read(lines: list[bytes], before: Counts) -> Block | None:
    """Parse lines, `before` counts what precedes them; None when they are left to the diagnosing reader."""
    if max(map(len, lines), default=0) > LONGEST:  # a number may be too long, which `float` does not mind
        return None
    rows = [line.split() for line in lines]
    lines_by_key: dict[bytes, list[int]] = {}
    for index, row in enumerate(rows):
        if row:
            lines_by_key.setdefault(row[0], []).append(index)
    others = lines_by_key.keys() - {b"v", b"vt", b"vn", b"f"} - SKIPPED
    if any(not key.startswith(b"#") for key in others) or any(line.endswith((b"\\\n", b"\\\r\n")) for line in lines):
        return None
    rows_by_key = {key: [rows[index] for index in lines_by_key.get(key, ())] for key in (b"v", b"vt", b"vn", b"f")}
    try:
        points, uvs, normals = (
            number_table(rows_by_key[b"v"], 3, 7),
            number_table(rows_by_key[b"vt"], 2, 3),
            number_table(rows_by_key[b"vn"], 3, 3),
        )
        named = corner_table(rows_by_key[b"f"])
    except (ValueError, OverflowError):
        return None
    sizes = np.array([len(row) - 1 for row in rows_by_key[b"f"]], np.int64)
    if (sizes < 3).any():
        return None
    faces = np.array(lines_by_key.get(b"f", ()), np.int64)
    corners: np.ndarray = np.full(named.shape, -1)
    for column, (key, count) in enumerate(zip((b"v", b"vt", b"vn"), before[:3], strict=True)):
        preceding = np.repeat(count + np.searchsorted(np.array(lines_by_key.get(key, ())), faces), sizes)
        number = named[:, column]
        corners[:, column] = np.where(number > 0, number - 1, np.where(number < 0, preceding + number, -1))
        if ((number < 0) & (corners[:, column] < 0)).any():
            return None
    return Block(points, uvs, normals, corners, sizes, before.lines + 1 + faces)


def number_table(rows: Rows, least: int, most: int) -> np.ndarray:
    """Return the first `least` numbers of each line; ValueError unless all have equally many, `most` at most."""
    if not rows:
        return np.zeros((0, least))
    width = len(rows[0]) - 1
    if not least <= width <= most:
        raise ValueError
    words = list(chain.from_iterable(rows))
    del words[:: width + 1]
    numbers = np.array(list(map(float, words))).reshape(len(rows), width)
    if set(map(len, rows)) != {width + 1} or not (np.abs(numbers) <= FARTHEST).all() or b"_" in b"".join(words):
        raise ValueError
    return np.ascontiguousarray(numbers[:, :least])


def corner_table(faces: Rows) -> np.ndarray:
    """Return the numbers of all corners, (c, 3), 0 for a missing one; ValueError unless all are written alike."""
    words = list(chain.from_iterable(row[1:] for row in faces))
    text, slashes = b" ".join(words), {word.count(b"/") for word in words}
    if slashes == {2} and text.count(b"//") == len(words):
        columns = [0, 2]
    elif slashes in ({0}, {1}, {2}, set()):
        columns = list(range(max(slashes, default=0) + 1))
    else:
        raise ValueError
    numbers = np.array(list(map(int, text.replace(b"/", b" ").split())), np.int64)
    if not numbers.all() or b"_" in text:
        raise ValueError
    table = np.zeros((len(words), 3), np.int64)
    table[:, columns] = numbers.reshape(len(words), len(columns))
    return table
