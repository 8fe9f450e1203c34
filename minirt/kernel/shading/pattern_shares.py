"""Marble, wood and clouds: the share of the second colour from fractal noise, and its gradient.

Lengths are in sizes of the pattern. Veins and rings that are finer than a pixel fade to their mean, as octaves do.
"""

from __future__ import annotations

from minirt.kernel.shading.fractal_noise import Fractal, faded
from minirt.kernel.shading.lights import clamp_to_unit, smoothstep
from minirt.lanes import Number, Vec, copysign, fabs, floor, inverse_root, minimum, sqrt, where

# Of the noise: cells of the first octave in a size, their stretch along the grain, and whether it is turbulence.
MARBLE_NOISE = 0.35, 1.0, 1.0
WOOD_NOISE = 0.25, 12.0, 0.0
CLOUD_NOISE = 0.5, 1.0, 0.0

ACROSS_X, ACROSS_Y, ACROSS_Z = 0.8, 0.5, 0.33  # direction across the veins of marble, about a unit vector
TURBULENCE = 2.0  # of the veins, in their distance
SOFT, CRACK = 0.35, 0.65  # shares of the soft and of the dark part of a vein
MEAN_VEIN = SOFT * 13.0 / 35.0 + CRACK * 386119.0 / 2042975.0

WARP = 1.2  # of the rings of wood, in their distance
EARLY = 0.8  # share of a ring in which it becomes darker
LIGHT, RING, GRAIN = 0.2, 0.55, 0.17  # share of the second colour at least, in late wood in addition, and by the grain
MEAN_RING = EARLY * 13.0 / 35.0 + (1.0 - EARLY) * 0.5

CONTRAST = 3.5  # of clouds


def marble(p: Vec, noise: Fractal, footprint: Number) -> tuple[Number, Vec]:
    """Veins one size apart, dark in their middle, that turbulence moves (Perlin 1985)."""
    phase = ACROSS_X * p.x + ACROSS_Y * p.y + ACROSS_Z * p.z + TURBULENCE * noise.total
    part = phase - floor(phase) - 0.5
    wave = minimum(2.0 * fabs(part), 1.0)  # 1 in the middle of a vein, and for NaN, which rays that hit nothing have
    vein = smoothstep(wave)
    second = vein * vein
    seventh = second * second * second * vein
    kept = 1.0 - faded(2.0 * footprint)
    share = MEAN_VEIN + kept * (SOFT * second + CRACK * (seventh * vein) - MEAN_VEIN)
    rise = kept * (2.0 * SOFT * vein + 8.0 * CRACK * seventh) * (6.0 * wave * (1.0 - wave)) * copysign(2.0, part)
    return share, rise * (Vec(ACROSS_X, ACROSS_Y, ACROSS_Z) + TURBULENCE * noise.slope)


def wood(p: Vec, noise: Fractal, footprint: Number) -> tuple[Number, Vec]:
    """Rings one size apart around z: each slowly becomes dark and then light again; and grain along z."""
    radius = sqrt(p.x * p.x + p.y * p.y)
    phase = radius + WARP * noise.total
    part = phase - floor(phase)
    growth = minimum(part * (1.0 / EARLY), 1.0)
    end = clamp_to_unit((part - EARLY) * (1.0 / (1.0 - EARLY)))
    early, late = smoothstep(growth), 1.0 - smoothstep(end)
    kept = 1.0 - faded(2.0 * footprint)
    share = LIGHT + RING * (MEAN_RING + kept * (early * early * late - MEAN_RING)) + GRAIN * noise.fine
    rise = 12.0 / EARLY * early * late * growth * (1.0 - growth)
    fall = 6.0 / (1.0 - EARLY) * early * early * end * (1.0 - end)
    per_radius = 1.0 / where(radius == 0.0, 1.0, radius)
    outward = Vec(p.x * per_radius, p.y * per_radius, 0.0)
    slope = RING * kept * (rise - fall) * (outward + WARP * noise.slope) + GRAIN * noise.fine_slope
    inside = (share > 0.0) & (share < 1.0)
    return clamp_to_unit(share), where(inside, 1.0, 0.0) * slope


def clouds(noise: Fractal) -> tuple[Number, Vec]:
    """Soft clouds: the noise with more contrast in the middle, and less towards 0 and 1, which it never reaches."""
    cover = CONTRAST * noise.total
    per_length = inverse_root(1.0 + cover * cover)
    rise = 0.5 * CONTRAST * (per_length * per_length * per_length)
    return clamp_to_unit(0.5 + 0.5 * (cover * per_length)), rise * noise.slope
