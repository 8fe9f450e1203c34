"""Table of all regimes of all shape types, with the backward errors and condition numbers of their hits."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from importlib import import_module
from importlib.util import find_spec
from typing import NamedTuple

import numpy as np

from minirt.shapes import KINDS, Kind
from minirt.shapes.torus import Torus
from tests.oracle.body import body
from tests.shapes.examples import example
from tests.shapes.execution_modes import on_arrays
from tests.shapes.regimes import Array
from tests.stability.common import common, stretched_regimes
from tests.stability.regime import BOUND, Regime, certified, normals_of


def own_regimes(kind: Kind) -> list[Regime]:
    """The regimes of one kind alone: `REGIMES` of the file in this folder that is named as the shape's, if any."""
    name = f"{__package__}.{kind.element.__module__.rpartition('.')[2]}"
    return list(import_module(name).REGIMES) if find_spec(name) else []


def regimes(kind: Kind) -> list[Regime]:
    """Return the regimes of a shape type: common ones, its own, and stretched ones for solids except tori."""
    plain = body(example(kind, np.random.default_rng(1))).solid and kind.element is not Torus
    return [*common(kind), *(stretched_regimes(kind) if plain else []), *own_regimes(kind)]


REGIMES = [(kind, regime) for kind in KINDS for regime in regimes(kind)]


class Figures(NamedTuple):
    """Certificates of the hits of a kind in a regime."""

    kind: str
    regime: str
    backward: Array
    condition: Array


def figures() -> Iterator[Figures]:
    """Certify the hits of all regimes."""
    for kind, regime in REGIMES:
        rays = regime.make()
        t = on_arrays(*rays)
        found = certified(rays, t, normals_of(rays, t))
        hit = np.isfinite(t)
        yield Figures(kind.element.title, regime.name, found.backward_error[hit], found.condition[hit])


def by_kind(found: Iterable[Figures]) -> Iterator[str]:
    """Yield the table of backward errors, a line for each kind."""
    yield "| shape | hits | bound | largest backward error | median |\n|---|---:|---:|---:|---:|"
    for kind in KINDS:
        errors = [each.backward for each in found if each.kind == kind.element.title]
        all_of = np.concatenate(errors)
        largest, median = all_of.max(), np.median(all_of)
        yield f"| {kind.element.title} | {len(all_of)} | {BOUND:g} | {largest:.1f} | {median:.2f} |"


def by_regime(found: Iterable[Figures]) -> Iterator[str]:
    """Yield the table of condition numbers, a line for each regime."""
    yield "| rays | shapes | condition: median | largest | backward error |\n|---|---|---:|---:|---:|"
    for name in dict.fromkeys(each.regime for each in found):
        some = [each for each in found if each.regime == name]
        condition, backward = (np.concatenate([each[i] for each in some]) for i in (3, 2))
        kinds = ", ".join(each.kind for each in some) if len(some) < len(KINDS) else "all"
        worst = f"{condition.max():.0e}" if np.isfinite(condition).all() else "infinite"
        yield f"| {name} | {kinds} | {np.median(condition):.2g} | {worst} | {backward.max():.1f} |"


def main() -> None:
    """Print both tables."""
    found = list(figures())
    print("\n".join([*by_kind(found), "", *by_regime(found)]))
