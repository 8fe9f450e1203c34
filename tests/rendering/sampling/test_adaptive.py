"""Refining: more samples where neighbouring pixels differ, and nothing else changed."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from minirt.kernel.frame import PACKET_HEIGHT
from minirt.rendering import Renderer
from minirt.rendering.sampling.adaptive import CONTRAST, STRIP, contrasts, edge_packets, packets_of
from minirt.scene import Scene
from tests.kernel.pictures import ALL, AMBIENT, EYE, TWO, picture
from tests.rendering.cancelling import ENDLESS, SAMPLES, cancelled

Pixels = NDArray[np.uint8]


def flat(height: int, width: int, level: int = 100) -> Pixels:
    pixels = np.full((height, width, 4), level, np.uint8)
    pixels[..., 3] = 255
    return pixels


def refined(pixels: Pixels, *passes: int) -> Pixels:
    made = pixels.copy()
    for samples in passes:
        assert TWO.refine(ALL, made, samples)
    return made


def error(pixels: Pixels, fine: Pixels) -> float:
    """Root of the mean square, in levels."""
    return float(np.sqrt(((pixels.astype(float) - fine)[..., :3] ** 2).mean()))


def near_edges(pixels: Pixels) -> NDArray[np.bool_]:
    """Where pixels may change: so close to one with contrast that they may be in its packet."""
    near = np.zeros(pixels.shape[:2], bool)
    for y, x in np.argwhere(contrasts(pixels)):
        near[max(y - PACKET_HEIGHT, 0) : y + PACKET_HEIGHT, max(x - 7, 0) : x + 8] = True
    return near


def test_a_flat_picture_has_no_contrast() -> None:
    assert not contrasts(flat(5, 7)).any()


@pytest.mark.parametrize("channel", [0, 1, 2])
def test_a_pixel_that_differs_stands_out_with_its_four_neighbours(channel: int) -> None:
    for least, found in ((CONTRAST, 0), (CONTRAST + 1, 5), (155, 5)):
        for sign in (1, -1):
            pixels = flat(6, 8)
            pixels[2, 3, channel] = 100 + sign * min(least, 100 if sign < 0 else 155)
            edge = contrasts(pixels)
            assert edge.sum() == found
            if found:
                assert edge[2, 2:5].all()
                assert edge[1:4, 3].all()


def test_small_differences_in_all_colours_do_not_add_up() -> None:
    pixels = flat(4, 4)
    pixels[2, 2, :3] += CONTRAST
    assert not contrasts(pixels).any()


@pytest.mark.parametrize("shape", [(1, 1), (1, 9), (9, 1)])
def test_pictures_of_one_line_or_column(shape: tuple[int, int]) -> None:
    pixels = flat(*shape)
    assert contrasts(pixels).shape == shape
    pixels[-1, -1, :3] = 0
    assert contrasts(pixels).sum() == min(2, pixels.shape[0] * pixels.shape[1]) * (shape != (1, 1))


@pytest.mark.parametrize("across", [1, 2, 4])
def test_a_packet_is_found_by_any_of_its_pixels(across: int) -> None:
    for y in range(PACKET_HEIGHT * 2):
        for x in range(across * 3):
            seen = np.zeros((PACKET_HEIGHT * 2 - 1, across * 3), bool)
            if y < len(seen):
                seen[y, x] = True
                packets = packets_of(seen, across)
                assert packets.dtype == np.uint8
                assert np.argwhere(packets).tolist() == [[y // PACKET_HEIGHT, x // across]]
    assert packets_of(np.ones((5, 2 * across + 1), bool), across).shape == (2, 3)


def test_strips_together_are_the_whole() -> None:
    generator = np.random.default_rng(3)
    for height in (1, STRIP - 1, STRIP, STRIP + 1, 2 * STRIP + PACKET_HEIGHT + 1):
        pixels = flat(height, 21)
        pixels[..., :3] = 100 + 50 * (generator.random((height, 21, 1)) < 0.004)
        if height > STRIP:  # the last line of a strip is a neighbour of the first one of the next
            pixels[STRIP - 1, 5, :3] = pixels[STRIP, 15, :3] = 200
        strips = list(edge_packets(pixels, 2))
        assert len(strips) == -(-height // STRIP)
        assert np.array_equal(np.concatenate(strips), packets_of(contrasts(pixels), 2))


@pytest.mark.parametrize(("width", "height"), [(64, 48), (61, 47), (5, 3), (1, 1), (3, 130)])
def test_flat_parts_keep_their_bytes_and_edges_get_all_their_samples(width: int, height: int) -> None:
    one, many = picture(ALL, width, height)[0], picture(ALL, width, height, 16)[0]
    made = refined(one, 16)
    away = ~near_edges(one)
    assert np.array_equal(made[away], one[away])
    edge = contrasts(one)
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


def test_nothing_to_refine() -> None:
    pixels = flat(5, 7)
    assert TWO.refine(Scene((AMBIENT, EYE)), pixels, 4)
    assert (pixels == (0, 0, 0, 255)).all()
    assert TWO.refine(ALL, np.zeros((0, 7, 4), np.uint8), 4)


def test_what_is_not_wanted_any_more_is_not_begun() -> None:
    pixels = picture(ALL, 30, 20)[0]
    before = pixels.copy()
    assert not TWO.refine(ALL, pixels, 4, is_wanted=lambda: False)
    assert not TWO.render(ALL, pixels, 4, is_wanted=lambda: False)
    assert np.array_equal(pixels, before)


def test_a_cancel_between_the_question_and_the_first_packet_is_heard() -> None:
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
