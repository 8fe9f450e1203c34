"""Projection of shapes to a grid of directions from a point, and their bounding cones.

Seen from a point, in a frame of across, down and forward, a direction has the slopes x / z and y / z, and the cells of
a grid are squares of slopes. A sphere projects to an interval of either slope. Both are conservative whatever the
rounding: bounding spheres grow by `MARGIN`, and intervals by the margin of the grid.
"""

from __future__ import annotations

from math import inf, sqrt
from typing import Any, NamedTuple

from minirt.kernel.scene_arrays import AXIS, COSINE, LEAST_DISTANCE, vector
from minirt.lanes import Number, Vec, copysign, dot, fabs, maximum

MARGIN = 1e-12  # relative to the coordinates that a position is computed from, whose rounding is 1e-16
SINE_MARGIN = 1e-7  # error of a cone's cosine, relative to its sine: roots of differences are wrong by 2e-8
COSINE_MARGIN = 4e-15  # error of a scalar product of unit vectors
ALL_DIRECTIONS = -2.0  # the cosine of a cone that takes in all directions


class Grid(NamedTuple):
    """A grid of directions from a point, in one frame or more: slope s is in the cell `floor(scale * s + middle)`, less
    the first one."""

    frames: Any  # (f, 3, 3) unit vectors across, down and forward
    across: int  # columns of cells of each frame
    down: int  # rows of cells of each frame
    scale_x: float
    middle_x: float
    scale_y: float
    middle_y: float
    margin: float  # by how many cells intervals grow before they are rounded to cells
    cells: int  # of all frames
    first_column: int = 0  # the first of the frame that has cells, where only a rectangle of it has any
    first_row: int = 0


def projected_rectangle(
    origin: Any, grid: Grid, face: int, spheres: Any, start: int, end: int, slack: float
) -> tuple[int, int, int, int]:
    """Project the convex hull of some spheres, grown by `slack`, to a rectangle of cells of the frame number `face`.

    The spheres are the rows from `start` up to `end` of `spheres`, (n, 4) centre and radius; `origin` is the point that
    sees them. Returns first column, first row, columns and rows: no columns or rows if the frame cannot see the hull.
    """
    half_x = (grid.middle_x + grid.margin) / grid.scale_x  # slopes at the edges of the grid
    half_y = (grid.middle_y + grid.margin) / grid.scale_y
    slant_x = sqrt(1.0 + half_x * half_x)
    slant_y = sqrt(1.0 + half_y * half_y)
    frames = grid.frames
    # Whether all spheres so far lie wholly behind the point, or beyond one edge of the grid, so that the hull of all is
    # not seen; and whether one of them reaches the plane z = 0.
    behind = left = right = above = below = True
    beside = False
    low_x, high_x, low_y, high_y = inf, -inf, inf, -inf
    for i in range(start, end):
        is_last = i + 1 == end
        px, py, pz = spheres[i, 0] - origin[0], spheres[i, 1] - origin[1], spheres[i, 2] - origin[2]
        radius = spheres[i, 3] + slack
        z = frames[face, 2, 0] * px + frames[face, 2, 1] * py + frames[face, 2, 2] * pz
        behind &= z <= -radius
        if is_last and behind:
            return 0, 0, 0, 0
        x = frames[face, 0, 0] * px + frames[face, 0, 1] * py + frames[face, 0, 2] * pz
        y = frames[face, 1, 0] * px + frames[face, 1, 1] * py + frames[face, 1, 2] * pz
        left &= x + half_x * z < -slant_x * radius
        right &= x - half_x * z > slant_x * radius
        above &= y + half_y * z < -slant_y * radius
        below &= y - half_y * z > slant_y * radius
        beside |= z <= radius
        if is_last and (left | right | above | below):
            return 0, 0, 0, 0
        low, high = tangent_slopes(x, z, radius)
        low_x, high_x = min(low_x, low), max(high_x, high)
        low, high = tangent_slopes(y, z, radius)
        low_y, high_y = min(low_y, low), max(high_y, high)
    if beside and end - start > 1:  # parts of the hull between spheres may project beyond all of them
        low_x, high_x, low_y, high_y = -inf, inf, -inf, inf
    # The edges above are those of the whole grid. Cells are counted from the first ones of a part of it.
    middle_x, middle_y = grid.middle_x - grid.first_column, grid.middle_y - grid.first_row
    margin_x, margin_y = margin_around(grid, low_x, high_x), margin_around(grid, low_y, high_y)
    column, columns = cell_interval(low_x, high_x, grid.scale_x, middle_x, margin_x, grid.across)
    row, rows = cell_interval(low_y, high_y, grid.scale_y, middle_y, margin_y, grid.down)
    return column, row, columns, rows


def margin_around(grid: Grid, low: float, high: float) -> float:
    """Return by how many cells an interval of slopes grows: on a cube so far that it takes in the middles of the cells
    whose circles it meets. An angle e at direction v changes the slope x by e |v| sqrt(1 + x^2) at most, and circles
    shrink by |v|."""
    steep = min(max(-low, high), 1.0)
    return grid.margin * sqrt(1.0 + steep * steep) - 0.5 if grid.frames.shape[0] > 1 else grid.margin


def tangent_slopes(x: float, z: float, radius: float) -> tuple[float, float]:
    """Return the least and the greatest slope x / z of the disc of `radius` about (x, z), seen from the origin.

    The disc lies at least partly before z = 0. The slopes are those of the tangents from the origin: the direction of
    the centre, turned by the angle whose sine is radius / distance. A tangent that touches the disc behind z = 0 has an
    infinite slope; so have both if the origin is in the disc.
    """
    squared = x * x + z * z - radius * radius
    if squared <= 0.0:
        return -inf, inf
    length = sqrt(squared)
    low_z = z * length + x * radius
    high_z = z * length - x * radius
    low = (x * length - z * radius) / low_z if low_z > 0.0 else -inf
    high = (x * length + z * radius) / high_z if high_z > 0.0 else inf
    return low, high


def cell_interval(low: float, high: float, scale: float, middle: float, margin: float, cells: int) -> tuple[int, int]:
    """First cell and number of cells, in a row of so many, that the slopes from `low` to `high` cover."""
    begin = low * scale + middle - margin
    end = high * scale + middle + margin
    if not (begin < cells and end >= 0.0):
        return 0, 0
    start = int(max(begin, 0.0))
    return start, int(min(end, cells - 1.0)) + 1 - start


def bounding_cone(origin: Any, spheres: Any, start: int, end: int, slack: float, cone: Any) -> None:
    """Write into `cone` the bounding cone, as seen from a point, of the convex hull of some spheres, grown by `slack`.

    The spheres are the rows from `start` up to `end` of `spheres`, (n, 4) centre and radius. The cone's five numbers
    are the axis, which points to the mean of the centres; the cosine of the half-angle, or `ALL_DIRECTIONS` if the cone
    would take in half of them or more; and a lower bound of the hull's distance, along the axis.
    """
    eye, total = vector(origin, 0), Vec(0.0, 0.0, 0.0)
    for i in range(start, end):
        total = total + (vector(spheres[i], 0) - eye)
    length = sqrt(dot(total, total))
    store_cone(cone, Vec(0.0, 0.0, 0.0), ALL_DIRECTIONS, 0.0)
    if length == 0.0:
        return
    least, cosine, widest = inf, 1.0, 0.0
    for i in range(start, end):
        p, radius = vector(spheres[i], 0) - eye, spheres[i, 3] + slack
        squared, along = dot(p, p), dot(p, total) / length
        aside = sqrt(max(squared - along * along, 0.0))
        tangent = sqrt(max(squared - radius * radius, 0.0))
        least = min(least, along - radius)
        widest = max(widest, radius * radius / squared)
        # Cosine of the sum of two angles: from the axis to the centre, and from there to the rim.
        cosine = min(cosine, (along * tangent - aside * radius) / squared) if tangent > 0.0 else ALL_DIRECTIONS
    axis = Vec(total.x / length, total.y / length, total.z / length)
    is_narrow = cosine > 0.0
    bound = cosine - SINE_MARGIN * sqrt(widest) - COSINE_MARGIN if is_narrow else ALL_DIRECTIONS
    store_cone(cone, axis, bound, max(least, 0.0))


def store_cone(cone: Any, axis: Vec, cosine: float, least_distance: float) -> None:
    """Store the numbers of a bounding cone, see `minirt.kernel.scene_arrays.SceneArrays`."""
    cone[AXIS], cone[AXIS + 1], cone[AXIS + 2] = axis.x, axis.y, axis.z
    cone[COSINE], cone[LEAST_DISTANCE] = cosine, least_distance


# Infinite planes.


def signed_height(plane: Any, point: Vec, slack: float) -> Number:
    """Return a lower bound of the height of a point above a plane, or of any point that is nearer to it than `slack`.

    It is negative below the plane, and 0 where rounding may decide. `plane` has the unit normal, its product with the
    points of the plane, and the rounding error of that.
    """
    above = dot(vector(plane, 0), point) - plane[3]
    return copysign(maximum(fabs(above) - (plane[4] + slack), 0.0), above)


def cells_of_plane(grid: Grid, row: int, towards: Vec, lean: float) -> tuple[int, int]:
    """Return the first column and the number of columns of the cells in a row in which a plane may be hit.

    Rows are counted through all frames. `towards` is the unit normal of the plane, on the side away from the point;
    0, 0, 0 stands for a plane that may be hit everywhere. A direction forward + x across + y down hits the plane if its
    product with the normal, a linear function of the slopes x and y, is positive. The row is tested at its edge, upper
    or lower, at which the product is greater. Directions may differ by vectors up to `lean`.
    """
    frames, face = grid.frames, row // grid.down
    across = dot(vector(frames[face, 0], 0), towards)
    down = dot(vector(frames[face, 1], 0), towards)
    middle = row - face * grid.down + grid.first_row - grid.middle_y
    upper, lower = (middle - grid.margin) / grid.scale_y, (middle + 1.0 + grid.margin) / grid.scale_y
    slack = MARGIN * (1.0 + grid.middle_x / grid.scale_x + grid.middle_y / grid.scale_y) + lean
    most = dot(vector(frames[face, 2], 0), towards) + max(down * upper, down * lower) + slack
    low, high = -inf, inf  # slopes x between which across * x + most is positive
    if across > 0.0:
        low = -most / across
    elif across < 0.0:
        high = -most / across
    elif most <= 0.0:
        return 0, 0
    return cell_interval(low, high, grid.scale_x, grid.middle_x - grid.first_column, grid.margin, grid.across)
