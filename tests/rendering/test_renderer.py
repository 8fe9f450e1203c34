"""The renderer: threads, cancelling, errors, samples."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from itertools import count
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import minirt
from minirt.errors import RenderError
from minirt.kernel.frame import CANCELLED
from minirt.rendering import Renderer
from minirt.rendering.frame_arguments import sample_positions
from minirt.rendering.running.kernel_features import kernel_features
from minirt.scene import Scene
from tests.kernel.pictures import ALL, AMBIENT, EYE, SHAPES, TWO, picture
from tests.rendering.cancelling import ENDLESS, SAMPLES, cancelled
from tests.waiting import until


@pytest.mark.parametrize("samples", [1, 2, 3, 16, 64])
def test_samples_lie_evenly_in_the_pixel(samples: int) -> None:
    places = sample_positions(samples)
    assert places.shape == (samples, 2)
    assert ((places >= 0) & (places < 1)).all()
    assert np.abs(places.mean(axis=0) - 0.5).max() <= (0 if samples == 1 else 0.5 / samples)
    assert len(np.unique(places[:, 0])) == len(np.unique(places[:, 1])) == samples
    quarters = np.histogram2d(places[:, 0], places[:, 1], bins=2, range=[[0, 1], [0, 1]])[0]
    assert np.ptp(quarters) <= max(1, samples / 8)


def test_one_sample_is_in_the_centre() -> None:
    assert sample_positions(1).tolist() == [[0.5, 0.5]]


@pytest.mark.parametrize("samples", [0, -1])
def test_less_than_one_sample_is_refused(samples: int) -> None:
    with pytest.raises(RenderError, match="at least 1 sample"):
        TWO.render(ALL, np.zeros((4, 4, 4), np.uint8), samples)


def test_a_scene_without_shapes_is_black() -> None:
    pixels = np.full((5, 7, 4), 9, np.uint8)
    assert TWO.render(Scene((AMBIENT, EYE)), pixels)
    assert (pixels == (0, 0, 0, 255)).all()


def test_a_picture_without_pixels_is_made_at_once() -> None:
    assert TWO.render(ALL, np.zeros((0, 7, 4), np.uint8))
    assert TWO.render(ALL, np.zeros((7, 0, 4), np.uint8))


def test_cancelling_ends_a_long_frame_and_the_next_is_right() -> None:
    renderer = Renderer(2)
    expected, _ = picture(ALL, 64, 48)
    renderer.prepare(ALL)
    pixels = np.zeros((*ENDLESS, 4), np.uint8)
    assert not cancelled(renderer, lambda: renderer.render(ALL, pixels, SAMPLES))
    pixels = np.zeros((48, 64, 4), np.uint8)
    assert renderer.render(ALL, pixels)
    assert np.array_equal(pixels, expected)


def test_cancelling_when_nothing_is_rendered_does_nothing() -> None:
    renderer = Renderer(1)
    renderer.cancel()
    assert renderer.render(ALL, np.zeros((8, 8, 4), np.uint8))
    renderer.cancel()
    assert renderer.render(ALL, np.zeros((8, 8, 4), np.uint8))


def test_several_threads_may_render_at_once() -> None:
    scenes = [ALL.replace(ALL.spheres[0], diameter=1 + i / 4) for i in range(8)]
    expected = [minirt.render(scene, 50, 40).array for scene in scenes]
    with ThreadPoolExecutor(8) as pool:
        made = list(pool.map(lambda scene: minirt.render(scene, 50, 40).array, scenes * 3))
    assert all(np.array_equal(image, expected[i % 8]) for i, image in enumerate(made))


def test_an_error_in_one_thread_reaches_the_caller() -> None:
    renderer = Renderer(3)
    renderer.prepare(ALL)
    kernel = renderer.kernels.jit
    turns, stopped = count(1), list[int]()

    def bands(counter: Any, *rest: Any) -> None:
        turn = next(turns)
        if turn == 2:
            raise ValueError("out of order")
        until(lambda: counter[0] >= CANCELLED, "the end of the other threads")
        stopped.append(turn)

    renderer.kernels.jit = SimpleNamespace(frame=kernel.frame, kernel_for=lambda _traced: bands)
    with pytest.raises(ValueError, match="out of order"):
        renderer.render(ALL, np.zeros((40, 40, 4), np.uint8))
    assert sorted(stopped) == [1, 3]
    renderer.kernels.jit = kernel
    assert renderer.render(ALL, np.zeros((8, 8, 4), np.uint8))


def test_it_knows_which_kernels_are_there() -> None:
    renderer = Renderer(1)
    assert not renderer.is_ready(ALL)
    renderer.prepare(ALL)
    assert renderer.is_ready(ALL)
    assert renderer.is_ready(Scene((EYE, *SHAPES[:3])))
    assert not renderer.is_ready(Scene((EYE, SHAPES[0])))
    assert kernel_features(ALL) == {type(shape) for shape in SHAPES}


def test_the_number_of_threads() -> None:
    assert Renderer(5).threads == 5
    assert Renderer().threads >= 1
