"""Every formula in every regime, against 60 digits."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.shapes import Kind
from tests.stability.regime import Regime, posed
from tests.stability.table import REGIMES
from tests.stability.ways import WAYS


def label(value: object) -> str:
    return value.element.title if isinstance(value, Kind) else getattr(value, "name", str(value))


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize(("kind", "regime"), REGIMES, ids=label)
def test_hits_are_exact(kind: Kind, regime: Regime, way: str) -> None:
    intersect, every = WAYS[way]
    right = posed(regime)
    assert {type(shape) for shape in right.rays.shapes} == {kind.element}
    wrong = right.wrong(intersect(*right.rays), every)
    assert not wrong, f"{len(wrong)} of {right.t.size // every}, the first: {wrong[0]}"


@pytest.mark.parametrize(("kind", "regime"), REGIMES, ids=label)
def test_a_regime_has_rays_that_hit(kind: Kind, regime: Regime) -> None:
    assert np.isfinite(posed(regime).t).sum() >= 20
