"""Finding the pixels at edges, and the packets that contain them."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from minirt.kernel.pixels import PACKET_HEIGHT
from minirt.rendering.sampling.adaptive import CONTRAST, STRIP, edge_packets, edge_pixels, packets_with_any

Pixels = NDArray[np.uint8]


def flat(height: int, width: int, level: int = 100) -> Pixels:
    pixels = np.full((height, width, 4), level, np.uint8)
    pixels[..., 3] = 255
    return pixels


def test_a_uniform_picture_has_no_edges() -> None:
    assert not edge_pixels(flat(5, 7)).any()


@pytest.mark.parametrize("channel", [0, 1, 2])
def test_a_pixel_that_differs_is_at_an_edge_and_so_are_its_four_neighbours(channel: int) -> None:
    for least, found in ((CONTRAST, 0), (CONTRAST + 1, 5), (155, 5)):
        for sign in (1, -1):
            pixels = flat(6, 8)
            pixels[2, 3, channel] = 100 + sign * min(least, 100 if sign < 0 else 155)
            edge = edge_pixels(pixels)
            assert edge.sum() == found
            if found:
                assert edge[2, 2:5].all()
                assert edge[1:4, 3].all()


def test_small_differences_in_all_colours_do_not_add_up() -> None:
    pixels = flat(4, 4)
    pixels[2, 2, :3] += CONTRAST
    assert not edge_pixels(pixels).any()


@pytest.mark.parametrize("shape", [(1, 1), (1, 9), (9, 1)])
def test_pictures_of_one_line_or_column_have_edges(shape: tuple[int, int]) -> None:
    pixels = flat(*shape)
    assert edge_pixels(pixels).shape == shape
    pixels[-1, -1, :3] = 0
    assert edge_pixels(pixels).sum() == min(2, pixels.shape[0] * pixels.shape[1]) * (shape != (1, 1))


@pytest.mark.parametrize("packet_width", [1, 2, 4])
def test_a_packet_is_marked_by_any_of_its_pixels(packet_width: int) -> None:
    for y in range(PACKET_HEIGHT * 2):
        for x in range(packet_width * 3):
            marked = np.zeros((PACKET_HEIGHT * 2 - 1, packet_width * 3), bool)
            if y < len(marked):
                marked[y, x] = True
                packets = packets_with_any(marked, packet_width)
                assert packets.dtype == np.uint8
                assert np.argwhere(packets).tolist() == [[y // PACKET_HEIGHT, x // packet_width]]
    assert packets_with_any(np.ones((5, 2 * packet_width + 1), bool), packet_width).shape == (2, 3)


def test_the_strips_make_up_the_whole_picture() -> None:
    generator = np.random.default_rng(3)
    for height in (1, STRIP - 1, STRIP, STRIP + 1, 2 * STRIP + PACKET_HEIGHT + 1):
        pixels = flat(height, 21)
        pixels[..., :3] = 100 + 50 * (generator.random((height, 21, 1)) < 0.004)
        if height > STRIP:  # the last line of a strip is a neighbour of the first one of the next
            pixels[STRIP - 1, 5, :3] = pixels[STRIP, 15, :3] = 200
        strips = list(edge_packets(pixels, 2))
        assert len(strips) == -(-height // STRIP)
        assert np.array_equal(np.concatenate(strips), packets_with_any(edge_pixels(pixels), 2))
