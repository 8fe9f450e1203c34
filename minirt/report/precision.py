"""Error of float32, feature by feature."""

from __future__ import annotations

from collections.abc import Hashable, Iterator
from math import nan
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import NDArray

from minirt.element import Element
from minirt.rendering import Renderer
from minirt.rendering.packing.camera import camera_numbers
from minirt.rendering.packing.features import NEEDS, WORDS, features
from minirt.rendering.packing.generic_kernels import precision_of
from minirt.rendering.queries.rays import Hits, trace
from minirt.report.metrics import changed, clamped, rmse
from minirt.report.variants import with_materials
from minirt.scene import Background, FurtherLight, Lamp, Scene
from minirt.shapes import ALL_KINDS, Kind

NEEDS_DOUBLE = "always float64"
NO_KERNEL = "no kernel was compiled ahead of time"


class SingleError(NamedTuple):
    """Difference of float32 and float64 in a scene that is reduced to one feature, both with one sample per pixel."""

    feature: Annotated[str, "feature"]  # in words, or "shapes alone"
    rmse: Annotated[float, "RMSE", ".1e"] = nan  # between the two pictures
    largest: Annotated[float, "largest difference", ".1e"] = nan  # of a channel of a pixel
    changed: Annotated[float, "changed pixels", ".0f"] = nan  # in 8 bits
    remark: Annotated[str, "remark"] = ""


def single_errors(scene: Scene, width: int, height: int, threads: int) -> Iterator[SingleError]:
    """Compare the precisions on the shapes of a scene alone, and with each feature that the scene uses."""
    used = features(scene)
    both = Renderer(threads), Renderer(threads, "single")
    for key in (None, *(feature for feature in WORDS if feature in used)):
        yield single_error(reduced(scene, key), WORDS[key] if key else "shapes alone", width, height, *both)


def single_error(scene: Scene, words: str, width: int, height: int, *renderers: Renderer) -> SingleError:
    """Compare the precisions, by a renderer in each, on a scene."""
    if precision_of(renderers[-1].packing.pack(scene, width, height)) == "double":
        return SingleError(words, remark=NEEDS_DOUBLE)
    if not all(each.is_ready(scene) for each in renderers):
        return SingleError(words, remark=NO_KERNEL)
    lights, pixels = np.zeros((2, height, width, 3)), np.zeros((height, width, 4), np.uint8)
    for renderer, light in zip(renderers, lights, strict=True):
        renderer.render(scene, pixels, 1, light)
    one, other = clamped(lights)
    return SingleError(words, rmse(one, other), float(np.abs(one - other).max()), changed(one, other))


def reduced(scene: Scene, feature: Hashable) -> Scene:
    """Return a scene with no other feature than the given one; None leaves the shapes alone."""
    kept = {feature, "reflective"} if feature in NEEDS else {feature}
    elements = (plain_element(each, feature) for each in with_materials(scene, kept.__contains__))
    return Scene((each for each in elements if each), scene.file)


def plain_element(element: Element, feature: Hashable) -> Element | None:
    """Return an element without other features; a spot becomes a point light, and parallel light is left out."""
    match element:
        case Background() if feature != ("environment" if isinstance(element.paint, str) else "background"):
            return None
        case Lamp() if feature != "spots" and "spots" in element.features():
            return FurtherLight(element.place, element.brightness, element.colour) if element.place else None
    return element


Array = NDArray[np.float64]

RAYS = 20_000  # from the eye, and as many from what they hit
LIMITS = (0.25, 0.5, 1.0, 2.0, 4.0)  # of the histogram of backward errors
CLEARANCE = 2.0**-40  # by which rays start above a surface, relative to the coordinates


class KindCertificates(NamedTuple):
    """Certificates of the hits of one kind of shape; backward errors in units of 2^-53 (t + |o - c| + size)."""

    kind: Annotated[str, "shape"]
    rays: Annotated[str, "rays"]
    hits: Annotated[int, "hits", "d"]
    backward_median: Annotated[float, "backward error, median", ".2f"]
    backward_largest: Annotated[float, "largest", ".2f"]
    up_to_quarter: Annotated[float, "up to 1/4", ".1%"]  # share of the hits with a backward error up to 0.25
    up_to_half: Annotated[float, "1/2", ".1%"]  # from there up to 0.5
    up_to_1: Annotated[float, "1", ".1%"]
    up_to_2: Annotated[float, "2", ".1%"]
    up_to_4: Annotated[float, "4", ".1%"]
    above_4: Annotated[float, "more", ".1%"]
    condition_median: Annotated[float, "condition, median", ".1f"]
    condition_99: Annotated[float, "99 %", ".2g"]  # 99 of 100 hits have no larger one
    condition_largest: Annotated[float, "largest", ".2g"]
    normal_largest: Annotated[float, "normal off by", ".1g"]  # distance from the exact unit normal


def hit_certificates(scene: Scene, width: int, height: int, seed: int) -> Iterator[KindCertificates]:
    """Certify hits of rays from the eye through random points of the picture, and of rays from there in random
    directions, as shadow rays and reflections are."""
    random = np.random.default_rng(seed)
    eye, right, up, forward = camera_numbers(scene.camera, width, height).reshape(4, 3)
    x, y = random.uniform(-1, 1, (2, RAYS, 1))
    seen = trace(scene, np.tile(eye, (RAYS, 1)), forward + x * right + y * up)
    kinds = np.array([type(shape) for shape in scene.shapes], object)
    for rays, hits in (("from the eye", seen), ("from what it sees", onward(scene, seen, random))):
        for kind in ALL_KINDS:
            of_kind = np.isin(hits.owner, np.flatnonzero(kinds == kind.element))
            if of_kind.any():
                yield summarised(kind, rays, *(part[of_kind] for part in hits.certificate))


def onward(scene: Scene, seen: Hits, random: np.random.Generator) -> Hits:
    """Trace rays in random directions from points just above or below the surfaces that were hit."""
    hit = seen.owner >= 0
    points, normals = seen.point[hit], seen.normal[hit]
    directions = random.normal(size=points.shape)
    directions /= np.abs(directions).max(axis=1, keepdims=True)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)  # uniform over the sphere
    clearance = CLEARANCE * (np.abs(points).max(axis=1, initial=0.0) + seen.distance[hit])
    way = np.sign((directions * normals).sum(axis=1)) * clearance
    return trace(scene, points + way[:, None] * normals, directions)


def summarised(kind: Kind, rays: str, backward: Array, condition: Array, normal: Array) -> KindCertificates:
    """Summarise the certificates of some hits of one kind."""
    counts, _ = np.histogram(backward, (0.0, *LIMITS, np.inf))
    far = np.quantile(condition, 0.99, method="inverted_cdf")
    figures = [np.median(condition), far, condition.max(), normal.max()]
    return KindCertificates(
        kind.element.title,
        rays,
        len(backward),
        *map(float, [np.median(backward), backward.max(), *(counts / len(backward)), *figures]),
    )
