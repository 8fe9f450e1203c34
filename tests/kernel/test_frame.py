"""Rendering of frames: every pixel once, at any size, on any number of threads, interpreted or compiled."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.kernel import frame
from minirt.lanes import Vec
from minirt.rendering import Renderer
from minirt.rendering.packing import lights
from minirt.scene import FurtherLight, Scene
from tests.kernel.pictures import ALL, AMBIENT, EYE, LAMP, ONE, SHAPES, TWO, interpreted, linear, picture

SIZES = [(1, 1), (1, 9), (9, 1), (5, 3), (4, 2), (3, 2), (13, 11), (4, 33), (33, 8)]


def test_one_thread_and_many_give_the_same_bits() -> None:
    pixels, light = picture(ALL, 150, 83, renderer=ONE)
    for threads in (TWO, Renderer(7)):
        again, same = picture(ALL, 150, 83, renderer=threads)
        assert np.array_equal(pixels, again)
        assert np.array_equal(light, same)


@pytest.mark.parametrize(("width", "height"), SIZES)
def test_every_pixel_is_rendered_at_every_size(width: int, height: int) -> None:
    pixels, light = picture(ALL, width, height)
    assert np.isfinite(light).all()
    assert (pixels[..., 3] == 255).all()
    interpreted_pixels, interpreted_light = interpreted(ALL, width, height)
    assert np.abs(light - interpreted_light).max() <= 1e-12
    assert np.array_equal(pixels, interpreted_pixels)


def test_a_small_picture_is_part_of_a_larger_one() -> None:
    # The middle of nine rows equals the only row of a picture as wide, although they fall into different packets.
    assert np.allclose(linear(ALL, 21, 9)[4:5], linear(ALL, 21, 1), atol=1e-12, rtol=0)
    odd = linear(ALL, 63, 27)
    assert np.allclose(odd[1::3, 1::3], linear(ALL, 21, 9), atol=1e-12, rtol=0)


def test_bytes_are_clamped_and_rounded() -> None:
    pixels, light = picture(ALL, 60, 40)
    expected = np.floor(np.clip(light, 0, 1) * 255 + 0.5)
    assert np.array_equal(pixels[..., 2::-1], expected)
    flash = FurtherLight(EYE.position, 1, LAMP.colour)
    pixels, light = picture(Scene((AMBIENT, EYE, flash, flash, flash, *SHAPES)), 60, 40)
    assert light.max() > 1.5
    assert np.array_equal(pixels[..., 2::-1], np.floor(np.clip(light, 0, 1) * 255 + 0.5))


def test_many_samples_approach_the_mean_of_finer_pixels() -> None:
    # A single sample is in the centre; many approach the mean over the pixel's area, as 81 finer pixels do.
    fine = linear(ALL, 24 * 9, 16 * 9).reshape(16, 9, 24, 9, 3).mean(axis=(1, 3))
    assert np.abs(linear(ALL, samples=256) - fine).mean() < 0.15 * np.abs(linear(ALL) - fine).mean()


@pytest.mark.parametrize(("width", "height"), [*SIZES, (60, 40), (150, 83)])
def test_the_picture_is_the_same_with_and_without_linear_output(width: int, height: int) -> None:
    with_light, _ = picture(ALL, width, height)
    padded = np.full((height + 6, width, 4), 77, np.uint8)
    assert TWO.render(ALL, padded[3:-3])
    assert np.array_equal(padded[3:-3], with_light)
    assert (padded[:3] == 77).all()
    assert (padded[-3:] == 77).all()


def test_radiance_that_is_not_finite_becomes_black_and_is_counted() -> None:
    light = np.full((3, 16), 0.5)
    light[0, 3], light[1, 5] = np.nan, np.inf
    memory = np.zeros((3, 4))
    mended = frame.without_non_finite(Vec(*light), memory)
    assert memory[2, 1] == 2
    assert memory.sum() == 2
    light[0, 3] = light[1, 5] = 0.0
    assert np.array_equal(np.stack([mended.x, mended.y, mended.z]), light)
    frame.without_non_finite(Vec(*light), memory)
    assert memory.sum() == 2


def test_a_renderer_counts_rays_whose_light_is_not_finite(monkeypatch: pytest.MonkeyPatch) -> None:
    renderer, pixels = Renderer(2), np.zeros((32, 32, 4), np.uint8)
    assert renderer.render(ALL, pixels)
    assert renderer.not_finite == 0
    rows = lights.positions_and_intensities
    factors = [1, 1, 1, np.nan, 1, 1]
    monkeypatch.setattr(lights, "positions_and_intensities", lambda some, colours: rows(some, colours) * factors)
    spoiled = Renderer(2)
    assert spoiled.render(ALL, pixels)
    assert 100 < spoiled.not_finite <= 32 * 32
