"""The background of another ray tracer: one colour, or a gradient from below to above."""

from __future__ import annotations

import numpy as np

from minirt.compare.geometry import Floats
from minirt.scene import Scene


def background(scene: Scene) -> Floats:
    """Return the background of a scene, (2, 3) from 0 to 1: colour at the horizon, and what is added straight up."""
    paint = scene.background.paint if scene.background else (0, 0, 0)
    return np.array([np.zeros(3) if isinstance(paint, str) else np.array(paint) / 255, np.zeros(3)])


def found_sky(scene: Scene, ways: Floats, theirs: Floats, form: str) -> Floats:
    """Return the background, as `background` does, that explains the colours of rays that meet no shape."""
    if form == "as given" or not len(theirs):
        return background(scene)
    if form == "own":
        return np.array([np.median(theirs, axis=0), np.zeros(3)])
    sky, *_ = np.linalg.lstsq(np.stack([np.ones(len(ways)), ways[:, 1]], axis=1), theirs, rcond=None)
    return sky.astype(np.float64)
