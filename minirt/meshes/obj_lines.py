"""Readers of a block of lines of an .obj file into arrays: a fast one, and one that names what is wrong."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import chain
from typing import NamedTuple

import numpy as np

from minirt.errors import FieldError
from minirt.fields import FARTHEST, number, whole
from minirt.fields.scalars import LONGEST

NUMBER_COUNTS = {"v": (3, 7, "x y z"), "vt": (1, 3, "u v"), "vn": (3, 3, "x y z")}  # fewest, most, names
CORNER_PARTS = ("point", "vt", "vn")  # the parts of a corner in messages
SKIPPED = frozenset(
    b"g o s mg usemtl mtllib usemap maplib l p lod bevel c_interp d_interp shadow_obj trace_obj".split()
)

Rows = list[list[bytes]]  # words of lines


class ObjError(Exception):
    """A file that is not a mesh; the message names line and column, unless it is about a whole line or file.

    It quotes nothing of the file, which a stranger's scene may name though it is none of the stranger's.
    """

    def __init__(self, message: str, line: int = 0, column: int = 0) -> None:
        place = (f"line {line}" if line else "") + (f", column {column}" if column else "")
        super().__init__(f"{place}: {message}" if line else message)


class Word(NamedTuple):
    """A word of a line, and the column at which it begins, from 1."""

    text: str
    column: int


class Block(NamedTuple):
    """Vertices, corners and faces of a block of lines, or of a whole file."""

    points: np.ndarray  # (n, 3) vertex positions
    uvs: np.ndarray  # (k, 2) texture coordinates
    normals: np.ndarray  # (j, 3) of any length
    corners: np.ndarray  # (c, 3) for each corner of all faces the index of its point, uv and normal, or -1
    sizes: np.ndarray  # (f,) number of corners of each face
    lines: np.ndarray  # (f,) line of each face, from 1


class Counts(NamedTuple):
    """Numbers of points, uvs, normals and lines of a file before a block."""

    points: int = 0
    uvs: int = 0
    normals: int = 0
    lines: int = 0

    def after(self, block: Block, lines: int) -> Counts:
        """Return the counts after a block of that many lines."""
        points, uvs, normals = (before + len(new) for before, new in zip(self[:3], block[:3], strict=True))
        return Counts(points, uvs, normals, self.lines + lines)


def diagnose(lines: list[bytes], before: Counts) -> Block:
    """Parse lines one by one; `before` counts what precedes them in the file. ObjError names the first wrong line."""
    rows: dict[str, list[list[float]]] = {"v": [], "vt": [], "vn": []}
    corners: list[list[int]] = []
    sizes, face_lines = [], []
    for line, words in words_of(lines, before.lines + 1):
        key, values = words[0].text, words[1:]
        if key in rows:
            rows[key].append(parse_numbers(key, values, line))
        elif key == "f":
            if len(values) < 3:
                raise ObjError(f"a face has at least 3 corners, got {len(values)}", line)
            counts = [count + len(new) for count, new in zip(before, rows.values(), strict=False)]
            corners += [parse_corner(word, counts, line) for word in values]
            sizes.append(len(values))
            face_lines.append(line)
        elif key.encode() not in SKIPPED:
            raise ObjError("a line begins with v, vt, vn, f or another word of .obj", line, words[0].column)
    points, uvs, normals = (
        np.array(values, np.float64).reshape(-1, width) for values, width in zip(rows.values(), (3, 2, 3), strict=True)
    )
    return Block(
        points, uvs, normals, *(np.array(ints, np.int64) for ints in (corners or np.zeros((0, 3)), sizes, face_lines))
    )


def words_of(lines: list[bytes], first: int) -> Iterator[tuple[int, list[Word]]]:
    """Yield the number and the words of each line that has words; a backslash at its end continues a line."""
    parts: list[bytes] = []
    for line, part in enumerate([*lines, b""], first):
        parts.append(part.rstrip(b"\r\n"))
        if parts[-1].endswith(b"\\"):
            parts[-1] = parts[-1][:-1]
            continue
        text = b" ".join(parts).partition(b"#")[0].decode("utf-8", "replace")
        words = [Word(each[0], each.start() + 1) for each in re.finditer(r"\S+", text)]
        if words:
            yield line + 1 - len(parts), words
        parts = []


def parse_numbers(key: str, words: list[Word], line: int) -> list[float]:
    """Parse the numbers of a line `v`, `vt` or `vn`; further numbers, such as colours, are left out."""
    least, most, names = NUMBER_COUNTS[key]
    if not least <= len(words) <= most:
        raise ObjError(f"{key} has {names}, got {len(words)} number{'s' * (len(words) != 1)}", line)
    values = []
    for word in words:
        try:
            values.append(number(word.text))
        except FieldError as error:
            raise ObjError(f"{key} {expected(error)}", line, word.column) from None
        if abs(values[-1]) > FARTHEST:
            raise ObjError(f"{key} must be in [-{FARTHEST:g}, {FARTHEST:g}]", line, word.column)
    return [*values, 0.0][: len(names.split())]


def expected(error: FieldError) -> str:
    """Return what was expected of a number, without what was found."""
    return str(error).partition(", got ")[0]


def parse_corner(word: Word, counts: list[int], line: int) -> list[int]:
    """Return the indices of a corner's point, uv and normal, -1 for a missing one; `counts` of them precede it."""
    parts = word.text.split("/")
    if len(parts) > 3 or not parts[0] or (len(parts) > 1 and not parts[-1]):
        raise ObjError("a corner is v, v/vt, v//vn or v/vt/vn", line, word.column)
    parts += [""] * (3 - len(parts))
    return [parse_index(Word(text, word.column), part, counts[part], line) for part, text in enumerate(parts)]


def parse_index(word: Word, part: int, count: int, line: int) -> int:
    """Return the index from 0 that a part of a corner names, -1 for an empty part; `count` items precede it."""
    if not word.text:
        return -1
    try:
        named = whole(word.text)
    except FieldError as error:
        raise ObjError(f"the {CORNER_PARTS[part]} of a corner {expected(error)}", line, word.column) from None
    if named == 0 or named < -count:
        raise ObjError(missing_index_message(part, named, count), line, word.column)
    return min(named - 1, 2**62) if named > 0 else count + named


def missing_index_message(part: int, named: int, count: int) -> str:
    """Return the message about a corner that names an item that does not exist."""
    return f"a corner names {CORNER_PARTS[part]} {named}, but there {'is' if count == 1 else 'are'} {count}"


def read_quickly(lines: list[bytes], before: Counts) -> Block | None:
    """Parse lines that are all written alike, as programs write them; None when they are left to `diagnose`.

    It gives the same as `diagnose`, five times as fast.
    """
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
