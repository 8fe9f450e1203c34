"""What rays see that hit nothing: a colour, or a picture around the scene."""

from __future__ import annotations

from math import pi
from typing import Any, NamedTuple

from minirt.kernel.scene_arrays import SceneArrays
from minirt.kernel.shading.texture_lookup import texture_lookup
from minirt.lanes import Vec, any, maximum, minimum, splat, sqrt, where
from minirt.lanes.angle import arctan2
from minirt.lanes.operations import Mask
from minirt.lanes.vec import Number


class Environment(NamedTuple):
    """A picture of all directions, equirectangular: +z is its middle, +y its upper edge, -x to the right of +z."""

    texels: Any  # as in `minirt.kernel.shading.texturing`
    pictures: Any  # its only row


def background_light(scene: SceneArrays, hit: Mask, light: Vec, direction: Vec) -> Vec:
    """The light of rays that hit, and of the sky for those that do not."""
    if scene.background is not None:
        light = where(hit, light, Vec(scene.background[0], scene.background[1], scene.background[2]))
    if scene.environment is not None and any(~hit):
        light = where(hit, light, environment_lookup(scene.environment, direction))
    return light


def weighted_background(scene: SceneArrays, weight: Number, direction: Vec) -> Vec:
    """The light of the sky in a direction, times a weight."""
    nothing = splat(0.0, weight)
    dark = Vec(nothing, nothing, nothing)
    return where(weight > 0.0, weight * background_light(scene, weight < 0.0, dark, direction), dark)


def environment_lookup(dome: Environment, direction: Vec) -> Vec:
    """The light of a picture around the scene."""
    u, v = equirectangular(direction)
    edge = 0.5 / dome.pictures[0, 2]  # nothing is above the upper row of pixels
    return texture_lookup(dome.texels, dome.pictures, 0, u, minimum(maximum(v, edge), 1.0 - edge))


def equirectangular(direction: Vec) -> tuple[Number, Number]:
    """Where a direction is in such a picture: from 0 to 1 from left to right and from below to above."""
    u = 0.5 + arctan2(-direction.x, direction.z) * (0.5 / pi)
    v = 0.5 + arctan2(direction.y, sqrt(direction.x * direction.x + direction.z * direction.z)) * (1.0 / pi)
    return u, v
