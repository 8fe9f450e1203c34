"""Pictures that are hard on a format: bright, dark and black light, noise, slopes, even areas, odd sizes."""

from __future__ import annotations

import numpy as np

from minirt.rendering.image import Image

SIZES = ((1, 1), (5, 7), (33, 40), (18, 301), (3, 9))  # height, width: of one block of 16 lines, and of several


def light(height: int, width: int) -> np.ndarray:
    """Return light from 0 to 3e4: noise above, an even area, a slope below, black in a corner."""
    random = np.random.default_rng(height * width)
    made = 3e4 ** random.uniform(-1.2, 1, (height, width, 3))
    made[height // 3 :] = (0.25, 0.5, 3.0)
    made[2 * height // 3 :] = np.linspace(0, 1.2, width)[None, :, None]
    made[-1:, :2] = 0
    return made


def picture(height: int, width: int, tone: str = "plain") -> Image:
    """Return a picture with such light; its levels are those of the plain tone."""
    made = light(height, width)
    return Image((np.clip(made, 0, 1) * 255 + 0.5).astype(np.uint8), made, None, tone)
