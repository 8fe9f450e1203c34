"""Reader of the numbers in the lines of an .obj file: a state machine over their bytes, for the compiler."""

from __future__ import annotations

from typing import Any, NamedTuple

from minirt.lanes.decimals import LARGEST, LONGEST, read_decimal, read_whole, skip_sign

TAB, NEWLINE, RETURN, BLANK, HASH, SLASH, BACKSLASH = b"\t\n\r #/\\"
V, T, N, F = b"vtnf"
A, Z, SMALL = b"az "  # the ends of the alphabet, and the bit of small letters
FACE, OTHER = 3, 4  # kinds of lines; those before are v, vt and vn
FIRST_WORDS = 1, 2, 2, 1, 0  # bytes that are skipped in these
FEWEST, MOST = (3, 1, 3, 3), (7, 3, 3, 2**60)  # words of these lines behind the first
FARTHEST = 1e15  # of the value of a number, as in `minirt.fields.scalars`
ABSENT, NOWHERE = -1, -2  # indices of a vt or vn that a corner does not name, and that is not there
VALUES, ROWS, CORNERS, INEXACT, WRONG = range(4, 9)  # in `Lines.counts`


class Lines(NamedTuple):
    """Lines, and arrays with room for what is in them."""

    text: Any  # (n,) int8 of them, and two more newlines
    size: int  # bytes of the lines
    values: Any  # (n / 2,) numbers of lines v, vt and vn
    rows: Any  # (n / 2, 3) kind, first byte, and number of values or corners of each line that is not blank
    corners: Any  # (n / 2, 3) for each corner of a face the index of its point, uv and normal, or a negative one
    inexact: Any  # (n / 2, 3) index in `values`, first byte, and that of the line: not rounded correctly, or no digits
    counts: Any  # (9,) of lines of kinds, also before; used items of arrays; whether the last row is of a wrong line


def read(lines: Lines) -> None:
    """Read lines, up to and with the first one that is wrong, and write what is in them into the arrays of `lines`.

    `lines.counts[WRONG]` becomes 1 where the last row is of a wrong line. The text ends with newlines, so that no line
    needs a look at its size.
    """
    text, counts, rows, at = lines.text, lines.counts, lines.rows, 0
    while at < lines.size and counts[WRONG] == 0:
        start, at = at, next_word(text, at)
        if text[at] != NEWLINE and text[at] != HASH:
            kind, row, size = kind_of(text, at), counts[ROWS], 0
            at = next_word(text, at + FIRST_WORDS[kind])
            while kind != OTHER and counts[WRONG] == 0 and text[at] != NEWLINE and text[at] != HASH:
                end = read_corner(lines, at) if kind == FACE else read_value(lines, start, at)
                if end == at or not ends_word(text, end):
                    counts[WRONG] = 1
                at, size = next_word(text, end), size + 1
            if kind != OTHER:
                if size < FEWEST[kind] or size > MOST[kind]:
                    counts[WRONG] = 1
                counts[kind] += 1
            rows[row, 0], rows[row, 1], rows[row, 2] = kind, start, size
            counts[ROWS] += 1
        at = next_line(text, at)


def next_word(text: Any, at: int) -> int:
    """Return the place of the next byte that is no blank. A line that ends with a backslash goes on in the next one."""
    while True:
        while text[at] == BLANK or (TAB <= text[at] <= RETURN and text[at] != NEWLINE):
            at += 1
        after = at + 1
        if text[at] != BACKSLASH:
            return at
        while text[after] == RETURN:
            after += 1
        if text[after] != NEWLINE:
            return at
        at = after + 1


def next_line(text: Any, at: int) -> int:
    """Return the first byte of the next line, behind those in which this one goes on."""
    before = BLANK
    while text[at] != NEWLINE or before == BACKSLASH:
        if text[at] != RETURN:
            before = int(text[at])
        at += 1
    return at + 1


def ends_word(text: Any, at: int) -> bool:
    return bool(text[at] == NEWLINE or text[at] == HASH or next_word(text, at) != at)


def kind_of(text: Any, at: int) -> int:
    """Return the kind of a line by the place of its first word."""
    if text[at] == V and (text[at + 1] == T or text[at + 1] == N) and ends_word(text, at + 2):
        return 1 if text[at + 1] == T else 2
    if (text[at] == V or text[at] == F) and ends_word(text, at + 1):
        return 0 if text[at] == V else FACE
    return OTHER


def letters_end(text: Any, start: int) -> int:
    """Return the place behind letters and the sign before them, the same one without letters."""
    at = first = skip_sign(text, start)
    while A <= text[at] | SMALL <= Z:
        at += 1
    return at if at > first else start


def read_value(lines: Lines, start: int, at: int) -> int:
    """Read a number of the line from byte `start` on, and return the place behind it, the same one without a number."""
    counts = lines.counts
    place, inexact = counts[VALUES], counts[INEXACT]
    value, end, is_exact = read_decimal(lines.text, at)
    if end == at:
        end = letters_end(lines.text, at)
        is_exact = end == at
    lines.inexact[inexact, 0], lines.inexact[inexact, 1], lines.inexact[inexact, 2] = place, at, start
    if not is_exact:  # else the next number takes this place
        counts[INEXACT] += 1
    lines.values[place] = value
    counts[VALUES] += 1
    return end if abs(value) <= FARTHEST and end - at <= LONGEST else at


def read_corner(lines: Lines, at: int) -> int:
    """Read a corner of a face, from byte `at` on, into the next row of `lines.corners`, also if it is wrong; return the
    place behind it, `at` where it is wrong.

    Its numbers count points, uvs or normals from 1 on, or back from the last one, -1. One that is counted back beyond
    the first is wrong for a point, and `NOWHERE` for a uv or normal. 0 is wrong for a point, and `ABSENT` for others.
    """
    text, counts, corners, part, end = lines.text, lines.counts, lines.corners, 0, at
    row = counts[CORNERS]
    corners[row, 0], corners[row, 1], corners[row, 2] = ABSENT, ABSENT, ABSENT
    counts[CORNERS] += 1
    while part < 3 and (part == 0 or text[end] == SLASH):
        start = end if part == 0 else end + 1  # behind the slash
        number, end = read_whole(text, start)
        if end - start > LONGEST or abs(number) == LARGEST:
            return at
        if end > start and number >= 0:
            corners[row, part] = number - 1  # ABSENT for 0
        elif end > start:
            index = counts[part] + number
            corners[row, part] = index if index >= 0 else NOWHERE
        part += 1
    return end if corners[row, 0] >= 0 else at
