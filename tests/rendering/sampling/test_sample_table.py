"""Tables of sample positions: those of uniform pictures, and references without bias."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.kernel.frame import REFERENCE_SAMPLES
from minirt.kernel.stored_light import PACKET_HEIGHT
from minirt.rendering.frame_arguments import sample_positions
from minirt.rendering.packing.camera import packet_pixels, packet_rays
from minirt.rendering.sampling.outcome import MOST_SAMPLES
from minirt.rendering.sampling.sample_table import COUNTS, SampleTable, random_shifts, table_rays

WIDTH = 4 * PACKET_HEIGHT


def test_numbers_of_samples_grow_by_at_most_a_half() -> None:
    assert COUNTS[:8].tolist() == [1, 2, 3, 4, 6, 8, 12, 16]
    assert COUNTS[-1] == MOST_SAMPLES
    assert (COUNTS[2:] / COUNTS[1:-1] <= 1.5).all()


def test_drawn_samples_are_those_of_a_uniform_picture() -> None:
    levels = np.array([0, 3, 7])
    table = SampleTable(levels, WIDTH)
    for level in levels:
        drawn = table.positions[table.first[level] :][: COUNTS[level]]
        assert np.array_equal(drawn, np.broadcast_to(sample_positions(COUNTS[level])[:, None], drawn.shape))


def test_plans_name_rows_of_the_table_and_references_differ() -> None:
    table = SampleTable(np.arange(12), WIDTH)
    levels = np.arange(600) % 12
    plan = table.plan(levels.astype(np.uint8), levels % 2 > 0)
    assert np.array_equal(plan[:, 1], COUNTS[levels])
    assert np.array_equal(plan[:, 2] > 0, levels % 2 > 0)
    ends = plan[:, 2] + 2 * REFERENCE_SAMPLES * plan[:, 1] * (plan[:, 2] > 0)
    assert ends.max() <= len(table.positions)
    assert (table.positions >= 0).all()
    assert (table.positions < 1).all()
    for _, count, reference in plan[plan[:, 2] > 0][:20]:
        one, other = table.positions[reference:][: 2 * REFERENCE_SAMPLES * count].reshape(2, -1, WIDTH, 2)
        assert not np.isclose(one, other).all(axis=(0, 2)).any()


def test_references_have_no_bias() -> None:
    """The mean of a function with an edge over many shifts is its mean over the pixel."""
    shifts = random_shifts(2000, WIDTH).reshape(-1, 2)
    positions = (sample_positions(REFERENCE_SAMPLES)[:, None] + shifts) % 1.0
    assert (positions @ (0.3, 0.8) < 0.4).mean() == pytest.approx(0.5 - 0.3 / 2 / 0.8, abs=0.003)


@pytest.mark.parametrize("precision", [np.float64, np.float32])
def test_rays_are_those_of_packets(precision: type[np.floating]) -> None:
    camera = np.random.default_rng(1).normal(size=12).astype(precision)
    positions = SampleTable(np.arange(5), 128 // camera.itemsize).positions
    rays = table_rays(camera, positions, packet_pixels(128 // camera.itemsize))
    expected = packet_rays(camera, positions)
    assert rays.dtype == expected.dtype
    assert rays == pytest.approx(expected, rel=1e-6 if precision == np.float32 else 1e-14, abs=1e-5)
