"""Closest-hit queries for single rays through a scene, by BVH traversal, and the primary rays of a camera."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from minirt.errors import check_whole, counted
from minirt.kernel import functions
from minirt.kernel.bvh_nodes import Tree
from minirt.kernel.machine_code.arguments import words_of
from minirt.kernel.machine_code.library import LIBRARY
from minirt.rendering.packing.generic_kernels import FULL_DOUBLE, empty_arrays, generalised
from minirt.rendering.packing.ray_casting import camera_ray
from minirt.rendering.renderer import renderer
from minirt.scene import Camera, Scene, check_scene
from minirt.shapes import Shape

if TYPE_CHECKING:
    from minirt.rendering.queries.certificates import Certificate


def camera_rays(
    scene: Scene | Camera, width: int, height: int, rows: tuple[int, int] | None = None
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the rays through the centres of all pixels: origins and unit directions, each (height, width, 3).

    They are the primary rays of a picture of that size with one sample a pixel; row 0 is the upper one. `rows` (a, b)
    are the rows from a to b - 1. RenderError for a size below 1.

        origins, directions = minirt.camera_rays(scene, 640, 480)
        hits = minirt.trace(scene, origins.reshape(-1, 3), directions.reshape(-1, 3))
    """
    check_scene(scene, "camera_rays")
    width, height = check_whole("width", width, 1), check_whole("height", height, 1)
    camera = scene if isinstance(scene, Camera) else scene.camera
    y, x = np.mgrid[slice(*rows or (0, height)), 0:width] + 0.5
    _, toward = camera_ray(camera, width, height, x, y)
    directions = np.stack(np.broadcast_arrays(toward.x, toward.y, toward.z), axis=-1)
    return np.broadcast_to(np.array(camera.position, np.float64), directions.shape).copy(), directions


class Traced(NamedTuple):
    """Rays and shapes from which certificates are computed."""

    shapes: tuple[Shape, ...]
    primitives: NDArray[np.int64]  # (n,) that were hit: shapes, or triangles of meshes; -1 where nothing was
    first_primitive: NDArray[np.int64]  # of each shape
    origins: NDArray[np.float64]
    directions: NDArray[np.float64]


class ClosestHits(NamedTuple):
    """The closest hits of n rays, as arrays."""

    distance: NDArray[np.float64]  # (n,) from the origin, in units of the scene; infinity where nothing is hit
    owner: NDArray[np.int64]  # (n,) the index in `scene.shapes` of the shape that is hit; -1 where nothing is
    point: NDArray[np.float64]  # (n, 3) on the surface; NaN where nothing is hit
    normal: NDArray[np.float64]  # (n, 3) of the surface, of unit length, outward where there is an outside; or NaN


class Hits(ClosestHits):
    """The closest hits of n rays, and their certificates, which are computed on first use.

    They are computed from the arrays that `trace` was given, which must not have changed.
    """

    traced: Traced | None = None

    @cached_property
    def certificate(self) -> Certificate:
        """Backward error, condition and normal error; ValueError for hits that are not those of a call of `trace`."""
        from minirt.rendering.queries import certificates

        shapes, primitives, first_primitive, origins, directions = self.known()
        rays = certificates.Rays(origins, directions, self.distance, self.normal)
        return certificates.certify(shapes, self.owner, primitives - first_primitive[self.owner], rays)

    def known(self) -> Traced:
        """Return the rays and shapes; ValueError for hits that are not those of a call of `trace`."""
        if self.traced is None:
            raise ValueError("only hits that minirt.trace returned know their rays, not parts of them or copies")
        return self.traced

    def columns(self) -> dict[str, NDArray[np.float64] | NDArray[np.int64]]:
        """Return the hits as columns of a table: `pandas.DataFrame(hits.columns())`.

        They are distance, owner, point_x, point_y, point_z, normal_x, normal_y and normal_z, each (n,).
        """
        vectors = {"point": self.point, "normal": self.normal}
        parts = {f"{name}_{axis}": vector[:, i] for name, vector in vectors.items() for i, axis in enumerate("xyz")}
        return {"distance": self.distance, "owner": self.owner, **parts}

    def __repr__(self) -> str:
        return f"<Hits of {counted(len(self.owner), 'ray')}, {np.count_nonzero(self.owner >= 0)} of which hit a shape>"

    @property
    def backward_error(self) -> NDArray[np.float64]:
        """(n,) distance of the hit from the exact surface, in units of 2^-53 (t + |o - c| + size): the rounding errors
        of t, of the way from the origin of the ray to the shape, and of the shape's lengths. NaN where nothing is hit.
        """
        return self.certificate.backward_error

    @property
    def condition(self) -> NDArray[np.float64]:
        """(n,) relative change of t per relative change of the numbers of ray and shape; infinity where a ray only
        touches a surface, NaN where nothing is hit. t is exact within 2^-53 times this times the backward error."""
        return self.certificate.condition

    @property
    def normal_error(self) -> NDArray[np.float64]:
        """(n,) distance of the normal from the exact unit normal, in radians while it is small. NaN where nothing is
        hit."""
        return self.certificate.normal_error


def trace(scene: Scene, origins: ArrayLike, directions: ArrayLike, *, threads: int | None = None) -> Hits:
    """Find the closest hit with t > 0 of each of n rays through a scene.

    `origins` and `directions` are (n, 3), in units of the scene; a direction may have any length but 0. A ray from a
    point that `trace` returned does not hit that surface there again: a ray starts on a surface if its origin is no
    farther from it than 8 * 2^-53 of the largest one of six lengths, which is as exact as such points are: along each
    axis of the scene the origin's coordinate, and its distance from the shape's centre. Where surfaces coincide the
    shape that comes first in the scene is hit.

    The BVH of the last scene is kept, so that further rays through it start at once. Safe to call from several threads.
    Where no kernel was compiled ahead of time, the first call for a combination of shapes compiles for some seconds.
    ValueError, naming the argument, if an array has another shape, a number is infinite or NaN, or a direction has
    length 0.
    """
    check_scene(scene, "trace")
    starts = checked_vectors(origins, "origins")
    vectors = checked_vectors(directions, "directions")
    if len(starts) != len(vectors):
        raise ValueError(f"directions must be as many as origins, {len(starts)}, got {len(vectors)}")
    x, y, z = vectors.T
    if (none := (x == 0) & (y == 0) & (z == 0)).any():
        raise ValueError(f"directions must not be 0,0,0, got it at {int(np.argmax(none))}")
    count, chosen = len(starts), renderer(threads)
    # The kernel writes them all, also where nothing is hit: for coherent rays filling them took a tenth of the time.
    distance, primitive = np.empty(count), np.empty(count, np.int64)
    point, normal = np.empty((count, 3)), np.empty((count, 3))
    owner = primitive  # without meshes each shape is one primitive
    first_primitive = np.zeros(1, np.int64)  # where nothing is hit
    if count and scene.runs:
        with chosen.busy:
            # The caller's thread only waits, so that Ctrl+C reaches it.
            counter = np.zeros(1, np.int64)
            bvh = chosen.packing.bvh_of(*scene.runs)
            job = query(bvh, counter, starts, vectors, distance, primitive, point, normal)
            skip_the_rest = partial(counter.fill, count)  # for Ctrl+C: as if all rays were taken
            chosen.runner.pool.run([job] * chosen.threads, skip_the_rest)
            shapes = chosen.packing.shape_arrays
            first_primitive = shapes.first_primitive
            if len(shapes.owner) > len(scene.shapes):
                owner = np.where(owner < 0, -1, shapes.owner[owner])
    else:
        for array, value in (distance, np.inf), (primitive, -1), (point, np.nan), (normal, np.nan):
            array.fill(value)
    hits = Hits(distance, owner, point, normal)
    hits.traced = Traced(scene.shapes, primitive, first_primitive, starts, vectors)
    return hits


def checked_vectors(values: ArrayLike, name: str) -> NDArray[np.float64]:
    """Convert an argument to an array of float64 (n, 3); ValueError with its name where that is impossible."""
    try:
        raw = np.asarray(values)
    except ValueError as error:
        raise ValueError(f"{name} must be numbers of shape (n, 3): {error}") from error
    if raw.dtype.kind not in "iuf":
        raise ValueError(f"{name} must be numbers of shape (n, 3), got {raw.dtype}")
    # One memory layout, so that one kernel serves all arguments.
    array: NDArray[np.float64] = np.require(raw, np.float64, ["C", "A", "W"])
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{name} must have the shape (n, 3), got {array.shape}")
    if not np.isfinite(array).all():
        raise ValueError(f"{name} must be finite, got {array[~np.isfinite(array)][0]}")
    return array


def query(tree: Tree, counter: NDArray[np.int64], *arrays: NDArray[Any]) -> Callable[[], None]:
    """Return a job that traces rays: by the most specialised kernel that is there, or by one that is compiled now."""
    trees = tree, generalised(tree, empty_arrays(FULL_DOUBLE).bvh)
    calls = [functions.trace_rays.call(counter, each, *arrays) for each in trees]
    call = next((each for each in calls if LIBRARY.has(LIBRARY.identity(each))), calls[0])
    return partial(LIBRARY.get(call).run, words_of(call[1]))
