"""POV-Ray: the program `povray`. Its time is its "Trace Time": rays alone, without reading the scene."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path

from minirt.rendering.packing.camera import camera_numbers
from minirt.scene import Scene
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.mesh import Mesh
from minirt.shapes.plane import Plane
from minirt.shapes.shape import Shape
from minirt.shapes.sphere import Sphere
from tests.bench.peers.command import Command, ends, light, words
from tests.bench.peers.triangles import triangulated

TRACE_TIME = re.compile(r"Trace Time:.*\(([\d.]+) seconds\)")


def vector(numbers: Iterable[float]) -> str:
    return f"<{', '.join(words(numbers))}>"


def surface(colour: Iterable[float]) -> str:
    return f"pigment {{ rgb {vector(colour)} / 255 }}"


def solid(shape: Shape) -> str:
    """Translate a shape to POV-Ray's language."""
    match shape:
        case Sphere():
            return f"sphere {{ {vector(shape.centre)}, {shape.diameter / 2:.9g} {surface(shape.colour)} }}"
        case Cylinder():
            bottom, top = map(vector, ends(shape))
            return f"cylinder {{ {bottom}, {top}, {shape.diameter / 2:.9g} {surface(shape.colour)} }}"
        case Plane():
            height = sum(n * p for n, p in zip(shape.normal, shape.point, strict=True))
            return f"plane {{ {vector(shape.normal)}, {height:.9g} {surface(shape.colour)} }}"
        case Mesh():
            points, corners = triangulated(shape)
            vertices, faces = (", ".join([str(len(rows)), *map(vector, rows)]) for rows in (points, corners))
            return f"mesh2 {{ vertex_vectors {{ {vertices} }} face_indices {{ {faces} }} {surface(shape.colour)} }}"
    raise ValueError(f"no POV-Ray for {shape}")


def translated(scene: Scene, width: int, height: int) -> Iterator[str]:
    """Translate a scene to POV-Ray's language; camera vectors keep it as right-handed as ours."""
    eye, right, up, forward = camera_numbers(scene.camera, width, height).reshape(4, 3)
    yield "#version 3.7;"
    yield f"global_settings {{ assumed_gamma 1 ambient_light rgb {vector(light(scene.ambient))} }}"
    yield "#default { finish { ambient 1 diffuse 1 } }"
    yield (
        f"camera {{ location {vector(eye)} direction {vector(forward)} right {vector(2 * right)} up {vector(2 * up)} }}"
    )
    for lamp in scene.lights:
        yield f"light_source {{ {vector(lamp.position)}, rgb {vector(light(lamp))} }}"
    yield from map(solid, scene.shapes)


class PovRay(Command):
    name, command, suffix = "POV-Ray", "povray", ".pov"
    how = "what it prints as Trace Time: the rays, without reading the scene"
    translate = staticmethod(translated)

    def arguments(self, file: Path, picture: Path) -> list[str]:
        width, height, threads, _ = self.setting
        return [
            f"+W{width}",
            f"+H{height}",
            f"+WT{threads}",
            "-A",
            "-D",
            "-V",
            "+FN8",
            "File_Gamma=1.0",
            f"+I{file}",
            f"+O{picture}",
        ]

    def milliseconds(self, printed: str) -> float:
        return float(TRACE_TIME.findall(printed)[-1]) * 1e3
