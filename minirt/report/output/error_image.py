"""Pictures of errors."""

from __future__ import annotations

import numpy as np

from minirt.image import Image
from minirt.report.measurements.metrics import Picture

LEAST = 1e-4  # the error that is still black; white is 1, the difference of black and white
HEAT = np.array([[0, 0, 0], [40, 20, 120], [190, 30, 80], [250, 150, 20], [255, 255, 255]])  # a factor of 10 each


def error_picture(picture: Picture, reference: Picture) -> Image:
    """The largest error of the three colours of each pixel, on a logarithmic scale of heat."""
    error = np.abs(picture - reference).max(axis=-1)
    heat = np.log10(np.maximum(error, LEAST) / LEAST)
    return Image(np.stack([np.interp(heat, range(len(HEAT)), part) for part in HEAT.T], axis=-1).astype(np.uint8))
