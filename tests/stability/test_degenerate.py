"""Rays at the special places of every shape, exactly and to a few units in the last place, have right answers.

A few thousand for each kind; `python -m tests.stability` tries a million.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice

import numpy as np
import pytest

from minirt.shapes import KINDS, Kind
from tests.shapes.execution_modes import Intersect
from tests.shapes.regimes import Rays
from tests.stability import mutants
from tests.stability.common import MODES
from tests.stability.degenerate import groups, wrong_of
from tests.stability.places import places, pose

KIND = pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.element.title)
SEED, SHAPES, RAYS = 5, 24, 256


def complaints(kind: Kind, *ways: Intersect, shapes: int = SHAPES) -> Iterator[str]:
    """Complaints about the answers of several ways to intersect, which are judged at once."""
    for shape, *rays in groups(kind, SEED, shapes, RAYS):
        given = Rays([shape], *(part[None] for part in rays))
        yield from map(str, wrong_of(given, *(intersect(*given) for intersect in ways), most=4))


@KIND
def test_rays_at_special_places_have_right_answers(kind: Kind) -> None:
    assert not list(islice(complaints(kind, MODES["arrays"], MODES["traced"]), 3))


@KIND
def test_every_kind_declares_its_special_places(kind: Kind) -> None:
    random = np.random.default_rng(1)
    for place in places(pose(kind, random)):
        points = place.points(random, 64)
        assert points.shape == place.ways(random, points).shape == (64, 3), place.name
        assert np.isfinite(points).all(), place.name


@pytest.mark.parametrize("name", mutants.VARIANTS)
def test_a_wrong_formula_is_found(name: str) -> None:
    title, intersect = mutants.VARIANTS[name]
    kind = next(each for each in KINDS if each.element.title == title)
    assert next(complaints(kind, intersect, shapes=10 * SHAPES), "")
