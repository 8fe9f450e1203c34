"""Diagnosing reader of .obj files: line by line, with errors that name the line."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from minirt.errors import FieldError, quoted
from minirt.fields import FARTHEST, number, spelled, whole
from minirt.meshes.block import Block, Counts, ObjError

NUMBER_COUNTS = {"v": (3, 7, "x y z"), "vt": (1, 3, "u v"), "vn": (3, 3, "x y z")}  # fewest, most, names
CORNER_PARTS = ("point", "vt", "vn")  # the parts of a corner in messages
SKIPPED = frozenset(
    b"g o s mg usemtl mtllib usemap maplib l p lod bevel c_interp d_interp shadow_obj trace_obj".split()
)


def read(lines: list[bytes], before: Counts) -> Block:
    """Parse lines; `before` counts what precedes them in the file. ObjError names the first wrong line."""
    rows: dict[str, list[list[float]]] = {"v": [], "vt": [], "vn": []}
    corners: list[list[int]] = []
    sizes, face_lines = [], []
    for line, words in words_of(lines, before.lines + 1):
        key, values = words[0], words[1:]
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
            raise ObjError(f"a line begins with v, vt, vn, f or another word of .obj, got {quoted(key)}", line)
    points, uvs, normals = (
        np.array(values, np.float64).reshape(-1, width) for values, width in zip(rows.values(), (3, 2, 3), strict=True)
    )
    return Block(
        points, uvs, normals, *(np.array(ints, np.int64) for ints in (corners or np.zeros((0, 3)), sizes, face_lines))
    )


def words_of(lines: list[bytes], first: int) -> Iterator[tuple[int, list[str]]]:
    """Yield the number and the words of each line that has words; a backslash at its end continues a line."""
    parts: list[bytes] = []
    for line, part in enumerate([*lines, b""], first):
        parts.append(part.rstrip(b"\r\n"))
        if parts[-1].endswith(b"\\"):
            parts[-1] = parts[-1][:-1]
            continue
        words = b" ".join(parts).partition(b"#")[0].decode("utf-8", "replace").split()
        if words:
            yield line + 1 - len(parts), words
        parts = []


def parse_numbers(key: str, words: list[str], line: int) -> list[float]:
    """Parse the numbers of a line `v`, `vt` or `vn`; further numbers, such as colours, are left out."""
    least, most, names = NUMBER_COUNTS[key]
    if not least <= len(words) <= most:
        raise ObjError(f"{key} has {names}, got {len(words)} number{'s' * (len(words) != 1)}", line)
    try:
        values = [number(word) for word in words]
    except FieldError as error:
        raise ObjError(f"{key} {error}", line) from None
    for value in values:
        if abs(value) > FARTHEST:
            raise ObjError(f"{key} must be in [-{FARTHEST:g}, {FARTHEST:g}], got {spelled(value)}", line)
    return [*values, 0.0][: len(names.split())]


def parse_corner(word: str, counts: list[int], line: int) -> list[int]:
    """Return the indices of a corner's point, uv and normal, -1 for a missing one; `counts` of them precede it."""
    parts = word.split("/")
    if len(parts) > 3 or not parts[0] or (len(parts) > 1 and not parts[-1]):
        raise ObjError(f"a corner is v, v/vt, v//vn or v/vt/vn, got {quoted(word)}", line)
    parts += [""] * (3 - len(parts))
    return [parse_index(text, part, counts[part], line) for part, text in enumerate(parts)]


def parse_index(text: str, part: int, count: int, line: int) -> int:
    """Return the index from 0 that a part of a corner names, -1 for an empty part; `count` items precede it."""
    if not text:
        return -1
    try:
        named = whole(text)
    except FieldError as error:
        raise ObjError(f"the {CORNER_PARTS[part]} of a corner {error}", line) from None
    if named == 0 or named < -count:
        raise ObjError(missing_index_message(part, named, count), line)
    return min(named - 1, 2**62) if named > 0 else count + named


def missing_index_message(part: int, named: int, count: int) -> str:
    """Return the message about a corner that names an item that does not exist."""
    return f"a corner names {CORNER_PARTS[part]} {named}, but there {'is' if count == 1 else 'are'} {count}"
