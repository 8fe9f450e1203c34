"""All regimes, by the kind of shape."""

from __future__ import annotations

from minirt.shapes import KINDS, Kind
from tests.stability import cylinder, plane, sphere
from tests.stability.common import common
from tests.stability.regime import Regime

OWN = {"sphere": sphere.REGIMES, "plane": plane.REGIMES, "cylinder": cylinder.REGIMES}
REGIMES: list[tuple[Kind, Regime]] = [
    (kind, regime) for kind in KINDS for regime in [*common(kind), *OWN.get(kind.element.title, [])]
]
