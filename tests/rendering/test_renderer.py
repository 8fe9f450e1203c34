"""The facade of the renderer: arguments, pictures without shapes or pixels, several threads."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import minirt
from minirt.errors import RenderError
from minirt.rendering import Renderer
from minirt.scene import Scene
from tests.kernel.pictures import ALL, AMBIENT, EYE, TWO


@pytest.mark.parametrize("samples", [0, -1])
def test_fewer_than_one_sample_is_an_error(samples: int) -> None:
    with pytest.raises(RenderError, match="at least 1 sample"):
        TWO.render(ALL, np.zeros((4, 4, 4), np.uint8), samples)


def test_a_scene_without_shapes_is_black() -> None:
    pixels = np.full((5, 7, 4), 9, np.uint8)
    assert TWO.render(Scene((AMBIENT, EYE)), pixels)
    assert (pixels == (0, 0, 0, 255)).all()


def test_a_picture_without_pixels_is_done_at_once() -> None:
    assert TWO.render(ALL, np.zeros((0, 7, 4), np.uint8))
    assert TWO.render(ALL, np.zeros((7, 0, 4), np.uint8))


def test_several_threads_may_render_at_once() -> None:
    scenes = [ALL.replace(ALL.spheres[0], diameter=1 + i / 4) for i in range(8)]
    expected = [minirt.render(scene, 50, 40).array for scene in scenes]
    with ThreadPoolExecutor(8) as pool:
        made = list(pool.map(lambda scene: minirt.render(scene, 50, 40).array, scenes * 3))
    assert all(np.array_equal(image, expected[i % 8]) for i, image in enumerate(made))


def test_the_number_of_threads_is_as_given_or_at_least_one() -> None:
    assert Renderer(5).threads == 5
    assert Renderer().threads >= 1


def test_a_child_process_leaves_busy_locks_and_compiling_to_its_parent() -> None:
    renderer = Renderer(1)
    compiling, background = renderer.kernels.compile_process, renderer.kernels.background
    renderer.busy.acquire()
    renderer.after_fork()
    assert not renderer.busy.locked()
    assert renderer.kernels.compile_process is not compiling
    assert renderer.kernels.background is not background
