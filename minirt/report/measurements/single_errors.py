"""Error of float32, feature by feature."""

from __future__ import annotations

from collections.abc import Hashable, Iterator
from math import nan
from typing import Any, NamedTuple

import numpy as np

from minirt.element import fields_of
from minirt.materials import Attributes
from minirt.rendering import Renderer
from minirt.rendering.packing.features import ATTRIBUTES, FEATURES, NEEDS, PLAIN, features
from minirt.rendering.packing.generic_kernels import precision_of
from minirt.report.measurements.metrics import Picture, changed, clamped, rmse
from minirt.scene import Background, FurtherLight, Light, Scene, SpotLight
from minirt.shapes import Shape

NEEDS_DOUBLE = "always float64"
NO_KERNEL = "no kernel was compiled ahead of time"


class SingleError(NamedTuple):
    """Difference of float32 and float64 in a scene that is reduced to one feature, both with one sample per pixel."""

    feature: str  # in words, or "shapes alone"
    rmse: float = nan  # between the two pictures
    largest: float = nan  # difference of a channel of a pixel
    changed: float = nan  # pixels that differ in 8 bits
    remark: str = ""


def single_errors(scene: Scene, width: int, height: int, threads: int) -> Iterator[SingleError]:
    """Compare the precisions on the shapes of a scene alone, and with each feature that the scene uses."""
    used = features(scene)
    double, single = Renderer(threads), Renderer(threads, "single")
    for key in (None, *(feature for feature in FEATURES if feature in used)):
        yield single_error(reduced(scene, key), FEATURES[key] if key else "shapes alone", width, height, double, single)


def single_error(scene: Scene, words: str, width: int, height: int, double: Renderer, single: Renderer) -> SingleError:
    """Compare the precisions on a scene."""
    if precision_of(single.packing.pack(scene, width, height)) == "double":
        return SingleError(words, remark=NEEDS_DOUBLE)
    if not (double.is_ready(scene) and single.is_ready(scene)):
        return SingleError(words, remark=NO_KERNEL)
    one, other = (light(renderer, scene, width, height) for renderer in (double, single))
    return SingleError(words, rmse(one, other), float(np.abs(one - other).max()), changed(one, other))


def light(renderer: Renderer, scene: Scene, width: int, height: int) -> Picture:
    """Return the clamped light of a picture with one sample per pixel."""
    linear = np.zeros((height, width, 3))
    renderer.render(scene, np.zeros((height, width, 4), np.uint8), 1, linear)
    return clamped(linear)


def reduced(scene: Scene, feature: Hashable) -> Scene:
    """Return a scene with no other feature than the given one; None leaves the shapes alone."""
    return Scene((kept for each in scene.elements for kept in reduced_element(each, feature)), scene.file)


def reduced_element(element: Any, feature: Hashable) -> Iterator[Any]:
    """Yield an element without other features; a spot becomes a point light, and parallel light is left out."""
    match element:
        case Shape() if ATTRIBUTES(element) != PLAIN:
            fields = (field for field in fields_of(Attributes) if getattr(element, field.name) is not None)
            kept = {feature, "reflective"} if feature in NEEDS else {feature}
            others = [each.name for each in fields if each.feature_of(getattr(element, each.name)) not in kept]
            yield element.replace(**dict.fromkeys(others))
        case Background():
            if feature == ("environment" if isinstance(element.paint, str) else "background"):
                yield element
        case Light() | SpotLight() if feature != "spots" and (element.fade or isinstance(element, SpotLight)):
            yield FurtherLight(position=element.position, brightness=element.brightness, colour=element.colour)
        case _:
            if feature == "spots" or not hasattr(element, "direction") or hasattr(element, "position"):
                yield element
