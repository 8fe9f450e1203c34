"""Scenes in POV-Ray's language, limited to what means exactly the same there, and its errors beside ours.

POV-Ray's Lambert term, ambient light, Phong and Blinn highlights and mirrors are those of miniRT. Textures, glass and
lights that fade or have a direction are not translated.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterable, Iterator
from pathlib import Path
from statistics import median

import numpy as np

from minirt import load
from minirt.element import fields_of
from minirt.errors import RenderError
from minirt.materials import Attributes
from minirt.materials.glass import mirror_of
from minirt.rendering.packing.camera import camera_numbers
from minirt.rendering.packing.features import DEPTH
from minirt.report.metrics import Picture, rmse
from minirt.report.pictures import ReferencePicture, SettingRenderer, crops_for, reference
from minirt.report.settings import ADAPTIVE, AUTO, UNIFORM, Setting
from minirt.scene import Ambient, Lamp, Light, Scene
from minirt.shapes import Cone, Cylinder, Disc, Plane, Shape, Sphere, Triangle
from tests.bench import measure
from tests.bench.measure import INSTALL, MissingError
from tests.processes import run

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


# Error against run time, of POV-Ray and of miniRT.

CHECKED = 2  # samples along an edge of a pixel, of the picture that shows whether the scene is the same
SAME = 0.02  # RMSE: a picture of four samples per pixel that is further off is not that of the scene
TRACE = re.compile(r"Trace Time:.*\(([\d.]+) seconds\)")
RUNS = 3
SEED = 20240607

GRID = "+AM1 +A0.0 -J +R{}"  # options for a grid of n x n samples in each pixel
# Names and options: grids, and supersampling where colours differ by more than a threshold, with 81 samples at most.
OPTIONS = {"POV-Ray 1": "-A"}
OPTIONS |= {f"POV-Ray {n * n}": GRID.format(n) for n in (2, 3, 4)}
OPTIONS |= {f"POV-Ray adaptive A{limit:g}": f"+AM2 +A{limit:g} +R3 -J" for limit in (0.3, 0.1, 0.03, 0.01)}
OURS = (*(Setting(UNIFORM, n) for n in (1, 4, 16)), *(Setting(ADAPTIVE, n) for n in (4, 16)), Setting(AUTO, 0.002))


class Antialiased:
    """Renders a scene with POV-Ray: `MissingError` where that is not installed, RenderError where it cannot show it."""

    def __init__(
        self, scene: Scene, width: int, height: int, threads: int, folder: Path, command: str = "povray"
    ) -> None:
        if not shutil.which(command):
            raise MissingError(f"POV-Ray: povray is not installed; {INSTALL}")
        self.command, self.size, self.threads, self.folder = command, (width, height), threads, folder
        (folder / "scene.pov").write_text("\n".join([*translated(scene, width, height), ""]), encoding="ascii")

    def check(self, right: ReferencePicture) -> None:
        """RenderError if the picture is not that of the scene."""
        error = rmse(right.crops.of(self.drawn(GRID.format(CHECKED))[1]), right.picture)
        if error > SAME:
            raise RenderError(f"POV-Ray shows something else: RMSE {error:.2g} at {CHECKED**2} samples per pixel")

    def drawn(self, options: str) -> tuple[float, Picture]:
        """Render with some options; return the milliseconds for the rays, and linear light in 16 bits."""
        width, height = self.size
        paths = f"{self.folder / 'scene.pov'}", f"{self.folder / 'picture.ppm'}"
        command = [
            self.command,
            f"+W{width}",
            f"+H{height}",
            f"+WT{self.threads}",
            "-D",
            "-V",
            "+FP16",
            "File_Gamma=1.0",
        ]
        ended = run([*command, f"+I{paths[0]}", f"+O{paths[1]}", *options.split()], text=True)
        found = TRACE.findall(ended.stderr)
        if ended.returncode or not found:
            raise RenderError(f"POV-Ray failed: {ended.stderr.strip()[-200:]}")
        data = Path(paths[1]).read_bytes()[-6 * width * height :]  # without its header
        light: Picture = np.frombuffer(data, ">u2").reshape(height, width, 3) / 65535.0
        return float(found[-1]) * 1e3, light


def errors(path: Path, setting: measure.Setting, samples: int = 256) -> str:
    """Return a table of the errors and times of both programs on a scene."""
    scene, (width, height, threads, folder) = load(path), setting
    other = Antialiased(scene, width, height, threads, folder)
    right = reference(scene, crops_for(scene, width, height, 2**17), samples, SEED)
    other.check(right)
    stage = SettingRenderer(scene, width, height, threads, 1.0)
    rows = [stage.measured(each, right)[0] for each in OURS]
    stage.take_times(0.0)
    lines = [f"{path.stem + ', ms and RMSE':<24}"]
    lines += [
        f"miniRT {row.name:<17}{median(run.wall for run in stage.times[row.name]) * 1e3:>10.1f} {row.rmse:.5f}"
        for row in rows
    ]
    for name, options in OPTIONS.items():
        drawn = [other.drawn(options) for _ in range(RUNS)]
        error = rmse(right.crops.of(drawn[0][1]), right.picture)
        lines.append(f"{name:<24}{median(ms for ms, _ in drawn):>10.1f} {error:.5f}")
    return "\n".join(lines)
