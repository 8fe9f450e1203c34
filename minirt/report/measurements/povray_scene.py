"""Scenes in POV-Ray's language, limited to what means exactly the same there.

POV-Ray's Lambert term, ambient light, Phong and Blinn highlights and mirrors are those of miniRT. Textures, glass and
lights that fade or have a direction are not translated.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from minirt.element import fields_of
from minirt.errors import RenderError
from minirt.materials import Attributes
from minirt.rendering.packing.camera import camera_numbers
from minirt.rendering.packing.features import DEPTH
from minirt.rendering.packing.materials import mirror_of
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
        names = (
            (f"specular {share}", f"roughness {1 / exponent}")
            if blinn
            else (f"phong {share}", f"phong_size {exponent}")
        )
        highlight = " ".join(names)
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
