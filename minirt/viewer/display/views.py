"""Views of a scene in place of its colours: the normals, depths and shapes that its pixels show."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from minirt.scene import Scene

STRIP = 2**16  # pixels that are traced at once: in some hundredths of a second
VIEWS = ("", "normals", "depth", "ids")  # in the order in which a key goes through them; '' are colours


def next_view(view: str) -> str:
    return VIEWS[(VIEWS.index(view) + 1) % len(VIEWS)]


def view_pixels(
    scene: Scene, view: str, width: int, height: int, is_wanted: Callable[[], bool] = lambda: True
) -> NDArray[np.uint8] | None:
    """Return the picture of a view, (h, w, 4) BGRA; None as soon as `is_wanted`, asked before each strip, is False."""
    from minirt.rendering.buffers import Buffers, geometry

    strips, rows = [], max(1, STRIP // width)
    for top in range(0, height, rows):
        if not is_wanted():
            return None
        strips.append(geometry(scene, width, height, rows=(top, min(top + rows, height))))
    levels = Buffers(*map(np.concatenate, zip(*strips, strict=True))).levels(view)
    return np.insert(levels[..., ::-1], 3, 255, axis=-1)
