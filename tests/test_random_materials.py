"""Random scenes of all shapes, lights and materials equal the reference renderer.

Each scene has all kinds of shapes and all features, so that all share one kernel. The tests try a few of them;

    python -m tests.test_random_materials 200

tries as many as it is told.
"""

from __future__ import annotations

import sys

import numpy as np

import minirt
from minirt.shapes.shape import Oriented
from tests.compare import off
from tests.paths import SCENES
from tests.reference import render, to_bytes

SIZE = 48, 30


def colour_of(random: np.random.Generator) -> tuple[int, int, int]:
    """Return a random colour."""
    red, green, blue = random.integers(30, 256, 3)
    return int(red), int(green), int(blue)


def material_scene(seed: int) -> minirt.Scene:
    """Make the scene of a seed."""
    random = np.random.default_rng(seed)

    def point(spread: float = 4) -> tuple[float, ...]:
        return tuple(spread * random.normal(size=3))

    def direction() -> tuple[float, ...]:
        v = random.normal(size=3)
        return tuple(v / np.linalg.norm(v))

    def colour() -> tuple[int, ...]:
        return tuple(random.integers(30, 256, 3))

    def size() -> float:
        return float(np.exp(0.5 * random.normal() + 0.5))

    shapes: list[minirt.Shape] = [
        minirt.Plane((0, -9, 0), (0, 1, 0), colour()),
        minirt.Sphere(point(), size(), colour()),
        minirt.Sphere(point(), 2 * size(), colour()),
        minirt.Cylinder(point(), direction(), size(), 2 * size(), colour()),
        minirt.Cone(point(), direction(), size(), 2 * size(), colour()),
        minirt.Paraboloid(point(), direction(), size(), size(), colour()),
        minirt.Hyperboloid(point(), direction(), 0.8, 0.8 + size(), 2 * size(), colour()),
        minirt.Torus(point(), direction(), 2 + size(), 1.2, colour()),
        minirt.Box(point(), direction(), (size(), size(), size()), colour()),
        minirt.Square(point(), direction(), 2 * size(), colour()),
        minirt.Disc(point(), direction(), 2 * size(), colour()),
        minirt.Triangle(point(), point(), point(), colour()),
    ]
    materials = [
        {"specular": minirt.Specular(random.random(), 1 + 40 * random.random(), blinn=random.random() < 0.5)},
        {"mirror": random.random()},
        {"glass": minirt.Glass(1 + random.random(), random.random())},
        {"checker": minirt.Checker(random.uniform(0.1, 0.5), colour())},
        {"texture": "textures/planet.png"},
        {"bump": minirt.Bump("textures/water-height.png", random.uniform(-0.05, 0.05))},
        {"normal_map": "textures/bricks-normal.png"},
    ]
    # Each material is on at least one shape, and every shape has about two.
    owners = random.permutation(len(shapes))[: len(materials)]
    with_materials = [
        shape.replace(
            **{
                name: value
                for number, material in enumerate(materials)
                for name, value in material.items()
                if owners[number] == index or random.random() < 0.15
            }
        )
        for index, shape in enumerate(shapes)
    ]
    own = np.random.default_rng([seed, 1])
    with_patterns = int(own.integers(len(shapes)))
    with_materials[with_patterns] = with_materials[with_patterns].replace(
        marble=minirt.Marble(own.uniform(0.5, 3), colour_of(own), height=own.uniform(-0.1, 0.1)),
        wood=minirt.Wood(own.uniform(0.2, 1), colour_of(own), 4),
    )
    with_materials[0] = with_materials[0].replace(clouds=minirt.Clouds(own.uniform(1, 5), colour_of(own)))
    ellipsoid = minirt.Ellipsoid(
        tuple(4 * own.normal(size=3)), (0, 1, 0), tuple(np.exp(own.normal(size=3))), tuple(own.integers(30, 256, 3))
    )
    with_materials.append(ellipsoid.replace(**materials[own.integers(len(materials))]))
    with_materials = [oriented(shape, own) for shape in with_materials]
    glass = [shape for shape in with_materials if shape.glass]
    for shape in glass:  # tinted, and with Fresnel reflection, both of all strengths
        changed = shape.replace(
            tint=minirt.Tint(tuple(own.integers(0, 256, 3)), float(np.exp(own.normal()))),
            fresnel=float(own.choice([0, 1, own.random()])),
            glass=shape.glass.replace(fade=float(own.choice([0, 0, 30]))) if shape.glass else None,
        )
        with_materials[with_materials.index(shape)] = changed
    which = own.integers(12)
    with_materials[which] = with_materials[which].replace(
        glow=own.random(), mirror=minirt.Mirror(0.3, 12.0), fresnel=1.0
    )
    eye = np.array(point(9))
    lights: list[minirt.Element] = [
        minirt.Light(point(7), 0.4, colour()),
        minirt.FurtherLight(point(7), 0.5, colour(), fade=30.0),
        minirt.ParallelLight(direction(), 0.3, colour()),
        minirt.SpotLight(tuple(eye), tuple(-eye / np.linalg.norm(eye)), 60, 0.6, colour(), rim=random.random()),
    ]
    camera = minirt.Camera.look_at(tuple(eye), (0, 0, 0), fov=60, roll=30 * random.random())
    return minirt.Scene(
        [minirt.Ambient(0.2, colour()), camera, minirt.Background("textures/evening.png"), *lights, *with_materials],
        SCENES / "x.rt",
    )


def oriented(shape: minirt.Shape, random: np.random.Generator) -> minirt.Shape:
    """Turn a shape about its own axis, half of the spheres about another one, and half of the pictures on shapes."""
    if random.random() < 0.5:
        scale = np.exp(0.5 * random.normal(size=2))  # finer pictures show how bumpy glass amplifies rounding
        shape = shape.replace(uv=minirt.Placement(*scale, *random.normal(size=2), random.uniform(-360, 360)))
    if isinstance(shape, minirt.Sphere) and random.random() < 0.5:
        shape = shape.replace(axis=tuple(random.uniform(-1, 1, 3)))
    return shape.replace(roll=random.uniform(-360, 360)) if isinstance(shape, Oriented) else shape


def check(seeds: range) -> None:
    """Assert that the pictures of these seeds are those of the reference, but for a few pixels at edges."""
    wrong = total = 0
    for seed in seeds:
        scene = material_scene(seed)
        bad = off(minirt.render(scene, *SIZE).array, to_bytes(render(scene, *SIZE)))
        assert bad.mean() < 0.003, f"seed {seed}"
        wrong, total = wrong + bad.sum(), total + bad.size
    assert wrong < 3e-4 * total


def test_random_scenes_with_all_features_equal_the_reference() -> None:
    check(range(8))


if __name__ == "__main__":
    check(range(int(sys.argv[1])))
