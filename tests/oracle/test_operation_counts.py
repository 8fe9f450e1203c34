"""The exact formulas take few more operations than the textbook formulas."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

from minirt.kernel.scene_arrays import row_type
from minirt.lanes import Vec, any, dot, sqrt, unit, where
from minirt.rendering.packing.shape_arrays import packed_rows
from minirt.shapes import KINDS, Kind, Shape, sphere
from minirt.shapes.compensated import power_of_point
from minirt.shapes.cone import Cone
from minirt.shapes.cylinder import Cylinder
from minirt.shapes.hyperboloid import Hyperboloid
from minirt.shapes.paraboloid import Paraboloid
from minirt.shapes.plane import Plane
from minirt.shapes.sphere import PackedSphere, Sphere
from minirt.shapes.triangle import Triangle
from tests.oracle import textbook
from tests.oracle.jit_formula import probe
from tests.oracle.operation_counts import PACKET, Work, work
from tests.oracle.random_rays import Rays
from tests.oracle.regimes import regimes_of

KIND = {kind.element: kind for kind in KINDS}
ELEMENTS = pytest.mark.parametrize("element", textbook.FORMULAS, ids=lambda element: element.title)

# Limits of all operations, as multiples of the textbook formula's. The triangle pays for being watertight, for rays
# that graze it or start on it, the sphere for precision with small and far shapes, the cone for rays beside its
# generators and its apex.
TIMES = {Sphere: 2.0, Triangle: 1.8, Cone: 1.35} | dict.fromkeys((Plane, Cylinder, Paraboloid, Hyperboloid), 1.25)
# Divisions and roots more than those of the textbook's, a packet. The tenth is for packets that a formula skips: which
# have no ray that may hit is not quite the same for both.
SLOW = {Triangle: 1.0} | dict.fromkeys((Sphere, Plane, Cylinder, Cone, Paraboloid, Hyperboloid), 0.1)


def rays_of(kind: Kind, count: int = 32) -> Rays:
    (benign,) = (each for each in regimes_of(kind) if each.name == "benign")
    return benign.pose(kind, np.random.default_rng(11), 64, count)


def is_cheap(element: type[Shape], formula: Any) -> bool:
    """Test whether a formula stays within its limits relative to the textbook formula."""
    rays = rays_of(KIND[element])
    own, other = work(formula, rays), work(textbook.FORMULAS[element], rays)
    return own.all <= TIMES[element] * other.all and own.slow <= other.slow + SLOW[element]


@ELEMENTS
def test_exact_formulas_take_little_more_than_those_of_textbooks(element: type[Shape]) -> None:
    assert set(TIMES) == set(textbook.FORMULAS)
    assert is_cheap(element, KIND[element].intersect)


def always_exact(ball: PackedSphere, origin: Vec, direction: Vec) -> Any:
    """Planted expensive formula of the sphere: it computes the power of each origin with twice the digits."""
    hit, t = sphere.intersect(ball, origin, direction)
    return hit & (power_of_point(origin, ball.centre, ball.radius) > 0.0), t


def with_unit_directions(ball: PackedSphere, origin: Vec, direction: Vec) -> Any:
    """Planted expensive formula of the sphere: it takes a root and a division more than it needs."""
    return sphere.intersect(ball, origin, unit(direction))


@pytest.mark.parametrize("formula", [always_exact, with_unit_directions])
def test_a_formula_that_costs_more_does_not_pass(formula: Any) -> None:
    assert not is_cheap(Sphere, formula)


def test_operations_by_hand() -> None:
    rays = rays_of(KIND[Sphere], PACKET)
    assert work(lambda ball, origin, direction: dot(origin, direction), rays) == Work(5, 0)
    assert work(lambda ball, origin, direction: origin - ball.centre, rays) == Work(3, 0)
    assert work(lambda ball, origin, direction: ball.radius * ball.radius, rays) == Work(0, 0)
    assert work(lambda ball, origin, direction: sqrt(origin.x) / direction.x, rays) == Work(2, 2)
    assert work(lambda ball, origin, direction: where(origin.x < 0.0, origin.x, direction.x), rays) == Work(2, 0)
    for least, total in ((0.5, Work(8, 1)), (2.0, Work(7, 0))):  # what no ray of a packet needs is not counted
        assert work(lambda _, __, d, least=least: any(dot(d, d) > least) and sqrt(d.x), rays) == total


@ELEMENTS
def test_a_compiled_formula_is_one_function(element: type[Shape]) -> None:
    """All called functions are inlined: a call would pass vectors through memory."""
    for formula in (KIND[element].intersect, textbook.FORMULAS[element]):
        shapes, origins, directions = rays_of(KIND[element])
        packed = np.ascontiguousarray(packed_rows([shape.pack() for shape in shapes])).view(row_type(KIND[element]))[
            :, 0
        ]
        o, d = (np.ascontiguousarray(each.reshape(-1, 3).T) for each in (origins, directions))
        run = probe(formula)
        run(packed, origins.shape[1], o, d, np.empty(o.shape[1]), 1)
        (code, *_) = run.inspect_llvm().values()
        body = re.search(r"^define .*?^}", code, re.MULTILINE | re.DOTALL)
        assert body
        calls = re.findall(r"call[^\n]*? @([\w.]+)\(", body[0])
        assert {name.split(".")[0] for name in calls} <= {"llvm"}
