"""Fractal noise: octaves of gradient noise, each twice as fine and half as high as the one before.

Octaves that are finer than a pixel fade to their mean, as in Advanced RenderMan (Apodaca and Gritz 1999): distant
patterns neither flicker nor show a moire.
"""

from __future__ import annotations

from typing import NamedTuple

from minirt.kernel.shading.lights import clamp_to_unit, smoothstep
from minirt.lanes import Number, Vec, any, copysign, fabs, splat
from minirt.lanes.mathematics import noise_and_gradient

SHARP, GONE = 0.2, 0.75  # footprints, in cells of the noise, at which an octave begins to fade and has faded
MEAN_FOLD = 0.218118  # mean of the absolute noise
SHIFT_X, SHIFT_Y, SHIFT_Z = (
    19.37,
    6.13,
    14.71,
)  # cells from octave to octave, so that their cells have no corner in common
FINE = 2  # octaves from this one on are fine


class Fractal(NamedTuple):
    """Fractal noise at some points."""

    total: Number  # the sum of all octaves
    slope: Vec  # its gradient
    fine: Number  # the sum of the fine octaves, all of the same height
    fine_slope: Vec


def fractal_noise(p: Vec, footprint: Number, octaves: int, frequency: float, stretch: float, fold: float) -> Fractal:
    """Sum octaves of noise at p. A cell of the first one is 1 / `frequency` wide, and along z `stretch` times as long.

    With a `fold` of 1 it is turbulence: the sum of absolute values, less their mean. `footprint` is the width of a
    pixel.
    """
    zero = splat(0.0, p.x)
    total, fine, slope, fine_slope = zero, zero, Vec(zero, zero, zero), Vec(zero, zero, zero)
    along, amplitude = frequency / stretch, 1.0
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
    """Return how much of a wave is lost, from 0 to 1, to a pixel that is `footprint` wavelengths wide."""
    return smoothstep(clamp_to_unit((footprint - SHARP) * (1.0 / (GONE - SHARP))))
