"""Wrong formulas that look right do not pass."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import pytest
from numba import njit

import minirt.kernel.compiler.object_code  # noqa: F401  (registers what is compiled)
from minirt.kernel.compiler.pipeline import FLAGS
from minirt.shapes import KINDS, Kind
from tests.shapes.execution_modes import Intersect
from tests.stability import mutants
from tests.stability.regime import Regime, posed
from tests.stability.table import REGIMES


def regimes(kind: Kind, names: Iterable[str]) -> list[Regime]:
    found = [regime for other, regime in REGIMES if other is kind and regime.name in names]
    assert len(found) == len(set(names))
    return found


def errors(regime: Regime, intersect: Intersect) -> int:
    right = posed(regime)
    return len(right.wrong(intersect(*right.rays)))


@pytest.mark.parametrize("name", mutants.ANY)
@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.element.title)
def test_no_remedy_without_a_scale_passes(kind: Kind, name: str) -> None:
    intersect, failing = mutants.ANY[name]
    for regime in regimes(kind, failing):
        assert errors(regime, intersect) > 20


@pytest.mark.parametrize("kind", mutants.CARELESS, ids=lambda kind: kind.element.title)
def test_a_formula_that_knows_the_start_of_a_ray_no_better_than_rounding_does_not_pass(kind: Kind) -> None:
    assert errors(*regimes(kind, ["usual"]), mutants.as_of_a_shadow_ray) == 0
    for regime in regimes(kind, mutants.STARTS):
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


def test_guards_hold_with_the_flags_of_the_kernel() -> None:
    assert guarded(FLAGS)


def test_fastmath_does_not_pass() -> None:
    assert not guarded({**FLAGS, "fastmath": True})
