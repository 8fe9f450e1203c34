"""Fixture that runs a test of formulas in each of the three execution modes."""

from __future__ import annotations

import pytest

from tests.shapes.execution_modes import MODES, Intersect


@pytest.fixture(params=MODES)
def intersect(request: pytest.FixtureRequest) -> Intersect:
    """`intersect` on single numbers, on arrays, and compiled."""
    return MODES[request.param]
