"""Directions from a lamp in cells, each of which has a list of the shapes that are met in it.

`around` (11,) tells how they are sorted for a lamp. One that looks at all shapes from outside has a square of cells
ahead of it: the unit vectors across, down and forward, and cells for a slope of 1; all other directions share one cell
more. Where there are 0 cells for a slope, a cube is around it. The last number is the square of a distance: the list
of a cell holds for all unit vectors so close to one that goes through it.
"""

from __future__ import annotations

from typing import Any

from minirt.lanes import Vec, dot, fabs, floor, lane, minimum, where
from minirt.lanes.operations import Mask
from minirt.lanes.vec import Number

SCALE, TOLERANCE = 9, 10  # in `around`
FRUSTUM_FACTOR = 2  # times the cells of a cube along an edge has the square ahead


def is_close(remembered: Any, around: Any, direction: Vec) -> Mask:
    """Whether a direction is as close to the remembered one as the lists of cells allow."""
    apart = direction - Vec(remembered[0], remembered[1], remembered[2])
    return dot(apart, apart) <= around[TOLERANCE]


def remember_cell(remembered: Any, around: Any, grid: int, direction: Vec, ray: int) -> None:
    """Remember the direction of a ray of the packet towards the lamp, and the cell that it comes through."""
    x, y, z = lane(direction.x, ray), lane(direction.y, ray), lane(direction.z, ray)
    remembered[0] = x
    remembered[1] = y
    remembered[2] = z
    remembered[3] = light_buffer_cell(around, grid, Vec(-x, -y, -z))


def light_buffer_cell(around: Any, grid: int, direction: Vec) -> Number:
    """The cell around a lamp that a direction from it goes through."""
    x, y, z = direction.x, direction.y, direction.z
    edge = FRUSTUM_FACTOR * grid
    per_slope = around[SCALE] / (around[6] * x + around[7] * y + around[8] * z)
    column = (around[0] * x + around[1] * y + around[2] * z) * per_slope + 0.5 * edge
    row = (around[3] * x + around[4] * y + around[5] * z) * per_slope + 0.5 * edge
    ahead = (per_slope > 0.0) & (minimum(column, row) >= 0.0) & (column < edge) & (row < edge)
    found = where(ahead, floor(row) * edge + floor(column), 1.0 * edge * edge)
    return where(around[SCALE] > 0.0, found, cube_cell(direction, grid))


def cube_cell(direction: Vec, grid: int) -> Number:
    """The cell of a cube that a direction from its middle goes through: (face * grid + row) * grid + column.

    Faces 0 to 5 are +x, -x, +y, -y, +z, -z; on each, columns go along the next axis in the cycle x, y, z, rows along
    the one after it, both from -1 to 1.
    """
    ax, ay, az = fabs(direction.x), fabs(direction.y), fabs(direction.z)
    along_x = (ax >= ay) & (ax >= az)
    along_y = ~along_x & (ay >= az)
    major = where(along_x, direction.x, where(along_y, direction.y, direction.z))
    across = where(along_x, direction.y, where(along_y, direction.z, direction.x))
    down = where(along_x, direction.z, where(along_y, direction.x, direction.y))
    face = where(along_x, 0.0, where(along_y, 2.0, 4.0)) + where(major > 0.0, 0.0, 1.0)
    half = 0.5 * grid
    scale = half / fabs(major)
    column = minimum(floor(across * scale + half), grid - 1.0)
    row = minimum(floor(down * scale + half), grid - 1.0)
    return (face * grid + row) * grid + column
