"""Lines of POV-Ray in the diagram: scenes in its language, limited to what means exactly the same there, and its runs.

POV-Ray's Lambert term, ambient light, Phong and Blinn highlights and mirrors are those of miniRT. Textures, glass and
lights that fade or have a direction are not translated.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np

from minirt.element import fields_of
from minirt.errors import RenderError
from minirt.materials import Attributes
from minirt.materials.glass import mirror_of
from minirt.rendering.packing.camera import camera_numbers
from minirt.rendering.packing.features import DEPTH
from minirt.report.bench import Run
from minirt.report.metrics import Picture, rmse
from minirt.report.pictures import FEW, TOO_SLOW, Budget, Reference, Row, Step, measure_times
from minirt.scene import Ambient, Lamp, Light, Scene
from minirt.shapes import Cone, Cylinder, Disc, Plane, Shape, Sphere, Triangle

TRANSLATED = {"specular", "mirror"}  # materials
LEAST_SHARE = 2.0**-10  # rays that would add less to a pixel are not traced, as in `minirt.kernel.shading.whitted`


def translated(scene: Scene, width: int, height: int) -> Iterator[str]:
    """Translate a scene to POV-Ray's language; RenderError where that is not exact."""
    eye, right, up, forward = camera_numbers(scene.camera, width, height).reshape(4, 3)
    paint = scene.background.paint if scene.background else (0, 0, 0)
    if isinstance(paint, str):
        raise RenderError("a picture as background is not translated")
    yield "#version 3.7;"
    yield (
        f"global_settings {{ assumed_gamma 1 ambient_light rgb {radiance(scene.ambient)} "
        f"max_trace_level {DEPTH + 1} adc_bailout {LEAST_SHARE} }}"
    )
    yield f"background {{ rgb {vector(paint)} / 255 }}"
    view = f"direction {vector(forward)} right {vector(2 * right)} up {vector(2 * up)}"  # right-handed, as miniRT's
    yield f"camera {{ location {vector(eye)} {view} }}"
    for light in scene.lights:
        if not isinstance(light, Light) or light.fade is not None:
            raise RenderError("spots, parallel and fading light are not translated")
        yield f"light_source {{ {vector(light.position)}, rgb {radiance(light)} }}"
    for shape in scene.shapes:
        yield f"{solid(shape)} {finish(shape)} }}"


def solid(shape: Shape) -> str:
    """Translate the geometry of a shape, without the closing brace."""
    match shape:
        case Sphere():
            return f"sphere {{ {vector(shape.centre)}, {shape.diameter / 2}"
        case Plane():
            height = sum(n * p for n, p in zip(shape.normal, shape.point, strict=True))
            return f"plane {{ {vector(shape.normal)}, {height + 0.0!r}"
        case Cylinder():
            ends = (np.array(shape.centre) + side * shape.height / 2 * np.array(shape.axis) for side in (-1, 1))
            return f"cylinder {{ {', '.join(map(vector, ends))}, {shape.diameter / 2}"
        case Cone():
            base = np.array(shape.apex) + shape.height * np.array(shape.axis)
            return f"cone {{ {vector(shape.apex)}, 0, {vector(base)}, {shape.diameter / 2}"
        case Disc():
            return f"disc {{ {vector(shape.centre)}, {vector(shape.normal)}, {shape.diameter / 2}"
        case Triangle():
            return f"triangle {{ {', '.join(map(vector, (shape.a, shape.b, shape.c)))}"
    raise RenderError(f"{shape.plural} are not translated")


def finish(shape: Shape) -> str:
    """Translate the colour and the materials of a shape."""
    for field in fields_of(Attributes):
        if field.name not in TRANSLATED and getattr(shape, field.name) is not None:
            raise RenderError(f"the material {field.title} is not translated")
    if mirror_of(shape).fade:
        raise RenderError("fading mirrors are not translated")
    mirror, highlight = mirror_of(shape).share, ""
    if shape.specular:
        share, exponent, blinn = shape.specular.share, shape.specular.exponent, shape.specular.blinn
        phong = f"phong {share} phong_size {exponent}"
        highlight = f"specular {share} roughness {1 / exponent}" if blinn else phong
    own = f"ambient {1 - mirror} diffuse {1 - mirror}"
    return f"pigment {{ rgb {vector(shape.colour)} / 255 }} finish {{ {own} reflection {mirror} {highlight} }}"


def radiance(source: Ambient | Lamp | None) -> str:
    """Translate the colour of a light source times its brightness; black for None."""
    return vector(source.brightness * level / 255 for level in source.colour) if source else vector((0, 0, 0))


def vector(numbers: Iterable[float]) -> str:
    """Format a vector to all digits, without negative zeros."""
    return f"<{', '.join(repr(float(each) + 0.0) for each in numbers)}>"


PROGRAM, COMMAND = "POV-Ray", ("povray",)
TICK = 0.005  # seconds by which its processor time may be too small
CHECKED = 2  # samples along an edge of a pixel, of the picture that shows whether the scene is the same
SAME = 0.02  # RMSE: a picture of four samples per pixel that is further off is not that of the scene
TRACE = re.compile(r"Trace Time:.*\(([\d.]+) seconds\)\s+using \d+ thread\(s\) with ([\d.]+) CPU-seconds")

ADAPTIVE = f"{PROGRAM} adaptive"
GRID = "+AM1 +A0.0 -J +R{}"  # options for a grid of n x n samples in each pixel
# Rows and options: grids, and supersampling where colours differ by more than a threshold, with 81 samples at most.
SETTINGS = (
    (Row(PROGRAM, "1", PROGRAM, samples=1), "-A"),
    *((Row(PROGRAM, str(n * n), PROGRAM, samples=n * n), GRID.format(n)) for n in (2, 3, 4)),
    *((Row(ADAPTIVE, f"A{limit:g}", PROGRAM), f"+AM2 +A{limit:g} +R3 -J") for limit in (0.3, 0.1, 0.03, 0.01)),
)
ABOUT = {
    PROGRAM: "POV-Ray with a grid of samples in each pixel; its time is what it prints as Trace Time",
    ADAPTIVE: "POV-Ray with recursive supersampling (+AM2 +R3) from a difference of colours (+A) on",
}


class PovRay:
    """Renders one scene with POV-Ray: RenderError where it is not installed or cannot show the same scene."""

    def __init__(self, scene: Scene, width: int, height: int, threads: int, folder: Path) -> None:
        if not shutil.which("povray"):
            raise RenderError(f"{PROGRAM} is not installed")
        self.width, self.height, self.threads, self.folder = width, height, threads, folder
        try:
            (folder / "scene.pov").write_text("\n".join([*translated(scene, width, height), ""]), encoding="ascii")
        except RenderError as error:
            raise RenderError(f"{PROGRAM} cannot show the same scene: {error}") from None

    def rows(self, right: Reference, budget: Budget, step: Step) -> Iterator[tuple[Row, Picture | None]]:
        """Yield a row and a picture for each setting, until those of a line take too long.

        RenderError, before the first row, if its picture is not that of the scene.
        """
        _, picture = self.drawn(GRID.format(CHECKED))
        error = rmse(picture, right.picture)
        if error > SAME:
            raise RenderError(f"{PROGRAM} shows something else: RMSE {error:.2g} at {CHECKED**2} samples per pixel")
        slow: set[str] = set()
        for row, options in SETTINGS:
            step(row.name)
            if row.knob in slow:
                yield row._replace(remark="left out: takes too long"), None
                continue
            first, picture = self.drawn(options)
            times = measure_times([lambda: self.drawn(options)[0]], first, self.threads, budget, FEW)  # noqa: B023
            if times.remark == TOO_SLOW:
                slow.add(row.knob)
            yield row.with_errors(picture, right).with_times(times), picture

    def drawn(self, options: str) -> tuple[Run, Picture]:
        """Render with some options; return the time that POV-Ray took for the rays, and linear light in 16 bits."""
        command = [*COMMAND, f"+W{self.width}", f"+H{self.height}", f"+WT{self.threads}", "-D", "-V", "+FP16"]
        paths = "File_Gamma=1.0", "+Iscene.pov", "+Opicture.ppm"
        ended = subprocess.run([*command, *paths, *options.split()], cwd=self.folder, capture_output=True, check=False)
        printed = ended.stderr.decode(errors="replace")
        found = TRACE.findall(printed)
        if ended.returncode or not found:
            raise RenderError(f"{PROGRAM} failed: {printed.strip()[-200:]}")
        data = (self.folder / "picture.ppm").read_bytes()[-6 * self.width * self.height :]  # without its header
        light: Picture = np.frombuffer(data, ">u2").reshape(self.height, self.width, 3) / 65535.0
        wall, cpu = map(float, found[-1])
        return Run(wall, cpu + TICK), light
