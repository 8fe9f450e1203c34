"""The shapes of a scene as a guess reads its lines: other radii, lengths, axes and cones."""

from __future__ import annotations

import re
from contextlib import suppress
from functools import lru_cache
from math import hypot, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from minirt.compare.table import OURS, Guess
from minirt.scene import Camera, Scene
from minirt.scene.dialect_tables import CONES, Meanings
from minirt.shapes import Cone, Cylinder, Hyperboloid, Sphere

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]
SHAPES = "radius", "cylinder", "axis", "cone"  # parameters that change the shapes of the scene
LONG = "not normalised", "in the formula"  # of axes, whose length is not 1 then
WIDEST = 178.0  # degrees from side to side of a cone
CONE_CHANGES: Meanings = {
    "base": CONES["base"],
    "reversed": lambda cone, axis: {"axis": tuple(-np.array(axis))},
    "angle": lambda cone, axis: CONES["angle"](cone.replace(diameter=min(cone.diameter, WIDEST / 2)), axis),
    "whole angle": lambda cone, axis: CONES["angle"](cone.replace(diameter=min(cone.diameter, WIDEST) / 2), axis),
}


def as_written(element: Camera | Cone | Cylinder) -> tuple[float, float, float]:
    """Return the direction of an element as its line in the file has it, where it need not be of length 1."""
    with suppress(IndexError, ValueError):
        x, y, z = map(float, re.findall(r"\S+,\S+,\S+", element.source)[1].split(","))
        return x, y, z
    return element.direction if isinstance(element, Camera) else element.axis


def changed_scene(scene: Scene, guess: Guess) -> Scene:
    """Return the scene with shapes as the guess reads their lines; the last ones are kept."""
    if all(guess[name] == OURS[name] for name in SHAPES):
        return scene
    return edited(scene, *(guess[name] for name in SHAPES))


@lru_cache(64)
def edited(scene: Scene, radius: str, cylinder: str, axis: str, cone: str) -> Scene:
    """Return the scene with spheres, cylinders and cones as the values of a guess for the parameters SHAPES read them.

    Second halves of cones come behind all other shapes.
    """
    for shape in scene.shapes:
        new: Any = shape
        if isinstance(shape, Sphere) and radius in ("spheres", "all"):
            new = shape.replace(diameter=shape.diameter * 2)
        if isinstance(shape, Cone | Cylinder) and axis in LONG:
            new = lengthened(shape, hypot(*as_written(shape)), axis)
        if isinstance(shape, Cylinder):
            new = new.replace(**cylinder_changes(new, radius, cylinder, axis))
        if isinstance(shape, Cone) and cone in CONE_CHANGES:
            new = new.replace(**CONE_CHANGES[cone](new, new.axis))
        if new != shape:
            scene = scene.replace(shape, new)
        if isinstance(shape, Cone) and cone == "both halves":
            scene = scene.add(new.replace(axis=tuple(-np.array(new.axis))))
    return scene


def lengthened(shape: Cone | Cylinder, length: float, axis: str) -> Cone | Cylinder | Hyperboloid:
    """Return a shape as a formula draws it into which the axis goes with a length other than 1."""
    if axis == "not normalised":
        return shape.replace(height=shape.height * length)
    height = shape.height / length
    if isinstance(shape, Cone):  # (p . axis)^2 = p . p / (1 + slope^2)
        steepness = length**2 * (1 + (shape.diameter / 2 / shape.height) ** 2) - 1
        return shape.replace(height=height, diameter=2 * height * sqrt(steepness)) if steepness > 0 else shape
    if length < 1:
        return shape
    across = sqrt(shape.diameter**2 + (length**2 - 1) * height**2)  # p . p - (p . axis)^2 = radius^2
    return Hyperboloid(shape.centre, shape.axis, shape.diameter, across, height, shape.colour)


def cylinder_changes(shape: Cylinder | Hyperboloid, radius: str, cylinder: str, axis: str) -> dict[str, Any]:
    """Return the changed fields of a cylinder, as the values of a guess read them; other values change nothing."""
    x, y, z = shape.axis
    ways = {"upright": (0.0, 1.0, 0.0), "-x": (-x, y, z), "-z": (x, y, -z), "swapped": (z, y, x)}
    way, centre = np.array(ways.get(axis, shape.axis)), np.array(shape.centre)
    to_end = shape.height / 2 * way
    turned = rotation(np.array((0.0, 1.0, 0.0)), way) @ centre
    centres = {"base": centre + to_end, "top": centre - to_end, "turned": turned}
    return {
        "axis": tuple(way),
        "centre": tuple(centres.get(cylinder, centre)),
        "diameter": shape.diameter * (2 if radius in ("cylinders", "all") else 1),
        "height": shape.height * (2 if cylinder == "doubled" else 1),
    }


def rotation(axis: Floats, onto: Floats) -> Floats:
    """Return the matrix that turns an axis by the shortest way onto another."""
    x, y, z = np.cross(axis, onto)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    result: Floats = np.eye(3) + cross + cross @ cross / max(1 + float(axis @ onto), 1e-12)
    return result
