"""Rays from the side of a cone, or from beside its apex, that a rounding takes to a wrong end.

Rays at special places found each of them, a few in a million. Every ray is tried in all 48 poses that permute and
negate coordinates, which no rounding disturbs.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import permutations, product

import numpy as np
import pytest

from minirt.fields import Triple
from minirt.shapes.cone import Cone
from tests.shapes.execution_modes import Array, Intersect
from tests.shapes.regimes import GREY
from tests.stability.degenerate import Wrong, wrong
from tests.stability.execution_modes import MODES
from tests.stability.wrong_starts import VARIANTS

DIAGONAL = 0.5**0.5 - 2.0**-53
RAYS: dict[str, tuple[Cone, Triple, Triple]] = {
    "from the rim beside a generator: it passes the apex 5e-10 off": (
        Cone((-3, 3, -3), (-1, 0, 0), 1, 0.5, GREY),
        (-3.5, 2.5, -3),
        (DIAGONAL, DIAGONAL, 7.071067804794406e-10),
    ),
    "from a few units in the last place off such a place": (
        Cone((-9, 3, -2), (0, 0, -1), 2, 1, GREY),
        (-8.999999999999993, 1.9999999999999987, -2.9999999999999987),
        (7.071067804794406e-10, DIAGONAL, DIAGONAL),
    ),
    "from the side next to the apex, along the axis": (
        Cone((5e-09, 9.000000000000001e-09, -6.000000000000001e-09), (1, 0, 0), 4e-09, 1e-09, GREY),
        (5.000000000000002e-09, 9.000000000000001e-09, -6.000000000000004e-09),
        (1, 0, 0),
    ),
    "from the side next to the apex, into the cone": (
        Cone((-7, -3, -2), (1, 0, 0), 5, 1.25, GREY),
        (-6.999999999999999, -2.9999999999999982, -2),
        (0.7978288025342568, 0.4789216007715009, 0.36620117717071443),
    ),
    "from the plane of the apex, within its rounding": (
        Cone((2e-09, -2e-09, 0), (0.8, 0.6, 0), 2e-09, 1e-09, GREY),
        (2e-09, -2e-09, 1.4881708671378342e-26),
        (0.9877619588255825, -0.14110885126079764, -0.0664424923742803),
    ),
}


def complaints(intersect: Intersect, name: str) -> Iterator[Wrong]:
    cone, origin, direction = RAYS[name]
    for order, signs in product(permutations(range(3)), product((-1.0, 1.0), repeat=3)):

        def posed(v: tuple[float, ...], order: tuple[int, ...] = order, signs: tuple[float, ...] = signs) -> Array:
            return np.array(v)[list(order)] * signs

        turned = cone.replace(apex=tuple(posed(cone.apex)), axis=tuple(posed(cone.axis)))
        yield from wrong(intersect, turned, posed(origin)[None], posed(direction)[None])


@pytest.mark.parametrize("mode", ["arrays", "numbers"])
@pytest.mark.parametrize("name", RAYS)
def test_rays_from_the_side_have_right_ends(name: str, mode: str) -> None:
    assert not [str(each) for each in complaints(MODES[mode][0], name)]


@pytest.mark.parametrize("name", RAYS)
def test_a_wrong_formula_of_starts_is_found(name: str) -> None:
    variants = VARIANTS["cone with a blurred start"], VARIANTS["cone with the formula of shadow rays"]
    assert any(next(complaints(intersect, name), None) for _, intersect in variants)
