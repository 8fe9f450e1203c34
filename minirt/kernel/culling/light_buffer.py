"""Lookup in light buffers: which cell a direction from a light source falls into (Haines and Greenberg 1986).

The cells of a light cover the faces of a cube around it. A light that sees all shapes from outside has a frustum
instead: a square grid of cells towards the shapes, and one more cell for all other directions. Each cell has a list of
the shapes that can be hit in it.

A `light_buffer` (11,) holds the frustum's unit vectors across, down and forward, its cells for each unit of slope (0: a
cube), and the square of a distance: a cell's list holds for all unit vectors so close to one that falls into the cell.
"""

from __future__ import annotations

from typing import Any

from minirt.lanes import Mask, Number, Vec, dot, fabs, floor, lane, minimum, where

SCALE, TOLERANCE = 9, 10  # indices of the last two numbers of a light buffer
FRUSTUM_FACTOR = 2  # a frustum's grid has so many times the cells along an edge of a cube


def is_close(cached: Any, light_buffer: Any, direction: Vec) -> Mask:
    """Whether directions are so close to the cached one that its cell's list holds for them."""
    difference = direction - Vec(cached[0], cached[1], cached[2])
    return dot(difference, difference) <= light_buffer[TOLERANCE]


def remember_cell(cached: Any, light_buffer: Any, cells: int, direction: Vec, ray: int) -> None:
    """Cache one ray's direction towards the light, and the cell that the ray arrives through."""
    x, y, z = lane(direction.x, ray), lane(direction.y, ray), lane(direction.z, ray)
    cached[0] = x
    cached[1] = y
    cached[2] = z
    cached[3] = light_buffer_cell(light_buffer, cells, Vec(-x, -y, -z))


def light_buffer_cell(light_buffer: Any, cells: int, direction: Vec) -> Number:
    """Return the number of the cell that a direction from the light falls into."""
    x, y, z = direction.x, direction.y, direction.z
    edge = FRUSTUM_FACTOR * cells
    per_slope = light_buffer[SCALE] / (light_buffer[6] * x + light_buffer[7] * y + light_buffer[8] * z)
    column = (light_buffer[0] * x + light_buffer[1] * y + light_buffer[2] * z) * per_slope + 0.5 * edge
    row = (light_buffer[3] * x + light_buffer[4] * y + light_buffer[5] * z) * per_slope + 0.5 * edge
    inside = (per_slope > 0.0) & (minimum(column, row) >= 0.0) & (column < edge) & (row < edge)
    frustum_cell = where(inside, floor(row) * edge + floor(column), 1.0 * edge * edge)
    return where(light_buffer[SCALE] > 0.0, frustum_cell, cube_cell(direction, cells))


def cube_cell(direction: Vec, cells: int) -> Number:
    """Return the cell of a cube that a direction from its centre falls into: (face * cells + row) * cells + column.

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
    half = 0.5 * cells
    scale = half / fabs(major)
    column = minimum(floor(across * scale + half), cells - 1.0)
    row = minimum(floor(down * scale + half), cells - 1.0)
    return (face * cells + row) * cells + column
