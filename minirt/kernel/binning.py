"""Binning of shapes into a grid of directions by projected bounds: the shape lists of screen tiles and light buffers.

The light buffer is that of Haines and Greenberg 1986. `minirt.kernel.rectangles` projects the shapes;
`fill_bins` then sorts their rectangles by depth into lists. The caller allocates all memory.
"""

from __future__ import annotations

from typing import Any

from minirt.kernel.rectangles import DROPPED_BITS, BinningArrays, project_chunk, rectangle_at, write_extent
from minirt.kernel.scene_arrays import LEAST_DISTANCE, SHAPE

# Entries sort by the upper 24 bits of distances, without the sign, digit after digit.
DIGITS, RADIX = 3, 8  # digits of a distance, and bits of a digit
INDEX_BITS = 32  # lower bits of an entry, which hold the row of its rectangle
INDEX_MASK = (1 << INDEX_BITS) - 1


def fill_bins(seen: BinningArrays, starts: Any, members: Any, entries: Any, digits: Any) -> None:
    """Sort the shapes of all rectangles into the lists of the cells that they cover, the nearest first.

    `members` receives the lists, one behind the other; `starts`, for each cell of each kind and one more behind those
    of a kind, the index at which its list starts; and `seen.found[0]` the number of all members. Where `members` has
    no room for so many, it is not written, and `starts` is of no use. `entries` (2, r) and `digits` (2 ** RADIX,) are
    memory that is overwritten.
    """
    across, rows_of_chunk = seen.grid.across, seen.chunk * seen.grid.frames.shape[0]
    for cell in range(starts.shape[0]):
        starts[cell] = 0
    count = 0
    for number in range(seen.used.shape[0]):
        for at in range(number * rows_of_chunk, number * rows_of_chunk + seen.used[number]):
            shape, cell, columns, rows = rectangle_at(seen, at)
            entries[0, count] = (seen.cone_bits[shape, LEAST_DISTANCE] >> DROPPED_BITS << INDEX_BITS) | at
            count += 1
            for row in range(rows):
                start = cell + row * across
                for covered in range(start, start + columns):
                    starts[covered] += 1
    total = 0
    for cell in range(starts.shape[0]):
        total += starts[cell]
        starts[cell] = total  # the end of the list, until it is counted down to its start
    if total <= members.shape[0]:
        sort_by_depth(entries, count, digits)
        for i in range(count - 1, -1, -1):
            shape, cell, columns, rows = rectangle_at(seen, entries[DIGITS % 2, i] & INDEX_MASK)
            for row in range(rows):
                start = cell + row * across
                for covered in range(start, start + columns):
                    starts[covered] -= 1
                    members[starts[covered]] = shape
    seen.found[0] = total


def sort_by_depth(entries: Any, count: int, digits: Any) -> None:
    """Sort the first `count` entries of row 0 of `entries`, (2, r), by depth: a radix sort, from row to row and back.

    The result is in row `DIGITS % 2`. `digits` holds how often each value of a digit occurs, and then the place of the
    next entry that has it.
    """
    for digit in range(DIGITS):
        shift, source, target = INDEX_BITS + digit * RADIX, digit % 2, 1 - digit % 2
        for value in range(digits.shape[0]):
            digits[value] = 0
        for i in range(count):
            digits[(entries[source, i] >> shift) & (digits.shape[0] - 1)] += 1
        start = 0
        for value in range(digits.shape[0]):
            start += digits[value]
            digits[value] = start - digits[value]
        for i in range(count):
            value = (entries[source, i] >> shift) & (digits.shape[0] - 1)
            entries[target, digits[value]] = entries[source, i]
            digits[value] += 1


# Lists of which one shape changes.


def move_shape(shape: int, seen: BinningArrays, starts: Any, members: Any) -> None:
    """Project one shape anew, which is no plane, and correct the lists: they become those that `fill_bins` writes.

    `seen.found[0]` receives the number of all members. Where `members` has no room for so many, the lists are spoilt.
    """
    take_out(seen, shape, starts, members)
    project_chunk(seen, shape // seen.chunk)
    write_extent(seen, seen.listed[shape, SHAPE])
    first, end = rectangles_of(seen, shape)
    more, last = 0, starts.shape[0] - 1
    for at in range(first, end):
        more += seen.rectangles[at, 2] * seen.rectangles[at, 3]  # columns times rows
    seen.found[0] = starts[last] + more
    if seen.found[0] <= members.shape[0]:
        put_in(seen, shape, more, starts, members)


def rectangles_of(seen: BinningArrays, shape: int) -> tuple[int, int]:
    """Return the first of the rectangles of a shape, and the one behind its last."""
    number = shape // seen.chunk
    first = number * seen.chunk * seen.grid.frames.shape[0]
    stop = first + seen.used[number]
    while first < stop and seen.rectangles[first, 0] < shape:
        first += 1
    end = first
    while end < stop and seen.rectangles[end, 0] == shape:
        end += 1
    return first, end


def take_out(seen: BinningArrays, shape: int, starts: Any, members: Any) -> None:
    """Take a shape out of the lists of the cells that its rectangles cover, each of which has it.

    `starts` and `members` are overwritten. Cells are visited in ascending order, so that each member behind the first
    one that is taken out moves once.
    """
    first, end = rectangles_of(seen, shape)
    # `gone` members were taken out so far, the last one from the cell `before`; `behind` is the place behind that one.
    last, gone, before, behind = starts.shape[0] - 1, 0, 0, 0
    for at in range(first, end):
        _, corner, columns, rows = rectangle_at(seen, at)
        for i in range(columns * rows):
            cell = corner + i // columns * seen.grid.across + i % columns
            place = int(starts[cell])  # which no shift has moved so far
            while members[place] != shape:
                place += 1
            shift(starts, members, before, cell, behind, place, -gone)
            gone, before, behind = gone + 1, cell, place + 1
    shift(starts, members, before, last, behind, int(starts[last]), -gone)


def put_in(seen: BinningArrays, shape: int, more: int, starts: Any, members: Any) -> None:
    """Put a shape into the lists of the `more` cells that its rectangles cover: by distance, then by number.

    `starts` and `members` are overwritten; `members` has room for `more` further ones. Cells are visited in descending
    order, so that each member moves once.
    """
    first, end = rectangles_of(seen, shape)
    last = starts.shape[0] - 1
    stop = int(starts[last])
    for at in range(end - 1, first - 1, -1):
        _, corner, columns, rows = rectangle_at(seen, at)
        for i in range(columns * rows - 1, -1, -1):
            cell = corner + i // columns * seen.grid.across + i % columns
            place = int(starts[cell + 1])
            while place > starts[cell] and is_behind(seen, members[place - 1], shape):
                place -= 1
            shift(starts, members, cell, last, place, stop, more)
            more, last, stop = more - 1, cell, place
            members[place + more] = shape


def is_behind(seen: BinningArrays, shape: int, other: int) -> bool:
    """Whether a shape follows another one in lists."""
    depth, nearer = seen.cone_bits[shape, LEAST_DISTANCE], seen.cone_bits[other, LEAST_DISTANCE]
    return bool(depth > nearer or (depth == nearer and shape > other))


def shift(starts: Any, members: Any, before: int, last: int, first: int, stop: int, by: int) -> None:
    """Move the members from `first` to before `stop` by some places, and add as many to the starts of the cells behind
    `before` up to and with `last`."""
    if by != 0:
        for cell in range(before + 1, last + 1):
            starts[cell] += by
        for i in range(first, stop):
            at = i if by < 0 else first + stop - 1 - i
            members[at + by] = members[at]
