"""Packed scenes without culling: without the lists of tiles, of light buffers, or the boxes of the BVH."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise
from math import inf
from typing import Any, NamedTuple

import numpy as np

from minirt.errors import RenderError
from minirt.kernel.bvh_nodes import NODE, REFERENCES, Tree
from minirt.kernel.frame import tile_count
from minirt.kernel.scene_arrays import SceneArrays
from minirt.rendering import Renderer
from minirt.rendering.packing.camera import Crop
from minirt.rendering.packing.features import DEPTH, features
from minirt.rendering.scene_packing import Packing
from minirt.scene import Scene

EVERYWHERE = (0.0, 0.0, 0.0, -2.0, 0.0)  # a bounding cone of all directions, from distance 0 on
MOST = 2**24  # entries of all lists together
Change = Callable[[SceneArrays, int], SceneArrays]  # of the arrays of a picture of so many tiles


class ChangedPacking(Packing):
    """Packs scenes and changes their arrays in one or more ways."""

    def __init__(self, *changes: Change) -> None:
        super().__init__()
        self.changes = changes

    def pack_double(self, scene: Scene, width: int, height: int, crop: Crop) -> SceneArrays:
        """Pack the scene; RenderError if its lists would fill the memory."""
        arrays = super().pack_double(scene, width, height, crop)
        for change in self.changes:
            arrays = change(arrays, tile_count(width) * tile_count(height))
        return arrays


def without_tiles(arrays: SceneArrays, tiles: int) -> SceneArrays:
    """Put all shapes into the list of each tile."""
    if tiles * len(arrays.slots) > MOST:
        raise RenderError(f"{len(arrays.slots)} shapes in each of {tiles} tiles are too many")
    members, starts = shapes_by_kind(arrays)
    counts = np.diff(starts)
    return arrays._replace(
        # All lists of one kind come first, then all lists of the next kind.
        tile_shapes=np.concatenate([np.tile(members[a:b], tiles) for a, b in pairwise(starts)]),
        cones=np.full_like(arrays.cones, EVERYWHERE),
        groups=tuple(
            group._replace(tile_starts=tiles * starts[kind] + counts[kind] * np.arange(tiles + 1))
            for kind, group in enumerate(arrays.groups)
        ),
    )


def without_light_buffers(arrays: SceneArrays, _: int) -> SceneArrays:
    """Put all shapes into one light-buffer cell around each light."""
    members, starts = shapes_by_kind(arrays)
    lights = len(arrays.lights)
    return arrays._replace(
        light_buffer_cells=1,
        light_shapes=np.concatenate([members[:0], *[members] * lights]),
        light_cones=np.full_like(arrays.light_cones, EVERYWHERE),
        groups=tuple(
            group._replace(light_starts=np.arange(lights)[:, None] * len(members) + starts[kind : kind + 2])
            for kind, group in enumerate(arrays.groups)
        ),
    )


def without_boxes(arrays: SceneArrays, _: int) -> SceneArrays:
    """Widen all boxes of the BVH to all of space, so that each ray visits every leaf."""
    tree: Tree | None = arrays.bvh
    if tree is None:
        return arrays
    nodes = tree.nodes.copy()
    boxes = nodes.reshape(-1, NODE)[:, :REFERENCES]
    low, high = np.split(boxes, 2, axis=1)
    used = low <= high  # an unused child has an empty box
    low[used], high[used] = -inf, inf
    return arrays._replace(bvh=tree._replace(nodes=nodes))


def shapes_by_kind(arrays: SceneArrays) -> tuple[np.ndarray, np.ndarray]:
    """Return the numbers of all shapes, sorted by kind, and where each kind starts, with the end of the last one."""
    kinds = arrays.slots[:, 0]
    members = np.argsort(kinds, kind="stable").astype(arrays.tile_shapes.dtype)
    return members, np.concatenate([[0], np.cumsum(np.bincount(kinds, minlength=len(arrays.groups)))])


COUNTS = (1, 4, 16, 64)  # samples per pixel
MORE_COUNTS = (1, 2, 4, 8, 16, 32, 64)  # for a line whose order of convergence is wanted best
ERRORS = (0.01, 0.005, 0.002, 0.001, 0.0005)  # asked of automatic sampling
ONE_SAMPLE = 0.02  # a usual error of a picture with one sample per pixel


Drawn = dict[str, Any]  # how a picture was drawn, by fields of `minirt.report.pictures.Row`
Linear = np.ndarray | None
Draw = Callable[[Renderer, Scene, np.ndarray, float, Linear], Drawn]


def uniform_samples(renderer: Renderer, scene: Scene, pixels: np.ndarray, samples: float, linear: Linear) -> Drawn:
    """Render with the same number of samples in each pixel."""
    renderer.render(scene, pixels, int(samples), linear)
    return {"samples": samples, "not_finite": renderer.not_finite}


def adaptive_samples(renderer: Renderer, scene: Scene, pixels: np.ndarray, samples: float, linear: Linear) -> Drawn:
    """Render one sample per pixel, then `samples` where neighbouring pixels differ."""
    renderer.render(scene, pixels, 1, linear)
    before = renderer.not_finite
    renderer.render(scene, pixels, int(samples), linear, edges_only=True)
    return {"samples": samples, "not_finite": before + renderer.not_finite}


def automatic_samples(renderer: Renderer, scene: Scene, pixels: np.ndarray, error: float, linear: Linear) -> Drawn:
    """Render as `--samples auto` does until the estimated error is at most `error`."""
    found = renderer.reach(scene, pixels, error, linear=linear)
    assert found, "nobody cancels"
    figures = {"samples": found.samples, "asked": error, "estimated": found.error}
    return figures | {"not_finite": renderer.not_finite}


def brute_force(threads: int) -> Renderer:
    """Return a renderer that tests every ray against every shape."""
    renderer = Renderer(threads)
    renderer.packing = ChangedPacking(without_tiles, without_light_buffers, without_boxes)
    return renderer


class Knob(NamedTuple):
    """A render option that is varied: a line of the diagram."""

    name: str
    about: str
    renderer: Callable[[int], Renderer] = Renderer  # number of threads -> renderer
    draw: Draw = uniform_samples
    values: tuple[float, ...] = COUNTS  # samples, or errors that are asked for
    work: Callable[[float], float] = float  # value -> samples per pixel, at most, to which the time is proportional


def bounces(depth: int, name: str) -> Knob:
    """Uniform samples with at most `depth` bounces."""
    about = f"light is reflected or refracted {depth} times at most, not {DEPTH} times"
    return Knob(name, about, renderer=lambda threads: Renderer(threads, depth=depth), values=COUNTS[::2])


SINGLE = Knob("single", "float32 relative to the eye", renderer=lambda threads: Renderer(threads, "single"))
AUTO = Knob(
    "auto",
    "as many samples in each part of the picture as the error that is asked for needs (`--samples auto`)",
    draw=automatic_samples,
    values=ERRORS,
    work=lambda error: (ONE_SAMPLE / error) ** 1.5,
)
BOUNCES = (bounces(0, "no bounces"), bounces(1, "1 bounce"), bounces(3, "3 bounces"))
KNOBS = (
    Knob("uniform", "the same samples in each pixel, float64", values=MORE_COUNTS),
    Knob("adaptive", "one sample, then more where neighbouring pixels differ", Renderer, adaptive_samples, COUNTS[1:]),
    AUTO,
    SINGLE,
    Knob("brute force", "no culling: every ray tries every shape", renderer=brute_force, values=COUNTS[:2]),
    *BOUNCES,
)


class Setting(NamedTuple):
    """A knob with a number of samples, or with the error that is asked for: a point of the diagram."""

    knob: Knob
    value: float

    @property
    def name(self) -> str:
        """Name of the setting, such as `uniform 16`."""
        return f"{self.knob.name} {self.value:g}"


def settings(scene: Scene, most: int, least_error: float) -> Iterator[Setting]:
    """Yield all settings of a scene with at most `most` samples, or errors of at least `least_error`, knob by knob.

    Single precision is left out if the scene needs float64, bounces if nothing reflects or refracts.
    """
    is_single = Packing(precision="single").pack(scene, 16, 9).camera.dtype == np.float32
    without = {SINGLE.name} if not is_single else set()
    without |= {each.name for each in BOUNCES} if "reflective" not in features(scene) else set()
    for knob in (each for each in KNOBS if each.name not in without):
        wanted = (value for value in knob.values if (value >= least_error if knob is AUTO else value <= most))
        yield from (Setting(knob, value) for value in wanted)
