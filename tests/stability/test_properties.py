"""Properties of hits for all sizes of shapes, distances of the eye and places of the scene."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import minirt
from minirt.scene import Camera, Scene
from minirt.shapes import KINDS, Kind
from tests.shapes.execution_modes import compiled, on_arrays
from tests.stability.common import towards
from tests.stability.regime import Regime, Right

EYE = Camera((0, 0, 0), (0, 0, 1), 60)
KIND = pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.element.title)
SEED = st.integers(0, 2**32)
powers = partial(st.floats, allow_nan=False)  # of ten
fixed = partial(settings, deadline=None, derandomize=True)


@KIND
@fixed(max_examples=60)
@given(SEED, powers(-12, 12), powers(-3, 7), st.one_of(st.none(), powers(-2, 12)))
def test_hits_are_exact(kind: Kind, seed: int, size: float, far: float, offset: float | None) -> None:
    place = 0.0 if offset is None else min(10 ** (size + offset), 1e14)
    rays = towards(kind, seed, (10**far, 3 * 10**far), 10**size, place, count=1)
    right = Right(Regime("", lambda: rays, tolerance=1e-14, blur=np.inf), rays)
    assert right.wrong(on_arrays(*rays)) == []
    assert right.wrong(compiled(*rays)) == []


@KIND
@fixed(max_examples=60)
@given(SEED, st.integers(-1000, 1000))
def test_the_length_of_a_direction_does_not_matter(kind: Kind, seed: int, power: int) -> None:
    (shape,), (origins,), (directions,) = towards(kind, seed, count=1)
    scene = Scene((EYE, shape))
    one, other = (minirt.trace(scene, origins, scale * directions) for scale in (1.0, 2.0**power))
    assert all(np.array_equal(a, b, equal_nan=True) for a, b in zip(one, other, strict=True))
