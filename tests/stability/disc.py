"""Rays that are hard for a disc."""

from tests.stability.sheets import DISCS as REGIMES
from tests.stability.sheets import of_disc as places

__all__ = ["REGIMES", "places"]
