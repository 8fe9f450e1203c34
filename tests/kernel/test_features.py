"""All features in one scene: the compiled kernel renders the picture that the interpreted kernel renders."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image as pillow  # noqa: N813

from minirt.materials import Bump, Checker, Glass, Mirror, Specular, Tint
from minirt.scene import Background, FurtherLight, Light, ParallelLight, Scene, SpotLight
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from tests.kernel.pictures import AMBIENT, BLUE, EYE, GREEN, ONE, RED, WHITE, interpreted, picture


@pytest.fixture
def scene(tmp_path: Path) -> Scene:
    """A scene with every feature, and enough shapes for light buffers."""
    random = np.random.default_rng(1)
    for name in ("colours.png", "heights.png", "sky.png"):
        pillow.fromarray(random.integers(0, 256, (8, 16, 3), np.uint8)).save(tmp_path / name)
    normals = np.concatenate([random.integers(90, 166, (8, 8, 2)), np.full((8, 8, 1), 240)], axis=-1).astype(np.uint8)
    pillow.fromarray(normals).save(tmp_path / "normals.png")
    items = (
        AMBIENT,
        EYE,
        Background("sky.png"),
        Light((-4, 6, -5), 0.5),
        FurtherLight((5, 3, -2), 0.6, (120, 160, 255), fade=12.0),
        ParallelLight((0.3, -0.9, 0.2), 0.3),
        SpotLight((0, 7, -3), (0, -1, 0.3), 50, 0.8, rim=0.4),
        Plane((0, -1, 0), (0, 1, 0), WHITE, checker=Checker(0.7, (90, 60, 60)), mirror=0.2),
        Sphere((-1.5, 0.2, 0), 2.4, RED, specular=Specular(0.6, 30)),
        Sphere(
            (1, 0, -3),
            1.5,
            WHITE,
            glass=Glass(1.5, 0.8, 20.0),
            tint=Tint((250, 200, 120)),
            fresnel=1.0,
            specular=Specular(0.6, 90, blinn=True),
        ),
        Cylinder((1.5, 0.3, 1.5), (0.3, 0.9, -0.2), 1.6, 2.5, GREEN, texture="colours.png"),
        Sphere((0.3, 1.6, 0), 1.2, BLUE, bump=Bump("heights.png", 0.1), mirror=Mirror(0.3, 9.0), glow=0.1),
        Sphere((3, 0.5, -1), 1.4, WHITE, normal_map="normals.png", checker=Checker(0.125)),
        *(Sphere((-4 + i, -0.7, -2 - i % 2), 0.6, (200, 40 * i, 90)) for i in range(6)),
    )
    return Scene(items, tmp_path / "scene.rt")


def test_compiled_and_interpreted_pictures_are_the_same(scene: Scene) -> None:
    pixels, light = picture(scene, 32, 20, renderer=ONE)
    interpreted_pixels, expected = interpreted(scene, 32, 20)
    # Rounding may send a ray to the other side of an edge, and curved mirrors and glass magnify it.
    different = np.abs(light - expected).max(axis=-1) > 1e-9
    assert different.mean() < 0.01
    assert (np.abs(pixels.astype(int) - interpreted_pixels)[~different] <= 1).all()
    assert len(np.unique(pixels.reshape(-1, 4), axis=0)) > 400


@pytest.mark.parametrize(
    ("element_type", "change"),
    [
        (Background, {"paint": (0, 0, 0)}),
        (FurtherLight, {"fade": None}),
        (ParallelLight, {"brightness": 0.0}),
        (SpotLight, {"angle": 20.0}),
        (Plane, {"checker": None}),
        (Plane, {"mirror": None}),
        (Sphere, {"specular": None}),
        (Cylinder, {"texture": None}),
    ],
)
def test_each_feature_changes_the_picture(scene: Scene, element_type: type, change: dict[str, object]) -> None:
    element = next(each for each in scene.elements if type(each) is element_type)
    without = scene.replace(element, **change)
    assert (interpreted(scene, 16, 10)[1] != interpreted(without, 16, 10)[1]).any(axis=-1).mean() > 0.02
