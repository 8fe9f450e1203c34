"""Every formula in every regime and at random sizes, against answers to 60 digits; wrong formulas do not pass."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numba import njit

import minirt
import minirt.kernel.compiler.object_code
from minirt.element import fields_of
from minirt.fields import Length, Lengths
from minirt.kernel.compiler.pipeline import FLAGS
from minirt.kernel.trace import ROUNDING
from minirt.rendering.packing.packed_shapes import bounding_boxes
from minirt.scene import Scene
from minirt.shapes import KINDS, Ellipsoid, Kind, Shape
from tests.oracle.body import body, normals
from tests.oracle.many import crossed
from tests.shapes.execution_modes import Intersect, compiled, on_arrays
from tests.shapes.regimes import Rays
from tests.stability import mutants
from tests.stability.common import EYE, MODES, common, interpreted, towards, traced
from tests.stability.degenerate import wrong_in
from tests.stability.regime import Array, Regime, U, rays_of, size
from tests.stability.table import REGIMES


def label(value: object) -> str:
    return value.element.title if isinstance(value, Kind) else getattr(value, "name", getattr(value, "__name__", ""))


Way = Callable[[Rays], tuple[Array, Array, Array]]
KIND = pytest.mark.parametrize("kind", KINDS, ids=label)
EACH = pytest.mark.parametrize(("kind", "regime"), REGIMES, ids=label)
SEED = st.integers(0, 2**32)
powers = partial(st.floats, allow_nan=False)  # of ten
fixed = partial(settings, deadline=None, derandomize=True)


@EACH
def test_hits_are_exact(kind: Kind, regime: Regime) -> None:
    rays = rays_of(regime)
    assert {type(shape) for shape in rays.shapes} == {kind.element}
    answers = [intersect(*rays) for intersect in MODES.values()]
    assert all(np.isfinite(t).sum() >= 20 for t in answers)
    wrong = wrong_in(regime, *answers)
    assert not wrong, f"{len(wrong)} of {np.size(answers)}, the first: {wrong[0]}"


@pytest.mark.parametrize("way", ["arrays", "compiled"])
@KIND
def test_usual_rays_are_exact_to_a_few_roundings(kind: Kind, way: str) -> None:
    (regime,) = regimes(kind, ["usual"])
    rays = rays_of(regime)
    exact = np.array([crossed(*each).nearest() for each in zip(*rays, strict=True)])
    hit = np.isfinite(exact)
    errors = np.abs(MODES[way](*rays)[hit] - exact[hit]) / exact[hit]
    assert np.sqrt((errors**2).mean()) <= 1e-15


@KIND
@fixed(max_examples=30)
@given(SEED, powers(-12, 12), powers(-3, 7), st.one_of(st.none(), powers(-2, 12)))
def test_hits_at_random_sizes_are_exact(kind: Kind, seed: int, size: float, far: float, offset: float | None) -> None:
    place = 0.0 if offset is None else min(10 ** (size + offset), 1e14)
    rays = towards(kind, seed, (10**far, 3 * 10**far), 10**size, place, count=1)
    regime = Regime("", lambda: rays)
    assert wrong_in(regime, on_arrays(*rays), compiled(*rays)) == []


@KIND
@fixed(max_examples=30)
@given(SEED, st.integers(-1000, 1000))
def test_the_length_of_a_direction_does_not_matter(kind: Kind, seed: int, power: int) -> None:
    (shape,), (origins,), (directions,) = towards(kind, seed, count=1)
    scene = Scene((EYE, shape))
    one, other = (minirt.trace(scene, origins, scale * directions) for scale in (1.0, 2.0**power))
    assert all(np.array_equal(a, b, equal_nan=True) for a, b in zip(one, other, strict=True))


def least(shape: Shape) -> float:
    """The least length of a shape: a normal turns over the surface in inverse proportion to it."""
    lengths = [np.min(getattr(shape, e.name)) for e in fields_of(type(shape)) if isinstance(e, (Length, Lengths))]
    return min(lengths, default=np.inf)


def off(shape: Shape, point: Array, normal: Array) -> tuple[float, float]:
    """Distance of a hit from the wall that its normal fits best, and the error of the normal."""
    found = normals(body(shape), list(point))
    errors = [float(np.linalg.norm(np.array(out, float) - normal)) for _, out in found]
    best = int(np.argmin(errors))
    return float(found[best][0]), errors[best]


@pytest.mark.parametrize("way", [interpreted, traced])
@pytest.mark.parametrize(("kind", "regime"), [(kind, each) for kind in KINDS for each in common(kind)], ids=label)
def test_hits_are_on_the_surface_and_normals_point_outwards(kind: Kind, regime: Regime, way: Way) -> None:
    rays = rays_of(regime)
    for shape, origins, directions, distances, points, found in zip(*rays, *way(rays), strict=True):
        for i in np.flatnonzero(np.isfinite(distances))[::5]:
            coordinates = np.abs(points[i]).max() + np.abs(bounding_boxes([shape])).max()
            distance, error = off(shape, points[i], found[i])
            # Rays leave from ROUNDING roundings above the point, which must be above the surface.
            assert distance <= ROUNDING / 2 * U * coordinates
            assert error <= 16 * U * (1 + coordinates / least(shape))
            moved = np.linalg.norm(points[i] - origins[i] - distances[i] * directions[i])
            assert moved <= 64 * U * (distances[i] + np.abs(origins[i]).max() + size(shape) + coordinates)


def regimes(kind: Kind, names: Iterable[str]) -> list[Regime]:
    found = [regime for other, regime in REGIMES if other is kind and regime.name in names]
    assert len(found) == len(set(names))
    return found


def errors(regime: Regime, intersect: Intersect) -> int:
    """Count wrong hits, of each shape the first few alone, since each is judged in 60 digits."""
    return len(wrong_in(regime, intersect(*rays_of(regime)), most=3))


@pytest.mark.parametrize("name", mutants.ANY)
@KIND
def test_no_remedy_without_a_scale_passes(kind: Kind, name: str) -> None:
    intersect, failing = mutants.ANY[name]
    for regime in regimes(kind, failing):
        assert errors(regime, intersect) > 8


@pytest.mark.parametrize("kind", mutants.CARELESS, ids=label)
def test_a_formula_that_knows_the_start_of_a_ray_no_better_than_rounding_does_not_pass(kind: Kind) -> None:
    assert errors(*regimes(kind, ["usual"]), mutants.as_of_a_shadow_ray) == 0
    for regime in regimes(kind, mutants.STARTS[: 2 if kind.element is Ellipsoid else 3]):
        assert errors(regime, mutants.as_of_a_shadow_ray) > 5
    for regime in regimes(kind, mutants.STARTS[:2]):
        assert errors(regime, mutants.hits_its_start) > 5


def guards(D: float, t: float) -> tuple[bool, bool, bool, float]:
    """The guards that formulas and renderer rely on: NaN is no hit, infinity is no nearer hit, and light that is NaN or
    infinite ends in [0, 1]."""
    hit = D >= 0.0
    nearer = t < np.inf
    light = t if t > 0.0 else 0.0
    return hit, not (D >= 0.0), nearer, light if light < 1.0 else 1.0


def guarded(flags: dict[str, Any]) -> bool:
    """Whether the guards hold when they are compiled with these flags."""
    compiled = njit(**flags)(guards)
    cases = [(np.nan, np.inf), (np.nan, np.nan), (np.inf, np.inf), (-1.0, -np.inf), (0.0, 0.5)]
    return all(compiled(*case) == guards(*case) for case in cases)


def test_guards_hold_with_the_flags_of_the_kernel_and_not_with_fastmath() -> None:
    assert guarded(FLAGS)
    assert not guarded({**FLAGS, "fastmath": True})
