"""Table of all regimes of all shape types."""

from __future__ import annotations

import numpy as np

from minirt.shapes import KINDS, Kind
from minirt.shapes.torus import Torus
from tests.oracle.body import body
from tests.shapes.examples import example
from tests.stability import (
    box,
    cone,
    cylinder,
    hyperboloid,
    paraboloid,
    plane,
    sheets,
    sphere,
    stretched,
    torus,
    triangle,
)
from tests.stability.common import common
from tests.stability.regime import Regime

OWN = {
    "sphere": sphere.REGIMES,
    "plane": plane.REGIMES,
    "cylinder": cylinder.REGIMES,
    "cone": cone.REGIMES,
    "paraboloid": paraboloid.REGIMES,
    "hyperboloid": hyperboloid.REGIMES,
    "triangle": triangle.REGIMES,
    "square": sheets.SQUARES,
    "disc": sheets.DISCS,
    "box": box.REGIMES,
    "torus": torus.REGIMES,
}


def regimes(kind: Kind) -> list[Regime]:
    """Return the regimes of a shape type: common ones, stretched ones for solids, and its own."""
    plain = body(example(kind, np.random.default_rng(1))).solid and kind.element is not Torus
    return [*common(kind), *(stretched.regimes(kind) if plain else []), *OWN[kind.element.title]]


REGIMES = [(kind, regime) for kind in KINDS for regime in regimes(kind)]
