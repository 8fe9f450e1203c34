"""Reader of a block of lines of an .obj file into arrays, and the error that names what is wrong in it."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Sequence
from itertools import chain
from typing import NamedTuple

import numpy as np

from minirt.errors import FieldError
from minirt.fields.scalars import FARTHEST, LONGEST, number, whole

COLOURED = 6  # numbers of a point that has a colour: further ones are left out
NUMBERS = {b"v": (3, 7, "x y z"), b"vt": (1, 3, "u v"), b"vn": (3, 3, "x y z")}  # fewest, most, names of those read
CORNER_PARTS = ("point", "vt", "vn")  # the parts of a corner in messages
SKIPPED = frozenset(b"g o s mg usemap maplib l p lod bevel c_interp d_interp shadow_obj trace_obj".split())
MATERIAL, LIBRARIES = b"usemtl", b"mtllib"
READ = (*NUMBERS, b"f", MATERIAL, LIBRARIES)  # first words of the lines that are read
ABSENT, NOWHERE = -1, -2  # indices of a vt or vn that a corner does not name, and that is not there


class ObjError(Exception):
    """A file that is not a mesh; the message names line and column, unless it is about a whole line or file.

    It quotes nothing of the file, which a stranger's scene may name though it is none of the stranger's.
    """

    def __init__(self, message: str, line: int = 0, column: int = 0) -> None:
        place = (f"line {line}" if line else "") + (f", column {column}" if column else "")
        super().__init__(f"{place}: {message}" if line else message)


class Block(NamedTuple):
    """Vertices, corners, faces and materials of a block of lines, or of a whole file."""

    points: np.ndarray  # (n, 3) vertex positions
    uvs: np.ndarray  # (k, 2) texture coordinates
    normals: np.ndarray  # (j, 3) of any length
    corners: np.ndarray  # (c, 3) for each corner of all faces the index of its point, uv and normal, or a negative one
    sizes: np.ndarray  # (f,) number of corners of each face
    lines: np.ndarray  # (f,) line of each face, from 1
    colours: np.ndarray  # (i, 3) of the points that have one, in [0, 1]
    materials: np.ndarray  # (j,) names of materials
    material_lines: np.ndarray  # (j,) lines from which on they are those of faces
    libraries: np.ndarray  # names of files of materials
    unknown: np.ndarray  # lines that begin with another word


def read(lines: list[bytes], first: int = 1, before: Sequence[int] = (0, 0, 0)) -> Block:
    """Parse lines from number `first` on, after so many points, uvs and normals; ObjError for the first wrong line."""
    lines = plain_lines(lines)
    rows = [line.split() for line in lines]
    places: dict[bytes, list[int]] = defaultdict(list)  # indices, by the first word
    try:
        for index, row in enumerate(rows):
            if row:
                places[row.pop(0)].append(index)
        points, uvs, normals = (
            number_table([rows[index] for index in places[key]], least, most, len(names.split()))
            for key, (least, most, names) in NUMBERS.items()
        )
        faces = np.array(places[b"f"], np.int64)
        sizes = np.array([len(rows[index]) for index in places[b"f"]], np.int64)
        named = corner_table([word for index in places[b"f"] for word in rows[index]])
        preceding = [count + np.searchsorted(places[key], faces) for key, count in zip(NUMBERS, before, strict=True)]
        corners = np.where(named < 0, np.repeat(np.stack(preceding, axis=1), sizes, axis=0) + named, named - 1)
        if named.min(initial=0) < 0:
            corners[(named < 0) & (corners < 0)] = NOWHERE
        if (sizes < 3).any() or (corners[:, 0] < 0).any():
            raise ValueError
        with_points = [rows[index] for index in places[b"v"]]
        colours = number_table([row[3:6] for row in with_points if len(row) >= COLOURED], 3, 3, 3)
    except (ValueError, OverflowError):
        explain(lines, first, before)
        raise
    materials, libraries = (
        np.array([b" ".join(rows[index]).decode("utf-8", "replace") for index in places[key]], object)
        for key in (MATERIAL, LIBRARIES)
    )
    unknown = [index for key in places.keys() - SKIPPED.union(READ) for index in places[key]]
    uses, others = (first + np.array(each, np.int64) for each in (places[MATERIAL], sorted(unknown)))
    return Block(points, uvs, normals, corners, sizes, first + faces, colours, materials, uses, libraries, others)


def plain_lines(lines: list[bytes]) -> list[bytes]:
    """Return lines without comments. One that a backslash continues has all the words, those that continue it none."""
    text = b"".join(lines)
    if b"#" not in text and b"\\" not in text:
        return lines
    plain: list[bytes] = []
    parts: list[bytes] = []
    for line in [*lines, b""]:
        parts.append(line.rstrip(b"\r\n"))
        if parts[-1].endswith(b"\\"):
            parts[-1] = parts[-1][:-1]
            continue
        plain += [b" ".join(parts).partition(b"#")[0], *[b""] * (len(parts) - 1)]
        parts = []
    return plain


def number_table(rows: list[list[bytes]], least: int, most: int, width: int) -> np.ndarray:
    """Return the first `width` numbers of each line; ValueError for a wrong number, or fewer or more than may be."""
    sizes = np.array(list(map(len, rows)), np.int64)
    words = list(chain.from_iterable(rows))
    numbers = np.fromiter(map(float, words), np.float64, len(words))
    are_in_range = ((least <= sizes) & (sizes <= most)).all() and (np.abs(numbers) <= FARTHEST).all()
    if not are_in_range or is_foreign(words, b" ".join(words)):
        raise ValueError
    return padded(numbers, sizes, width)


def corner_table(words: list[bytes]) -> np.ndarray:
    """Return the numbers of corners `v`, `v/vt`, `v//vn` or `v/vt/vn`, (c, 3), 0 for a missing one; ValueError."""
    text = b" ".join([*words, b""])
    characters = np.frombuffer(text, np.uint8)
    sizes = np.diff(np.cumsum(characters == ord("/"))[characters == ord(" ")], prepend=0) + 1
    parts = text.replace(b"//", b"/0/").replace(b"/ ", b"/0 ").replace(b"/", b" ").split() if b"/" in text else words
    numbers = np.fromiter(map(int, parts), np.int64, len(parts))
    if len(numbers) != sizes.sum() or (sizes > 3).any() or is_foreign(parts, text):
        raise ValueError
    return padded(numbers, sizes, 3)


def is_foreign(words: list[bytes], text: bytes) -> bool:
    """Whether one of the numbers in a text is written as Python alone may: with underscores, or in too many digits."""
    return b"_" in text or max(map(len, words), default=0) > LONGEST


def padded(values: np.ndarray, sizes: np.ndarray, width: int) -> np.ndarray:
    """Return the first `width` values of each row, 0 where it has fewer; one row after the other has `sizes` values."""
    columns = np.arange(width)
    places = (np.cumsum(sizes) - sizes)[:, None] + columns
    return np.where(columns < sizes[:, None], values[np.minimum(places, len(values) - 1)], 0)


def explain(lines: list[bytes], first: int, before: Sequence[int]) -> None:
    """Raise the ObjError of the first wrong line; arguments are those of `read`."""
    counts = dict(zip(NUMBERS, before, strict=True))
    for line, text in enumerate(lines, first):
        words = words_of(text)
        key, values = words[0][0].encode() if words else b"", words[1:]
        if key in counts:
            check_numbers(key, values, line)
            counts[key] += 1
        elif key == b"f":
            if len(values) < 3:
                raise ObjError(f"a face has at least 3 corners, got {len(values)}", line)
            for word in values:
                check_corner(word, counts[b"v"], line)


def words_of(line: bytes) -> list[re.Match[str]]:
    """Return the words of a line, and their places."""
    return list(re.finditer(r"\S+", line.decode("utf-8", "replace"), re.ASCII))


def check_numbers(key: bytes, words: list[re.Match[str]], line: int) -> None:
    """Check the numbers of a line `v`, `vt` or `vn`; further numbers, such as colours, are left out."""
    name, (least, most, names) = key.decode(), NUMBERS[key]
    if not least <= len(words) <= most:
        raise ObjError(f"{name} has {names}, got {len(words)} number{'s' * (len(words) != 1)}", line)
    for word in words:
        try:
            value = number(word[0])
        except FieldError as error:
            raise ObjError(f"{name} {expected(error)}", line, word.start() + 1) from None
        if abs(value) > FARTHEST:
            raise ObjError(f"{name} must be in [-{FARTHEST:g}, {FARTHEST:g}]", line, word.start() + 1)


def expected(error: FieldError) -> str:
    """Return what was expected of a number, without what was found."""
    return str(error).partition(", got ")[0]


def check_corner(word: re.Match[str], count: int, line: int) -> None:
    """Check the numbers of a corner's point, uv and normal; `count` points precede it."""
    parts, column = word[0].split("/"), word.start() + 1
    if len(parts) > 3 or not parts[0]:
        raise ObjError("a corner is v, v/vt, v//vn or v/vt/vn", line, column)
    for part, text in enumerate(parts):
        if not text:
            continue
        try:
            named = whole(text)
        except FieldError as error:
            raise ObjError(f"the {CORNER_PARTS[part]} of a corner {expected(error)}", line, column) from None
        if not -(2**63) <= named < 2**63 or (part == 0 and not (named and named >= -count)):
            raise ObjError(missing_point_message(count), line, column)


def missing_point_message(count: int) -> str:
    """Return the message about a corner that names a point that does not exist."""
    return f"a corner names a point that is not there: there {'is' if count == 1 else 'are'} {count}"
