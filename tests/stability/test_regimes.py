"""Every formula in every regime, against answers to 60 digits."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.shapes import KINDS, Kind
from tests.shapes.execution_modes import compiled
from tests.stability.common import MODES
from tests.stability.regime import Regime, away_from_surface, posed
from tests.stability.table import REGIMES


def label(value: object) -> str:
    return value.element.title if isinstance(value, Kind) else getattr(value, "name", str(value))


@pytest.mark.parametrize("way", MODES)
@pytest.mark.parametrize(("kind", "regime"), REGIMES, ids=label)
def test_hits_are_exact(kind: Kind, regime: Regime, way: str) -> None:
    intersect, every = MODES[way]
    right = posed(regime)
    assert {type(shape) for shape in right.rays.shapes} == {kind.element}
    wrong = right.wrong(intersect(*right.rays), every)
    assert not wrong, f"{len(wrong)} of {right.t.size // every}, the first: {wrong[0]}"


@pytest.mark.parametrize(("kind", "regime"), REGIMES, ids=label)
def test_compiled_formulas_hold_the_backward_bound(kind: Kind, regime: Regime) -> None:
    rays = posed(regime).rays
    away = away_from_surface(rays, compiled(*rays))
    assert not away, f"{len(away)}, the first: {away[0]}"


@pytest.mark.parametrize(("kind", "regime"), REGIMES, ids=label)
def test_a_regime_has_rays_that_hit(kind: Kind, regime: Regime) -> None:
    assert np.isfinite(posed(regime).t).sum() >= 20


@pytest.mark.parametrize("way", ["arrays", "compiled"])
@pytest.mark.parametrize("kind", KINDS, ids=label)
def test_usual_rays_are_exact_to_a_few_roundings(kind: Kind, way: str) -> None:
    right = posed(next(regime for other, regime in REGIMES if (other, regime.name) == (kind, "usual")))
    t = MODES[way][0](*right.rays)
    hit = np.isfinite(right.t)
    errors = np.abs(t[hit] - right.t[hit]) / right.t[hit]
    assert np.sqrt((errors**2).mean()) <= 1e-15
