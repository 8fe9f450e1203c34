"""Tests of formulas run in each of the three ways."""

from __future__ import annotations

import pytest

from tests.shapes.execution_modes import MODES, Intersect


@pytest.fixture(params=MODES)
def way(request: pytest.FixtureRequest) -> Intersect:
    """`intersect` on single numbers, on arrays, and compiled."""
    return MODES[request.param]
