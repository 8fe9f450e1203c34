"""Table of all regimes of all shape types, with the backward errors of their hits."""

from __future__ import annotations

import numpy as np

from minirt.shapes import KINDS, Kind
from minirt.shapes.torus import Torus
from tests.oracle.body import body
from tests.shapes.examples import example
from tests.shapes.execution_modes import on_arrays
from tests.stability.common import common, stretched_regimes
from tests.stability.places import files
from tests.stability.regime import BOUND, Regime, certified, normals_of


def own_regimes(kind: Kind) -> list[Regime]:
    """The regimes of one kind alone, from `REGIMES` of the files in this folder."""
    return [regime for file in files(kind) for regime in getattr(file, "REGIMES", {}).get(kind.element, [])]


def regimes(kind: Kind) -> list[Regime]:
    """Return the regimes of a shape type: common ones, its own, and stretched ones for solids except tori."""
    plain = body(example(kind, np.random.default_rng(1))).solid and kind.element is not Torus
    return [*common(kind), *(stretched_regimes(kind) if plain else []), *own_regimes(kind)]


REGIMES = [(kind, regime) for kind in KINDS for regime in regimes(kind)]


def main() -> None:
    """Print the table of backward errors, a line for each kind."""
    print("| shape | hits | bound | largest backward error | median |\n|---|---:|---:|---:|---:|")
    for kind in KINDS:
        found = []
        for rays in (regime.make() for other, regime in REGIMES if other is kind):
            t = on_arrays(*rays)
            found.append(certified(rays, t, normals_of(rays, t)).backward_error[np.isfinite(t)])
        errors = np.concatenate(found)
        print(f"| {kind.element.title} | {len(errors)} | {BOUND:g} | {errors.max():.1f} | {np.median(errors):.2f} |")
