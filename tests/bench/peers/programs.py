"""Peers that are programs: translate a scene to their language, run them, and read the time that they print."""

from __future__ import annotations

import re
import shutil
from abc import abstractmethod
from collections.abc import Callable, Iterable, Iterator
from math import hypot
from pathlib import Path

import numpy as np

from minirt import load
from minirt.materials.glass import mirror_of
from minirt.rendering.packing.camera import camera_frame, camera_numbers
from minirt.rendering.packing.features import DEPTH
from minirt.scene import Scene
from minirt.shapes import Cylinder, Mesh, Plane, Shape, Sphere
from tests.bench.measure import GLASS, INSTALL, MissingError, Setting, System
from tests.bench.peers import povray
from tests.bench.triangles import light, triangulated
from tests.processes import run


class Command(System):
    """A ray tracer that is started for each frame; `MissingError` if it is not on the PATH."""

    command: str
    suffix: str
    translate: Callable[[Scene, int, int], Iterator[str]]

    def __init__(self, setting: Setting) -> None:
        super().__init__(setting)
        if not shutil.which(self.command):
            raise MissingError(f"{self.name}: {self.command} is not installed; {INSTALL}")

    @abstractmethod
    def arguments(self, file: Path, picture: Path) -> list[str]:
        """Return the arguments of the command that renders a file into a picture."""

    @abstractmethod
    def milliseconds(self, printed: str) -> float:
        """Read the render time from the command's output."""

    def prepared(self, path: Path) -> list[str]:
        """Translate a scene and return the command that renders it."""
        width, height, _, folder = self.setting
        file = folder / f"{path.stem}-{width}x{height}{self.suffix}"
        file.write_text("\n".join(self.translate(load(path), width, height)) + "\n", encoding="ascii")
        return [self.command, *self.arguments(file, self.picture(path))]

    def frame_times(self, path: Path, seconds: float) -> list[float]:
        ran = run(self.prepared(path), text=True)
        if ran.returncode:
            raise RuntimeError(f"{self.name} on {path}: {ran.stderr or ran.stdout}")
        return [self.milliseconds(ran.stdout + ran.stderr)]


# POV-Ray: the program `povray`. Its time is its "Trace Time": rays alone, without reading the scene.


TRACE_TIME = re.compile(r"Trace Time:.*\(([\d.]+) seconds\)")


def in_povray(scene: Scene, width: int, height: int) -> Iterator[str]:
    """Translate a scene to POV-Ray's language, meshes and plain glass, too."""
    glass = [each for each in scene.shapes if each.glass]
    untranslated = {*scene.meshes, *glass}
    yield from povray.translated(
        Scene((each for each in scene.elements if each not in untranslated), scene.file), width, height
    )
    for shape in glass:
        own = f"pigment {{ rgb {povray.vector(shape.colour)} / 255 transmit {shape.glass.share} }}"
        yield f"{povray.solid(shape)} {own} finish {{ ambient 1 diffuse 1 }} interior {{ ior {shape.glass.ior} }} }}"
    for mesh in scene.meshes:
        points, corners = triangulated(mesh)
        vertices, faces = (", ".join([str(len(rows)), *map(povray.vector, rows)]) for rows in (points, corners))
        yield f"mesh2 {{ vertex_vectors {{ {vertices} }} face_indices {{ {faces} }} {povray.finish(mesh)} }}"


class PovRay(Command):
    name, command, suffix = "POV-Ray", "povray", ".pov"
    how = "what it prints as Trace Time: the rays, without reading the scene"
    translate = staticmethod(in_povray)

    def arguments(self, file: Path, picture: Path) -> list[str]:
        width, height, threads, _ = self.setting
        options = f"+W{width} +H{height} +WT{threads} -A -D -V +FN8 File_Gamma=1.0"
        return [*options.split(), f"+I{file}", f"+O{picture}"]

    def milliseconds(self, printed: str) -> float:
        return float(TRACE_TIME.findall(printed)[-1]) * 1e3


# Tachyon: the program `tachyon`. Its time is its "Ray Tracing Time", without building its grid of shapes.


TRACING_TIME = re.compile(r"Ray Tracing Time:\s*([\d.]+) seconds")


def numbers(triple: Iterable[float]) -> str:
    """Format numbers, without negative zeros."""
    return " ".join(f"{number + 0.0:.9g}" for number in triple)


def mirrored(triple: Iterable[float]) -> str:
    """Convert a vector to Tachyon's left-handed coordinates."""
    x, y, z = triple
    return numbers((-x, y, z))


def solid(shape: Shape, ambient: float) -> Iterator[str]:
    """Translate a shape to Tachyon's language; a cylinder becomes a tube and two discs."""
    red, green, blue = (level / 255 for level in shape.colour)
    mirror = mirror_of(shape).share
    own = f"AMBIENT {ambient * (1 - mirror):.9g} DIFFUSE {1 - mirror:.9g} SPECULAR {mirror:.9g}"
    finish = f"TEXTURE {own} OPACITY 1 COLOR {numbers((red, green, blue))} TEXFUNC 0"
    match shape:
        case Sphere():
            yield f"SPHERE CENTER {mirrored(shape.centre)} RAD {shape.diameter / 2:.9g} {finish}"
        case Cylinder():
            radius = f"{shape.diameter / 2:.9g}"
            half = shape.height / 2 * np.array(shape.axis)
            bottom, top = (np.array(shape.centre) + end * half for end in (-1, 1))
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


def in_tachyon(scene: Scene, width: int, height: int) -> Iterator[str]:
    """Translate a scene to Tachyon's language; its ambient light has no colour, so it gets the green of ours."""
    _, up, forward = camera_frame(scene.camera)
    upward = camera_numbers(scene.camera, width, height)[6:9]  # from the middle to the edge, at distance 1
    zoom = 0.5 / hypot(*upward)
    yield "BEGIN_SCENE"
    yield f"RESOLUTION {width} {height}"
    yield (
        f"CAMERA PROJECTION PERSPECTIVE ZOOM {zoom:.9g} ASPECTRATIO 1 ANTIALIASING 0 RAYDEPTH {DEPTH + 1} "
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
    lacks = (GLASS,)
    translate = staticmethod(in_tachyon)

    def arguments(self, file: Path, picture: Path) -> list[str]:
        options = ["-numthreads", str(self.setting.threads), "-aasamples", "0", "-fullshade", "+V"]
        return [str(file), *options, "-format", "PNG", "-o", str(picture)]

    def milliseconds(self, printed: str) -> float:
        return float(TRACING_TIME.findall(printed)[-1]) * 1e3
