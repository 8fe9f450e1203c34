"""Reader of plain lines of a text, for the compiler: an identifier, and numbers behind blanks or commas; comments; and
blank lines."""

from __future__ import annotations

from typing import Any

from minirt.lanes.decimals import LONGEST, read_decimal, read_whole

OTHER, NOTHING = -1, -2  # a line that is not plain; one that is blank or a comment
NAME, MOST = 6, 24  # bytes of an identifier, and at least one more; numbers of a line, and at least one more
NUMBER, BEHIND_COMMA, WHOLE = 1, 2, 4  # bits of a form: a number; not behind blanks; a whole number
TAB, LINE_FEED, RETURN, BLANK, HASH, COMMA = b"\t\n\r #,"


def read_lines(text: Any, forms: Any, kinds: Any, numbers: Any, inexact: Any) -> None:
    """Read as many lines of a `text` of bytes, int8, as `kinds` has room for; each ends in a line feed.

    - `forms` (k, `NAME` + `MOST`) has a row for each kind of plain line: the bytes of its identifier, zeros up to
      `NAME`, the bits of its numbers, and zeros.
    - `kinds` (lines,) receives the row in `forms` of each line, `OTHER` or `NOTHING`.
    - `numbers` (lines * `MOST`,) receives the numbers of each plain line, as many as it has.
    - `inexact` (n, 3) receives the numbers that are not rounded correctly, which the caller has to read: index in
      `numbers`, first byte, and the byte behind the last one. A row with -1 and the byte behind the last line follows.
    """
    at, guess, count = 0, 0, 0  # `guess`: the form of the line before, which is tried first
    for line in range(kinds.shape[0]):
        at = behind_blanks(text, at)
        kind, end = NOTHING, at
        if text[at] != LINE_FEED and text[at] != RETURN and text[at] != HASH:
            kind = form_at(text, at, forms, guess)
            guess, end, column = max(kind, 0), at if kind >= 0 else -1, NAME  # `end` is -1 where the line is not plain
            while end >= 0 and text[end] > BLANK:
                end += 1
            while end >= 0 and forms[guess, column] != 0:
                bits, index = forms[guess, column], line * MOST + column - NAME
                begin = behind_blanks(text, end) if bits & BEHIND_COMMA == 0 else end + int(text[end] == COMMA)
                value, stop, is_exact = 0.0, 0, True
                if bits & WHOLE == 0:
                    value, stop, is_exact = read_decimal(text, begin)
                else:
                    whole, stop = read_whole(text, begin)
                    value = float(whole)
                numbers[index] = value + 0.0  # -0 becomes 0
                if not is_exact:
                    inexact[count, 0], inexact[count, 1], inexact[count, 2] = index, begin, stop
                    count += 1
                is_separate_number = end < begin < stop <= begin + LONGEST
                end, column = stop if is_separate_number else -1, column + 1
        end = end_of_line(text, end)
        if end < 0:
            kind, end = OTHER, at
            while text[end] != LINE_FEED:
                end += 1
        kinds[line], at = kind, end + 1
    inexact[count, 0], inexact[count, 1] = -1, at


def behind_blanks(text: Any, at: int) -> int:
    """Return the index of the first byte from `at` on that is no blank."""
    while text[at] == BLANK or text[at] == TAB:
        at += 1
    return at


def form_at(text: Any, at: int, forms: Any, guess: int) -> int:
    """Return the row of `forms` whose identifier stands at a byte, a `guess` being tried first; or `OTHER`."""
    for i in range(-1, forms.shape[0]):
        row, width = guess if i < 0 else i, 0
        while forms[row, width] != 0 and text[at + width] == forms[row, width]:
            width += 1
        if forms[row, width] == 0 and (text[at + width] == BLANK or text[at + width] == TAB):
            return row
    return OTHER


def end_of_line(text: Any, at: int) -> int:
    """Return the index of the line feed, if from `at` on there are at most blanks, a comment and a carriage return;
    else -1."""
    if at < 0:
        return -1
    at = behind_blanks(text, at)
    if text[at] == HASH:
        while text[at] != LINE_FEED and text[at] != RETURN and text[at] != 0:
            at += 1
    if text[at] == RETURN:
        at += 1
    return at if text[at] == LINE_FEED else -1
