"""Reflection and refraction by the interpreted kernel, in scenes with known radiance."""

from __future__ import annotations

import numpy as np
from mpmath import mp, mpf

from minirt.kernel.shading.surfaces import reflectance
from minirt.kernel.shading.whitted import MIN_WEIGHT
from minirt.rendering.packing.features import DEPTH
from minirt.scene import Ambient, Background, Camera, Scene
from minirt.shapes import Plane, Shape
from tests.kernel.pictures import Array, interpreted

WHITE, RED, GREY = (255, 255, 255), (255, 0, 0), (102, 102, 102)
LIGHT = Ambient(1.0, WHITE)
AHEAD = Camera((0, 0, -5), (0, 0, 1), 40)


def light(*elements: Shape | Camera | Ambient | Background, depth: int = DEPTH) -> Array:
    """Render the linear light of a small picture, (4, 4, 3)."""
    return interpreted(Scene(elements), 4, 4, depth=depth)[1]


def test_two_facing_mirrors_sum_a_geometric_series() -> None:
    # Seen along the normals: every mirror shows half of its own light and half of the light from the other mirror.
    ends = [Plane((0, 0, z), (0, 0, 1), GREY, mirror=0.5) for z in (-6, 6)]
    for depth in (0, 1, 2, 5):
        expected = 0.4 * sum(0.5**i * 0.5 for i in range(depth + 1)) if depth else 0.4
        assert np.allclose(light(LIGHT, AHEAD, *ends, depth=depth), expected, rtol=1e-13)
    deep = light(LIGHT, AHEAD, *ends, depth=32)
    assert np.allclose(deep, 0.4, atol=2 * MIN_WEIGHT)
    assert (deep < 0.4).all()  # rays below the cut-off weight are not traced


def transmittance(cosine: float, before: float, behind: float) -> float:
    """Share of the light that is refracted, from the amplitudes of the refracted waves, with 50 digits."""
    with mp.workdps(50):
        c, m, n = mpf(cosine), mpf(before), mpf(behind)
        squared = 1 - (m / n) ** 2 * (1 - c * c)
        if squared <= 0:
            return 0.0
        there = mp.sqrt(squared)
        across, along = 2 * m * c / (m * c + n * there), 2 * m * c / (n * c + m * there)
        return float(n * there / (m * c) * (across**2 + along**2) / 2)


def test_what_is_not_refracted_is_reflected() -> None:
    cosines = np.cos(np.radians([0, 1, 20, 41, 45, 60, 75, 89, 89.999]))
    for n in (1.0, 1.1, 1.33, 1.5, 2.42, 10.0):
        for before, behind in ((1.0, n), (n, 1.0)):
            expected = [1 - transmittance(c, before, behind) for c in cosines]
            assert np.abs(reflectance(cosines, before / behind) - expected).max() < 1e-13


WHITE_WALL, BRIGHT_SKY = (255, 255, 255), Background((51, 102, 204))
