"""Mitsuba 3 from the package `mitsuba`, whose LLVM back end compiles a frame to vector code on all threads.

Its integrators have no ambient light, so a frame is written with its rays: nearest hits, and a shadow ray to each
light. It is traced once and then replayed (`drjit.freeze`); each frame is evaluated to its end before the next begins.
Cylinders and planes are triangles, as Mitsuba's cylinders have no caps.
"""

from __future__ import annotations

from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from PIL import Image

from minirt import load
from minirt.rendering.packing.camera import camera_numbers
from minirt.report.bench import runs
from minirt.shapes import Shape, Sphere
from tests.bench.measure import GLASS, INSTALL, MIRROR, MissingError, Setting, System
from tests.bench.triangles import light, triangulated

VARIANT = "llvm_ad_rgb"
OFF_SURFACE = 1e-3  # offset of shadow rays


class Traceable(NamedTuple):
    """A scene prepared for Mitsuba."""

    scene: Any  # mitsuba.Scene
    colours: Any  # (3 n,) red, green and blue of each shape, by its number in Mitsuba's registry
    view: Any  # (12,) those of `camera_numbers`
    ambient: tuple[float, float, float]
    lights: Any  # (6 k,) position and radiance of each


class Mitsuba(System):
    name = "Mitsuba"
    how = "frames by its LLVM back end, with cylinders and planes as triangles; its trees and code are made before"
    lacks = MIRROR, GLASS

    def __init__(self, setting: Setting) -> None:
        super().__init__(setting)
        if find_spec("mitsuba") is None:
            raise MissingError(f"Mitsuba: mitsuba is not installed; {INSTALL}")
        import drjit
        import mitsuba

        try:
            mitsuba.set_variant(VARIANT)
            drjit.eval(mitsuba.Float(0))
        except (ImportError, RuntimeError) as error:
            raise MissingError(f"Mitsuba: {str(error).strip().splitlines()[-1]}; {INSTALL}") from error
        drjit.set_thread_count(setting.threads)
        self.mi, self.dr = mitsuba, drjit
        self.traceable = lru_cache(maxsize=1)(self.read)

    def frame_times(self, path: Path, seconds: float) -> list[float]:
        traceable = self.traceable(path)
        width, height, _, _ = self.setting
        frame, index = self.dr.freeze(self.frame), self.dr.arange(self.mi.UInt32, width * height)
        self.dr.make_opaque(index)
        pixels: Any = None

        def rendered() -> None:
            nonlocal pixels
            pixels = frame(*traceable, index, width, height)
            self.dr.eval(pixels)
            self.dr.sync_thread()

        for _ in range(3):  # traced, compiled, replayed
            rendered()
        times = [run.wall * 1e3 for run in runs(rendered, 3, seconds)]
        words = np.array(pixels, np.uint32)
        Image.fromarray(words.view(np.uint8).reshape(height, width, 4)).save(self.picture(path))
        return times

    def frame(
        self, scene: Any, colours: Any, view: Any, ambient: Any, lights: Any, index: Any, width: int, height: int
    ) -> Any:
        """Return the pixels of a frame, 0xAABBGGRR each; `index` is that of each pixel."""
        mi, dr = self.mi, self.dr

        def triple(array: Any, start: int) -> Any:
            return mi.Vector3f(*(dr.gather(mi.Float, array, mi.UInt32(start + axis)) for axis in range(3)))

        x, y = mi.Float(index % width), mi.Float(index // width)
        right, up = 2 * (x + 0.5) / width - 1, 1 - 2 * (y + 0.5) / height
        eye = mi.Point3f(triple(view, 0))
        direction = dr.normalize(triple(view, 9) + right * triple(view, 3) + up * triple(view, 6))
        hit = scene.ray_intersect(mi.Ray3f(eye, direction), mi.RayFlags.Minimal, coherent=True)
        valid = hit.is_valid()
        normal = mi.Vector3f(dr.select(dr.dot(hit.n, direction) > 0, -hit.n, hit.n))
        point = hit.p + OFF_SURFACE * normal
        received = mi.Color3f(*ambient)
        for number in range(len(lights) // 6):
            way = triple(lights, 6 * number) - point
            distance = dr.norm(way)
            cosine = dr.dot(normal, way) / distance
            ray = mi.Ray3f(point, way / distance, distance, 0.0, [])
            lit = valid & (cosine > 0)
            lit &= ~scene.ray_test(ray, coherent=True, active=lit)
            received += dr.select(lit, cosine, 0) * mi.Color3f(triple(lights, 6 * number + 3))
        shape = dr.reinterpret_array(mi.UInt32, hit.shape)
        colour = dr.gather(mi.Color3f, colours, shape, active=valid)
        levels = dr.select(valid, colour * received, 0)
        # LLVM up to 15 has no instruction for `minimum`.
        red, green, blue = (mi.UInt32(dr.select(each < 255, each, 255) + 0.5) for each in levels)
        return red | (green << 8) | (blue << 16) | 0xFF000000

    def read(self, path: Path) -> Traceable:
        """Read a scene file, and have Mitsuba build its trees."""
        mi, dr = self.mi, self.dr
        scene, setting = load(path), self.setting
        shapes = {f"shape{number}": self.shape(each) for number, each in enumerate(scene.shapes)}
        loaded = mi.load_dict({"type": "scene", **shapes})
        numbers = np.array(dr.reinterpret_array(mi.UInt32, mi.ShapePtr(loaded.shapes()))).ravel()
        levels = np.zeros((numbers.max() + 1, 3), np.float32)
        for number, each in zip(numbers, loaded.shapes(), strict=True):
            levels[number] = scene.shapes[int(each.id().removeprefix("shape"))].colour
        lights = [number for each in scene.lights for number in (*each.position, *light(each))]
        view = camera_numbers(scene.camera, setting.width, setting.height)
        return Traceable(loaded, mi.Float(levels.ravel()), mi.Float(view), light(scene.ambient), mi.Float(lights))

    def shape(self, shape: Shape) -> Any:
        """Translate a shape."""
        if isinstance(shape, Sphere):
            return {"type": "sphere", "center": list(shape.centre), "radius": shape.diameter / 2}
        points, corners = triangulated(shape)
        mesh = self.mi.Mesh("", len(points), len(corners), props=flat(self.mi))
        parameters = self.mi.traverse(mesh)
        parameters["vertex_positions"] = points.astype(np.float32).ravel()
        parameters["faces"] = corners.astype(np.uint32).ravel()
        parameters.update()
        return mesh


def flat(mi: Any) -> Any:
    """Return the properties of a mesh without smooth shading."""
    properties = mi.Properties()
    properties["face_normals"] = True
    return properties
