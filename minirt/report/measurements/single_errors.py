"""Error of float32, feature by feature."""

from __future__ import annotations

from math import nan
from typing import NamedTuple


class SingleError(NamedTuple):
    """Difference of float32 and float64 in a scene that is reduced to one feature."""

    feature: str  # in words; "shapes" alone, or "all" features of the scene
    rmse: float = nan  # between the two pictures, which have the same samples
    largest: float = nan  # difference of a channel of a pixel
    changed: float = nan  # pixels that differ in 8 bits
    remark: str = ""
