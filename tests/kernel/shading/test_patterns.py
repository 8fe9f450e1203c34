"""Marble, wood and clouds: shares and slopes against the reference, frames of shapes, seams, and distance."""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np
import pytest

import minirt
from minirt.kernel.shading import patterns
from minirt.kernel.shading.patterns import CLOUDS, MARBLE, WOOD, share_and_slope
from minirt.lanes import Vec, load
from minirt.materials import Clouds, Marble, Wood
from minirt.rendering.packing.lights import Colours
from minirt.rendering.packing.materials import pack_patterns
from minirt.scene import Ambient, Camera, Scene
from minirt.shapes import Plane, Sphere
from tests.reference import texturing as reference
from tests.shapes.execution_modes import on_lanes, vec_lanes

NUMBERS = {Marble: MARBLE, Wood: WOOD, Clouds: CLOUDS}
EACH = pytest.mark.parametrize("kind", NUMBERS)
RANDOM = np.random.default_rng(1)
POINTS = RANDOM.uniform(-9, 9, (3, 1024))
FOOTPRINTS = np.where(np.arange(1024) % 2, RANDOM.uniform(0, 0.8, 1024), 0.0)
WHITE = (255, 255, 255)


def share_lanes(i: int, kind: Any, octaves: Any, p: Any, footprints: Any) -> Any:
    share, slope = share_and_slope(kind, octaves, vec_lanes(p, i), load(footprints, i))
    return share, slope.x, slope.y, slope.z


def compiled(kind: type, octaves: int, p: Any, footprints: Any) -> Any:
    """Return shares and slopes at points (3, n), (4, n)."""
    return on_lanes(share_lanes, 4, float(NUMBERS[kind]), octaves, p, footprints)


def interpreted(kind: type, octaves: int, p: Any, footprints: Any) -> Any:
    """Return the same by the plain formula."""
    share, slope = share_and_slope(NUMBERS[kind], octaves, Vec(*p), footprints)
    return np.stack([share, slope.x, slope.y, slope.z])


BOTH = pytest.mark.parametrize("shares_of", [interpreted, compiled])


def largest_difference(shares_of: Any, kind: Any, octaves: int = 6, dtype: Any = np.float64) -> float:
    """Return the largest difference of shares from those of the reference."""
    p, footprints = POINTS.astype(dtype), FOOTPRINTS.astype(dtype)
    expected = reference.share(kind(1.0, octaves=octaves), p.T.astype(np.float64), footprints.astype(np.float64))
    return float(np.abs(shares_of(kind, octaves, p, footprints)[0] - expected).max())


@EACH
@BOTH
@pytest.mark.parametrize("octaves", [1, 3, 6, 12])
def test_shares_are_those_of_the_reference(shares_of: Any, kind: Any, octaves: int) -> None:
    assert largest_difference(shares_of, kind, octaves) < 1e-10


@EACH
@BOTH
def test_shares_of_float32_are_nearly_those(shares_of: Any, kind: Any) -> None:
    assert largest_difference(shares_of, kind, dtype=np.float32) < 2e-3


@EACH
@BOTH
def test_shares_are_between_0_and_1_and_finite_for_rays_that_hit_nothing(shares_of: Any, kind: Any) -> None:
    for p in (1e3 * POINTS, 1e14 * POINTS, np.full((3, 32), np.nan)):
        footprints = np.full(p.shape[1], np.nan if np.isnan(p).any() else 0.0)
        with np.errstate(invalid="ignore"):
            shares = shares_of(kind, 6, p, footprints)[0]
        assert ((shares >= 0) & (shares <= 1)).all()


@EACH
def test_slopes_are_those_of_differences_of_50_digits(kind: Any) -> None:
    p, footprints = POINTS[:, :32], FOOTPRINTS[:32]
    with mpmath.workdps(50):
        exact = np.vectorize(mpmath.mpf, otypes=[object])(p.T)
        step = mpmath.mpf(10) ** -20
        for axis in range(3):
            aside = np.array([step if axis == i else mpmath.mpf(0) for i in range(3)], object)
            before, behind = (reference.share(kind(1.0), each, footprints) for each in (exact - aside, exact + aside))
            slope = ((behind - before) / (2 * step)).astype(float)
            for shares_of in (interpreted, compiled):
                found = shares_of(kind, 6, p, footprints)[1 + axis]
                assert np.abs(found - slope).max() < 1e-9 * max(1.0, np.abs(slope).max())
                assert np.abs(slope).max() > 0.1


ALL_PATTERNS = {"marble": Marble(0.7, (255, 0, 0)), "wood": Wood(0.5, (0, 255, 0)), "clouds": Clouds(0.9, (0, 0, 255))}


def floor_shares(kind: Any, x: np.ndarray, z: np.ndarray, footprints: np.ndarray) -> np.ndarray:
    """Return the shares of a floor at points."""
    floor = Plane((0, -2, 0), (0, 1, 0), WHITE)
    origin, axes = reference.frame(floor)
    p = (np.stack([x, np.full_like(x, -2.0), z], axis=-1) - origin) @ axes.T + (0, 3.5, 0)
    flat = np.ascontiguousarray(p.reshape(-1, 3).T)
    return np.asarray(compiled(kind, 6, flat, footprints.ravel())[0].reshape(x.shape))


def far_floor(kind: Any, rows: tuple[int, int], samples: int, pixel: float) -> np.ndarray:
    """Return the mean shares of pixels of a floor, `rows` below the horizon; a `pixel` of 0 fades no octave."""
    side = 0.7 / 48
    y, x = np.mgrid[rows[0] : rows[1], 0:96].astype(float)
    total = np.zeros_like(x)
    for i in range(samples):
        for j in range(samples):
            down, aside = side * (y + (i + 0.5) / samples), side * (x - 48 + (j + 0.5) / samples)
            t = 2.0 / down
            way = t * np.sqrt(1 + aside**2 + down**2)
            total += floor_shares(kind, aside * t, t, pixel * side * way / np.sqrt(2.0 / way))
    return total / samples**2


@EACH
def test_a_far_floor_has_its_mean_colour_and_no_moire(kind: Any) -> None:
    rows = 1, 4
    truth = far_floor(kind, rows, 32, 0.0)  # 1024 samples a pixel
    faded = far_floor(kind, rows, 1, 1.0)
    assert np.ptp(faded) < 0.02
    assert abs(faded.mean() - truth.mean()) < 0.02
    aliased = np.sqrt(np.mean((far_floor(kind, rows, 1, 0.0) - truth) ** 2))
    assert np.sqrt(np.mean((faded - truth) ** 2)) < 0.3 * aliased


@EACH
def test_many_samples_show_a_far_floor_as_it_is(kind: Any) -> None:
    """Octaves fade by the spacing of samples: by the width of pixels, the picture would not near the truth."""
    floor = Plane((0, -2, 0), (0, 1, 0), (0, 0, 0), **{kind.title: kind(1.0, WHITE)})
    camera = Camera((0, 0, 0), (0, 0, 1), 2 * np.degrees(np.arctan(0.7)))
    light = minirt.render(Scene((Ambient(1.0, WHITE), camera, floor)), 96, 16, samples=1024).linear[11:15, ::-1, 0]
    rows = 3, 7
    truth, faded = far_floor(kind, rows, 32, 0.0), far_floor(kind, rows, 32, 1.0)
    assert np.abs(light - truth).mean() < 0.3 * np.abs(faded - truth).mean()


def test_a_mesh_of_many_primitives_has_one_row() -> None:
    ball = Sphere((0, 0, 0), 1, WHITE, marble=Marble(1.0))
    shapes = [(1, ball), (3, ball.replace(**ALL_PATTERNS))]
    found = pack_patterns(shapes, 4, np.array([0, 1, 1, 2, 3]), {"patterns"}, Colours())
    assert found.ranges.tolist() == [[0, 0], [0, 1], [0, 1], [0, 0], [1, 4]]
    assert found.rows.shape == (4, patterns.COLUMNS)
    assert found.heights is None
