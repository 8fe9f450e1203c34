"""Views of a scene in place of its colours: the normals, depths and shapes that its pixels show."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from minirt.scene import Scene

VIEWS = ("", "normals", "depth", "ids")  # in the order in which a key goes through them; '' are colours


def next_view(view: str) -> str:
    return VIEWS[(VIEWS.index(view) + 1) % len(VIEWS)]


def view_pixels(scene: Scene, view: str, width: int, height: int) -> NDArray[np.uint8]:
    """Return the picture of a view, (h, w, 4) in the order blue, green, red, alpha."""
    from minirt.rendering.buffers import geometry

    levels = geometry(scene, width, height, has_uv=False).picture(view).array
    return np.insert(levels[..., ::-1], 3, 255, axis=-1)
