"""Soft shadows and depth of field: shares of discs, circles of confusion, convergence, culling that misses nothing."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from minirt.kernel import frame, interpreted
from minirt.kernel.pixels import TILE
from minirt.materials import Placement
from minirt.rendering.frame import frame_arguments
from minirt.rendering.packing.camera import aperture_places, in_disc, lens_numbers, with_apertures
from minirt.rendering.packing.features import features
from minirt.rendering.renderer import PRECISIONS, Renderer
from minirt.rendering.scene_packing import BVH, LIGHT_BUFFERS, TILES, Packing
from minirt.scene import Camera, FurtherLight, Light, Scene, parse
from tests.kernel.pictures import EVERY, linear, picture
from tests.random_scenes import random_scene
from tests.reference import render_sampled
from tests.seeds import seed_of

RENDERER = Renderer(2)


def soft_scene(spread: float = 1.0) -> Scene:
    """All kinds of shapes, enough for light buffers and tiles, with four lights and a lens."""
    soft: Any = {Light: 2.0, FurtherLight: 1.2}
    items = [each.replace(size=soft[type(each)] * spread) if type(each) in soft else each for each in EVERY.elements]
    camera = EVERY.camera.replace(lens=1.0 * spread, focus=6.0)
    return Scene((*(each for each in items if type(each) is not Camera), camera))


def light_of(arrays: Any, width: int, height: int) -> np.ndarray:
    """Render a packed scene by the interpreted kernel, with four samples."""
    pixels, light = np.zeros((height, width, 4), np.uint8), np.zeros((height, width, 3))
    with np.errstate(all="ignore"):
        frame.frame(*frame_arguments(arrays, pixels, 4, light))
    return light


def test_culling_leaves_out_nothing_that_a_moved_eye_or_light_sees() -> None:
    size = TILE, TILE
    arrays, hard = (Packing(interpreted).pack(each, *size) for each in (soft_scene(), EVERY))
    assert arrays.light_buffer_cells > 1
    every = Packing(interpreted, without=(TILES, LIGHT_BUFFERS, BVH)).pack(soft_scene(), *size)
    expected = light_of(every, *size)
    assert np.array_equal(light_of(arrays, *size), expected)
    fields = ("tile_shapes", "cones", "light_shapes", "light_cones", "groups")
    narrow = arrays._replace(**{name: getattr(hard, name) for name in fields})
    assert not np.array_equal(light_of(narrow, *size), expected)  # lists for a pinhole and points would not do


HELD_OUT = """
A 0.1 255,240,220
C 0.5,3,-8 -0.05,-0.3,0.95 50 {lens}
{light}
pl 0,0,0 0,1,0 200,200,190
pl 0,0,9 0.1,0.1,-1 120,140,165
sp 0,1,0 2 220,80,60 specular:0.4,20
sp 2.2,0.6,-1.5 1.2 60,120,220 mirror:0.3
cy -2.4,1,1 0.1,1,0 0.6 2 90,180,90
bo -0.8,0.3,-2.5 0.2,1,0.1 0.6,0.6,0.6 230,200,80
co 1.5,2.6,2 0,-1,0.1 1 2 200,90,200
to -3,0.5,-1 0,1,0.3 1 0.3 230,230,230
"""
CASES = {
    "size": (
        "",
        "L -4,7,-4 0.6 255,255,255 size:2.5\nl 5,4,-3 0.3 size:1\ndl 0.4,-1,0.3 0.3 size:9\n"
        "sl -3,7,-3 0.4,-0.8,0.4 60 0.5 size:1.5 rim:0.5 fade:30",
    ),
    "focus": ("lens:0.5 focus:6 roll:10", "L -4,7,-4 0.8 255,255,255 size:1"),
}


def held_out(case: str) -> Scene:
    """Return the scene of a case."""
    lens, light = CASES[case]
    return parse(HELD_OUT.format(lens=lens, light=light)).scene


@pytest.mark.parametrize("case", CASES)
def test_pictures_equal_those_of_the_reference_with_random_samples(case: str) -> None:
    scene, size, count = held_out(case), (32, 20), 4
    pictures = [render_sampled(scene, *size, samples=16, seed=seed) for seed in range(count)]
    light, expected = linear(scene, *size, 512, RENDERER), np.mean(pictures, axis=0)
    noise = np.sqrt(np.var(pictures, axis=0, ddof=1).mean() / count)
    assert noise < 0.02
    assert np.sqrt(((light - expected) ** 2).mean()) < 1.3 * noise
    assert abs((light - expected).mean()) < 0.003
    pinhole = scene.replace(scene.camera, lens=None) if "lens:" in CASES[case][0] else hard(scene)
    sharp = linear(pinhole, *size, 512, RENDERER)
    # The effect of the size, which is smaller than the noise of a pixel, is found whole: without it the share is 0.
    effect = light - sharp
    assert abs(((expected - sharp) * effect).sum() / (effect**2).sum() - 1) < 0.3


def hard(scene: Scene) -> Scene:
    """Return a scene with lights without a size."""
    for light in scene.lights:
        scene = scene.replace(light, size=None)
    return scene


def drawn(scene: Scene, renderer: Renderer) -> tuple[bytes, bytes, str]:
    """Return the bits of a picture and of its light with one sample, and the kernel that such a picture asks for."""
    pixels, light = picture(scene, 40, 24, 1, renderer)
    chosen = renderer.runner.choice
    assert chosen
    assert chosen.specialised == renderer.kernels.specialised(scene, 1)[-1]
    return pixels.tobytes(), light.tobytes(), chosen.specialised


@pytest.mark.parametrize("precision", PRECISIONS)
def test_one_sample_leaves_out_the_size_of_lights_the_lens_and_the_place_of_no_picture(precision: str) -> None:
    renderer = Renderer(2, precision)
    for seed in np.random.default_rng(seed_of("left out")).integers(1e6, size=20).tolist():
        random, plain = np.random.default_rng(seed), random_scene(seed)
        scene = plain.replace(plain.camera, lens=random.uniform(0.01, 1)) if random.random() < 0.7 else plain
        for light in scene.lights[: random.integers(1 + len(scene.lights))]:
            scene = scene.replace(light, size=random.uniform(0.1, 5))
        for shape in scene.shapes[: random.integers(1 + len(scene.shapes))]:
            scene = scene.replace(shape, uv=Placement(*random.uniform(0.1, 9, 4)))
        assert drawn(scene, renderer) == drawn(plain, renderer), seed
        several = renderer.kernels.specialised(scene)[-1]
        has_apertures = features(scene) != features(plain)
        assert (several != renderer.kernels.specialised(plain)[-1]) == has_apertures, seed


def test_pictures_of_one_sample_and_of_more_take_turns() -> None:
    """Each packs what it shows, whichever was packed before."""
    renderer, scene = Renderer(2), soft_scene()
    expected = {samples: linear(scene, 24, 16, samples, Renderer(2)) for samples in (1, 4)}
    for samples in (1, 4, 4, 1, 1, 4):
        assert np.array_equal(linear(scene, 24, 16, samples, renderer), expected[samples])


def test_the_error_falls_faster_than_that_of_random_samples() -> None:
    scene = held_out("size")
    exact = linear(scene, 40, 24, 4096, RENDERER)
    errors = [np.sqrt(((linear(scene, 40, 24, n, RENDERER) - exact) ** 2).mean()) for n in (4, 16, 64, 256)]
    order = -np.polyfit(np.log([4, 16, 64, 256]), np.log(errors), 1)[0]
    assert order > 0.56, errors  # 0.5 for random samples


def test_neighbouring_pixels_have_samples_of_their_own() -> None:
    # In a penumbra the rest of the noise of a pixel says nothing about that of its neighbours.
    scene = held_out("size")
    noise = linear(scene, 64, 40, 4, RENDERER)[..., 1] - linear(scene, 64, 40, 2048, RENDERER)[..., 1]
    noise = np.where(np.abs(noise) < 0.2, noise, 0.0)  # without edges
    for one, other in ((noise[1:], noise[:-1]), (noise[:, 1:], noise[:, :-1]), (noise[:, 4:], noise[:, :-4])):
        assert abs((one * other).mean()) < 0.25 * (noise**2).mean()


def test_the_estimated_error_is_that_of_the_picture() -> None:
    for case in ("size", "focus"):
        scene = held_out(case)
        exact = np.clip(linear(scene, 160, 90, 1024, RENDERER), 0, 1)
        pixels, light = np.zeros((90, 160, 4), np.uint8), np.zeros((90, 160, 3))
        outcome = RENDERER.reach(scene, pixels, 0.008, linear=light)
        assert outcome
        error = np.sqrt(((np.clip(light, 0, 1) - exact) ** 2).mean())
        assert error / 2 < outcome.error < 2 * error
        assert error < 1.3 * 0.008


def test_places_fill_discs_evenly() -> None:
    places = aperture_places(64, 4, 16, 0)
    assert places.shape == (256, 16, 4)
    for first in (0, 2):
        x, y = places[..., first], places[..., first + 1]
        assert_allclose([x.mean(), y.mean(), (x * y).mean()], 0, atol=0.01)
        assert_allclose([(x * x).mean(), (y * y).mean()], 0.25, atol=0.005)
        assert np.hypot(x, y).max() <= 1
    assert np.abs(np.corrcoef(places.reshape(-1, 4).T) - np.eye(4)).max() < 0.05
    # Areas keep their ratio: of the square's points as many fall into the inner half of the disc as beside it.
    grid = (np.stack(np.mgrid[:200, :200], axis=-1) + 0.5) / 200
    assert_allclose((np.hypot(*np.moveaxis(in_disc(grid), -1, 0)) < 0.5**0.5).mean(), 0.5, atol=0.005)
    assert in_disc(np.array([0.5, 0.5])).tolist() == [0, 0]


LENGTHS = (1e-50, 1e-30, 1.0, 1e15)


@pytest.mark.parametrize("focus", LENGTHS)
def test_what_is_in_focus_may_be_as_close_as_a_scene_may_say(focus: float) -> None:
    rays, places = np.ones((4, 3 * 8)), aperture_places(4, 1, 8, 1)
    for lens in LENGTHS:
        numbers = lens_numbers(Camera((0, 0, 0), (0.6, 0, 0.8), 60, lens=lens), focus)
        directions = with_apertures(rays, places, numbers)[:, :24].astype(np.float32)
        assert np.isfinite(directions * directions).all()
        assert np.isfinite(numbers.astype(np.float32)).all()
        is_kept = focus >= 1e-18 * lens and focus >= 1e-30
        assert not is_kept or numbers[6] == 1 / focus
