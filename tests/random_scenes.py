"""Random scenes: intersecting shapes of many sizes, cameras and lights anywhere, also inside shapes."""

from __future__ import annotations

import numpy as np

from minirt.element import Element
from minirt.scene import Ambient, Camera, FurtherLight, Light, Scene
from minirt.shapes import Cylinder, Plane, Shape, Sphere

AXES = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (-1, 0, 0), (0, -1, 0), (0, 0, -1)]


def random_scene(seed: int) -> Scene:
    """Make the scene of a seed."""
    random = np.random.default_rng(seed)
    offset = random.choice([0, 0, 0, 1e3, 1e5]) * random.normal(size=3)

    def point(spread: float) -> tuple[float, ...]:
        return tuple(offset + spread * random.normal(size=3))

    def direction() -> tuple[float, ...]:
        v = random.normal(size=3)
        return AXES[random.integers(6)] if random.random() < 0.3 else tuple(v / np.abs(v).max())

    def colour() -> tuple[int, ...]:
        return tuple(random.integers(30, 256, 3))

    def size() -> float:
        return float(np.exp(random.normal()))

    def shape() -> Shape:
        kind = random.choice(["sphere", "sphere", "cylinder", "cylinder", "plane"])
        if kind == "plane":
            return Plane(point(6), direction(), colour())
        if kind == "sphere":
            return Sphere(point(3), 2 * size(), colour())
        return Cylinder(point(3), direction(), size(), 3 * size(), colour())

    shapes = [shape() for _ in range(random.choice([1, 2, 4, 8, 12, 40]))]
    lights: list[Element] = [
        FurtherLight(point(5), random.uniform(0.2, 0.8), colour()) for _ in range(random.integers(3))
    ]
    target = random.choice(shapes)
    centre = target.point if isinstance(target, Plane) else target.centre
    near_centre = tuple(np.array(centre) + 0.05 * random.normal(size=3))
    eye = near_centre if random.random() < 0.25 else point(7)
    light = near_centre if random.random() < 0.25 else point(6)
    towards = np.array(centre) - eye
    look = direction() if random.random() < 0.4 else tuple(towards / np.abs(towards).max())
    roll = float(random.choice([0, 0, random.uniform(-360, 360)]))
    camera = Camera(eye, look, random.uniform(20, 140), roll=roll)
    enclosure = [Sphere(eye, 60, colour())] if random.random() < 0.3 else []  # so that every ray hits something
    return Scene([Ambient(0.2, colour()), camera, Light(light, 0.7, colour()), *lights, *shapes, *enclosure])
