"""Ablation: what each absent feature or kind of shape would cost, and what each list for culling saves."""

from __future__ import annotations

from math import nan
from typing import NamedTuple


class Part(NamedTuple):
    """Frame time and compile time with one part of the renderer added to, or taken from, what a scene uses."""

    sort: str  # "scene", "feature", "kind" or "list"
    name: str  # such as "mirrors and glass", "torus", "tiles"
    change: str  # "as it is", "added" or "without"
    frame_ms: float = nan  # of a picture with one sample per pixel, median
    percent: float = nan  # change of the frame time; median of the ratios of runs in turn
    percent_low: float = nan  # 95 % confidence interval
    percent_high: float = nan
    compile_s: float = nan  # NaN for a list, which needs no kernel of its own
    compile_percent: float = nan
    same: bool = True  # the picture is that of the scene as it is, bit for bit
    valid: bool = False  # False: failed, or other programs disturbed the times
    remark: str = ""
