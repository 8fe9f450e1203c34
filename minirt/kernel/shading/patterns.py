"""Solid textures: marble, wood and clouds in the frame of a shape (Perlin, An Image Synthesizer, 1985).

A pattern gives each point of space a share from 0 to 1. By this share a second colour replaces that of the surface, and
the surface is raised, as a bump map raises it. A texture of space needs no coordinates on the surface: it has no seams.

The share follows from fractal noise: octaves of gradient noise, each twice as fine and half as high as the one before.
Octaves, veins and rings that are finer than the spacing of samples fade to their mean, as in Advanced RenderMan
(Apodaca and Gritz 1999): distant patterns neither flicker nor show a moire. A pattern with faded octaves has not quite
its own mean: more samples fade less, and references, which tell the error of other samples, fade nothing.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from minirt.kernel.scene_arrays import SceneArrays, has_rows, vector
from minirt.kernel.shading.lights import clamp_to_unit, smoothstep
from minirt.lanes import Number, Vec, any, copysign, dot, fabs, floor, inverse_root, maximum, splat, sqrt, unit, where
from minirt.lanes.mathematics import noise_and_gradient

SHARP, GONE = 0.2, 0.75  # footprints, in cells of the noise, at which an octave begins to fade and has faded
MEAN_FOLD = 0.218118  # mean of the absolute noise
SHIFT_X, SHIFT_Y, SHIFT_Z = 19.37, 6.13, 14.71  # cells from octave to octave: their cells have no corner in common
FINE = 2  # octaves from this one on are fine

# Lengths are in sizes of the pattern. Of the noise: cells of the first octave in a size, their stretch along the grain,
# and whether it is turbulence.
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

MARBLE, WOOD, CLOUDS = 0, 1, 2  # kinds of patterns
KIND, COLOUR, OCTAVES, PER_SIZE, ORIGIN, FRAME = 0, 1, 4, 5, 6, 9  # columns of `Patterns.rows`
COLUMNS = 18
FLATTEST = 2.0**-10  # least cosine between a ray and a normal for the footprint of a pixel
SPACING = 2  # column of the last row of `memory` with the distance of samples, in pixels


class Fractal(NamedTuple):
    """Fractal noise at some points."""

    total: Number  # the sum of all octaves
    slope: Vec  # its gradient
    fine: Number  # the sum of the fine octaves, all of the same height
    fine_slope: Vec


def fractal_noise(p: Vec, footprint: Number, octaves: int, frequency: float, stretch: float, fold: float) -> Fractal:
    """Sum octaves of noise at p. A cell of the first octave is 1 / `frequency` wide, and `stretch` times as long in z.

    With a `fold` of 1 the sum is turbulence: that of absolute values, less their mean; with 0 it is that of the noise.
    `footprint` is the distance of samples, in the unit of p: octaves that are too fine for it fade.
    """
    zero = splat(0.0, p.x)
    total, fine, slope, fine_slope = zero, zero, Vec(zero, zero, zero), Vec(zero, zero, zero)
    along, amplitude = frequency / stretch, 1.0  # `along`: the frequency along z
    for octave in range(octaves):
        kept = 1.0 - faded(footprint * frequency)
        if not any(kept > 0.0):
            break
        x, y, z = p.x * frequency, p.y * frequency, p.z * along
        noise, gradient = noise_and_gradient(Vec(x + SHIFT_X * octave, y + SHIFT_Y * octave, z + SHIFT_Z * octave))
        gradient = Vec(frequency * gradient.x, frequency * gradient.y, along * gradient.z)
        folded = noise + fold * (fabs(noise) - MEAN_FOLD - noise)
        total = total + (amplitude * kept) * folded
        slope = slope + (amplitude * kept * (1.0 + fold * (copysign(1.0, noise) - 1.0))) * gradient
        if octave >= FINE:
            fine = fine + kept * noise
            fine_slope = fine_slope + kept * gradient
        frequency, along, amplitude = 2.0 * frequency, 2.0 * along, 0.5 * amplitude
    return Fractal(total, slope, fine, fine_slope)


def faded(footprint: Number) -> Number:
    """Return how much of a wave is lost, from 0 to 1, to samples that are `footprint` wavelengths apart."""
    return smoothstep(clamp_to_unit((footprint - SHARP) * (1.0 / (GONE - SHARP))))


def marble(p: Vec, noise: Fractal, footprint: Number) -> tuple[Number, Vec]:
    """Veins one size apart, dark in their middle, that turbulence moves (Perlin 1985)."""
    phase = ACROSS_X * p.x + ACROSS_Y * p.y + ACROSS_Z * p.z + TURBULENCE * noise.total
    part = phase - floor(phase) - 0.5
    wave = clamp_to_unit(2.0 * fabs(part))  # 1 in the middle of a vein; 0 for NaN, which rays that hit nothing have
    vein = smoothstep(wave)
    second = vein * vein
    seventh = second * second * second * vein
    kept = 1.0 - faded(2.0 * footprint)
    share = MEAN_VEIN + kept * (SOFT * second + CRACK * (seventh * vein) - MEAN_VEIN)
    rise = kept * (2.0 * SOFT * vein + 8.0 * CRACK * seventh) * (6.0 * wave * (1.0 - wave)) * copysign(2.0, part)
    return share, rise * (Vec(ACROSS_X, ACROSS_Y, ACROSS_Z) + TURBULENCE * noise.slope)


def wood(p: Vec, noise: Fractal, footprint: Number) -> tuple[Number, Vec]:
    """Return the share of the dark colour of wood at p, and its gradient.

    Rings one size apart lie around the z axis. Each slowly becomes dark and then light again. Grain runs along z.
    """
    radius = sqrt(p.x * p.x + p.y * p.y)
    phase = radius + WARP * noise.total
    part = phase - floor(phase)
    growth = clamp_to_unit(part * (1.0 / EARLY))
    end = clamp_to_unit((part - EARLY) * (1.0 / (1.0 - EARLY)))
    early, late = smoothstep(growth), 1.0 - smoothstep(end)
    kept = 1.0 - faded(2.0 * footprint)
    share = LIGHT + RING * (MEAN_RING + kept * (early * early * late - MEAN_RING)) + GRAIN * noise.fine
    # Derivatives of early * early * late by the phase, where the ring becomes dark and where it becomes light.
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


class Patterns(NamedTuple):
    """The patterns of n shapes, k in all."""

    ranges: Any  # (n, 2) the patterns of a shape: its first row, and the row behind its last
    rows: Any  # (k, 18) kind, second colour, number of octaves, 1 / size, origin and three axes of the shape's frame
    heights: Any  # (k,) height of the second colour above the first, in scene units; None, or no rows, if all are 0


def apply_patterns(
    patterns: Any, index: int, point: Vec, footprint: Number, normal: Vec, colour: Vec
) -> tuple[Vec, Vec]:
    """Apply the patterns of shape `index`, one after the other, to its shading normals and colours at some points.

    `footprint` is the distance of samples on the surface.
    """
    if has_rows(patterns.ranges):
        for i in range(patterns.ranges[index, 0], patterns.ranges[index, 1]):
            row = patterns.rows[i]
            share, gradient = pattern_at(row, point, footprint)
            colour = colour + share * (vector(row, COLOUR) - colour)
            if has_rows(patterns.heights):
                normal = raised(normal, patterns.heights[i] * gradient)
    return normal, colour


def raised(normal: Vec, gradient: Vec) -> Vec:
    """Return the normal of a surface that is raised by a height with this gradient in space.

    Only the part of the gradient along the surface tilts it (Mikkelsen, Simulation of Wrinkled Surfaces Revisited,
    2008).
    """
    return unit(normal - (gradient - dot(gradient, normal) * normal))


def remember_spacing(scene: SceneArrays, memory: Any, samples: int, estimate: int) -> None:
    """Remember the distance, in pixels, of so many samples of a pixel; 0 for those of references, estimates after 0."""
    if scene.patterns is not None:
        memory[scene.lights.shape[0], SPACING] = 1.0 / sqrt(1.0 * samples) if estimate == 0 else 0.0


def pixel_footprint(camera: Any, point: Vec, t: Number, direction: Vec, normal: Vec) -> Number:
    """Return the width of a pixel on a surface that a ray meets after the distance t: of a square of the same area.

    The way of a ray that was mirrored is not known, but it is at least the distance of the point from the eye.
    """
    offset = point - vector(camera, 0)
    squared = maximum(t * t, dot(offset, offset)) / maximum(fabs(dot(normal, direction)), FLATTEST)
    right = vector(camera, 6)
    return sqrt(squared * dot(right, right))


def pattern_at(row: Any, point: Vec, footprint: Number) -> tuple[Number, Vec]:
    """Return the share of a pattern at some points, and its gradient; `footprint` is the distance of samples there."""
    per_size = row[PER_SIZE]
    x, y, z = vector(row, FRAME), vector(row, FRAME + 3), vector(row, FRAME + 6)
    offset = per_size * (point - vector(row, ORIGIN))
    p = Vec(dot(offset, x), dot(offset, y), dot(offset, z))
    share, slope = share_and_slope(row[KIND], int(row[OCTAVES]), p, per_size * footprint)
    return share, per_size * (slope.x * x + slope.y * y + slope.z * z)


def share_and_slope(kind: float, octaves: int, p: Vec, footprint: Number) -> tuple[Number, Vec]:
    """Return the share of a pattern of this `kind` at p, from 0 to 1, and its gradient there.

    p and `footprint`, the distance of samples, are in sizes of the pattern; p is in the frame of the shape.
    """
    if kind == MARBLE:
        frequency, stretch, fold = MARBLE_NOISE
    elif kind == WOOD:
        frequency, stretch, fold = WOOD_NOISE
    else:
        frequency, stretch, fold = CLOUD_NOISE
    fractal = fractal_noise(p, footprint, octaves, frequency, stretch, fold)
    if kind == MARBLE:
        return marble(p, fractal, footprint)
    if kind == WOOD:
        return wood(p, fractal, footprint)
    return clouds(fractal)
