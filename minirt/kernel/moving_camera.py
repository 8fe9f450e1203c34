"""Packing of a frame whose camera has moved: the lists of what it sees, its primary rays, and tables in float32."""

from __future__ import annotations

from typing import Any, NamedTuple

from minirt.kernel.binning import fill_bins
from minirt.kernel.rectangles import BinningArrays, project_shapes
from minirt.kernel.scene_arrays import to_single
from minirt.lanes import rounded_product


class Followers(NamedTuple):
    """The arrays that follow a camera beside the lists of shapes. Tables are rounded to float32 relative to the eye."""

    camera: Any  # (14,) that of `minirt.kernel.scene_arrays.SceneArrays`, in float64
    places: Any  # (2, n) x and y of the rays of a packet, in pixels from its upper left corner
    rays: Any  # (3 n or more,) the first are a row of those of `minirt.kernel.frame.frame`, in float64
    tables: Any  # int64 (t, 5) address of a table, its rows and columns, their first kind, address of the rounded table
    kinds: Any  # int64 (c,) of each column of a table, which of the shifts is subtracted
    shifts: Any  # (5,) the eye, and other numbers


def pack_frame(
    followers: Followers, next_chunk: Any, seen: BinningArrays, starts: Any, members: Any, entries: Any, digits: Any
) -> None:
    """Bin the shapes that a point sees, see `minirt.kernel.binning`, and let all else follow."""
    project_shapes(next_chunk, seen)
    fill_bins(seen, starts, members, entries, digits)
    follow(followers)


def follow(followers: Followers) -> None:
    """Write the rays of a packet, and the rounded tables."""
    camera, places, count = followers.camera, followers.places, followers.places.shape[1]
    for axis in range(3):
        followers.shifts[axis] = camera[axis]
        for i in range(count):
            across = rounded_product(camera[6 + axis], places[0, i])
            followers.rays[axis * count + i] = across + camera[9 + axis] * places[1, i]
    for number in range(followers.tables.shape[0]):
        to_single(followers.tables[number], followers.kinds, followers.shifts)
