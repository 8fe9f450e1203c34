"""Error images: the error of each pixel as a heat map."""

from __future__ import annotations

import numpy as np

from minirt.image import Image
from minirt.report.measurements.metrics import Picture

LEAST = 1e-4  # errors up to this are black; an error of 1, black against white, is white
HEAT = np.array([[0, 0, 0], [40, 20, 120], [190, 30, 80], [250, 150, 20], [255, 255, 255]])  # one colour a decade


def error_image(picture: Picture, reference: Picture) -> Image:
    """Map the largest error of the three channels of each pixel to a colour, on a logarithmic scale."""
    error = np.abs(picture - reference).max(axis=-1)
    heat = np.log10(np.maximum(error, LEAST) / LEAST)
    return Image(np.stack([np.interp(heat, range(len(HEAT)), part) for part in HEAT.T], axis=-1).astype(np.uint8))
