"""Reads .obj files line by line, and says what is wrong with them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from minirt.errors import FieldError, quoted
from minirt.fields import FARTHEST, number, spelled, whole
from minirt.meshes.block import Block, Counts, ObjError

NUMBER_COUNTS = {"v": (3, 7, "x y z"), "vt": (1, 3, "u v"), "vn": (3, 3, "x y z")}  # at least, at most, of what
CORNER_PARTS = ("point", "vt", "vn")  # of what a corner names
SKIPPED = frozenset(
    b"g o s mg usemtl mtllib usemap maplib l p lod bevel c_interp d_interp shadow_obj trace_obj".split()
)


def read(lines: list[bytes], before: Counts) -> Block:
    """What the lines hold, of which so much is before them; BrokenError."""
    found: dict[str, list[list[float]]] = {"v": [], "vt": [], "vn": []}
    corners: list[list[int]] = []
    sizes, places = [], []
    for line, words in words_of(lines, before.lines + 1):
        key, given = words[0], words[1:]
        if key in found:
            found[key].append(parse_numbers(key, given, line))
        elif key == "f":
            if len(given) < 3:
                raise ObjError(f"a face has at least 3 corners, got {len(given)}", line)
            known = [earlier + len(rows) for earlier, rows in zip(before, found.values(), strict=False)]
            corners += [parse_corner(word, known, line) for word in given]
            sizes.append(len(given))
            places.append(line)
        elif key.encode() not in SKIPPED:
            raise ObjError(f"a line begins with v, vt, vn, f or another word of .obj, got {quoted(key)}", line)
    points, uvs, normals = (
        np.array(rows, np.float64).reshape(-1, wide) for rows, wide in zip(found.values(), (3, 2, 3), strict=True)
    )
    return Block(
        points, uvs, normals, *(np.array(each, np.int64) for each in (corners or np.zeros((0, 3)), sizes, places))
    )


def words_of(lines: list[bytes], first: int) -> Iterator[tuple[int, list[str]]]:
    """The number and the words of each line that has some; a line that ends in a backslash goes on in the next."""
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


def parse_numbers(key: str, given: list[str], line: int) -> list[float]:
    """The numbers of a line that are of use."""
    least, most, names = NUMBER_COUNTS[key]
    if not least <= len(given) <= most:
        raise ObjError(f"{key} has {names}, got {len(given)} number{'s' * (len(given) != 1)}", line)
    try:
        values = [number(word) for word in given]
    except FieldError as error:
        raise ObjError(f"{key} {error}", line) from None
    for value in values:
        if abs(value) > FARTHEST:
            raise ObjError(f"{key} must be in [-{FARTHEST:g}, {FARTHEST:g}], got {spelled(value)}", line)
    return [*values, 0.0][: len(names.split())]


def parse_corner(word: str, known: list[int], line: int) -> list[int]:
    """The indices that a corner has, -1 where it has none; `known` is how many of each are before it."""
    parts = word.split("/")
    if len(parts) > 3 or not parts[0] or (len(parts) > 1 and not parts[-1]):
        raise ObjError(f"a corner is v, v/vt, v//vn or v/vt/vn, got {quoted(word)}", line)
    parts += [""] * (3 - len(parts))
    return [parse_index(part, which, known[which], line) for which, part in enumerate(parts)]


def parse_index(text: str, which: int, known: int, line: int) -> int:
    """The index that a part of a corner has, -1 where it is empty."""
    if not text:
        return -1
    try:
        given = whole(text)
    except FieldError as error:
        raise ObjError(f"the {CORNER_PARTS[which]} of a corner {error}", line) from None
    if given == 0 or given < -known:
        raise ObjError(missing_index_message(which, given, known), line)
    return min(given - 1, 2**62) if given > 0 else known + given


def missing_index_message(which: int, given: int, there: int) -> str:
    """What is wrong with a corner that names what is not there."""
    return f"a corner names {CORNER_PARTS[which]} {given}, and there {'is' if there == 1 else 'are'} {there}"
