"""Light buffer over a frustum: for a light outside of a dense cluster of shapes, cells only towards the cluster, and so
much the finer.

All directions outside of the frustum share one more cell. A few shapes outside of the cluster may therefore be left out
of it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from minirt.kernel.binning import Grid
from minirt.kernel.shadow_rays import FRUSTUM_FACTOR
from minirt.rendering.packing.shape_arrays import ShapeArrays

LEAST_SHAPES = 1000  # in a cluster: with fewer a cube takes less time
MOST_OUTSIDE = 8  # shapes left out of the cluster
SPREAD = 0.5  # of the mean angle of a cell: the list of a cell holds for all directions so close to one in it
WIDEST_SLOPE = 1.0  # at the edges of the frustum: where more would be needed a cube is used
LEAST_SLOPE = 2.0**-18  # that a cell spans: float32 could not tell closer directions apart
BORDER = 4  # cells on each side, so that rounding and `SPREAD` leave no shape at the edge of the cluster outside


class Cluster(NamedTuple):
    """A ball that encloses all but a few shapes."""

    centre: np.ndarray
    radius: float


def dense_cluster(shape_arrays: ShapeArrays) -> Cluster | None:
    """Find the cluster of a scene; None where there are too few shapes for one."""
    boxes = shape_arrays.boxes
    if len(shape_arrays.plane_indices):
        boxes = np.delete(boxes, shape_arrays.plane_indices, axis=0)
    if len(boxes) < LEAST_SHAPES:
        return None
    centre = boxes[:, :3].mean(axis=0)
    offsets = boxes[:, :3] - centre
    reach = np.sqrt(np.einsum("ij,ij->i", offsets, offsets)) + np.sqrt(3) * boxes[:, 3]
    last = len(reach) - 1 - MOST_OUTSIDE
    return Cluster(centre, float(np.partition(reach, last)[last]))


def frustum_grid(cluster: Cluster | None, light: np.ndarray, cells: int) -> Grid | None:
    """The frustum from a light to the cluster as a grid; None where the light needs a cube, with so many `cells` along
    an edge."""
    if cluster is None:
        return None
    to_centre = cluster.centre - light
    distance = float(np.linalg.norm(to_centre))
    edge_cells = FRUSTUM_FACTOR * cells
    if not cluster.radius < distance / np.sqrt(1 + WIDEST_SLOPE**-2):
        return None
    slope = cluster.radius / np.sqrt(distance**2 - cluster.radius**2)
    size = max(slope / (edge_cells / 2 - BORDER), LEAST_SLOPE)
    edge = size * (edge_cells / 2 + 2)
    forward = to_centre / distance
    across = np.cross(forward, np.eye(3)[np.abs(forward).argmin()])
    across /= np.linalg.norm(across)
    frames = np.stack([across, np.cross(forward, across), forward])[None]
    # An angle changes a slope by at most its product with both roots, where both slopes are those at the edge.
    margin = 1.02 * SPREAD * np.sqrt(1 + edge**2) * np.sqrt(1 + 2 * edge**2)
    half = edge_cells / 2
    cube_cells, square_cells = 6 * cells * cells, edge_cells * edge_cells
    return Grid(frames, edge_cells, edge_cells, 1 / size, half, 1 / size, half, margin, cube_cells, square_cells)
