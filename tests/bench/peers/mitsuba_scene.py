"""Scenes for Mitsuba: spheres, meshes, rectangles for planes, and open cylinders with two discs as caps."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from minirt.fields import Triple
from minirt.scene import Scene
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.mesh import Mesh
from minirt.shapes.plane import Plane
from minirt.shapes.shape import Shape
from minirt.shapes.sphere import Sphere
from tests.bench.peers.command import ends
from tests.bench.peers.triangles import ENDLESS, across, triangulated


def loaded(mitsuba: Any, scene: Scene) -> tuple[Any, dict[str, Triple]]:
    """Load a scene into Mitsuba; return it, and the colour of each of its shapes by the shape's id."""
    shapes, colours = {}, {}
    for shape in scene.shapes:
        for part in parts(mitsuba, shape):
            identity = f"shape{len(shapes)}"
            shapes[identity], colours[identity] = part, shape.colour
    return mitsuba.load_dict({"type": "scene"} | shapes), colours


def parts(mitsuba: Any, shape: Shape) -> Iterator[Any]:
    """Yield the shapes of Mitsuba that make up a shape."""
    match shape:
        case Sphere():
            yield {"type": "sphere", "center": shape.centre, "radius": shape.diameter / 2}
        case Cylinder():
            radius = shape.diameter / 2
            bottom, top = ends(shape)
            yield {"type": "cylinder", "p0": bottom, "p1": top, "radius": radius}
            for end in (bottom, top):
                yield {"type": "disk", "to_world": placed(mitsuba, end, shape.axis, radius)}
        case Plane():
            yield {"type": "rectangle", "to_world": placed(mitsuba, shape.point, shape.normal, ENDLESS)}
        case Mesh():
            yield mesh(mitsuba, shape)
        case _:
            raise ValueError(f"no Mitsuba for {shape}")


def placed(mitsuba: Any, centre: Triple, normal: Triple, size: float) -> Any:
    """Return the transform that places a flat shape of half width 1."""
    u, v = across(normal)
    columns = np.eye(4)
    columns[:3] = np.column_stack([size * u, size * v, normal, centre])
    return mitsuba.ScalarTransform4f(columns)


def mesh(mitsuba: Any, shape: Mesh) -> Any:
    """Return a mesh of Mitsuba, without normals of its own."""
    points, corners = triangulated(shape)
    made = mitsuba.Mesh(shape.file.name, len(points), len(corners))
    fields = mitsuba.traverse(made)
    fields["vertex_positions"] = mitsuba.Float(points.astype(np.float32).ravel())
    fields["faces"] = mitsuba.UInt32(corners.astype(np.uint32).ravel())
    fields.update()
    return made
