"""Planes behind planes are left out of the lists of a crowd, and no picture changes by that."""

from __future__ import annotations

import numpy as np
import pytest

import minirt
from minirt.rendering.culling import hidden_planes, planes
from minirt.rendering.renderer import Renderer
from minirt.rendering.scene_packing import Packing

WIDTH, HEIGHT = 96, 64
HEAD = "A 0.2 255,255,255\nC 1,2,-3 0.2,0.1,1 80\nL 4,2,-1 0.6 255,255,255\n"


def scene_of(seed: int, planes: int, glass: bool = False, lights: str = "") -> minirt.Scene:
    """Return a scene of planes that are tangential to balls around a point near the eye, some twice or nearly so."""
    rng = np.random.default_rng(seed)
    normals = rng.normal(size=(planes, 3))
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    lines = []
    for i, (normal, far) in enumerate(zip(normals, rng.uniform(6, 60, planes), strict=True)):
        look = " glass:1.2,0.5" if glass and i % 3 == 0 else ""
        near = far * (1 + 1e-9) if i % 5 == 0 else far * 1.0003
        for colour, distance in ((i % 256, far), (255 - i % 256, near)):
            point, axis = (",".join(f"{x:.12f}" for x in each) for each in (normal * distance, normal))
            lines.append(f"pl {point} {axis} {colour},90,200{look}\n")
    lines += [f"sp {x:.3f},{y:.3f},{z:.3f} 0.7 255,255,255\n" for x, y, z in rng.uniform(-5, 5, (12, 3))]
    return minirt.loads(HEAD + lights + "".join(lines))


def light_of(scene: minirt.Scene) -> np.ndarray:
    """Return the light of a picture of a scene, packed anew."""
    light = np.zeros((HEIGHT, WIDTH, 3))
    assert Renderer(threads=1).render(scene, np.empty((HEIGHT, WIDTH, 4), np.uint8), 2, light)
    return light


def members(scene: minirt.Scene) -> tuple[int, int]:
    """Return the lengths of the lists of tiles and of light buffers."""
    arrays = Packing().pack(scene, WIDTH, HEIGHT)
    return len(arrays.tile_shapes), len(arrays.light_shapes)


def cull_all(monkeypatch: pytest.MonkeyPatch) -> None:
    """Cull planes however few they are, for each cell by itself."""
    monkeypatch.setattr(planes, "CROWD", 0)
    for name, value in (("SMALL_BLOCK", 0), ("BLOCKS", 256)):
        monkeypatch.setattr(hidden_planes, name, value)


@pytest.mark.parametrize(
    "scene",
    [
        scene_of(1, 150),
        scene_of(2, 16, lights="l -30,50,90 0.5 255,200,100\nl 70,-3,2 0.4 100,255,255\n"),  # behind some planes
        scene_of(3, 20, glass=True, lights="l -9,5,6 0.5 255,200,100\n"),
        scene_of(4, 30, lights="l 9,5,-6 0.5 255,200,100 size:2\n"),
    ],
    ids=["plain", "lights", "glass", "soft"],
)
def test_the_picture_is_that_of_all_planes(scene: minirt.Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    expected = light_of(scene)
    cull_all(monkeypatch)
    assert np.array_equal(light_of(scene), expected)


def test_most_planes_are_hidden(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = scene_of(5, 150, lights="l 0,0,25 0.5 255,255,255\n")
    tiles, cells = members(scene)
    cull_all(monkeypatch)
    fewer_tiles, fewer_cells = members(scene)
    assert fewer_tiles < tiles / 10
    assert fewer_cells < cells / 2


@pytest.mark.parametrize(("name", "wrong"), [("COINCIDENT", 0.5), ("MARGIN", -0.3)])
def test_too_much_culling_is_found(name: str, wrong: float, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = scene_of(1, 150)
    expected = light_of(scene)
    cull_all(monkeypatch)
    monkeypatch.setattr(hidden_planes, name, wrong)
    assert not np.array_equal(light_of(scene), expected)


def test_planes_through_the_eye_hide_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    through_the_eye = "pl 1,2,-3 0.6,0.8,0 255,0,0\npl 1,2,-3 0,0,1 0,255,0\n"
    scene = minirt.loads(HEAD + through_the_eye + "pl 0,0,9 0,0,1 0,0,255\npl 0,0,-9 0,0,1 9,9,9\n")
    expected = light_of(scene)
    cull_all(monkeypatch)
    assert np.array_equal(light_of(scene), expected)
    assert expected.any()
