"""Background of a scene: the colour or the environment map seen by rays that hit nothing."""

from __future__ import annotations

from math import pi
from typing import Any, NamedTuple

from minirt.kernel.scene_arrays import SceneArrays, has_rows
from minirt.kernel.shading.texture_lookup import texture_lookup
from minirt.lanes import Mask, Number, Vec, any, maximum, minimum, splat, sqrt, where
from minirt.lanes.mathematics import arctan2


class Environment(NamedTuple):
    """An equirectangular environment map: +z is in its middle, +y along its upper edge, -x to the right of +z."""

    texels: Any  # its pixels, as in `minirt.kernel.shading.texturing.SurfaceMaps`
    pictures: Any  # (1, 4) its layout, likewise


def has_environment(scene: SceneArrays) -> bool:
    """Whether a scene has an environment map."""
    return scene.environment is not None and has_rows(scene.environment.pictures)


def background_light(scene: SceneArrays, hit: Mask, radiance: Vec, direction: Vec) -> Vec:
    """Return `radiance` for rays that hit a shape, and the background's radiance for all other rays."""
    if scene.background is not None:
        radiance = where(hit, radiance, Vec(scene.background[0], scene.background[1], scene.background[2]))
    if scene.environment is not None and has_rows(scene.environment.pictures) and any(~hit):
        radiance = where(hit, radiance, environment_lookup(scene.environment, direction))
    return radiance


def weighted_background(scene: SceneArrays, weight: Number, direction: Vec) -> Vec:
    """Return the background's radiance times the weight of each ray; black for rays of weight 0."""
    zero = splat(0.0, weight)
    black = Vec(zero, zero, zero)
    return where(weight > 0.0, weight * background_light(scene, weight < 0.0, black, direction), black)


def environment_lookup(environment: Environment, direction: Vec) -> Vec:
    """Look up the radiance of an environment map in a direction."""
    u, v = equirectangular(direction)
    edge = 0.5 / environment.pictures[0, 2]  # no blending across the poles: nothing is above the upper row of pixels
    return texture_lookup(environment.texels, environment.pictures, 0, u, minimum(maximum(v, edge), 1.0 - edge))


def equirectangular(direction: Vec) -> tuple[Number, Number]:
    """Equirectangular projection of a direction: u from 0 at the left to 1 at the right, v from 0 below to 1 above."""
    u = 0.5 + arctan2(-direction.x, direction.z) * (0.5 / pi)
    v = 0.5 + arctan2(direction.y, sqrt(direction.x * direction.x + direction.z * direction.z)) * (1.0 / pi)
    return u, v
