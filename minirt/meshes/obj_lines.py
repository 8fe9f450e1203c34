"""Reader of a block of lines of an .obj file into arrays, and the error that names what is wrong in it."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Sequence
from math import inf, nan
from typing import NamedTuple

import numpy as np

from minirt.errors import FieldError
from minirt.fields.scalars import FARTHEST, number, whole
from minirt.kernel.machine_code.library import LIBRARY, CompiledFunction
from minirt.lanes.decimals import LARGEST
from minirt.meshes import obj_bytes
from minirt.meshes.obj_bytes import FACE, FEWEST, MOST, OTHER, Lines

COLOURED = 6  # numbers of a point that has a colour: further ones are left out
NUMBERS = {b"v": "x y z", b"vt": "u v", b"vn": "x y z"}  # names of those that are read
WIDTHS = 3, 2, 3  # and how many these are
CORNER_PARTS = ("point", "vt", "vn")  # the parts of a corner in messages
SKIPPED = frozenset(b"g o s mg usemap maplib l p lod bevel c_interp d_interp shadow_obj trace_obj".split())
MATERIAL, LIBRARIES = b"usemtl", b"mtllib"
DECIMAL = rb"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:e[-+]?[0-9]+)?"
NUMBER = re.compile(rb"([-+]?(?:nan|inf|infinity)\b)|(" + DECIMAL + rb")?", re.IGNORECASE)
CONTINUED = re.compile(rb"\\\r*(?:\n|\Z)")
LOGICAL = re.compile(rb"(?:[^\n]*\\\r*\n)*[^\n]*")  # a line and those in which it goes on
LARGE = 2**20  # bytes: the interpreter reads them in less time than the compiler takes
READ = CompiledFunction(obj_bytes.read)


class ObjError(Exception):
    """A file that is not a mesh; the message names line and column, unless it is about a whole line or file.

    It quotes nothing of the file, which a stranger's scene may name though it is none of the stranger's.
    """

    def __init__(self, message: str, line: int = 0, column: int = 0) -> None:
        place = (f"line {line}" if line else "") + (f", column {column}" if column else "")
        super().__init__(f"{place}: {message}" if line else message)
        self.message = message  # without the place


class Block(NamedTuple):
    """Vertices, corners, faces and materials of a block of lines, or of a whole file."""

    points: np.ndarray  # (n, 3) vertex positions
    uvs: np.ndarray  # (k, 2) texture coordinates
    normals: np.ndarray  # (j, 3) of any length
    corners: np.ndarray  # (c, 3) for each corner of all faces the index of its point, uv and normal, or a negative one
    sizes: np.ndarray  # (f,) number of corners of each face
    starts: np.ndarray  # (f,) first byte of the line of each face
    colours: np.ndarray  # (i, 3) of the points that have one, in [0, 1]
    materials: np.ndarray  # (j,) names of materials
    uses: np.ndarray  # (j,) first bytes of the lines from which on they are those of faces
    libraries: np.ndarray  # names of files of materials
    unknown: np.ndarray  # first bytes of the lines that begin with another word
    spoiled: np.ndarray  # (k, 2) index of each point with a coordinate nan or inf, and first byte of its line


def read(data: bytes, start: int = 0, end: int | None = None, before: Sequence[int] = (0, 0, 0)) -> Block:
    """Parse the lines of a file from byte `start` up to `end`; ObjError for the first wrong line.

    `before` counts the points, uvs and normals of the lines before them.
    """
    text = data[start:end]
    lines = call_for(text, before)
    read_bytes(lines)
    *_, row_count, corner_count, inexact, is_wrong = lines.counts.tolist()
    kinds, firsts, sizes = lines.rows[:row_count].T.copy()
    for place, at, line in lines.inexact[:inexact].tolist():  # words that the interpreter has to read
        not_finite, decimal = NUMBER.match(text, at).groups()  # type: ignore[union-attr]
        lines.values[place] = value = nan if not_finite else float(decimal or inf)
        if abs(value) > FARTHEST or (not_finite and not is_coordinate(text[line:at])):
            explain(data, start + line, 0)
    if is_wrong:
        explain(data, start + int(firsts[-1]), int(lines.counts[0]))
    ends = np.cumsum(np.where(kinds < FACE, sizes, 0))
    starts = ends - sizes  # of the numbers of each line v, vt and vn
    points, uvs, normals = (
        lines.values[starts[kinds == kind][:, None] + np.arange(width)] for kind, width in enumerate(WIDTHS)
    )
    uvs[sizes[kinds == 1] == 1, 1] = 0.0  # v of a line `vt u`
    are_coloured = (kinds == 0) & (sizes >= COLOURED)
    colours = lines.values[starts[are_coloured][:, None] + np.arange(3, COLOURED)]
    said: dict[bytes, list[tuple[int, str]]] = defaultdict(list)  # by first word
    for at in firsts[kinds == OTHER].tolist():
        word, *words = logical_line(text, at).split()
        said[word].append((start + at, b" ".join(words).decode("utf-8", "replace")))
    others = sorted(at for word in said.keys() - SKIPPED - {MATERIAL, LIBRARIES} for at, _ in said[word])
    materials, libraries = (np.array([name for _, name in said[word]], object) for word in (MATERIAL, LIBRARIES))
    uses, unknown = (np.array(each, np.int64) for each in ([at for at, _ in said[MATERIAL]], others))
    of_faces = lines.corners[:corner_count], sizes[kinds == FACE], start + firsts[kinds == FACE]
    spoiled = np.flatnonzero(np.isnan(points).any(axis=1))
    spoiled = np.stack([before[0] + spoiled, start + firsts[kinds == 0][spoiled]], axis=1)
    return Block(points, uvs, normals, *of_faces, colours, materials, uses, libraries, unknown, spoiled)


def is_coordinate(before: bytes) -> bool:
    """Whether a word is a coordinate of a point, given what precedes it in its line."""
    key, *words = CONTINUED.sub(b" ", before).split()
    return key == b"v" and len(words) < WIDTHS[0]


def call_for(text: bytes, before: Sequence[int] = (0, 0, 0)) -> Lines:
    """Return the lines of a text, and memory for what is in them."""
    rows, corners, inexact = (np.empty((len(text) // 2 + 1, 3), np.int64) for _ in range(3))
    counts = np.array([*before, *[0] * 6], np.int64)
    read = np.frombuffer(text + b"\n\n", np.int8)
    return Lines(read, len(text), np.empty(len(text) // 2 + 2), rows, corners, inexact, counts)


def read_bytes(lines: Lines) -> None:
    """Read lines by the compiled function, or by the interpreted one where that takes less time than compiling."""
    if lines.size >= LARGE or LIBRARY.has(LIBRARY.identity(READ.call(lines))):
        READ(lines)
    else:
        obj_bytes.read(lines._replace(text=lines.text.tolist()))


def line_of(data: bytes, at: int) -> int:
    """Return the number of the line of a byte, from 1."""
    return data.count(b"\n", 0, at) + 1


def logical_line(data: bytes, start: int) -> bytes:
    """Return the line that begins at a byte, without comment, and with the words of those in which it goes on."""
    return CONTINUED.sub(b" ", LOGICAL.match(data, start)[0]).partition(b"#")[0]  # type: ignore[index]


def explain(data: bytes, start: int, count: int) -> None:
    """Raise the ObjError of the wrong line that begins at a byte; `count` points precede it."""
    key, *words = words_of(logical_line(data, start))
    line = line_of(data, start)
    if key[0] != "f":
        check_numbers(key[0].encode(), words, line)
    elif len(words) < 3:
        raise ObjError(f"a face has at least 3 corners, got {len(words)}", line)
    for word in words:
        check_corner(word, count, line)


def words_of(line: bytes) -> list[re.Match[str]]:
    """Return the words of a line, and their places."""
    return list(re.finditer(r"\S+", line.decode("utf-8", "replace"), re.ASCII))


def check_numbers(key: bytes, words: list[re.Match[str]], line: int) -> None:
    """Check the numbers of a line `v`, `vt` or `vn`; further numbers, such as colours, are left out."""
    name, names, kind = key.decode(), NUMBERS[key], [*NUMBERS].index(key)
    if not FEWEST[kind] <= len(words) <= MOST[kind]:
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
    """Raise ObjError if the numbers of a corner's point, uv and normal are wrong; `count` points precede it.

    `line` is the number of its line.
    """
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
        if abs(named) >= LARGEST or (part == 0 and not (named and named >= -count)):
            raise ObjError(missing_point_message(count), line, column)


def missing_point_message(count: int) -> str:
    """Return the message about a corner that names a point that does not exist."""
    return f"a corner names a point that is not there: there {'is' if count == 1 else 'are'} {count}"
