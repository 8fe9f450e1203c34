"""Precision of pictures: single while something moves, where that shows the same and takes less time; else double."""

from __future__ import annotations

from contextlib import suppress

from minirt.rendering.packing.features import FEATURES, features, fits_single
from minirt.rendering.renderer import Renderer
from minirt.scene import Scene

JUDGED = 16  # pictures of a movement after which its scene is judged again, which takes 1 to 5 ms
GROWTH = 1.1  # of a cost from one picture to the next, at most; single precision must be faster by as much
MOST_SHAPES = 12_000  # or triangles of meshes: judging more for the first time would delay a key by 40 ms or more


class MovingPrecision:
    """Chooses the renderer of each picture: that of the window, or one like it in single precision."""

    def __init__(self, renderer: Renderer) -> None:
        self.double = self.single = renderer
        if renderer.moves_in_single:
            self.single = Renderer(renderer.threads, "single", renderer.depth, renderer.dither)
        self.allowed = False  # whether the scene that was judged last looks the same in single precision
        self.pictures = 0  # of this movement
        self.costs = [0.0, 0.0]  # seconds per pixel of a movement's pictures, in double and in single

    def is_single(self, *, urgent: bool) -> bool:
        """Whether the next picture is single: never one that stays, nor the first of a movement, whose second, fourth,
        eighth, ... picture has the slower precision, to see whether it still is."""
        self.pictures = self.pictures + 1 if urgent else 0
        is_faster = GROWTH * self.costs[True] < self.costs[False]
        return self.allowed and self.pictures > 1 and is_faster != (self.pictures & (self.pictures - 1) == 0)

    def record(self, cost: float, *, single: bool) -> None:
        self.costs[single] = min(cost, GROWTH * self.costs[single] or cost)

    def judge(self, scene: Scene, width: int, height: int) -> None:
        """Find out whether single precision shows all of a scene, by a kernel that is there: see `lost_in_single`."""
        if self.single is self.double or self.pictures % JUDGED:
            return
        from minirt.rendering.queries.stiffness import lost_in_single

        few, packing = len(self.double.packing.shape_arrays.slots) <= MOST_SHAPES, self.single.packing
        self.allowed = False
        with suppress(Exception):  # of any kind: what is in the window is drawn in double
            known = all(FEATURES[each].single for each in FEATURES.keys() & features(scene, 1))
            known = few and known and self.single.is_ready(scene)
            if known and fits_single(packing.pack(scene, width, height, samples=1)):
                self.allowed = not any(lost_in_single(scene, packing, width, height))
