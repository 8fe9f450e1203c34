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
from tests.stability import mutants
from tests.stability.common import MODES
from tests.stability.degenerate import groups, wrong
from tests.stability.places import places, pose

KIND = pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.element.title)
SEED, SHAPES, RAYS = 5, 24, 256


def complaints(intersect: Intersect, kind: Kind, shapes: int = SHAPES) -> Iterator[str]:
    return (str(each) for group in groups(kind, SEED, shapes, RAYS) for each in wrong(intersect, *group, most=4))


@KIND
@pytest.mark.parametrize("mode", ["arrays", "traced"])
def test_rays_at_special_places_have_right_answers(kind: Kind, mode: str) -> None:
    assert not list(islice(complaints(MODES[mode], kind), 3))


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
    assert next(complaints(intersect, kind, 10 * SHAPES), "")
