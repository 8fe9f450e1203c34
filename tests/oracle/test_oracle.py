"""The oracle itself, against answers known by hand."""

from __future__ import annotations

import pytest
from gmpy2 import mpfr, sqrt
from hypothesis import given, settings
from hypothesis import strategies as st

from minirt.shapes import KINDS
from minirt.shapes.hyperboloid import Hyperboloid
from tests.oracle.body import Body, Polynomial, body, crossings, dot, gradient

GREY = (9, 9, 9)
RING = Body((lambda p: (dot(p, p) + 9 - 1) ** 2 - 36 * (p[0] ** 2 + p[2] ** 2),))  # radii 3 and 1, about y
SQUARE = Body((lambda p: p[1],), (lambda p: p[0] ** 2 - 1, lambda p: p[2] ** 2 - 1), solid=False)
PIPE = Body((lambda p: p[0] ** 2 + p[2] ** 2 - 1,), (lambda p: p[1] ** 2 - 4,))  # open at both ends

numbers = st.floats(-1e6, 1e6).map(lambda x: mpfr(round(x, 3)))


def product(roots: list[mpfr], factor: mpfr) -> Polynomial:
    made = Polynomial(factor)
    for root in roots:
        made = made * Polynomial(-root, 1)
    return made


@settings(deadline=None, derandomize=True, max_examples=150)
@given(st.lists(numbers, min_size=1, max_size=5, unique=True), st.sampled_from([1, -3e-30, 7e20]))
def test_the_roots_of_a_polynomial(roots: list[mpfr], factor: float) -> None:
    found = product(roots, mpfr(factor)).roots()
    assert len(found) == len(roots)
    for one, other in zip(found, sorted(roots), strict=True):
        assert abs(one - other) <= abs(other) * mpfr("1e-35")


def test_close_multiple_and_missing_roots() -> None:
    close = [mpfr(1), 1 + mpfr("1e-20"), mpfr(5)]
    assert max(abs(x - y) for x, y in zip(product(close, mpfr(1)).roots(), close, strict=True)) < mpfr("1e-38")
    assert Polynomial(4, -4, 1).roots() == [2]  # a double root
    assert Polynomial(0, 0, 0, 1).roots() == [0]
    assert Polynomial(1, 0, 1).roots() == Polynomial(1).roots() == Polynomial(0).roots() == []
    assert Polynomial(-1, 0, 0, 1, 0).roots() == [1]  # one turn only, and a coefficient that is 0
    small, _ = Polynomial(1, -1, mpfr("1e-90")).roots()
    assert abs(small - 1) < mpfr("1e-55")


def test_many_walls_and_many_roots() -> None:
    assert crossings(RING, [-9, 0, 0], [1, 0, 0]) == pytest.approx([5, 7, 11, 13])
    assert crossings(RING, [0, 9, 0], [0, -1, 0]) == []
    assert crossings(SQUARE, [0.5, 3, 0], [0, -1, 0]) == [3]
    assert crossings(SQUARE, [1.5, 3, 0], [0, -1, 0]) == []
    assert crossings(PIPE, [0, 0, -3], [0, 0, 1]) == [2, 4]
    assert crossings(PIPE, [0, 9, 0], [0, -1, 0]) == []
    assert crossings(PIPE, [-3, 4.5, 0], [0.75, -0.75, 0]) == pytest.approx([16 / 3])  # over the rim, at the far wall


@pytest.mark.parametrize("sizes", [(0.2, 4, 0.2), (1e-6, 4, 0.01), (3, 4, 50), (4, 4, 4)])
def test_the_side_of_a_hyperboloid_moves_by_at_least_the_swell(sizes: tuple[float, float, float]) -> None:
    shape, swell = Hyperboloid((0, 0, 0), (0, 0, 1), *sizes, GREY), mpfr(1e-20)
    waist, radius, half = (mpfr(x) / 2 for x in sizes)
    for share in map(mpfr, (0, 1e-3, 0.1, 0.5, 1)):
        rho = sqrt(waist**2 + (radius**2 - waist**2) * share**2)
        slope = gradient(body(shape).walls[0], [rho, mpfr(0), share * half])
        steepness = sqrt(dot(slope, slope))
        for sign in (1, -1):
            moved = -sign * body(shape, sign * swell).walls[0]([rho, mpfr(0), share * half]) / steepness
            assert moved >= swell * (1 - mpfr(1e-6))
    # Planted: a constant of twice the radius, by which steep rims move too little.
    assert (2 * radius < steepness * (1 - mpfr(1e-6))) == (waist < radius)


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.element.title)
def test_the_oracle_knows_every_shape(kind: object) -> None:
    assert kind.element in body.registry
