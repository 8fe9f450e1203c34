"""Grid on the ground of a scene without shapes, whose picture shows nothing: where the ground is, and the horizon."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from minirt.scene import Camera
from minirt.viewer.editing.projection import looked_at_distance, projection_of
from minirt.viewer.editing.values import nice_number

SHARE = 1 / 8  # size of a cell, as a share of the distance to what the camera looks at, before rounding
CELLS = 20  # depth to which lines are drawn, in cells: farther away they are too dense


@lru_cache(maxsize=2)
def ground_lines(camera: Camera, width: int, height: int) -> NDArray[np.bool_]:
    """Return which pixels show the horizon, or a border between square cells of the plane y = 0: (h, w) bool.

    The lines are two pixels wide: they are looked for in a picture of half the size, in a quarter of the time.
    """
    full_height, full_width = height, width
    width, height = -(-width // 2), -(-height // 2)
    view, cell = projection_of(camera, width, height), nice_number(SHARE * looked_at_distance(camera))
    across = (2 * np.arange(width, dtype=np.float32) + 1) / width - 1
    up = 1 - (2 * np.arange(height, dtype=np.float32)[:, None] + 1) / height
    # Components of the directions through the pixels, (h, w) each, which are 1 deep.
    x, y, z = (f + across * a + up * b for f, a, b in zip(view.forward, view.right, view.up, strict=True))
    with np.errstate(divide="ignore"):
        depth = -view.eye[1] / y  # of the ground
    is_near = (depth > 0) & (depth < CELLS * cell)
    depth[~is_near] = 0.0  # may be infinite, or behind the eye
    is_line = np.zeros((height, width), bool)
    is_line[1:] = np.diff(y > 0, axis=0)  # the horizon
    for eye, direction in ((view.eye[0], x), (view.eye[2], z)):  # a border is where neighbours see different cells
        cells = np.floor((eye + depth * direction) / cell)
        is_line[1:] |= (cells[1:] != cells[:-1]) & is_near[1:] & is_near[:-1]
        is_line[:, 1:] |= (cells[:, 1:] != cells[:, :-1]) & is_near[:, 1:] & is_near[:, :-1]
    return is_line.repeat(2, axis=0).repeat(2, axis=1)[:full_height, :full_width]
