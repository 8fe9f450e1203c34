"""Scene -> the arrays that the kernel reads; what did not change since the last scene is kept."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from functools import cached_property
from importlib import import_module
from typing import Any

import numpy as np

from minirt.kernel.culling import binning
from minirt.kernel.scene_arrays import Group, SceneArrays
from minirt.rendering.culling.light_frustum import dense_cluster
from minirt.rendering.culling.planes import never_occludes
from minirt.rendering.culling.visibility import (
    BinnedShapes,
    light_buffer_cells,
    seen_by_eye,
    seen_by_light,
    seen_by_parallel_light,
)
from minirt.rendering.notes import notes
from minirt.rendering.packing.bvh import build_bvh
from minirt.rendering.packing.camera import camera_numbers, pixel_rays
from minirt.rendering.packing.features import DEPTH, features
from minirt.rendering.packing.lights import emitting_lights, intensity, positions_and_intensities, spot_parameters
from minirt.rendering.packing.materials import pack_environment, pack_materials
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.rendering.packing.single_precision import in_single
from minirt.scene import ParallelLight, Scene
from minirt.shapes import Shape


class Packing:
    """Packs scene after scene, in "double" or, where a scene allows it, "single" `precision`. Given
    `minirt.kernel.culling.binning` for the kernel it does without the compiler."""

    def __init__(self, kernel: Any = None, precision: str = "double", depth: int = DEPTH) -> None:
        self.kernel = kernel
        self.precision = precision
        self.depth = depth  # bounces at most
        self.tables = ShapeArrays()
        self.known: dict[Hashable, Any] = {}  # what was worked out for the last scene, by what it was worked out from
        self.last: tuple[Scene, int, int, SceneArrays] | None = None

    def tables_of(self, shapes: tuple[Shape, ...]) -> ShapeArrays:
        """The arrays of those shapes; what was worked out for others is forgotten."""
        if self.tables.update(shapes):
            self.known, self.last = {}, None
        return self.tables

    def pack(self, scene: Scene, width: int, height: int) -> SceneArrays:
        """The scene, seen in a picture of that size."""
        if self.last and self.last[0] is scene and self.last[1:3] == (width, height):
            return self.last[3]
        traced = self.traced(scene, width, height)
        if self.precision == "single" and fits_single(traced):
            traced = in_single(traced, self.tables.boxes)
        self.last = scene, width, height, traced
        return traced

    def traced(self, scene: Scene, width: int, height: int) -> SceneArrays:
        """The same in double precision, anew."""
        self.kernel = self.kernel or import_module("minirt.kernel.compiler.jit_binning")
        tables = self.tables_of(scene.shapes)
        before, self.known = self.known, {}

        def keep(key: Hashable, work: Callable[..., Any], *given: Any) -> Any:
            self.known[key] = before[key] if key in before else work(*given)
            return self.known[key]

        used = features(scene) - (set() if self.depth else {"reflective"})
        camera, lamps = camera_numbers(scene.camera, width, height), emitting_lights(scene)
        lights = positions_and_intensities(lamps)
        eye = keep((camera.tobytes(), width, height), seen_by_eye, self.kernel, tables, camera, width, height)
        grid, most = light_buffer_cells(tables), keep("crowd", dense_cluster, tables)
        seen: list[BinnedShapes] = []
        keys: list[Hashable] = []
        for lamp, place in zip(lamps, lights[:, :3], strict=True):
            skipped = never_occludes(tables, camera[:3], lamp)
            if isinstance(lamp, ParallelLight):
                keys.append(("parallel", skipped.tobytes()))
                seen.append(keep(keys[-1], seen_by_parallel_light, tables, grid, skipped))
            else:
                keys.append((place.tobytes(), skipped.tobytes()))
                seen.append(keep(keys[-1], seen_by_light, self.kernel, tables, most, place, grid, skipped))
        lamp_starts, lit, lamp_views, around = keep(tuple(keys), joined_light_buffers, seen, eye)
        materials = keep(("materials", used), pack_materials, scene, tables.owner, used)
        tree = "reflective" in used or ("parallel" in used and grid > 1)
        paint: Any = scene.background and scene.background.paint
        return SceneArrays(
            camera=pixel_rays(camera, width, height),
            ambient=intensity(scene.ambient) if scene.ambient else np.zeros(3),
            lights=lights,
            colours_and_extents=tables.colours_and_extents,
            slots=tables.slots,
            tile_shapes=eye.members,
            cones=eye.cones,
            light_buffer_cells=grid,
            light_buffers=around,
            light_shapes=lit,
            light_cones=lamp_views,
            groups=tuple(map(Group, tables.rows, eye.tile_starts, lamp_starts)),
            spots=spot_parameters(lamps) if "spots" in used else None,
            depth=self.depth,
            background=np.divide(paint, 255) if "background" in used else None,
            environment=keep(("environment", paint), pack_environment, scene, paint) if "environment" in used else None,
            bvh=keep("bvh", build_bvh, tables, self.planter) if tree else None,
            **materials._asdict(),
        )

    @cached_property
    def planter(self) -> Any:
        """What builds trees: `minirt.kernel.compiler.jit_bvh`, or the same without the compiler."""
        return import_module(
            "minirt.kernel.bvh.interpreted" if self.kernel is binning else "minirt.kernel.compiler.jit_bvh"
        )

    @property
    def notes(self) -> list[str]:
        """What was decided about the last scene, in words."""
        if not self.last:
            return []
        scene, _, _, traced = self.last
        told = list(notes(scene, self.tables, traced))
        if self.precision == "single" and not fits_single(traced):
            told.insert(0, "double precision: single has neither pictures nor a tree of shapes")
        return told


def fits_single(traced: SceneArrays) -> bool:
    """Whether float32 will do: the tree is made of float64, and float32 cannot count the pixels of a large picture."""
    return (
        traced.bvh is None
        and traced.environment is None
        and (traced.surface_maps is None or not len(traced.surface_maps.pictures))
    )


def joined_light_buffers(lamps: list[BinnedShapes], eye: BinnedShapes) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """The lists of all lamps as one: starts (kinds, m, cells + 1), members, views (m, n, 5), around (m, 11)."""
    if len(lamps) == 1:
        return lamps[0].tile_starts[:, None], lamps[0].members, lamps[0].cones[None], lamps[0].light_buffers[None]
    if not lamps:
        return (
            np.zeros((len(eye.tile_starts), 0, 1), np.int64),
            eye.members[:0],
            np.zeros((0, *eye.cones.shape)),
            np.zeros((0, 11)),
        )
    before = np.cumsum([0, *(len(each.members) for each in lamps[:-1])])
    starts = np.stack([each.tile_starts + first for each, first in zip(lamps, before, strict=True)], axis=1)
    return (
        starts,
        np.concatenate([each.members for each in lamps]),
        np.stack([each.cones for each in lamps]),
        np.stack([each.light_buffers for each in lamps]),
    )
