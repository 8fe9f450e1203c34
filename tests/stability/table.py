"""All regimes of all kinds of shapes."""

from __future__ import annotations

from minirt.shapes import KINDS, Kind, Torus
from tests.stability.common import common, is_solid, stretched_regimes
from tests.stability.places import files
from tests.stability.regime import Regime


def own_regimes(kind: Kind) -> list[Regime]:
    """The regimes of one kind alone, from `REGIMES` of the files in this folder."""
    return [regime for file in files(kind) for regime in getattr(file, "REGIMES", {}).get(kind.element, [])]


def regimes(kind: Kind) -> list[Regime]:
    """Return the regimes of a shape type: common ones, its own, and stretched ones for solids except tori."""
    plain = is_solid(kind) and kind.element is not Torus
    return [*common(kind), *(stretched_regimes(kind) if plain else []), *own_regimes(kind)]


REGIMES = [(kind, regime) for kind in KINDS for regime in regimes(kind)]
