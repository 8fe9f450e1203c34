"""Explanations of pixels: the light of all rays is that of the picture, and its parts are those of known scenes."""

from __future__ import annotations

import json
from collections.abc import Iterator

import numpy as np
import pytest

import minirt
from minirt.rendering.queries.explanation import Explanation, TreeText
from minirt.rendering.queries.ray_tree import RayNode
from tests.random_scenes import random_scene
from tests.test_random_materials import material_scene

SIZE = 32, 24
WHITE = (255, 255, 255)
BALL = minirt.Sphere((0, 0, 5), 2, (200, 100, 50))
LAMP = minirt.Light((0, 3, 0), 0.5)
SIMPLE = minirt.Scene([minirt.Ambient(0.2, WHITE), minirt.Camera((0, 0, 0), (0, 0, 1), 60), LAMP, BALL])
MIDDLE = 33, 25, 16, 12  # size and pixel of a ray along the axis: it hits the ball at 0,0,4, and the lamp is 5 away


def rays_of(ray: RayNode) -> Iterator[RayNode]:
    """Yield a ray and all that it becomes."""
    yield ray
    for each in ray.rays:
        yield from rays_of(each)


def check_sums(explanation: Explanation) -> None:
    """Assert that the rays add up to the pixel, and the light of lamps to that of each surface."""
    rays = [*rays_of(explanation.ray)]
    assert np.allclose(np.sum([ray.light for ray in rays], axis=0), explanation.light, rtol=0, atol=1e-12)
    for at in (ray.surface for ray in rays if ray.surface):
        falling = np.sum([at.ambient, *(each.diffuse for each in at.lights)], axis=0)
        own = max(1.0 - at.mirror - at.glass, 0.0) * falling * at.colour
        highlights = np.sum([(0.0, 0.0, 0.0), *(each.highlight for each in at.lights)], axis=0)
        assert np.allclose(own + highlights + at.glow * np.array(at.colour), at.light, rtol=0, atol=1e-12)


def check_pixels(scene: minirt.Scene, seed: int, count: int) -> None:
    """Assert that the explanations of some pixels have their levels."""
    picture = minirt.render(scene, *SIZE)
    for x, y in np.random.default_rng(seed).integers(SIZE, size=(count, 2)).tolist():
        explanation = minirt.explain(scene, *SIZE, x, y)
        assert explanation.level == tuple(picture.array[y, x].tolist()), (seed, x, y)
        check_sums(explanation)


@pytest.mark.parametrize("seeds", [range(first, first + 50) for first in range(0, 200, 50)], ids=str)
def test_the_light_of_rays_is_that_of_the_pixel_in_random_scenes(seeds: range) -> None:
    for seed in seeds:
        check_pixels(random_scene(seed), seed, 3)


@pytest.mark.parametrize("seed", range(12))
def test_the_light_of_rays_is_that_of_the_pixel_with_all_features(seed: int) -> None:
    check_pixels(material_scene(seed), seed, 3)


@pytest.mark.parametrize(
    "name", ["light-soft", "camera-lens", "gallery-teapot", "material-glass-window", "tone", "sky"]
)
def test_the_light_of_rays_is_that_of_the_pixel_in_examples(name: str) -> None:
    check_pixels(minirt.example(name), 1, 4)


def test_a_lit_surface_is_explained_by_its_numbers() -> None:
    explanation = minirt.explain(SIMPLE, *MIDDLE)
    at = explanation.ray.surface
    assert at
    assert (at.shape, at.name, at.leaves) == (0, "sphere 1", False)
    assert (at.distance, *at.point, *at.normal) == pytest.approx((4, 0, 0, 4, 0, 0, -1), abs=1e-12)
    (lamp,) = at.lights
    assert (lamp.light, lamp.strength, lamp.passes, lamp.meets) == (0, 1.0, (1, 1, 1), ())
    assert (*lamp.direction, lamp.distance, lamp.cosine) == pytest.approx((0, 0.6, -0.8, 5, 0.8))
    assert lamp.diffuse == pytest.approx((0.4, 0.4, 0.4))
    assert explanation.level == (120, 60, 30)


def test_what_lies_between_a_surface_and_a_lamp_is_named() -> None:
    opaque = minirt.Sphere((0, 1.5, 2), 0.5, WHITE)
    pane = minirt.Disc((0, 1.5, 2), (0, 0.6, -0.8), 1, WHITE, glass=minirt.Glass(1, 0.5))
    for shape, name, distance, share in ((opaque, "sphere 2", 2.25, 0.0), (pane, "disc 1", 2.5, 0.5)):
        at = minirt.explain(SIMPLE.add(shape), *MIDDLE).ray.surface
        assert at
        (lamp,) = at.lights
        assert lamp.passes == pytest.approx((share, share, share))
        assert lamp.diffuse == pytest.approx((0.4 * share,) * 3)
        assert [(each.name, pytest.approx(each.distance)) for each in lamp.meets] == [(name, distance)]


def test_a_lamp_behind_the_surface_has_no_shadow_ray() -> None:
    at = minirt.explain(SIMPLE.replace(LAMP, position=(0, 9, 5)), *MIDDLE).ray.surface
    assert at
    (lamp,) = at.lights
    assert lamp.cosine == pytest.approx(-1 / 82**0.5)
    assert (lamp.passes, lamp.meets, lamp.diffuse) == ((0, 0, 0), (), (0, 0, 0))


def test_a_mirror_and_glass_send_on_rays_with_their_shares() -> None:
    clear = BALL.replace(mirror=0.25, glass=minirt.Glass(1, 0.5))
    scene = SIMPLE.replace(BALL, clear).add(minirt.Plane((0, 0, 9), (0, 0, 1), WHITE), minirt.Background((255, 0, 0)))
    first = minirt.explain(scene, *MIDDLE, depth=1).ray
    assert [(each.kind, each.weight) for each in first.rays] == [("reflected", 0.25), ("refracted", 0.5)]
    mirrored, refracted = first.rays
    assert mirrored.direction == pytest.approx((0, 0, -1), abs=1e-12)
    assert (mirrored.surface, mirrored.light) == (None, (0.25, 0, 0))
    assert [each.name for each in refracted.meets] == ["sphere 1", "plane 1"]
    assert refracted.surface
    assert refracted.surface.leaves
    assert refracted.rays == []  # as deep as was asked for
    assert minirt.explain(scene, *MIDDLE, depth=0).ray.rays == []


@pytest.mark.parametrize("paint", [None, (30, 40, 50)])
def test_a_scene_without_shapes_has_the_light_of_the_background(paint: tuple[int, int, int] | None) -> None:
    scene = SIMPLE.remove(BALL)
    explanation = minirt.explain(scene if paint is None else scene.add(minirt.Background(paint)), *MIDDLE)
    assert (explanation.ray.surface, explanation.ray.meets) == (None, ())
    assert explanation.level == (paint or (0, 0, 0))


@pytest.mark.parametrize(("x", "y"), [(33, 0), (0, 25)])
def test_a_pixel_outside_of_the_picture_is_refused(x: int, y: int) -> None:
    with pytest.raises(minirt.RenderError, match=f"pixel {x},{y} does not lie in the picture of 33x25 pixels"):
        minirt.explain(SIMPLE, 33, 25, x, y)


@pytest.mark.parametrize("wrong", [-1, 2.5])
def test_a_pixel_has_whole_numbers(wrong: int) -> None:
    with pytest.raises(minirt.RenderError, match=f"y must be a whole number of at least 0, got {wrong}"):
        minirt.explain(SIMPLE, 33, 25, 0, wrong)


def test_a_busy_renderer_is_not_waited_for() -> None:
    expected = minirt.explain(SIMPLE, *MIDDLE)
    with minirt.renderer().busy:
        assert minirt.explain(SIMPLE, *MIDDLE) == expected


def test_the_keys_of_json_are_those_of_the_records() -> None:
    scene = SIMPLE.replace(LAMP, minirt.ParallelLight((0, -0.6, 0.8), 0.5))
    made = json.loads(json.dumps(minirt.explain(scene, *MIDDLE).as_dict(), allow_nan=False))
    assert [*made] == ["x", "y", "width", "height", "ray", "light", "tone", "level"]
    assert [*made["ray"]] == ["kind", "origin", "direction", "meets", "weight", "tint", "surface", "light", "rays"]
    words = "shape name distance point leaves normal shading_normal uv colour specular mirror glass ior glow"
    assert [*made["ray"]["surface"]] == [*words.split(), "ambient", "lights", "light"]
    (lamp,) = made["ray"]["surface"]["lights"]
    words = "light origin direction distance cosine strength passes meets diffuse highlight"
    assert [*lamp] == words.split()
    assert lamp["distance"] is None  # infinite


def test_the_text_is_a_tree() -> None:
    scene = SIMPLE.replace(BALL, mirror=0.25).add(minirt.Sphere((0, 1.5, 2), 0.5, WHITE))
    explanation = minirt.explain(scene, *MIDDLE)
    assert f"{explanation}".replace("\N{MULTIPLICATION SIGN}", "x") == TREE
    assert "\x1b[38;2;30;15;8m██\x1b[0m" in f"{TreeText(explanation, has_colours=True)}"


TREE = """\
pixel 16,12 of 33x25: red 30, green 15, blue 8

● primary ray
│   from 0,0,0 towards 0,0,1
│
│   ◆ sphere 1 at the distance 4
│     point 0,0,4   normal 0,0,-1   u,v 0.5,0.5
│     colour 0.784 0.392 0.196, 75.0% its own, 25.0% mirrored
│     light    towards     cosine  way                                falls onto it
│     ambient                                                         0.200 0.200 0.200
│     light 1  0,0.6,-0.8  0.800   in the shadow of sphere 2 at 2.25  0.000 0.000 0.000
│     0.75 x colour x light = 0.118 0.059 0.029
│   ⇒ adds 0.118 0.059 0.029 to the pixel
│
╰─● reflected ray, 25.0% of the pixel
      from 0,0,4 towards 0,0,-1
      it meets nothing: the light is that of the background
      ⇒ adds 0.000 0.000 0.000 to the pixel

the sum of all rays: 0.118 0.059 0.029, times 255, rounded: 30 15 8"""
