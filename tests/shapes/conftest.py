"""Tests of formulas run in each of the three ways."""

from __future__ import annotations

import pytest

from tests.shapes.ways import WAYS, Intersect


@pytest.fixture(params=WAYS)
def way(request: pytest.FixtureRequest) -> Intersect:
    """`intersect` on single numbers, on arrays, and compiled."""
    return WAYS[request.param]
