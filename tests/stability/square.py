"""Rays that are hard for a square."""

from tests.stability.sheets import SQUARES as REGIMES

__all__ = ["REGIMES"]
