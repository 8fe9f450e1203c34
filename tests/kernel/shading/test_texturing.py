"""What is painted on surfaces: boards, reliefs against differences of the raised surface, pictures of normals."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numba import njit

import minirt.kernel.compiler.jit  # noqa: F401  (attaches the compiler)
from minirt.kernel.compiler.options import FLAGS
from minirt.kernel.shading import texturing
from minirt.kernel.shading.texture_lookup import height_gradient
from minirt.kernel.shading.texturing import SurfaceMaps, bump_mapped, checkered, normal_mapped
from minirt.lanes import Vec, load, save, width
from minirt.shapes import KINDS, Kind
from tests.kernel.pictures import Array
from tests.shapes.charts import Chart
from tests.shapes.mapped import Mapped, cases, interpreted, lengths
from tests.shapes.regimes import unit, ways
from tests.shapes.ways import array, vec

SIDE = 256  # pixels of the relief
STRENGTH = 0.05
OWN, SECOND = (0.25, 0.5, 0.75), (1.0, 0.0, 0.125)


def height(u: Array, v: Array) -> Array:
    """A relief that fits to itself, from 0 to 1."""
    found: Array = 0.5 + 0.25 * np.sin(2 * np.pi * u) * np.cos(2 * np.pi * v) + 0.2 * np.sin(2 * np.pi * (u + 2 * v))
    return found


def page(pixels: Array) -> dict[str, Any]:
    """A picture (h, w, channels) as the kernel has it."""
    row = 0, pixels.shape[1], pixels.shape[0], pixels.shape[2]
    return {"texels": pixels.ravel().astype(np.float32), "pictures": np.array([row], np.int64)}


def skins_of(pixels: Array, strength: float = STRENGTH) -> SurfaceMaps:
    """Those of one shape with a picture of heights, of normals."""
    return SurfaceMaps(None, None, np.array([[1, strength]]), np.array([1]), np.array([1]), **page(pixels))


def relief(strength: float = STRENGTH) -> SurfaceMaps:
    places = (np.arange(SIDE) + 0.5) / SIDE
    return skins_of(height(places[None], 1 - places[:, None])[..., None], strength)


def plain(colour: tuple[int, int, int]) -> SurfaceMaps:
    """A picture of one colour."""
    return skins_of(np.tile(np.array(colour) / 255, (2, 3, 1)))


@njit(**FLAGS)
def raised_on_lanes(worn: Any, uv: Any, a: Any, b: Any, n: Any, out: Any) -> None:
    for i in range(0, out.shape[1], width(out)):
        along_u = Vec(load(a[0], i), load(a[1], i), load(a[2], i))
        along_v = Vec(load(b[0], i), load(b[1], i), load(b[2], i))
        normal = Vec(load(n[0], i), load(n[1], i), load(n[2], i))
        bent = bump_mapped(worn.bumps, worn, 0, load(uv[0], i), load(uv[1], i), along_u, along_v, normal)
        save(bent.x, out[0], i)
        save(bent.y, out[1], i)
        save(bent.z, out[2], i)


@njit(**FLAGS)
def turned_on_lanes(worn: Any, uv: Any, a: Any, b: Any, n: Any, out: Any) -> None:
    for i in range(0, out.shape[1], width(out)):
        along_u = Vec(load(a[0], i), load(a[1], i), load(a[2], i))
        along_v = Vec(load(b[0], i), load(b[1], i), load(b[2], i))
        normal = Vec(load(n[0], i), load(n[1], i), load(n[2], i))
        bent = normal_mapped(worn.normals, worn, 0, load(uv[0], i), load(uv[1], i), along_u, along_v, normal)
        save(bent.x, out[0], i)
        save(bent.y, out[1], i)
        save(bent.z, out[2], i)


LANES = {"raised": raised_on_lanes, "turned": turned_on_lanes}
PLAIN = {"raised": bump_mapped, "turned": normal_mapped}
Bend = Callable[[str, SurfaceMaps, Mapped, Array], Array]


def as_it_stands(name: str, worn: SurfaceMaps, at: Mapped, normals: Array) -> Array:
    table = worn.bumps if name == "raised" else worn.normals
    bent = PLAIN[name](table, worn, 0, at.u, at.v, vec(at.along_u), vec(at.along_v), vec(normals))
    return array(bent, normals)


def on_lanes(name: str, worn: SurfaceMaps, at: Mapped, normals: Array) -> Array:
    out = np.full((3, len(normals)), np.nan)
    vectors = (np.ascontiguousarray(each.T) for each in (at.along_u, at.along_v, normals))
    LANES[name](worn, np.stack([at.u, at.v]), *vectors, out)
    return out.T


EITHER = pytest.mark.parametrize("bend", [as_it_stands, on_lanes])
ALL = pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.element.title)


def of_raised(chart: Chart, u: Array, v: Array, strength: float, width: Array) -> Array:
    """The normals of a surface that is raised around each of the places u, v by the heights over that of the place, in
    widths of the picture there: by differences of its points."""
    middle = height(u, v)

    def point(a: float, b: float) -> Array:
        points, normals = chart(u + a, v + b)
        return points + (strength * width * (height(u + a, v + b) - middle))[:, None] * normals

    h = 1e-5
    return unit(np.cross(point(h, 0) - point(-h, 0), point(0, h) - point(0, -h)))


def worst(kind: Kind, bend: Bend, size: float = 1.0, strength: float = STRENGTH) -> float:
    """The largest angle between a normal and the right one."""
    off = []
    for case in cases(kind, size, 0.0):
        points, normals = case.chart(case.u, case.v)
        at = interpreted(case.shape, points, normals)
        got = bend("raised", relief(strength), at, normals)
        right = of_raised(case.chart, case.u, case.v, strength, lengths(at.along_u))
        off.append(float(lengths(got - right).max()))
    return max(off)


@ALL
@EITHER
@pytest.mark.parametrize("size", [1.0, 1e-6, 1e6])
def test_bumps_are_lit_as_the_raised_surface(kind: Kind, bend: Bend, size: float) -> None:
    for strength in (STRENGTH, -0.3):
        assert worst(kind, bend, size, strength) < 2e-3


WRONG: dict[str, Any] = {
    "left as it is": ("bump_mapped", lambda *given: given[-1]),
    "deep in the place of high": ("copysign", lambda x, sign: -np.copysign(x, sign)),
    "heights in units of the scene": ("inverse_length", lambda v: np.ones_like(v.x)),
    "u and v changed round": ("height_gradient", lambda *given: height_gradient(*given)[::-1]),
    "upside down": ("height_gradient", lambda *given: (height_gradient(*given)[0], -height_gradient(*given)[1])),
}


@ALL
@pytest.mark.parametrize("name", WRONG)
def test_wrong_ones_are_found(kind: Kind, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    function, wrong = WRONG[name]
    monkeypatch.setattr(texturing if function != "raised" else sys.modules[__name__], function, wrong)
    monkeypatch.setitem(PLAIN, "raised", bump_mapped)
    if (kind.element.title, function) != ("plane", "inverse_length"):  # there both are the same
        assert worst(kind, as_it_stands) > 0.02


@EITHER
def test_a_picture_that_is_mirrored_is_raised_outwards_too(bend: Bend) -> None:
    # As on a mesh whose file has it so.
    (case, *_) = cases(KINDS[0], 1.0, 0.0)
    points, normals = case.chart(case.u, case.v)
    at = interpreted(case.shape, points, normals)
    mirrored = at._replace(u=1 - at.u, along_u=-at.along_u)

    def chart(u: Array, v: Array) -> tuple[Array, Array]:
        return case.chart(1 - u, v)

    right = -of_raised(chart, 1 - case.u, case.v, STRENGTH, lengths(at.along_u))
    assert lengths(bend("raised", relief(), mirrored, normals) - right).max() < 2e-3


@EITHER
def test_a_flat_relief_leaves_every_normal_as_it_is(bend: Bend) -> None:
    # Also one that is not that of the tangents, as on a mesh that stands for something round.
    at, _ = askew()
    normals = unit(np.cross(at.along_u, at.along_v) + 0.5 * at.along_u)
    flat = skins_of(np.full((3, 4, 1), 0.7))
    assert lengths(bend("raised", flat, at, normals) - normals).max() < 1e-6


@EITHER
@pytest.mark.parametrize("name", LANES)
def test_where_the_tangents_are_zero_nothing_is_raised(bend: Bend, name: str) -> None:
    normals = ways(np.random.default_rng(2), 16)
    nothing = np.zeros((16, 3))
    worn = relief() if name == "raised" else plain((200, 50, 230))
    for a, b in ((nothing, nothing), (nothing, ways(np.random.default_rng(3), 16))):
        at = Mapped(np.full(16, 0.3), np.full(16, 0.6), a, b)
        got = bend(name, worn, at, normals)
        assert np.abs(lengths(got) - 1).max() < 1e-12
        if name == "raised" or b is nothing:
            assert lengths(got - normals).max() < 1e-12


def askew() -> tuple[Mapped, Array]:
    """Tangents of many lengths at an angle to each other, and normals."""
    random = np.random.default_rng(4)
    a, b = random.normal(size=(2, 32, 3)) * 10.0 ** random.uniform(-6, 6, (2, 32, 1))
    return Mapped(*random.random((2, 32)), a, b), unit(np.cross(unit(a), unit(b)))


@EITHER
def test_the_blue_of_a_normal_map_changes_nothing(bend: Bend) -> None:
    at, normals = askew()
    assert lengths(bend("turned", plain((128, 128, 255)), at, normals) - normals).max() < 1e-6
    assert lengths(bend("turned", plain((128, 128, 200)), at, normals) - normals).max() < 1e-6


@EITHER
@pytest.mark.parametrize(
    ("colour", "shares"),
    [
        ((255, 128, 128), (1, 0, 0)),
        ((1, 128, 128), (-1, 0, 0)),
        ((128, 255, 128), (0, 1, 0)),
        ((128, 1, 128), (0, -1, 0)),
        ((255, 128, 255), (1, 0, 1)),
        ((128, 128 - 50, 128 + 100), (0, -0.5, 1)),
        ((128 + 30, 128 + 60, 128 + 60), (0.5, 1, 1)),
    ],
)
def test_colours_of_a_normal_map_are_directions(bend: Bend, colour: Any, shares: Any) -> None:
    at, normals = askew()
    right = shares[0] * unit(at.along_u) + shares[1] * unit(at.along_v) + shares[2] * normals
    assert lengths(bend("turned", plain(colour), at, normals) - unit(right)).max() < 1e-6


@njit(**FLAGS)
def checkered_on_lanes(checks: Any, uv: Any, own: Any, out: Any) -> None:
    for i in range(0, out.shape[1], width(out)):
        colour = Vec(load(own[0], i), load(own[1], i), load(own[2], i))
        seen = checkered(checks, 0, load(uv[0], i), load(uv[1], i), colour)
        save(seen.x, out[0], i)
        save(seen.y, out[1], i)
        save(seen.z, out[2], i)


def boards(size: float, u: Array, v: Array) -> list[Array]:
    """The colours of places on a board, interpreted and compiled, (n, 3)."""
    checks = np.array([[size, *SECOND]])
    own = np.tile(np.array(OWN)[:, None], u.size)
    out = np.full((3, u.size), np.nan)
    checkered_on_lanes(checks, np.stack([u, v]), own, out)
    return [array(checkered(checks, 0, u, v, Vec(*own)), np.empty((u.size, 3))), out.T]


@pytest.mark.parametrize("size", [0.125, 1.0, 2.5, 1e-3, 1e6])
def test_squares_have_the_two_colours_in_turn(size: float) -> None:
    column, row = (each.ravel() for each in np.meshgrid(np.arange(-8, 8), np.arange(-8, 8)))
    for within in ((0.5, 0.5), (0.01, 0.99), (0.99, 0.01)):
        right = np.where(((column + row) % 2 == 0)[:, None], OWN, SECOND)
        for got in boards(size, (column + within[0]) * size, (row + within[1]) * size):
            assert np.array_equal(got, right)


def test_the_lower_left_corner_of_a_square_belongs_to_it() -> None:
    u, v = (np.resize(each, 16) for each in ((0.0, 0.125, 0.0, 0.125), (0.0, 0.0, 0.125, 0.125)))
    for got in boards(0.125, u, v):
        assert np.array_equal(got[:4], [OWN, SECOND, SECOND, OWN])


def test_a_shape_without_a_board_keeps_its_colour() -> None:
    u, v = np.random.default_rng(5).normal(size=(2, 16))
    for got in boards(0.0, u, v):
        assert np.array_equal(got, np.tile(OWN, (16, 1)))
