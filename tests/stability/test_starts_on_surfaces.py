"""Pictures of scenes in which the eye lies exactly on a curved solid, or on the axis of a cone."""

from __future__ import annotations

import numpy as np
import pytest

from minirt.element import fields_of
from minirt.fields import Length, Lengths, Point
from minirt.scene import Ambient, Camera, Light, Scene
from minirt.shapes import Shape
from minirt.shapes.cone import Cone
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.ellipsoid import Ellipsoid
from minirt.shapes.hyperboloid import Hyperboloid
from minirt.shapes.paraboloid import Paraboloid
from minirt.shapes.sphere import Sphere
from minirt.shapes.torus import Torus
from tests.kernel.pictures import linear

WHITE, GREEN = (255, 255, 255), (0, 255, 0)
AT_1_0_0 = (  # solids whose side contains the point 1,0,0
    Sphere((0, 0, 0), 2, GREEN),
    Cylinder((0, 0, 0), (0, 1, 0), 2, 5, GREEN),
    Cone((0, 4, 0), (0, -1, 0), 4, 8, GREEN),
    Paraboloid((0, -4, 0), (0, 1, 0), 2 * 2**0.5, 8, GREEN),
    Hyperboloid((0, 0, 0), (0, 1, 0), 2, 4, 4, GREEN),
    Ellipsoid((0, 0, 0), (0, 1, 0), (2, 6, 2), GREEN),
    Torus((0, 0, 0), (0, 1, 0), 1.4, 0.6, GREEN),
)


def scaled(shape: Shape, factor: float) -> Shape:
    """A shape that is larger by a factor, as seen from the origin: each number is rounded once."""
    new = {}
    for field in fields_of(type(shape)):
        value = getattr(shape, field.name)
        if isinstance(field, Length):
            new[field.name] = factor * value
        elif isinstance(field, Point | Lengths):
            new[field.name] = tuple(factor * part for part in value)
    return shape.replace(**new)


def place(shape: Shape) -> str:
    """The name of the field that places a shape."""
    return next(field.name for field in fields_of(type(shape)) if isinstance(field, Point))


def picture(eye: Camera, lamp: Light, shape: Shape, width: int, height: int, scale: float = 1.0) -> np.ndarray:
    """The green light of a picture of a shape. The other solids are far behind the eye: one kernel is for all."""
    behind = [scaled(each, scale / 8).replace(**{place(each): (0, 0, -1e3 * scale)}) for each in AT_1_0_0]
    return linear(Scene((Ambient(0.3, WHITE), eye, lamp, shape, *behind)), width, height)[..., 1]


@pytest.mark.parametrize("scale", [1.0, 1e-6, 1e-3, 1e4, 1e9])
@pytest.mark.parametrize("shape", AT_1_0_0, ids=lambda shape: shape.title)
def test_an_eye_on_the_surface_sees_the_inside_on_one_side_and_nothing_on_the_other(shape: Shape, scale: float) -> None:
    eye = Camera((scale, 0, 0), (0, 0, 1), 90)
    lamp = Light((0, 0, 0.7 * scale), 1.0)
    lit = picture(eye, lamp, scaled(shape, scale), 41, 31, scale)
    outside, inside = lit[10:21, :18], lit[10:21, 23:]
    assert (outside == 0).all()
    assert (inside >= 0.3 * (1 - 1e-15)).all()
    assert np.abs(np.diff(inside, axis=1)).max() < 0.1  # no grain
    assert inside.max() > 0.4 or isinstance(shape, Torus)  # the lamp is inside, too


@pytest.mark.parametrize("size", [3, 21, 31, 101])
def test_a_cone_seen_along_its_axis_has_no_hole(size: int) -> None:
    eye = Camera((0, 0, -10.4), (0, 0, 1), 60)
    cone = Cone((0, 0, 3.42), (0, 0, -1), 0.8, 3.42, WHITE)
    seen = picture(eye, Light((0, 0, -10), 0.5), cone, size, size) > 0
    assert seen[size // 2, size // 2]
    assert (seen == seen[::-1]).all()
    assert (seen == seen[:, ::-1]).all()
