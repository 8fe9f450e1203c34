"""Packs a scene into the arrays that the kernel reads, and reuses what has not changed since the last scene."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from itertools import count
from typing import Any

import numpy as np

from minirt.kernel.machine_code import functions
from minirt.kernel.scene_arrays import Group, SceneArrays
from minirt.rendering.culling.light_frustum import dense_cluster
from minirt.rendering.culling.planes import never_occludes
from minirt.rendering.culling.unseen_materials import effective, without_unseen
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
from minirt.rendering.packing.colours import colours_of
from minirt.rendering.packing.eye_medium import medium_at
from minirt.rendering.packing.features import DEPTH, SECONDARY, features
from minirt.rendering.packing.lights import emitting_lights, intensity, positions_and_intensities, spot_parameters
from minirt.rendering.packing.materials import pack_environment, pack_materials
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.rendering.packing.single_precision import in_single
from minirt.scene import ParallelLight, Scene
from minirt.shapes import Shape


class Packing:
    """Packs scene after scene, in "double" precision or, where a scene allows it, in "single".

    With `minirt.kernel.interpreted` as the kernel it does without compiled functions.
    """

    def __init__(self, kernel: Any = functions, precision: str = "double", depth: int = DEPTH) -> None:
        self.kernel = kernel
        self.precision = precision
        self.depth = depth  # bounces at most
        self.shape_arrays = ShapeArrays()
        self.cache: dict[Hashable, Any] = {}  # results for the last scene, by what they depend on beside its shapes
        self.last: tuple[Scene, int, int, SceneArrays] | None = None

    def shape_arrays_for(self, shapes: tuple[Shape, ...]) -> ShapeArrays:
        """Return the arrays of these shapes. Where the last scene had other shapes its results are dropped."""
        if self.shape_arrays.update(shapes):
            self.cache, self.last = {}, None
        return self.shape_arrays

    def pack(self, scene: Scene, width: int, height: int) -> SceneArrays:
        """Return the arrays of a scene for a picture of that size."""
        if self.last and self.last[0] is scene and self.last[1:3] == (width, height):
            return self.last[3]
        arrays = self.pack_double(scene, width, height)
        if self.precision == "single" and fits_single(arrays):
            arrays = in_single(arrays, self.shape_arrays.boxes)
        self.last = scene, width, height, arrays
        return arrays

    def pack_double(self, scene: Scene, width: int, height: int) -> SceneArrays:
        """Return the arrays in double precision, packed again even if the scene is the last one."""
        shapes = self.shape_arrays_for(scene.shapes)
        before, self.cache = self.cache, {}

        def cached(key: Hashable, compute: Callable[..., Any], *arguments: Any) -> Any:
            self.cache[key] = before[key] if key in before else compute(*arguments)
            return self.cache[key]

        used = features(scene) - (set() if self.depth else SECONDARY)
        camera, sources = camera_numbers(scene.camera, width, height), emitting_lights(scene)
        colours = colours_of(scene.camera)
        lights = positions_and_intensities(sources, colours)
        eye = cached((camera.tobytes(), width, height), seen_by_eye, self.kernel, shapes, camera, width, height)
        cells, dense = light_buffer_cells(shapes), cached("cluster", dense_cluster, shapes)
        binned: list[BinnedShapes] = []
        keys: list[Hashable] = []
        for light, position in zip(sources, lights[:, :3], strict=True):
            skipped = never_occludes(shapes, camera[:3], light)
            if isinstance(light, ParallelLight):
                keys.append(("parallel", skipped.tobytes()))
                binned.append(cached(keys[-1], seen_by_parallel_light, shapes, cells, skipped))
            else:
                keys.append((position.tobytes(), skipped.tobytes()))
                binned.append(cached(keys[-1], seen_by_light, self.kernel, shapes, dense, position, cells, skipped))
        light_starts, light_shapes, light_cones, light_buffers = cached(tuple(keys), joined_light_buffers, binned, eye)
        materials = cached(
            ("materials", used, colours.decodes, colours.gain if "glow" in used else 1.0),
            pack_materials,
            scene,
            shapes.owner,
            used,
        )
        materials = without_unseen(materials, cached(("effective", used), effective, materials), eye.members)
        needs_bvh = "reflective" in used or ("parallel" in used and cells > 1)
        paint: Any = scene.background and scene.background.paint
        return SceneArrays(
            camera=pixel_rays(camera, width, height),
            ambient=intensity(scene.ambient, colours) if scene.ambient else np.zeros(3),
            lights=lights,
            colours_and_extents=cached(
                ("colours", colours.decodes), colours.surface_colours, shapes.colours_and_extents
            ),
            slots=shapes.slots,
            tile_shapes=eye.members,
            cones=eye.cones,
            light_buffer_cells=cells,
            light_buffers=light_buffers,
            light_shapes=light_shapes,
            light_cones=light_cones,
            groups=tuple(map(Group, shapes.rows, eye.starts, light_starts, count())),
            spots=spot_parameters(sources) if "spots" in used else None,
            eye_medium=medium_at(camera[:3], scene.shapes, colours) if "media" in used else None,
            depth=self.depth,
            background=colours.light(paint) if "background" in used else None,
            environment=cached(("environment", paint, colours), pack_environment, scene, paint)
            if "environment" in used
            else None,
            bvh=cached("bvh", build_bvh, shapes, self.kernel) if needs_bvh else None,
            **materials._asdict(),
        )

    @property
    def notes(self) -> list[str]:
        """Sentences about the decisions made for the last scene."""
        if not self.last:
            return []
        scene, _, _, arrays = self.last
        sentences = list(notes(scene, self.shape_arrays, arrays))
        if self.precision == "single" and not fits_single(arrays):
            sentences.insert(0, "double precision: single supports neither images nor a BVH")
        return sentences


def fits_single(arrays: SceneArrays) -> bool:
    """Whether float32 will do: a BVH consists of float64, and float32 cannot count the pixels of a large picture."""
    return (
        arrays.bvh is None
        and arrays.environment is None
        and (arrays.surface_maps is None or not len(arrays.surface_maps.pictures))
    )


def joined_light_buffers(
    lights: list[BinnedShapes], eye: BinnedShapes
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Join the bins of m lights: starts (kinds, m, cells + 1), members, cones (m, n, 5), light buffers (m, 11)."""
    if len(lights) == 1:
        return lights[0].starts[:, None], lights[0].members, lights[0].cones[None], lights[0].light_buffer[None]
    if not lights:
        return (
            np.zeros((len(eye.starts), 0, 1), np.int64),
            eye.members[:0],
            np.zeros((0, *eye.cones.shape)),
            np.zeros((0, 11)),
        )
    offsets = np.cumsum([0, *(len(each.members) for each in lights[:-1])])
    starts = np.stack([each.starts + offset for each, offset in zip(lights, offsets, strict=True)], axis=1)
    return (
        starts,
        np.concatenate([each.members for each in lights]),
        np.stack([each.cones for each in lights]),
        np.stack([each.light_buffer for each in lights]),
    )
