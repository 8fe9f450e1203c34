"""Rays that are hard for a square."""

from tests.stability.sheets import SQUARES as REGIMES
from tests.stability.sheets import of_square as places

__all__ = ["REGIMES", "places"]
