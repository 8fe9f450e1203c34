"""Rays that start on a surface as `minirt.kernel.shade` starts them do not hit it again."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from minirt.shapes import KINDS, Kind, Shape
from tests import oracle
from tests.shapes.examples import CONCAVE, Hits, hits, offsets
from tests.shapes.regimes import Array, Random, across, log, unit
from tests.shapes.ways import compiled

SCALES = [(1.0, 0.0), (1e4, 0.0), (1e-4, 0.0), (1e8, 0.0), (1.0, 1e4), (1.0, 1e8), (1e-4, 1.0)]  # size, distance
Offset = Callable[[Array, list[Shape]], Array]


def outwards(random: Random, normals: Array) -> Array:
    """Directions away from a surface: half of them anywhere, half of them grazing it, to a cosine of 1e-8."""
    shape = normals.shape[:2]
    cosine = np.where(random.random(shape) < 0.5, random.uniform(0.01, 1, shape), log(random, 1e-8, 1e-2, *shape))
    return unit(cosine[..., None] * normals + np.sqrt(1 - cosine[..., None] ** 2) * across(random, normals, *shape))


def acne(seen: Hits, offset: Offset) -> int:
    """How many rays from the outside of a surface hit it again."""
    random = np.random.default_rng(2)
    starts = seen.points + offset(seen.points, seen.shapes) * seen.facing
    directions = outwards(random, seen.facing)
    t = compiled(seen.shapes, starts, directions)
    again = np.isfinite(t)
    outside = (seen.facing == seen.normals).all(axis=-1) | np.array([[s.bounds() is None] for s in seen.shapes])
    assert (seen.hit & outside).sum() > 2000
    counted = again & seen.hit & outside
    if seen.shapes[0].title in CONCAVE:  # rays may hit another part of it
        for i, j in np.argwhere(counted).tolist():
            right = oracle.nearest(seen.shapes[i], starts[i, j], directions[i, j])
            counted[i, j] = right is None or t[i, j] < 0.5 * float(right)
    return int(counted.sum())


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.element.title)
@pytest.mark.parametrize(("size", "offset"), SCALES)
def test_no_ray_hits_the_surface_again_from_which_it_starts(kind: Kind, size: float, offset: float) -> None:
    assert acne(hits(kind, 1, size, offset, shapes=150), offsets) == 0


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.element.title)
@pytest.mark.parametrize("size", [1e-4, 1.0, 1e8])
def test_rays_start_close_to_the_surface(kind: Kind, size: float) -> None:
    assert_close(hits(kind, 3, size, 0.0), size, offsets)


def assert_close(seen: Hits, size: float, offset: Offset) -> None:
    reach = np.abs(seen.points).max(axis=-1) + size  # how far out the point is
    assert (offset(seen.points, seen.shapes)[..., 0] / reach)[seen.hit].max() <= 1e-13


def test_other_offsets_do_not_pass() -> None:
    sphere = KINDS[0]

    def fixed(points: Array, shapes: list[Shape]) -> Array:
        return np.full((*points.shape[:2], 1), 1e-4)

    def none(points: Array, shapes: list[Shape]) -> Array:
        return np.zeros((*points.shape[:2], 1))

    assert acne(hits(sphere, 1, 1e13, 0.0), fixed) > 100
    with pytest.raises(AssertionError):
        assert_close(hits(sphere, 3, 1e-4, 0.0), 1e-4, fixed)
    for kind in KINDS:
        assert acne(hits(kind, 1, 1.0, 0.0), none) > 100
