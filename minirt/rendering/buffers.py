"""Buffers of a picture: what each pixel shows, as arrays, for compositing, denoising and training data."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from minirt.fields import unit
from minirt.kernel.scene_arrays import kind_of
from minirt.lanes import Vec
from minirt.rendering.packing.materials import placement_numbers
from minirt.rendering.packing.ray_casting import packed_columns
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.rendering.queries.rays import camera_rays, trace
from minirt.rendering.renderer import renderer as shared_renderer
from minirt.scene import Ambient, Scene, check_scene

WHITE = (255, 255, 255)
UNLIT = ("specular", "mirror", "glass", "tint", "fresnel", "glow", "bump", "normal_map")  # no part of the albedo


class Buffers(NamedTuple):
    """Properties of what the centre of each pixel shows; row 0 is the upper one."""

    depth: NDArray[np.float64]  # (h, w) along the viewing direction, in scene units; infinity where nothing is hit
    distance: NDArray[np.float64]  # (h, w) from the eye; infinity where nothing is hit
    shape: NDArray[np.int64]  # (h, w) index in `scene.shapes`; -1 where nothing is hit
    point: NDArray[np.float64]  # (h, w, 3) on the surface; NaN where nothing is hit
    normal: NDArray[np.float64]  # (h, w, 3) of the surface, of unit length; NaN where nothing is hit
    uv: NDArray[np.float64]  # (h, w, 2) at which pictures are looked up, `uv:` included; NaN where nothing is hit
    albedo: NDArray[np.float64]  # (h, w, 3) colour under white light, textures included; 0 where nothing is hit

    def __repr__(self) -> str:
        height, width = self.depth.shape
        return f"<Buffers of {width}x{height} pixels: {', '.join(self._fields)}>"


def buffers(scene: Scene, width: int, height: int, *, threads: int | None = None) -> Buffers:
    """Return depth, distance, shape, point, normal, uv and albedo of each pixel, of its first surface.

    The rays are those of `minirt.camera_rays`. The albedo is linear: the tones srgb and filmic
    decode colours. RenderError for a size below 1.

        seen = minirt.buffers(scene, 640, 480)
        ball = seen.shape == 0  # the mask of the first shape
    """
    check_scene(scene, "buffers")
    origins, directions = camera_rays(scene, width, height)
    hits = trace(scene, origins.reshape(-1, 3), directions.reshape(-1, 3), threads=threads)
    forward = np.array(unit(scene.camera.direction))
    distance, shape = hits.distance.reshape(height, width), hits.owner.reshape(height, width)
    arrays = ShapeArrays()
    arrays.update(*scene.runs)
    parts = hits.point, hits.normal, coordinates(arrays, hits.known().primitives, hits.point, hits.normal)
    point, normal, uv = (each.reshape(height, width, -1) for each in parts)
    colours = albedo(scene, width, height, threads)
    return Buffers(distance * (directions @ forward), distance, shape, point, normal, uv, colours)


def albedo(scene: Scene, width: int, height: int, threads: int | None) -> NDArray[np.float64]:
    """Render the colours of surfaces: the scene under white ambient light alone, in front of black.

    This is a second sweep over the picture, by the kernel that renders. It takes 14 to 22 ms of the 180 to 240 ms of
    960x540 pixels; one sweep for all buffers would need a kernel of its own for each kind of scene.
    """
    matt = [shape.replace(**dict.fromkeys(UNLIT)) for shape in scene.shapes]
    camera = scene.camera.replace(exposure=0.0, lens=None)
    light = np.zeros((height, width, 3))
    renderer = shared_renderer(threads, "double", 0, False)
    flat = Scene((Ambient(1.0, WHITE), camera, *matt), scene.file)
    renderer.render(flat, np.empty((height, width, 4), np.uint8), 1, light)
    return light


def coordinates(
    arrays: ShapeArrays, primitive: NDArray[np.int64], point: NDArray[np.float64], normal: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return u and v, (n, 2), of n points of primitives, -1 where there is none, and their outward normals."""
    shapes, owner = arrays.shapes, np.append(arrays.owner, -1)[primitive]  # the last one where there is none
    uv, normal = np.full((len(owner), 2), np.nan), normal.copy()
    # Where `uv:` or a turn of the shape changes its coordinates from those of its `mapping`.
    turned = [i for i in np.unique(owner[owner >= 0]) if shapes[i].uv or shapes[i].map_frame()]
    placements = {i: placement_numbers(shapes[i]) for i in turned}
    for i, numbers in placements.items():
        normal[owner == i] = normal[owner == i] @ np.reshape(numbers[6:], (3, 3)).T
    for group, rows in enumerate(arrays.rows):
        here = np.flatnonzero((owner >= 0) & (arrays.slots[primitive, 0] == group))
        packed = packed_columns(rows[arrays.slots[primitive[here], 1]])
        with np.errstate(all="ignore"):
            u, v, *_ = kind_of(rows.dtype.names).mapping(packed, Vec(*point[here].T), Vec(*normal[here].T))
        uv[here, 0], uv[here, 1] = u, v
    for i, (scale_u, scale_v, shift_u, shift_v, c, s, *_) in placements.items():
        u, v = uv[owner == i].T - np.array([[shift_u], [shift_v]])
        uv[owner == i] = np.stack([scale_u * (c * u + s * v), scale_v * (c * v - s * u)], axis=-1)
    return uv
