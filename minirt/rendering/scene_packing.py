"""Packs a scene into the arrays that the kernel reads, and reuses what has not changed since the last scene."""

from __future__ import annotations

from collections.abc import Callable, Collection, Hashable, Sequence
from itertools import count, islice
from math import inf
from typing import Any

import numpy as np

from minirt.helpers.system import TooLargeError
from minirt.kernel import functions
from minirt.kernel.bvh_nodes import MARGIN, Tree
from minirt.kernel.frame import tile_count
from minirt.kernel.pixels import TILE
from minirt.kernel.scene_arrays import Group, SceneArrays
from minirt.kernel.shading.lights import LightGrid
from minirt.rendering.notes import notes
from minirt.rendering.packing import camera, light_buffers, lights, materials, visibility
from minirt.rendering.packing.bvh import build_bvh
from minirt.rendering.packing.camera import Crop, Place
from minirt.rendering.packing.features import APERTURES, DEPTH, SECONDARY, SPREAD, features, fits_single
from minirt.rendering.packing.mesh_trees import pack_meshes
from minirt.rendering.packing.ray_casting import nearest_hits
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.rendering.packing.view import PackedScene, View, all_but_pose
from minirt.rendering.packing.visibility import BinnedShapes, Bins, Run
from minirt.scene import Lamp, Scene
from minirt.shapes import Mesh, Shape

FEW = 4  # lights whose bins are used again
IN_DOUBLE = "double precision: single supports neither images nor a BVH, as mirrors and glass need"
TILES, LIGHT_BUFFERS, BOXES, BVH = "tiles", "light buffers", "boxes", "BVH"


class Packing:
    """Packs scene after scene, in "double" precision or, where a scene allows it, in "single".

    With `minirt.kernel.interpreted` as the kernel it does without compiled functions. `without` names what does not
    cull: without `TILES` each tile has all shapes, and precision is double; without `LIGHT_BUFFERS` each light has one
    cell with all shapes; without `BOXES` each ray visits all of the BVH. Without `BVH` there is none.
    """

    def __init__(
        self,
        kernel: Any = functions,
        precision: str = "double",
        depth: int = DEPTH,
        without: Collection[str] = (),
        run: Run | None = None,
    ) -> None:
        """`run` runs a job on all threads; without it the caller's thread packs."""
        self.kernel, self.without, self.run = kernel, without, run
        self.precision = precision
        self.depth = depth  # bounces at most
        self.shape_arrays = ShapeArrays()
        self.cache: dict[Hashable, Any] = {}  # results for the last scene, by what they depend on beside its shapes
        self.cells_that_fit: dict[int, int] = {}  # by the number of lights, where the usual cells do not fit
        self.bvh: Tree | None = None  # of the last shapes, once it was needed
        self.last: PackedScene | None = None
        self.view: View | None = None  # of the last scene
        self.samples: object = None  # as of `features`, for which the last scene was packed
        self.spare: dict[int, Bins] = {}  # of the first lights, after a change of shapes

    def shape_arrays_for(self, *runs: Sequence[Shape]) -> ShapeArrays:
        """Return the arrays of these shapes, run by run. Where the last scene had others its results are dropped."""
        if self.shape_arrays.update(*runs):
            bins = (each.bins for each in self.cache.values() if isinstance(each, BinnedShapes))
            self.spare = dict(enumerate(islice((each for each in bins if each), FEW)))
            kept = {key: each for key, each in self.cache.items() if isinstance(each, LightGrid)}
            self.cache, self.last, self.cells_that_fit, self.bvh = kept, None, {}, None
        return self.shape_arrays

    def bvh_of(self, *runs: Sequence[Shape]) -> Tree:
        """Return the BVH over the shapes of some runs, which is kept until other ones are packed."""
        arrays = self.shape_arrays_for(*runs)
        if not self.bvh:
            margin = inf if BOXES in self.without else MARGIN
            meshes = self.cache.get("meshes") or pack_meshes(arrays, self.kernel, self.run)
            self.bvh = build_bvh(arrays, self.kernel, margin, self.run, meshes)
        return self.bvh

    def pack(
        self, scene: Scene, width: int, height: int, crop: Crop | None = None, samples: object = None
    ) -> SceneArrays:
        """Return the arrays of a scene for a picture of that size, or for a rectangle of that size of a larger one at
        `crop`. `samples` are those of `features`.

        The next call may overwrite them: where nothing but the camera moves it returns the same arrays.
        """
        place = width, height, crop or Crop(width, height)
        self.shape_arrays_for(*scene.runs)
        last, self.last = self.last, None  # after an error there is no last scene
        changes_apertures = (samples == 1) != (self.samples == 1) and not APERTURES.isdisjoint(features(scene))
        self.samples = samples
        is_alike = last and last.place == place and not changes_apertures
        can_stay = last and is_alike and self.follows(scene, last.scene, last.arrays)
        arrays = last.arrays if last and can_stay else self.pack_anew(scene, place)
        self.last = PackedScene(scene, place, arrays)
        return arrays

    def follows(self, scene: Scene, last: Scene, arrays: SceneArrays) -> bool:
        """Whether the arrays of the last scene are those of this one, or now follow its camera: they are written."""
        if scene is last:
            return True
        if not self.view or arrays.lens is not None or all_but_pose(scene) != all_but_pose(last):
            return False
        if arrays.eye_medium is not None:
            arrays.eye_medium[:] = materials.medium_at(scene.camera, self.cache["tinted"])
        return self.view.follow(scene.camera, self.run)

    def pack_anew(self, scene: Scene, place: Place) -> SceneArrays:
        """Return arrays that are made anew, except what the scene shares with the last one: `cache` is renewed.

        TooLargeError where even the coarsest light buffers have no room.
        """
        width, height, crop = place
        shapes = self.shape_arrays_for(*scene.runs)
        before, self.cache = self.cache, {}

        def cached(key: Hashable, compute: Callable[..., Any], *arguments: Any) -> Any:
            self.cache[key] = before[key] if key in before else compute(*arguments)
            return self.cache[key]

        numbers, sources = camera.camera_numbers(scene.camera, crop.width, crop.height), lights.emitting_lights(scene)
        used = features(scene, self.samples) - (set() if self.depth else SECONDARY)
        colours = lights.colours_of(scene.camera)
        if "soft" not in used:
            sources = [each.replace(size=None) if each.size else each for each in sources]
        lens = self.lens_of(scene, numbers, cached) if "lens" in used else None
        radius, _ = camera.radius_and_focus(lens)
        cells, binned, keys = self.light_buffers_that_fit(sources, numbers[:3], cached, radius)
        light_starts, lists_of_lights = cached(keys, light_buffers.joined_light_buffers, binned, shapes)
        # How files spell colours matters to all materials, the exposure only to what glows.
        materials_key = "materials", used, colours.decodes, colours.gain if "glow" in used else 1.0
        packed = cached(materials_key, materials.pack_materials, scene, shapes, used)
        if TILES in self.without:  # `square`: pixels along the edge of the squares of the picture that have lists
            square, in_tiles = TILE, visibility.in_all_cells(shapes, tile_count(width) * tile_count(height))
        else:
            self.view = View(self.kernel, shapes, scene.camera, place, lens, self.precision, self.view)
            square, in_tiles = self.view.square, self.view.look(scene.camera, self.run)
        spots = lights.spot_parameters(sources) if "spots" in used else None
        emitted = lights.positions_and_intensities(sources, colours)
        grid_key = "light grid", emitted.tobytes(), spots is None or spots.tobytes()
        needs_bvh = "reflective" in used or (len(shapes.slots) > light_buffers.SMALL and not SPREAD.isdisjoint(used))
        meshes = cached("meshes", pack_meshes, shapes, self.kernel, self.run)
        trees, triangles = ([part if kind is Mesh else None for kind in shapes.group_numbers] for part in meshes)
        tinted = cached("tinted", materials.tinted, shapes) if "media" in used else []
        paint: Any = scene.background and scene.background.paint
        sky_key, colours_key = ("environment", paint, colours), ("colours", colours.decodes)
        arrays = SceneArrays(
            camera=np.append(camera.pixel_rays(scene.camera, crop.width, crop.height), (crop.left, crop.top)),
            ambient=colours.light(scene.ambient.colour, scene.ambient.brightness) if scene.ambient else np.zeros(3),
            lights=emitted,
            colours_and_extents=cached(colours_key, colours.surface_colours, shapes.colours_and_extents),
            slots=shapes.slots,
            listed=shapes.listed,
            tile_shapes=in_tiles.members,
            cones=in_tiles.cones,
            square=square,
            light_buffer_cells=cells,
            **lists_of_lights,
            groups=tuple(map(Group, shapes.tables, in_tiles.starts, light_starts, count(), trees, triangles)),
            spots=spots,
            light_grid=cached(grid_key, lights.light_grid, emitted, spots),
            soft=lights.light_sizes(sources) if "soft" in used else None,
            lens=lens,
            eye_medium=materials.medium_at(scene.camera, tinted) if "media" in used else None,
            smooth=cached("smooth", shapes.smooth) if "smooth" in used else None,
            depth=self.depth,
            background=colours.light(paint) if "background" in used else None,
            environment=cached(sky_key, materials.pack_environment, scene, paint) if "environment" in used else None,
            bvh=self.bvh_of(*scene.runs) if needs_bvh and BVH not in self.without else None,
            **packed,
        )
        is_single = self.precision == "single" and fits_single(arrays)
        return self.view.complete(arrays, is_single) if self.view else arrays

    def lens_of(self, scene: Scene, numbers: np.ndarray, cached: Callable[..., Any]) -> np.ndarray:
        """Return the numbers of the lens, whose focus is what the middle of the picture shows unless the camera has
        one. `numbers` are its `camera_numbers`; `cached` keeps what is computed."""
        if not (focus := scene.camera.focus):
            key = "middle", numbers.tobytes()
            focus, _ = cached(key, nearest_hits, self.shape_arrays, *camera.middle_ray(numbers))
        return camera.lens_numbers(scene.camera, float(focus))

    def light_buffers_that_fit(
        self, sources: list[Lamp], eye: np.ndarray, cached: Callable[..., Any], radius: float
    ) -> tuple[int, Any, Any]:
        """Return the cells along an edge of the lights' cubes, and the two results of `seen_by_lights` for so many.

        There are as many as usual, or half as many, a quarter and so on, until the lists have room in memory;
        TooLargeError where the coarsest ones have none. `eye` (3,) is the camera's position, `radius` that of its lens,
        and `cached` keeps what is computed for a light.
        """
        usual_cells = self.cells_that_fit.get(len(sources), light_buffers.light_buffer_cells(self.shape_arrays))
        cells = 1 if LIGHT_BUFFERS in self.without else usual_cells
        while True:
            try:
                return cells, *self.seen_by_lights(sources, eye, cells, cached, radius)
            except TooLargeError:
                if cells <= light_buffers.COARSEST:
                    raise
                cells //= 2
                self.cells_that_fit[len(sources)] = cells

    def seen_by_lights(
        self, sources: list[Lamp], eye: np.ndarray, cells: int, cached: Callable[..., Any], radius: float
    ) -> tuple[list[BinnedShapes], Hashable]:
        """Return the shapes that each light sees, in light buffers of so many cells an edge, and a key of these lists.

        The other arguments are those of `light_buffers_that_fit`. `TooLargeError` where there is no room for the lists.
        """
        if LIGHT_BUFFERS in self.without:
            return [visibility.in_all_cells(self.shape_arrays, 1)] * len(sources), len(sources)
        shapes = self.shape_arrays
        copies = 2 * len(sources) if len(sources) > 1 else 1  # of lists: each light's, and all of them joined
        has_meshes = Mesh in shapes.group_numbers  # from whose facets rays may be moved out of reach
        has_cones = light_buffers.has_cones(len(sources), len(shapes.listed))
        binned: list[BinnedShapes] = []
        keys: list[Hashable] = []
        for light in sources:
            skipped = lights.never_occludes(shapes, eye, light, radius)
            if not light.position or (light.size and cells > 1):  # the kernel traverses the BVH
                keys.append(("spread", cells, skipped.tobytes(), has_cones))
                binned.append(cached(keys[-1], light_buffers.seen_by_parallel_light, shapes, cells, skipped))
            else:
                position, size = lights.light_position(light), lights.radius_of(light)
                reach = light.fade if light.fade and not has_meshes else np.inf
                keys.append((cells, position.tobytes(), skipped.tobytes(), size, reach, has_cones))
                alike = 1 if binned else copies  # lists in memory: those of the first light stand for all
                at = position, cells, skipped, size, reach, alike, self.run, self.spare.pop(len(binned), None)
                binned.append(cached(keys[-1], light_buffers.seen_by_light, self.kernel, shapes, *at))
            if len(binned) > FEW:  # scratch memory, of twice the size of the lists
                cones = binned[-1].cones if has_cones else light_buffers.NO_CONES
                self.cache[keys[-1]] = binned[-1] = binned[-1]._replace(bins=None, cones=cones)
        self.spare = {}
        return binned, tuple(keys)

    @property
    def notes(self) -> list[str]:
        """Sentences that say what was chosen for the last scene, and what it leaves out."""
        return list(notes(self.last.scene, self.shape_arrays, self.last.arrays)) if self.last else []

    @property
    def computed_in(self) -> str:
        """The precision of the last scene, and why it is double where single was asked for."""
        is_other = self.precision == "single" and self.last is not None and not fits_single(self.last.arrays)
        return IN_DOUBLE if is_other else f"{self.precision} precision"
