"""Shapes that are turned about their own axis, against 60 digits and against the same shapes unturned."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from gmpy2 import const_pi, cos, mpfr, sin

from minirt.element import fields_of
from minirt.fields import Colour, cos_and_sin
from minirt.shapes import KINDS, Box, Disc, Kind, Sphere, Square, Triangle
from minirt.shapes.shape import Oriented
from tests.meshes.examples import named
from tests.reference.hits import own_axes
from tests.reference.vectors import turned
from tests.seeds import RUN
from tests.shapes.examples import example, place
from tests.shapes.execution_modes import MODES, on_arrays, shape_rows, surfaces
from tests.shapes.mapping_checks import interpreted
from tests.shapes.regimes import RAYS, Array, Rays, random_directions, unit
from tests.stability.rays import meeting
from tests.stability.verdicts import BOUND, Wrong, off, wrong

U = 2.0**-53
ROLLS = (90.0, 33.3, -200.0, 1e-3)
ORIENTED = [kind for kind in KINDS if issubclass(kind.element, Oriented) and kind.element is not Sphere]
ANGULAR = [kind for kind in ORIENTED if not kind.element.revolved]  # type: ignore[attr-defined]


def rolled(kind: Kind) -> list[Any]:
    """Random shapes of a kind, each turned by one of ROLLS."""
    chance = np.random.default_rng(5)
    return [example(kind, chance).replace(roll=roll) for roll in ROLLS]


SLIP = 1e-9  # relative change of a field


def posed(kind: Kind) -> Rays:
    """Shapes of a kind, turned and rolled anyhow, and rays at and near them; at a sheet, just outside of its edges."""
    chance = np.random.default_rng(RUN)
    shapes = [example(kind, chance) for _ in range(6)]
    if kind in ANGULAR:
        shapes = [shape.replace(roll=chance.uniform(-360, 360)) for shape in shapes]
    middles = np.array([place(shape) for shape in shapes])[:, None]
    targets = middles + chance.uniform(-1, 1, (len(shapes), 64, 3)) * chance.random((len(shapes), 64, 1)) ** 2
    if kind.element in (Disc, Square, Triangle):
        edges = np.stack([np.zeros(RAYS, int), 1 + np.arange(RAYS) % {Disc: 1, Square: 2, Triangle: 3}[kind.element]])
        targets[:, :RAYS] = [meeting(shape, each[:RAYS], edges) for shape, each in zip(shapes, targets, strict=True)]
        targets[:, :RAYS] += SLIP / 4 * (targets[:, :RAYS] - middles)
    origins = middles + 6 * random_directions(chance, *targets.shape[:2])
    return Rays(shapes, origins, unit(targets - origins))


def slipped(shape: Any, name: str) -> Any:
    """A shape with one field changed by 1e-9, of three numbers the first."""
    value = getattr(shape, name)
    if isinstance(value, float):
        return shape.replace(**{name: value * (1 + SLIP)})
    return shape.replace(**{name: (value[0] * (1 + SLIP), *value[1:])})


def wrong_of(rays: Rays, t: Array, most: int = 4) -> list[Wrong]:
    """The wrong ones of the answers t to rays."""
    return [each for *one, at in zip(*rays, t, strict=True) for each in wrong(*one, at, most)]


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.element.title)
def test_hits_are_those_of_the_oracle_which_knows_all_fields(kind: Kind) -> None:
    rays = posed(kind)
    answers = [intersect(*rays) for intersect in MODES.values()]
    assert np.isfinite(answers[0]).sum() > 20, RUN
    for t in answers:
        assert not [str(each) for each in wrong_of(rays, t)], RUN
        assert all(
            np.nanmax([*off(*one, np.where(np.isfinite(at), at, np.nan)), 0]) <= BOUND
            for *one, at in zip(*rays, t, strict=True)
        )
    # Planted: formulas that know a field to nine digits only, or that ignore the roll.
    names = [each.name for each in fields_of(kind.element) if not (each.keyed or isinstance(each, Colour))]
    for name in names + ["roll"] * (kind in ANGULAR):
        wrong = rays._replace(shapes=[slipped(shape, name) for shape in rays.shapes])
        assert wrong_of(rays, on_arrays(*wrong), most=1), (name, RUN)
    if kind in ANGULAR:
        unturned = rays._replace(shapes=[shape.replace(roll=0.0) for shape in rays.shapes])
        assert wrong_of(rays, on_arrays(*unturned), most=1)


@pytest.mark.parametrize("kind", ORIENTED, ids=lambda kind: kind.element.title)
def test_pictures_turn_with_their_shapes(kind: Kind) -> None:
    for shape in rolled(kind):
        plain = shape.replace(roll=0.0)
        u, v, axis = (np.array([each.x, each.y, each.z]) for each in plain.frame())
        centre = next(getattr(plain, name) for name in ("point", "centre", "apex", "vertex") if hasattr(plain, name))
        near = np.array(centre) + np.random.default_rng(7).normal(size=(16, 3))
        points, normals = (each[0] for each in surfaces([plain], near[None]))
        here = interpreted(plain, points, normals)
        there = interpreted(
            shape, centre + turned(points - centre, axis, shape.roll), turned(normals, axis, shape.roll)
        )
        beside = np.abs((there.u - here.u + 0.5) % 1 - 0.5)  # a longitude of 0 may become 1
        assert max(beside.max(), np.abs(there.v - here.v).max()) <= 1e-12
        for before, after in ((here.along_u, there.along_u), (here.along_v, there.along_v)):
            assert np.abs(turned(before, axis, shape.roll) - after).max() <= 1e-11 * max(1, np.abs(before).max())
        assert np.allclose(np.cross(u, v), axis)


def test_without_a_turn_the_packed_form_has_the_same_bits() -> None:
    for kind in ORIENTED:
        shape = example(kind, np.random.default_rng(8))
        assert all(np.array_equal(shape_rows([shape]), shape_rows([shape.replace(roll=roll)])) for roll in (0.0, -0.0))


@pytest.mark.parametrize("degrees", [0, 90, -90, 180, 270, 360, -360])
def test_right_angles_are_exact(degrees: float) -> None:
    c, s = cos_and_sin(degrees)
    assert (c, s) == (round(np.cos(np.radians(degrees))), round(np.sin(np.radians(degrees))))
    box = Box((0, 0, 0), (0, 1, 0), (1, 2, 3), (9, 9, 9), roll=degrees)
    assert {abs(part) for corner in box.corners() for part in corner} == {0.5, 1.0, 1.5}


@pytest.mark.parametrize("degrees", [1e-9, 30, 45.1, -77, 135, 359.999])
def test_cosine_and_sine_are_those_of_the_angle(degrees: float) -> None:
    angle = mpfr(degrees) * const_pi() / 180
    assert cos_and_sin(degrees) == pytest.approx((float(cos(angle)), float(sin(angle))), rel=4 * U, abs=0)


TURNS: list[tuple[tuple[float, float, float], float]] = [
    ((0.0, 1.0, 0.0), 30.0),
    ((0.6, 0.0, 0.8), 0.0),
    ((0.48, -0.6, 0.64), -100.0),
]


@pytest.mark.parametrize(("axis", "roll"), TURNS)
def test_a_mesh_is_turned_about_its_origin(axis: tuple[float, float, float], roll: float) -> None:
    plain = named("knot", (1.0, 2.0, 3.0), 2.0)
    mesh = plain.replace(axis=axis, roll=roll)
    turn = own_axes(mesh)
    before, after = plain.rows(), mesh.rows()
    corners = (before[:, :9].reshape(-1, 3) - plain.position) @ turn + plain.position
    assert np.abs(after[:, :9].reshape(-1, 3) - corners).max() <= 1e-14 * 10
    for column in (9, 12, 15, 18):
        assert np.abs(after[:, column : column + 3] - before[:, column : column + 3] @ turn).max() <= 1e-9
    assert np.array_equal(after[:, 21:], before[:, 21:])
    (low, high), placed = mesh.bounds(), after[:, :9].reshape(-1, 3)
    assert (low, high) == (tuple(placed.min(axis=0)), tuple(placed.max(axis=0)))


def test_equal_points_of_a_turned_mesh_stay_equal() -> None:
    mesh = named("icosphere").replace(axis=(0.48, -0.6, 0.64), roll=12.3)
    for count in range(1, 40):
        placed = mesh.placed(np.tile([0.1, 0.7, -0.3], (count, 1)))
        assert (placed == placed[0]).all()
        assert (placed[0] == mesh.placed(np.array([[0.1, 0.7, -0.3]]))[0]).all()
