"""Buffers of a picture: what each pixel shows, as arrays, for compositing, denoising and training data."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from minirt.errors import RenderError
from minirt.fields import unit
from minirt.kernel.scene_arrays import KIND, ROW, kind_of
from minirt.lanes import Vec
from minirt.rendering.image import Image
from minirt.rendering.packing.camera import GOLDEN_RATIO
from minirt.rendering.packing.features import MATERIALS
from minirt.rendering.packing.materials import placement_numbers
from minirt.rendering.packing.ray_casting import packed_columns
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.rendering.queries.rays import camera_rays, trace
from minirt.rendering.renderer import renderer as shared_renderer
from minirt.scene import Ambient, Scene, check_scene

WHITE = (255, 255, 255)
MEMORY = 500  # bytes a pixel of all buffers while they are made
UNLIT = tuple(name for name, field in MATERIALS if not field.facts.in_albedo)


class Buffers(NamedTuple):
    """Properties of what the centre of each pixel shows; row 0 is the upper one."""

    depth: NDArray[np.float64]  # (h, w) along the viewing direction, in scene units; infinity where nothing is hit
    distance: NDArray[np.float64]  # (h, w) from the eye; infinity where nothing is hit
    shape: NDArray[np.int64]  # (h, w) index in `scene.shapes`; -1 where nothing is hit
    point: NDArray[np.float64]  # (h, w, 3) on the surface; NaN where nothing is hit
    normal: NDArray[np.float64]  # (h, w, 3) of the surface, of unit length; NaN where nothing is hit
    uv: NDArray[np.float64]  # (h, w, 2) at which pictures are looked up, `uv:` included; NaN where nothing is hit
    albedo: NDArray[np.float64]  # (h, w, 3) colour under white light, textures included; 0 where nothing is hit

    def picture(self, kind: str) -> Image:
        """Return normals, depth, ids, uv or point as a picture: colours to look at, and the numbers as its light.

        RenderError for another kind.
        """
        if kind not in COLOURS:
            raise RenderError(f"a picture of buffers shows {', '.join(COLOURS)}, got {kind!r}")
        numbers: Any = {"normals": self.normal, "depth": self.depth, "ids": self.shape, "point": self.point}.get(kind)
        if numbers is None:
            numbers = np.insert(self.uv, 2, 0.0, axis=-1)
        elif numbers.ndim == 2:
            numbers = np.repeat(numbers[..., None], 3, axis=-1).astype(np.float64)
        return Image(self.levels(kind), numbers)

    def levels(self, kind: str) -> NDArray[np.uint8]:
        """Return the colours of a picture of buffers, (h, w, 3); black where nothing is hit."""
        with np.errstate(all="ignore"):
            return np.nan_to_num(255 * COLOURS[kind](self) + 0.5).astype(np.uint8)

    def __repr__(self) -> str:
        height, width = self.depth.shape
        return f"<Buffers of {width}x{height} pixels: {', '.join(self._fields)}>"


def colours_of_normals(seen: Buffers) -> NDArray[np.float64]:
    """Return red, green and blue for x, y and z from -1 to 1."""
    return (seen.normal + 1) / 2


def colours_of_depths(seen: Buffers) -> NDArray[np.float64]:
    """Return white for the nearest depth, and grey in proportion to one over the others."""
    return np.broadcast_to((seen.depth.min() / seen.depth)[..., None], (*seen.depth.shape, 3))


def colours_of_ids(seen: Buffers) -> NDArray[np.float64]:
    """Return a colour for each shape: hues that a golden angle divides, so that no two near numbers look alike."""
    numbers = np.arange(seen.shape.max() + 1)[:, None]
    hue = numbers * GOLDEN_RATIO + np.array([0.0, 1 / 3, 2 / 3])
    table = np.clip(np.abs(6 * (hue % 1) - 3) - 1, 0, 1) * 0.7 + 0.3 * (1 - numbers % 3 / 4)
    return np.append(table, np.zeros((1, 3)), axis=0)[seen.shape]


def colours_of_uvs(seen: Buffers) -> NDArray[np.float64]:
    """Return red for u and green for v, each from one whole number to the next."""
    return np.insert(seen.uv % 1, 2, 0.0, axis=-1)


def colours_of_points(seen: Buffers) -> NDArray[np.float64]:
    """Return red, green and blue for x, y and z, between those of most points: a plane reaches far away."""
    points = seen.point[seen.shape >= 0]
    low, high = np.percentile(points, (5, 95), axis=0) if len(points) else np.zeros((2, 3))
    return np.clip((seen.point - low) / np.where(high > low, high - low, 1.0), 0, 1)


COLOURS = {  # by the kinds of pictures
    "normals": colours_of_normals,
    "depth": colours_of_depths,
    "ids": colours_of_ids,
    "uv": colours_of_uvs,
    "point": colours_of_points,
}


def buffers(scene: Scene, width: int, height: int, *, threads: int | None = None) -> Buffers:
    """Return depth, distance, shape, point, normal, uv and albedo of each pixel, of its first surface.

    The rays are those of `minirt.camera_rays`. The albedo is linear: the tones srgb and filmic
    decode colours. RenderError for a size below 1.

        seen = minirt.buffers(scene, 640, 480)
        ball = seen.shape == 0  # the mask of the first shape
    """
    check_scene(scene, "buffers")
    return geometry(scene, width, height, threads, has_uv=True)._replace(albedo=albedo(scene, width, height, threads))


def geometry(
    scene: Scene,
    width: int,
    height: int,
    threads: int | None = None,
    has_uv: bool = False,
    rows: tuple[int, int] | None = None,
) -> Buffers:
    """Return the buffers of a picture, or those of its `rows` (a, b) from a to b - 1, without albedo.

    The albedo has no rows, nor has uv without `has_uv`: it would take most of the time.
    """
    origins, directions = camera_rays(scene, width, height, rows)
    height, width, _ = directions.shape
    hits = trace(scene, origins.reshape(-1, 3), directions.reshape(-1, 3), threads=threads)
    forward = np.array(unit(scene.camera.direction))
    distance, shape = hits.distance.reshape(height, width), hits.owner.reshape(height, width)
    point, normal = (each.reshape(height, width, 3) for each in (hits.point, hits.normal))
    uv, colours = np.zeros((0, 0, 2)), np.zeros((0, 0, 3))
    if has_uv:
        arrays = ShapeArrays()
        arrays.update(*scene.runs)
        uv = coordinates(arrays, hits.known().primitives, hits.point, hits.normal).reshape(height, width, 2)
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
    """Return u and v at n points, (n, 2); NaN where there is no primitive.

    `primitive` (n,) has the index of the primitive on which each point lies, -1 for none, `point` (n, 3) the points and
    `normal` (n, 3) the outward normals there.
    """
    no_shape = -1  # the last row, which the primitive -1 selects
    shapes, owner = arrays.shapes, np.append(arrays.owner, no_shape)[primitive]
    uv, normal = np.full((len(owner), 2), np.nan), normal.copy()
    # Where `uv:` or a turn of the shape changes its coordinates from those of its `mapping`.
    placed = [i for i in np.unique(owner[owner >= 0]) if shapes[i].uv or shapes[i].map_frame()]
    placements = {i: placement_numbers(shapes[i]) for i in placed}
    for i, (_, _, _, _, _, _, *axes) in placements.items():
        normal[owner == i] = normal[owner == i] @ np.reshape(axes, (3, 3)).T
    for group, rows in enumerate(arrays.rows):
        here = np.flatnonzero((owner >= 0) & (arrays.slots[primitive, KIND] == group))
        packed = packed_columns(rows[arrays.slots[primitive[here], ROW]])
        with np.errstate(all="ignore"):
            u, v, *_ = kind_of(rows.dtype.names).mapping(packed, Vec(*point[here].T), Vec(*normal[here].T))
        uv[here, 0], uv[here, 1] = u, v
    for i, (scale_u, scale_v, shift_u, shift_v, c, s, *_) in placements.items():
        u, v = uv[owner == i].T - np.array([[shift_u], [shift_v]])
        uv[owner == i] = np.stack([scale_u * (c * u + s * v), scale_v * (c * v - s * u)], axis=-1)
    return uv
