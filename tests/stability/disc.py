"""Rays that are hard for a disc."""

from tests.stability.sheets import DISCS as REGIMES

__all__ = ["REGIMES"]
