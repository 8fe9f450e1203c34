"""Closest-hit queries for single rays through a scene: distance, shape, point and normal, by BVH traversal."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, cached_property, partial
from importlib import import_module
from threading import Lock
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from minirt.helpers.system import renew_after_fork
from minirt.kernel.bvh.nodes import Tree
from minirt.kernel.machine_code import functions
from minirt.kernel.machine_code.argument_block import words_of
from minirt.kernel.machine_code.library import LIBRARY
from minirt.rendering.packing.generic_kernels import generalised_tree
from minirt.rendering.queries.hits import Hits, Traced
from minirt.rendering.running.cores import usable_cores
from minirt.rendering.running.thread_pool import ThreadPool
from minirt.scene import Scene
from minirt.scene.arguments import check_scene
from minirt.shapes import Shape


def trace(scene: Scene, origins: ArrayLike, directions: ArrayLike, *, threads: int | None = None) -> Hits:
    """Find the closest hit with t > 0 of each of n rays through a scene.

    `origins` and `directions` are (n, 3), in units of the scene; a direction may have any length but 0. A surface on
    which a ray starts may be hit again: start it a little off. Where surfaces coincide the shape that comes first in
    the scene is hit. The BVH of the last scene is kept, so that further rays through it start at once. Safe to call
    from several threads. Where no kernel was compiled ahead of time, the first call for a combination of shapes
    compiles for some seconds. ValueError, naming the argument, if an array has another shape, a number is infinite or
    NaN, or a direction has length 0.
    """
    check_scene(scene, "trace")
    starts = checked_vectors(origins, "origins")
    vectors = checked_vectors(directions, "directions")
    if len(starts) != len(vectors):
        raise ValueError(f"directions must be as many as origins, {len(starts)}, got {len(vectors)}")
    if not vectors.any(axis=1).all():
        raise ValueError(f"directions must not be 0,0,0, got it at {int(np.argmin(vectors.any(axis=1)))}")
    return tracer(threads).trace(scene, starts, vectors)


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


class Tracer:
    """Keeps threads and the BVH of the last scene. Any thread may call it; it serves one call at a time."""

    shapes: tuple[Shape, ...] | None = None  # in the BVH

    def __init__(self, threads: int | None) -> None:
        self.threads = threads or usable_cores()
        self.busy = Lock()
        renew_after_fork(self)

    def after_fork(self) -> None:
        """In a child process: replace the lock and drop the threads, which are the parent's.

        The BVH goes too, since a thread may have been building it.
        """
        self.busy = Lock()
        self.shapes = None
        for name in ("pool", "shape_arrays"):
            self.__dict__.pop(name, None)

    @cached_property
    def pool(self) -> ThreadPool:
        """The threads that trace."""
        return ThreadPool(self.threads)

    @cached_property
    def shape_arrays(self) -> Any:
        """The packed shapes of the last scene."""
        return import_module("minirt.rendering.packing.shape_arrays").ShapeArrays()

    def trace(self, scene: Scene, origins: NDArray[np.float64], directions: NDArray[np.float64]) -> Hits:
        """Find the closest hits, as the function `trace` does, for arguments that were checked."""
        count = len(origins)
        hits = Hits(
            np.full(count, np.inf), np.full(count, -1), np.full((count, 3), np.nan), np.full((count, 3), np.nan)
        )
        primitives = first_primitive = np.zeros(0, np.int64)
        if count and scene.shapes:
            with self.busy:
                if self.shapes is not scene.shapes:
                    self.build_bvh(scene.shapes)
                # The caller's thread only waits, so that Ctrl+C reaches it.
                counter = np.zeros(1, np.int64)
                job = query(counter, self.bvh, origins, directions, hits)
                self.pool.run([job] * self.threads, partial(counter.fill, count))
                is_hit = hits.owner >= 0
                primitives = hits.owner[is_hit]
                hits.owner[is_hit] = self.shape_arrays.owner[primitives]
                first_primitive = self.shape_arrays.first_primitive
        hits.traced = Traced(scene.shapes, first_primitive, primitives, origins, directions)
        return hits

    def build_bvh(self, shapes: tuple[Shape, ...]) -> None:
        """Build the BVH over the shapes of a scene."""
        self.shapes = None
        self.shape_arrays.update(shapes)
        self.bvh = import_module("minirt.rendering.packing.bvh").build_bvh(self.shape_arrays, functions)
        self.shapes = shapes


def query(
    counter: NDArray[np.int64], tree: Tree, origins: NDArray[np.float64], directions: NDArray[np.float64], hits: Hits
) -> Callable[[], None]:
    """Return a job that traces rays: by the most specialised kernel that is there, or by one that is compiled now."""
    trees = tree, generalised_tree(tree)
    specialised, generic = (functions.trace_rays.call(counter, each, origins, directions, *hits) for each in trees)
    for call in (specialised, generic):
        if entry := LIBRARY.find(LIBRARY.identity(call)):
            return partial(entry.run, words_of(call[1]))
    return partial(LIBRARY.get(specialised).run, words_of(specialised[1]))


@cache
def tracer(threads: int | None) -> Tracer:
    """Return the tracer with that many threads, which is kept for later calls."""
    return Tracer(threads)
