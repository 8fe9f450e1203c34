"""Small test scenes, and their pictures by the compiled and by the interpreted kernel."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from minirt.kernel import frame
from minirt.kernel import interpreted as interpreted_functions
from minirt.rendering.frame import ALL_PACKETS, NO_ERRORS, frame_rays, thread_memory
from minirt.rendering.packing.features import DEPTH
from minirt.rendering.renderer import Renderer
from minirt.rendering.scene_packing import Packing
from minirt.scene import Ambient, Camera, FurtherLight, Light, Scene
from minirt.shapes.box import Box
from minirt.shapes.cone import Cone
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.disc import Disc
from minirt.shapes.ellipsoid import Ellipsoid
from minirt.shapes.hyperboloid import Hyperboloid
from minirt.shapes.paraboloid import Paraboloid
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from minirt.shapes.square import Square
from minirt.shapes.torus import Torus
from minirt.shapes.triangle import Triangle

Array = NDArray[np.float64]

RED, GREEN, BLUE, WHITE = (255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 255)
EYE = Camera((1, 2, -9), (-0.1, -0.15, 1), 60)
AMBIENT = Ambient(0.15, (255, 230, 200))
LAMP = Light((-4, 6, -5), 0.6, (255, 240, 220))
SECOND = FurtherLight((5, 3, -2), 0.4, (120, 160, 255))
SHAPES = (
    Plane((0, -1, 0), (0, 1, 0), (200, 200, 210)),
    Sphere((-1.5, 0.2, 0), 2.4, (230, 60, 50)),
    Cylinder((1.5, 0.3, 0.5), (0.3, 0.9, -0.2), 1.6, 2.5, (70, 180, 80)),
    Sphere((0.3, -0.6, -2), 0.8, (60, 110, 235)),
    Plane((0, 0, 6), (0.1, 0.2, -1), (120, 140, 165)),
    Cylinder((-3, -0.5, -1), (1, 0, 0.4), 1, 1.5, (245, 180, 50)),
)
ALL = Scene((AMBIENT, EYE, LAMP, SECOND, *SHAPES))  # common kinds of shapes, two lights, shadows
MORE = (
    Cone((-3, 2.5, 1), (0.2, -1, 0.1), 1.4, 2.2, (200, 90, 200)),
    Paraboloid((3.6, 2.6, 1), (0.1, -0.9, 0.3), 1.4, 1.8, (90, 200, 200)),
    Hyperboloid((3, -0.2, -3), (0.2, 1, 0.1), 0.5, 1.1, 1.2, (200, 200, 90)),
    Triangle((-4, 0.5, 3), (-1, 3.5, 4), (0.5, 0.8, 2.5), (120, 200, 120)),
    Square((-3.2, 1.2, -2), (0.3, 0.5, -0.8), 0.9, (230, 140, 60)),
    Disc((0.8, 2.6, 1), (0.2, -0.4, -0.9), 1.6, (100, 140, 230)),
    Box((-0.8, -0.6, -3), (0.3, 0.9, 0.2), (0.6, 0.4, 0.9), (180, 180, 180)),
    Torus((2.2, 1.9, -2), (0.4, 0.6, -0.7), 1.2, 0.4, (220, 120, 160)),
    Ellipsoid((-2.4, 2.4, -2), (0.3, 0.9, 0.4), (1.2, 0.5, 0.8), (200, 160, 90)),
)
EVERY = Scene((AMBIENT, EYE, LAMP, SECOND, *SHAPES, *MORE))
ONE, TWO = Renderer(1), Renderer(2)


def linear(scene: Scene, width: int = 24, height: int = 16, samples: int = 1, renderer: Renderer = TWO) -> Array:
    """Render a scene by the compiled kernel, and return its linear light, (height, width, 3)."""
    return picture(scene, width, height, samples, renderer)[1]


def picture(
    scene: Scene, width: int = 24, height: int = 16, samples: int = 1, renderer: Renderer = TWO
) -> tuple[NDArray[np.uint8], Array]:
    """Render a scene by the compiled kernel: pixels (h, w, 4) in BGRA order, and linear light, finite for every ray."""
    pixels, light = np.full((height, width, 4), 77, np.uint8), np.full((height, width, 3), np.nan)
    assert renderer.render(scene, pixels, samples, light)
    assert renderer.not_finite == 0
    return pixels, light


def interpreted(
    scene: Scene, width: int = 24, height: int = 16, samples: int = 1, precision: str = "double", depth: int = DEPTH
) -> tuple[Any, Array]:
    """Render a scene by the interpreted kernel: pixels and linear light, as `picture` returns them."""
    words, light = np.zeros((height, width), np.uint32), np.full((height, width, 3), np.nan)
    traced = Packing(interpreted_functions, precision, depth).pack(scene, width, height)
    with np.errstate(all="ignore"):
        rays = frame_rays(traced, samples)
        memory = thread_memory(traced)
        frame.frame(np.zeros(1, np.int64), words, light, rays, ALL_PACKETS, NO_ERRORS, *memory, traced)
    return words.view(np.uint8).reshape(height, width, 4), light
