"""Notices about what of a scene has no effect on its picture: what is certain, of its first `MOST_COMPARED` shapes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import chain, islice, product

import numpy as np

from minirt.lanes import Vec, dot, unit
from minirt.rendering.notes import light_name, names_of, shape_name
from minirt.rendering.packing.features import features
from minirt.rendering.packing.lights import emitting_lights
from minirt.rendering.packing.materials import encloses
from minirt.rendering.packing.ray_casting import camera_ray, nearest_hits
from minirt.rendering.packing.shape_arrays import ShapeArrays
from minirt.rendering.queries.unseen import SOME, arrays_of, rectangles, visible_shapes
from minirt.scene import Camera, Lamp, Light, Scene
from minirt.shapes import Box, Cone, Cylinder, Ellipsoid, Mesh, Paraboloid, Shape, Sphere

CONVEX = (Sphere, Box, Cylinder, Cone, Ellipsoid, Paraboloid)
UNBOUNDED = ((-np.inf,) * 3, (np.inf,) * 3)  # box of a plane
MOST_COMPARED = 200  # shapes of which one may be inside of another
CERTAIN = 1e-3  # of the size of a shape by which its bounding box is grown
AMBIENT_ALONE = "no light is on but the ambient one, which is the same everywhere: a line L adds another"
COARSE = 48, 27  # pixels of pictures that show what a light lights
MOST_LIT = 100  # shapes, times lights: looking takes a twentieth of a second at most, and mostly a thousandth


def is_one_square(shape: Shape) -> bool:
    """Whether one square of a checkerboard covers all of a shape whose u and v run from 0 to 1."""
    is_usual = not (shape.infinite or shape.uv or isinstance(shape, Mesh))
    return bool(is_usual and shape.checker and shape.checker.size >= 1)


def is_clear(shape: Shape) -> bool:
    """Whether a shape with an inside is of clear glass, which does not show its colour."""
    is_glass = bool(shape.glass and shape.glass.share == 1 and not shape.tint and not shape.glow)
    return is_glass and shape.solid and not shape.infinite and len({*shape.colour}) > 1


LOST: dict[str, Callable[[Shape], bool]] = {
    "the checker: of {} is not seen: a square with sides of 1 covers the shape, try 0.125": is_one_square,
    "the colour of {} is not seen: it is of clear glass, which tint:R,G,B colours": is_clear,
}


def without_effect(scene: Scene, size: tuple[int, int]) -> Iterator[str]:
    """Yield sentences about what has no effect on a picture of that size."""
    shapes = [*islice(chain.from_iterable(scene.runs), MOST_COMPARED)]
    boxes = np.array([shape.bounds() or UNBOUNDED for shape in shapes]).reshape(-1, 2, 3)
    inside = list(hidden(scene, shapes, boxes))
    yield from inside
    idle = [name for name in idle_lights(scene) if not any(each.startswith(name) for each in inside)]
    if idle:
        yield f"nothing that is in view seems to be lit by {', '.join(idle)}"
    if shapes and scene.ambient and scene.ambient.brightness and not emitting_lights(scene):
        yield AMBIENT_ALONE
    bounded = np.flatnonzero(np.isfinite(boxes).all(axis=(1, 2)))
    low, high = rectangles(scene.camera, size, boxes[bounded])
    tiny = (((high - low) * size < 1) & (low > 0) & (high < 1)).all(axis=1)
    if tiny.any():
        yield f"smaller than a pixel: {names_of(scene, bounded[tiny].tolist())}"
    for sentence, is_lost in LOST.items():
        if found := [index for index, shape in enumerate(shapes) if is_lost(shape)]:
            yield sentence.format(names_of(scene, found))


def hidden(scene: Scene, shapes: list[Shape], boxes: np.ndarray) -> Iterator[str]:
    """Yield sentences about shapes and lamps that are inside an opaque shape, and the eye is not.

    Something is inside a convex shape if all corners of its bounding box, grown, are; `boxes` (s, 2, 3) are those of
    the shapes. Inside other shapes only lamps without a size are looked for. With a lens nothing is, since the eye is a
    disc.
    """
    eye, lamps = np.array(scene.camera.position), [(n, lamp) for n, lamp in enumerate(scene.lights) if lamp.position]
    extents = [np.add(lamp.position or 0.0, np.multiply(lamp.size or 0.0, [[-0.5], [0.5]])) for _, lamp in lamps]
    # The least and the greatest corners of the boxes of shapes, then of lamps.
    starts, ends = np.concatenate([boxes, np.reshape(extents, (-1, 2, 3))]).swapaxes(0, 1)
    grown = CERTAIN * (ends - starts)
    for outer, shape in enumerate(shapes):
        is_closed = shape.solid and not shape.infinite and not shape.glass
        if is_closed and not scene.camera.lens and not encloses(shape, eye):
            within = (starts >= starts[outer]).all(axis=1) & (ends <= ends[outer]).all(axis=1)
            if not isinstance(shape, CONVEX):
                within &= (starts == ends).all(axis=1)  # lamps without a size
            for index in np.flatnonzero(within).tolist():
                corners = product(*zip(starts[index] - grown[index], ends[index] + grown[index], strict=True))
                if index != outer and all(encloses(shape, np.array(at)) for at in corners):
                    if index < len(shapes):
                        what = f"{shape_name(scene, index)} is never seen"
                    else:
                        number, _ = lamps[index - len(shapes)]
                        what = f"{light_name(scene, number)} lights nothing"
                    yield f"{what}: it is inside {shape_name(scene, outer)}, which is opaque"


def idle_lights(scene: Scene) -> Iterator[str]:
    """Yield the names of the lights that light nothing in a coarse picture: with such a light alone it is the same as
    without any lamp.

    Lights with a size, which are sampled at random, are left out. Nothing is yielded where mirrors or glass may show
    what is lit, where nothing is in view, or for more than MOST_LIT shapes times lights.
    """
    lights, arrays = emitting_lights(scene), arrays_of(scene)
    is_quick = len(lights) * sum(each.parts for each in scene.shapes) <= MOST_LIT
    is_direct = "reflective" not in features(scene)
    if not is_quick or not is_direct or not arrays or not len(visible_shapes(arrays, scene.camera, COARSE)):
        return
    others = [each for each in scene.elements if not isinstance(each, Lamp)]
    unlit: np.ndarray | None = None  # the picture without any lamp
    for number, light in enumerate(scene.lights):
        if light not in lights or light.size or lights_a_solid(arrays, scene.camera, light):
            continue
        from minirt.rendering.queries.preview import render_interpreted

        if unlit is None:
            _, unlit = render_interpreted(Scene(others, scene.file), *COARSE)
        _, lit = render_interpreted(Scene([*others, light], scene.file), *COARSE)
        if np.array_equal(lit, unlit):
            yield light_name(scene, number)


def lights_a_solid(arrays: ShapeArrays, camera: Camera, light: Lamp) -> bool:
    """Whether some rays of the eye meet a solid at a point that the light reaches, from outside and past all shapes.

    Finding that takes a tenth of the time of a coarse picture. False for a light that fades or is no point light.
    """
    if not isinstance(light, Light) or light.fade:
        return False
    solid = np.array([shape.solid and not shape.infinite for shape in arrays.shapes])
    eye, rays = camera_ray(camera, *COARSE, *(SOME * COARSE).T)
    distances, primitives = nearest_hits(arrays, eye, rays)
    places = [at for at, found in enumerate(primitives.tolist()) if found >= 0 and solid[arrays.owner[found]]]
    if not places:
        return False
    lamp, rays = Vec(*light.position), Vec(rays.x[places], rays.y[places], rays.z[places])
    way = eye + distances[places] * rays - lamp
    reached, found = nearest_hits(arrays, lamp, unit(way))
    is_first = (found == primitives[places]) & (reached >= (1 - CERTAIN) * np.sqrt(dot(way, way)))
    lit = {*arrays.owner[found[is_first]].tolist()}
    return any(not encloses(arrays.shapes[index], np.array(light.position)) for index in lit)
