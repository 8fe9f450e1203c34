"""Table of all regimes of all shape types."""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec

import numpy as np

from minirt.shapes import KINDS, Kind
from minirt.shapes.torus import Torus
from tests.oracle.body import body
from tests.shapes.examples import example
from tests.stability import stretched
from tests.stability.common import common
from tests.stability.regime import Regime


def own_regimes(kind: Kind) -> list[Regime]:
    """The regimes of one kind alone: `REGIMES` of the file in this folder that is named as the shape's, if any."""
    name = f"{__package__}.{kind.element.__module__.rpartition('.')[2]}"
    return list(import_module(name).REGIMES) if find_spec(name) else []


def regimes(kind: Kind) -> list[Regime]:
    """Return the regimes of a shape type: common ones, its own, and stretched ones for solids except tori."""
    plain = body(example(kind, np.random.default_rng(1))).solid and kind.element is not Torus
    return [*common(kind), *(stretched.regimes(kind) if plain else []), *own_regimes(kind)]


REGIMES = [(kind, regime) for kind in KINDS for regime in regimes(kind)]
