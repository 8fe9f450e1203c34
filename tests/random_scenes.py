"""Random scenes: eyes and lamps anywhere, also inside of things, and things of many sizes through each other."""

from __future__ import annotations

import numpy as np

from minirt.element import Element
from minirt.scene import Ambient, Camera, FurtherLight, Light, Scene
from minirt.shapes import Shape
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere

AXES = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (-1, 0, 0), (0, -1, 0), (0, 0, -1)]


def random_scene(seed: int) -> Scene:
    """The scene of that number."""
    random = np.random.default_rng(seed)
    offset = random.choice([0, 0, 0, 1e3, 1e5]) * random.normal(size=3)

    def place(spread: float) -> tuple[float, ...]:
        return tuple(offset + spread * random.normal(size=3))

    def way() -> tuple[float, ...]:
        v = random.normal(size=3)
        return AXES[random.integers(6)] if random.random() < 0.3 else tuple(v / np.abs(v).max())

    def colour() -> tuple[int, ...]:
        return tuple(random.integers(30, 256, 3))

    def size() -> float:
        return float(np.exp(random.normal()))

    def shape() -> Shape:
        kind = random.choice(["sphere", "sphere", "cylinder", "cylinder", "plane"])
        if kind == "plane":
            return Plane(place(6), way(), colour())
        if kind == "sphere":
            return Sphere(place(3), 2 * size(), colour())
        return Cylinder(place(3), way(), size(), 3 * size(), colour())

    shapes = [shape() for _ in range(random.choice([1, 2, 4, 8, 12, 40]))]
    lamps: list[Element] = [
        FurtherLight(place(5), random.uniform(0.2, 0.8), colour()) for _ in range(random.integers(3))
    ]
    inside = random.choice(shapes)
    middle = inside.point if isinstance(inside, Plane) else inside.centre
    near_middle = tuple(np.array(middle) + 0.05 * random.normal(size=3))
    eye = near_middle if random.random() < 0.25 else place(7)
    lamp = near_middle if random.random() < 0.25 else place(6)
    towards = np.array(middle) - eye
    look = way() if random.random() < 0.4 else tuple(towards / np.abs(towards).max())
    roll = float(random.choice([0, 0, random.uniform(-360, 360)]))
    camera = Camera(eye, look, random.uniform(20, 140), roll=roll)
    surround = [Sphere(eye, 60, colour())] if random.random() < 0.3 else []  # so that every ray hits something
    return Scene([Ambient(0.2, colour()), camera, Light(lamp, 0.7, colour()), *lamps, *shapes, *surround])
