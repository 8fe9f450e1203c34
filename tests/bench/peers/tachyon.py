"""Tachyon: the program `tachyon`. Its time is its "Ray Tracing Time", without building its grid of shapes."""

from __future__ import annotations

import re
from collections.abc import Iterator
from math import hypot
from pathlib import Path

from minirt.fields import Triple
from minirt.rendering.packing.camera import camera_numbers
from minirt.scene import Scene
from minirt.scene.elements import camera_frame
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.mesh import Mesh
from minirt.shapes.plane import Plane
from minirt.shapes.shape import Shape
from minirt.shapes.sphere import Sphere
from tests.bench.peers.command import Command, ends, light, words
from tests.bench.peers.triangles import triangulated

TRACING_TIME = re.compile(r"Ray Tracing Time:\s*([\d.]+) seconds")


def numbers(triple: Triple) -> str:
    return " ".join(words(triple))


def mirrored(triple: Triple) -> str:
    """Convert a vector to Tachyon's left-handed coordinates."""
    x, y, z = triple
    return numbers((-x, y, z))


def solid(shape: Shape, ambient: float) -> Iterator[str]:
    """Translate a shape to Tachyon's language; a cylinder becomes a tube and two discs."""
    red, green, blue = (level / 255 for level in shape.colour)
    finish = (
        f"TEXTURE AMBIENT {ambient:.9g} DIFFUSE 1 SPECULAR 0 OPACITY 1 COLOR {numbers((red, green, blue))} TEXFUNC 0"
    )
    match shape:
        case Sphere():
            yield f"SPHERE CENTER {mirrored(shape.centre)} RAD {shape.diameter / 2:.9g} {finish}"
        case Cylinder():
            radius = f"{shape.diameter / 2:.9g}"
            bottom, top = ends(shape)
            yield f"FCYLINDER BASE {mirrored(bottom)} APEX {mirrored(top)} RAD {radius} {finish}"
            for end in (bottom, top):
                yield f"RING CENTER {mirrored(end)} NORMAL {mirrored(shape.axis)} INNER 0 OUTER {radius} {finish}"
        case Plane():
            yield f"PLANE CENTER {mirrored(shape.point)} NORMAL {mirrored(shape.normal)} {finish}"
        case Mesh():
            points, corners = triangulated(shape)
            for a, b, c in points[corners]:
                yield f"TRI V0 {mirrored(a)} V1 {mirrored(b)} V2 {mirrored(c)} {finish}"
        case _:
            raise ValueError(f"no Tachyon for {shape}")


def translated(scene: Scene, width: int, height: int) -> Iterator[str]:
    """Translate a scene to Tachyon's language; its ambient light has no colour, so it gets the green of ours."""
    _, up, forward = camera_frame(scene.camera)
    upward = camera_numbers(scene.camera, width, height)[6:9]  # from the middle to the edge, at distance 1
    zoom = 0.5 / hypot(*upward)
    yield "BEGIN_SCENE"
    yield f"RESOLUTION {width} {height}"
    yield (
        f"CAMERA PROJECTION PERSPECTIVE ZOOM {zoom:.9g} ASPECTRATIO 1 ANTIALIASING 0 RAYDEPTH 1 "
        f"CENTER {mirrored(scene.camera.position)} VIEWDIR {mirrored(forward)} UPDIR {mirrored(up)} END_CAMERA"
    )
    for lamp in scene.lights:
        yield f"LIGHT CENTER {mirrored(lamp.position)} RAD 0.001 COLOR {numbers(light(lamp))}"
    for shape in scene.shapes:
        yield from solid(shape, light(scene.ambient)[1])
    yield "END_SCENE"


class Tachyon(Command):
    name, command, suffix = "Tachyon", "tachyon", ".dat"
    how = "what it prints as Ray Tracing Time: the rays, without reading the scene"
    translate = staticmethod(translated)

    def arguments(self, file: Path, picture: Path) -> list[str]:
        options = ["-numthreads", str(self.setting.threads), "-aasamples", "0", "-fullshade", "+V"]
        return [str(file), *options, "-format", "PNG", "-o", str(picture)]

    def milliseconds(self, printed: str) -> float:
        return float(TRACING_TIME.findall(printed)[-1]) * 1e3
