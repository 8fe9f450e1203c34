"""Lines of POV-Ray in the diagram: scenes in its language, limited to what means exactly the same there, and its runs.

POV-Ray's Lambert term, ambient light, Phong and Blinn highlights and mirrors are those of miniRT. Textures, glass and
lights that fade or have a direction are not translated.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from minirt.element import fields_of
from minirt.errors import RenderError
from minirt.helpers.system import Run, is_disturbed
from minirt.materials import Attributes
from minirt.materials.glass import mirror_of
from minirt.rendering.packing.camera import camera_numbers
from minirt.rendering.packing.features import DEPTH
from minirt.report.metrics import Picture, perceived, rmse
from minirt.report.pictures import DISTURBED_BY_OTHERS, Reference, Row, Times, with_errors, with_times
from minirt.scene import Ambient, Lamp, Light, Scene
from minirt.shapes import Shape
from minirt.shapes.cone import Cone
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.disc import Disc
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import Sphere
from minirt.shapes.triangle import Triangle

TRANSLATED = {"specular", "mirror"}  # materials
LEAST_SHARE = 2.0**-10  # rays that would add less to a pixel are not traced, as in `minirt.kernel.shading.whitted`


class NotExactError(RenderError):
    """Something in the scene has no exact counterpart in POV-Ray."""


def translated(scene: Scene, width: int, height: int) -> Iterator[str]:
    """Translate a scene to POV-Ray's language; NotExactError where that is not exact."""
    eye, right, up, forward = camera_numbers(scene.camera, width, height).reshape(4, 3)
    paint = scene.background.paint if scene.background else (0, 0, 0)
    if isinstance(paint, str):
        raise NotExactError("a picture as background is not translated")
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
            raise NotExactError("spots, parallel and fading light are not translated")
        yield f"light_source {{ {vector(light.position)}, rgb {radiance(light)} }}"
    for shape in scene.shapes:
        yield f"{solid(shape)} {finish(shape)} }}"


def solid(shape: Shape) -> str:
    """Translate the geometry of a shape, without the closing brace."""
    match shape:
        case Sphere():
            return f"sphere {{ {vector(shape.centre)}, {number(shape.diameter / 2)}"
        case Plane():
            height = sum(n * p for n, p in zip(shape.normal, shape.point, strict=True))
            return f"plane {{ {vector(shape.normal)}, {number(height)}"
        case Cylinder():
            ends = (along(shape.centre, shape.axis, side * shape.height / 2) for side in (-1, 1))
            return f"cylinder {{ {', '.join(map(vector, ends))}, {number(shape.diameter / 2)}"
        case Cone():
            base = along(shape.apex, shape.axis, shape.height)
            return f"cone {{ {vector(shape.apex)}, 0, {vector(base)}, {number(shape.diameter / 2)}"
        case Disc():
            return f"disc {{ {vector(shape.centre)}, {vector(shape.normal)}, {number(shape.diameter / 2)}"
        case Triangle():
            return f"triangle {{ {', '.join(map(vector, (shape.a, shape.b, shape.c)))}"
    raise NotExactError(f"{shape.plural} are not translated")


def finish(shape: Shape) -> str:
    """Translate the colour and the materials of a shape."""
    for field in fields_of(Attributes):
        if field.name not in TRANSLATED and getattr(shape, field.name) is not None:
            raise NotExactError(f"the material {field.title} is not translated")
    if mirror_of(shape).fade:
        raise NotExactError("fading mirrors are not translated")
    mirror, highlight = mirror_of(shape).share, ""
    if shape.specular:
        share, exponent, blinn = shape.specular.share, shape.specular.exponent, shape.specular.blinn
        phong = f"phong {share} phong_size {exponent}"
        highlight = f"specular {share} roughness {1 / exponent}" if blinn else phong
    own = f"ambient {1 - mirror} diffuse {1 - mirror}"
    return f"pigment {{ rgb {vector(shape.colour)} / 255 }} finish {{ {own} reflection {mirror} {highlight} }}"


def along(point: Iterable[float], axis: Iterable[float], length: float) -> list[float]:
    """Return the point at a distance along an axis."""
    return [p + length * a for p, a in zip(point, axis, strict=True)]


def radiance(source: Ambient | Lamp | None) -> str:
    """Translate the colour of a light source times its brightness; black for None."""
    return vector(source.brightness * level / 255 for level in source.colour) if source else vector((0, 0, 0))


def vector(numbers: Iterable[float]) -> str:
    """Format a vector."""
    return f"<{', '.join(map(number, numbers))}>"


def number(value: float) -> str:
    """Format a number to all its digits, without a negative zero."""
    return repr(float(value) + 0.0)


PROGRAM, COMMAND = "POV-Ray", ("povray",)
RUNS, MOST_RUNS = 3, 6  # undisturbed, and in all
TICK = 0.005  # seconds by which its processor time may be too small
CHECKED = 2  # samples along an edge of a pixel, of the picture that shows whether the scene is the same
SAME = 0.02  # RMSE: a picture of four samples per pixel that is further off is not that of the scene
TRACE = re.compile(r"Trace Time:.*\(([\d.]+) seconds\)\s+using \d+ thread\(s\) with ([\d.]+) CPU-seconds")
HEADER = re.compile(rb"P6\s(?:#[^\n]*\n)*(\d+)\s+(\d+)\s+65535\s")


class Setting(NamedTuple):
    """Options of POV-Ray: a point of a line."""

    knob: str
    label: str
    samples: float
    options: tuple[str, ...]


def uniform(side: int) -> Setting:
    """A grid of side x side samples in each pixel."""
    many = "+AM1", "+A0.0", f"+R{side}", "-J"
    return Setting(PROGRAM, str(side * side), side * side, many if side > 1 else ("-A",))


def adaptive(threshold: float) -> Setting:
    """Recursive supersampling where colours differ by more than a threshold, with 81 samples per pixel at most."""
    return Setting(f"{PROGRAM} adaptive", f"A{threshold:g}", float("nan"), ("+AM2", f"+A{threshold:g}", "+R3", "-J"))


SETTINGS = (*map(uniform, (1, 2, 3, 4)), *map(adaptive, (0.3, 0.1, 0.03, 0.01)))
ABOUT = {
    PROGRAM: "POV-Ray with a grid of samples in each pixel; its time is what it prints as Trace Time",
    f"{PROGRAM} adaptive": "POV-Ray with recursive supersampling (+AM2 +R3) from a difference of colours (+A) on",
}


class PovRay:
    """Renders one scene with POV-Ray: RenderError where it is not installed or cannot show the same scene."""

    def __init__(self, scene: Scene, width: int, height: int, threads: int, folder: Path) -> None:
        if not shutil.which("povray"):
            raise RenderError(f"{PROGRAM} is not installed")
        self.width, self.height, self.threads, self.folder = width, height, threads, folder
        try:
            text = "\n".join(translated(scene, width, height))
        except RenderError as error:
            raise RenderError(f"{PROGRAM} cannot show the same scene: {error}") from None
        (folder / "scene.pov").write_text(text + "\n", encoding="ascii")

    def rows(
        self, right: Reference, longest: float, step: Callable[[str], object]
    ) -> Iterator[tuple[Row, Picture | None]]:
        """Yield a row and a picture for each setting that takes at most `longest` seconds.

        RenderError, before the first row, if its picture is not that of the scene.
        """
        _, picture = self.drawn(uniform(CHECKED))
        error = rmse(picture, right.picture)
        if error > SAME:
            raise RenderError(f"{PROGRAM} shows something else: RMSE {error:.2g} at {CHECKED**2} samples per pixel")
        seen = perceived(right.picture)
        slow: set[str] = set()
        for setting in SETTINGS:
            step(f"{setting.knob} {setting.label}")
            row = Row(setting.knob, setting.label, PROGRAM, setting.samples)
            if setting.knob in slow:
                yield row._replace(remark="left out: takes too long"), None
                continue
            run, picture = self.drawn(setting)
            runs = [run]
            if run.wall > longest:
                slow.add(setting.knob)
            while run.wall <= longest and len(self.calm(runs)) < RUNS and len(runs) < MOST_RUNS:
                runs.append(self.drawn(setting)[0])
            calm = self.calm(runs)
            times = Times(calm) if calm else Times(runs, DISTURBED_BY_OTHERS)
            yield with_times(with_errors(row, picture, right, seen), times), picture

    def calm(self, runs: list[Run]) -> list[Run]:
        """Return the undisturbed runs."""
        return [run for run in runs if not is_disturbed(run, self.threads)]

    def drawn(self, setting: Setting) -> tuple[Run, Picture]:
        """Render with a setting; return the time that POV-Ray took for the rays, and linear light in 16 bits."""
        command = [*COMMAND, f"+W{self.width}", f"+H{self.height}", f"+WT{self.threads}", "-D", "-V", "+FP16"]
        paths = "File_Gamma=1.0", "+Iscene.pov", "+Opicture.ppm"
        ended = subprocess.run([*command, *paths, *setting.options], cwd=self.folder, capture_output=True, check=False)
        printed = ended.stderr.decode(errors="replace")
        found = TRACE.findall(printed)
        if ended.returncode or not found:
            raise RenderError(f"{PROGRAM} failed: {printed.strip()[-200:]}")
        data = (self.folder / "picture.ppm").read_bytes()
        header = HEADER.match(data)
        if not header:
            raise RenderError(f"{PROGRAM} wrote no picture of 16 bits")
        light: Picture = np.frombuffer(data, ">u2", offset=header.end()).reshape(self.height, self.width, 3) / 65535.0
        wall, cpu = map(float, found[-1])
        return Run(wall, cpu + TICK), light
