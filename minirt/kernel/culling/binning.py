"""In which directions from a point shapes may be met: rectangles of cells, and the lists of the cells.

Seen from a point, in a frame of across, down and forward, a direction has the slopes x / z and y / z, and the cells of
a grid are squares of slopes. A ball covers an interval of either slope. What is left out of a cell is not met there,
whatever the rounding: balls grow by `MARGIN`, and intervals by the margin of the grid.

All memory is the caller's. Between `project_all` and `fill_bins` the rectangles are sorted by depth and the counts summed to ends.
"""

from __future__ import annotations

from math import inf, sqrt
from typing import Any, NamedTuple

MARGIN = 1e-12  # of the coordinates that a place is computed from, which are rounded to 1e-16
SINE_MARGIN = 1e-7  # of the sine of a cone: by how much its cosine may be wrong, as roots of differences are by 2e-8
COSINE_MARGIN = 4e-15  # of a scalar product of unit vectors


class Grid(NamedTuple):
    """Directions from a point in cells; slope s belongs to the cell `floor(scale * s + middle)`."""

    frames: Any  # (f, 3, 3) unit vectors across, down and forward
    across: int  # cells of each frame
    down: int
    scale_x: float
    middle_x: float
    scale_y: float
    middle_y: float
    margin: float  # cells by which intervals grow before they are rounded to cells
    cells: int  # of all frames, and others
    elsewhere: int  # the cell of all directions that are in no frame, which is among those; -1 where there is none


def project_all(
    origin: Any,
    grid: Grid,
    balls: Any,
    slack: float,
    first: Any,
    places: Any,
    rectangles: Any,
    used: int,
    views: Any,
    counts: Any,
) -> int:
    """Find the rectangles of the shapes that have balls.

    Shape i is the convex hull of `balls[first[i]:first[i + 1]]`, (b, 4) centre and radius, which grow by `slack`; its
    cells begin at `places[i, 0]` times one more than the grid has. Writes rectangles, (r, 4) shape, first cell, columns
    and rows, from number `used` on, and answers how many there are; of shapes with a rectangle the `bounding_cone`; and adds to
    `counts` how many rectangles cover each cell. A shape that may be met in the directions that are in no frame has a
    rectangle of that cell.
    """
    stride = grid.cells + 1
    for shape in range(views.shape[0]):
        before = used
        whole = False
        for face in range(grid.frames.shape[0]):
            column, row, columns, rows, whole = projected_rectangle(
                origin, grid, face, balls, first[shape], first[shape + 1], slack
            )
            if columns > 0 and rows > 0:
                cell = places[shape, 0] * stride + (face * grid.down + row) * grid.across + column
                rectangles[used, 0] = shape
                rectangles[used, 1] = cell
                rectangles[used, 2] = columns
                rectangles[used, 3] = rows
                used += 1
                for line in range(cell, cell + rows * grid.across, grid.across):
                    for at in range(line, line + columns):
                        counts[at] += 1
        if grid.elsewhere >= 0 and first[shape] < first[shape + 1] and not whole:
            cell = places[shape, 0] * stride + grid.elsewhere
            rectangles[used, 0] = shape
            rectangles[used, 1] = cell
            rectangles[used, 2] = 1
            rectangles[used, 3] = 1
            used += 1
            counts[cell] += 1
        if used > before:
            bounding_cone(origin, balls, first[shape], first[shape + 1], slack, views[shape])
    return used


def projected_rectangle(
    origin: Any, grid: Grid, face: int, balls: Any, start: int, end: int, slack: float
) -> tuple[int, int, int, int, bool]:
    """First column, first row, columns and rows of the cells in which the convex hull of some balls, grown by `slack`,
    may be met; no columns or no rows where there is none. And whether all of it, and of the margin, is in cells."""
    half_x = (grid.middle_x + grid.margin) / grid.scale_x  # slopes at the edges of the grid
    half_y = (grid.middle_y + grid.margin) / grid.scale_y
    slant_x = sqrt(1.0 + half_x * half_x)
    slant_y = sqrt(1.0 + half_y * half_y)
    frame = grid.frames[face]
    behind = left = right = above = below = True
    beside = False
    low_x, high_x, low_y, high_y = inf, -inf, inf, -inf
    for i in range(start, end):
        px, py, pz = balls[i, 0] - origin[0], balls[i, 1] - origin[1], balls[i, 2] - origin[2]
        radius = balls[i, 3] + slack
        z = frame[2, 0] * px + frame[2, 1] * py + frame[2, 2] * pz
        behind &= z <= -radius
        if behind and i + 1 == end:
            return 0, 0, 0, 0, False
        x = frame[0, 0] * px + frame[0, 1] * py + frame[0, 2] * pz
        y = frame[1, 0] * px + frame[1, 1] * py + frame[1, 2] * pz
        left &= x + half_x * z < -slant_x * radius
        right &= x - half_x * z > slant_x * radius
        above &= y + half_y * z < -slant_y * radius
        below &= y - half_y * z > slant_y * radius
        beside |= z <= radius
        if i + 1 == end and (left | right | above | below):
            return 0, 0, 0, 0, False
        low, high = tangent_slopes(x, z, radius)
        low_x, high_x = min(low_x, low), max(high_x, high)
        low, high = tangent_slopes(y, z, radius)
        low_y, high_y = min(low_y, low), max(high_y, high)
    if beside and end - start > 1:  # some of the hull may be where no ball is
        low_x, high_x, low_y, high_y = -inf, inf, -inf, inf
    column, columns, all_across = cell_interval(low_x, high_x, grid.scale_x, grid.middle_x, grid.margin, grid.across)
    row, rows, all_down = cell_interval(low_y, high_y, grid.scale_y, grid.middle_y, grid.margin, grid.down)
    return column, row, columns, rows, all_across and all_down


def tangent_slopes(x: float, z: float, radius: float) -> tuple[float, float]:
    """Least and greatest slope x / z of a disc, some of it before z = 0: those of the tangents from the origin, which
    are the way to its centre turned by the angle of sine radius / distance; infinite where they touch it behind."""
    squared = x * x + z * z - radius * radius
    if squared <= 0.0:
        return -inf, inf
    length = sqrt(squared)
    low_z = z * length + x * radius
    high_z = z * length - x * radius
    low = (x * length - z * radius) / low_z if low_z > 0.0 else -inf
    high = (x * length + z * radius) / high_z if high_z > 0.0 else inf
    return low, high


def cell_interval(
    low: float, high: float, scale: float, middle: float, margin: float, cells: int
) -> tuple[int, int, bool]:
    """First cell and number of cells, of so many in a row, for the slopes from `low` to `high`; and whether those are
    all of them."""
    begin = low * scale + middle - margin
    end = high * scale + middle + margin
    if not (begin < cells and end >= 0.0):
        return 0, 0, False
    start = int(max(begin, 0.0))
    return start, int(min(end, cells - 1.0)) + 1 - start, begin >= 0.0 and end < cells


def bounding_cone(origin: Any, balls: Any, start: int, end: int, slack: float, seen: Any) -> None:
    """How the convex hull of some balls, grown by `slack`, looks from a point, in five numbers.

    A cone around it: the axis, which is the direction of its middle, and the cosine of the half-angle, or -2 where it
    would take in half of all directions; and a distance that none of it falls below: how far all of it lies along the
    axis.
    """
    x = 0.0
    y = 0.0
    z = 0.0
    for i in range(start, end):
        x += balls[i, 0] - origin[0]
        y += balls[i, 1] - origin[1]
        z += balls[i, 2] - origin[2]
    length = sqrt(x * x + y * y + z * z)
    seen[3], seen[4] = -2.0, 0.0
    if length == 0.0:
        return
    least, cosine, widest = inf, 1.0, 0.0
    for i in range(start, end):
        px, py, pz = balls[i, 0] - origin[0], balls[i, 1] - origin[1], balls[i, 2] - origin[2]
        radius = balls[i, 3] + slack
        squared = px * px + py * py + pz * pz
        along = (px * x + py * y + pz * z) / length
        aside = sqrt(max(squared - along * along, 0.0))
        tangent = sqrt(max(squared - radius * radius, 0.0))
        least = min(least, along - radius)
        widest = max(widest, radius * radius / squared)
        # Of the sum of two angles: from the axis to the centre, and from there to the rim.
        cosine = min(cosine, (along * tangent - aside * radius) / squared) if tangent > 0.0 else -2.0
    seen[0], seen[1], seen[2] = x / length, y / length, z / length
    if cosine > 0.0:
        seen[3] = cosine - SINE_MARGIN * sqrt(widest) - COSINE_MARGIN
    seen[4] = max(least, 0.0)


def fill_bins(rectangles: Any, order: Any, across: int, ends: Any, members: Any) -> None:
    """Put shapes into the lists of their cells, the last of the order first; `ends` become the starts of the lists."""
    for i in range(order.shape[0] - 1, -1, -1):
        at = order[i]
        shape = rectangles[at, 0]
        cell = rectangles[at, 1]
        columns = rectangles[at, 2]
        for line in range(cell, cell + rectangles[at, 3] * across, across):
            for place in range(line, line + columns):
                ends[place] -= 1
                members[ends[place]] = shape
