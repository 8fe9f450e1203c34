"""Rendering and refining with a given number of samples: only pixels near edges change, and cancelling is heard."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from minirt.kernel.stored_light import PACKET_HEIGHT
from minirt.rendering import Renderer
from minirt.rendering.sampling.adaptive import edge_pixels
from minirt.scene import Scene
from tests.kernel.pictures import ALL, AMBIENT, EYE, TWO, picture
from tests.rendering.cancelling import ENDLESS, SAMPLES, cancelled
from tests.rendering.sampling.test_adaptive import Pixels, flat


def refined(pixels: Pixels, *passes: int) -> Pixels:
    made = pixels.copy()
    for samples in passes:
        assert TWO.refine(ALL, made, samples)
    return made


def error(pixels: Pixels, fine: Pixels) -> float:
    """RMSE in levels."""
    return float(np.sqrt(((pixels.astype(float) - fine)[..., :3] ** 2).mean()))


def near_edges(pixels: Pixels) -> NDArray[np.bool_]:
    """Pixels that may change: so close to one at an edge that they may be in its packet."""
    near = np.zeros(pixels.shape[:2], bool)
    for y, x in np.argwhere(edge_pixels(pixels)):
        near[max(y - PACKET_HEIGHT, 0) : y + PACKET_HEIGHT, max(x - 7, 0) : x + 8] = True
    return near


@pytest.mark.parametrize(("width", "height"), [(64, 48), (61, 47), (5, 3), (1, 1), (3, 130)])
def test_only_packets_with_edges_change_and_get_all_their_samples(width: int, height: int) -> None:
    one, many = picture(ALL, width, height)[0], picture(ALL, width, height, 16)[0]
    made = refined(one, 16)
    far = ~near_edges(one)
    assert np.array_equal(made[far], one[far])
    edge = edge_pixels(one)
    assert np.array_equal(made[edge], many[edge])


def test_the_refined_picture_is_as_good_as_one_with_as_many_samples_everywhere() -> None:
    one, many, fine = (picture(ALL, 160, 120, samples)[0] for samples in (1, 16, 256))
    passes = refined(one, 4, 16)
    assert error(passes, fine) < 1.1 * error(many, fine)
    assert error(passes, fine) < error(refined(one, 4), fine) / 2 < error(one, fine) / 4
    assert (passes == one).all(axis=2).mean() > 0.5  # and most of it was not rendered again


def test_refining_leaves_a_picture_without_edges_alone() -> None:
    pixels = flat(40, 50, 77)
    assert TWO.refine(ALL, pixels, 4)
    assert (pixels[..., :3] == 77).all()


def test_pictures_without_shapes_or_pixels_are_refined_at_once() -> None:
    pixels = flat(5, 7)
    assert TWO.refine(Scene((AMBIENT, EYE)), pixels, 4)
    assert (pixels == (0, 0, 0, 255)).all()
    assert TWO.refine(ALL, np.zeros((0, 7, 4), np.uint8), 4)


def test_a_picture_that_is_not_wanted_is_not_begun() -> None:
    pixels = picture(ALL, 30, 20)[0]
    before = pixels.copy()
    assert not TWO.refine(ALL, pixels, 4, is_wanted=lambda: False)
    assert not TWO.render(ALL, pixels, 4, is_wanted=lambda: False)
    assert np.array_equal(pixels, before)


def test_a_cancel_before_the_first_packet_is_heard() -> None:
    renderer = Renderer(2)
    renderer.prepare(ALL)
    pixels = picture(ALL, 200, 150)[0]
    before = pixels.copy()

    def is_wanted() -> bool:
        renderer.cancel()
        return True

    assert not renderer.refine(ALL, pixels, 4, is_wanted)
    assert np.array_equal(pixels, before)
    assert renderer.refine(ALL, pixels, 4)
    assert not np.array_equal(pixels, before)


def test_cancelling_ends_a_long_pass() -> None:
    renderer = Renderer(2)
    renderer.prepare(ALL)
    pixels = np.random.default_rng(1).integers(0, 256, (*ENDLESS, 4), np.uint8)  # all of its pixels differ
    assert not cancelled(renderer, lambda: renderer.refine(ALL, pixels, SAMPLES))
