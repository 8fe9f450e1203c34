"""The torus' formulas, against answers known by hand; rays that are hard for them are in `tests.stability`."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from minirt.lanes import Mask, Number, Vec
from minirt.shapes import torus as module
from minirt.shapes.shape import Position
from minirt.shapes.torus import PackedTorus, Torus
from tests.seeds import RUN
from tests.shapes.execution_modes import Intersect, compiled, on_arrays, vec, with_numpy_numbers
from tests.shapes.regimes import GREY, RAYS, unit
from tests.stability.verdicts import wrong

RING = Torus((0, 1, 5), (0, 1, 0), 6, 2, GREY)  # radii 3 and 1


@pytest.mark.parametrize("tube", [2, 6])
@pytest.mark.parametrize("intersect", [on_arrays, compiled])
def test_no_ray_depends_on_its_neighbours_in_a_packet(intersect: Intersect, tube: float) -> None:
    torus, random = RING.replace(tube=tube), np.random.default_rng(3)
    # Many of such rays are in a plane through the axis or across it, and leave nothing but rounding.
    targets, origins = np.array(torus.centre) + random.integers(-8, 9, (2, 200 * RAYS, 3)) / 2
    directions = unit(targets + (targets == origins).all(axis=1, keepdims=True) - origins)
    order = random.permutation(200 * RAYS)
    t = intersect([torus], origins[None], directions[None])[0]
    packets = intersect(200 * [torus], *(part[order].reshape(200, RAYS, 3) for part in (origins, directions)))
    assert np.isfinite(t).sum() > 500
    assert np.array_equal(packets.reshape(-1), t[order])


@pytest.mark.parametrize(
    ("tube", "origin", "target", "most"),
    [
        (1, (0, -5, 2), (0, -3, 0), 12),
        (1, (-7e6, -1e6, 5), (1, 3, 0), 30),
        (0.01, (0, 1, 0), (0, -3, 0), 12),  # its first place in the tube's wall is as near as can be told
        (1, (-4 + 1e-13, 0, 0), (-5, 7, 6), 13),  # from closely inside of it
        (3, (1.5, 0.5, 0), (-5, -7, 0), 36),  # what height is left is rounding, of either sign
    ],
)
def test_newtons_method_ends(
    tube: float, origin: tuple[float, ...], target: tuple[float, ...], most: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    looks: list[bool] = []
    monkeypatch.setattr(module, "any", lambda mask: looks.append(mask) or bool(mask))
    x, y, z = (Vec(*row) for row in np.eye(3))
    upright = PackedTorus(Position(Vec(0.0, 0.0, 0.0)), x, y, z, 3, tube)
    direction = unit(np.subtract(target, origin))
    with np.errstate(all="ignore"):
        hit, _ = module.intersect(upright, vec(np.array(origin, float)), vec(direction))
    assert hit
    assert len(looks) <= most


def test_only_rays_near_the_torus_are_solved(monkeypatch: pytest.MonkeyPatch) -> None:
    rays = np.array(
        [
            ((0, 1, 0), (0, 0, 1)),  # hits
            ((0, 1, 9), (0, 0, -1)),
            ((0, 1, 10), (0, 0, 1)),  # behind it
            ((4.05, 1, 0), (0, 0, 1)),  # beside it
            ((9, 1, 0), (0, 0, 1)),
            ((0, 4.5, 6), (0, -0.28, 0.96)),  # over it, and out of the ball around it
            ((-4.5, 9, 5), (0, -1, 0)),
            ((0, 3, 0), (0, 0, 1)),  # over it
        ]
    )
    near, asked = [True, True, *[False] * 6], list[Mask]()
    real = module.turning_points

    def recorded(torus: PackedTorus, p: Vec, d: Vec, mask: Mask) -> tuple[Number, Number, Number]:
        asked.append(mask)
        return real(torus, p, d, mask)

    monkeypatch.setattr(module, "turning_points", recorded)
    for i, come in enumerate(near):
        asked.clear()
        on_arrays([RING], rays[None, i : i + 1, 0], rays[None, i : i + 1, 1])
        assert len(asked) == come
    asked.clear()
    on_arrays([RING], rays[None, :, 0], rays[None, :, 1])
    assert np.array_equal(asked, [near])


def test_a_newton_step_out_of_the_bracket_is_not_taken(intersect: Intersect) -> None:
    thin = Torus((0, 0, 0), (0, 0, 1), 2, 2 * 0.034751787197153904, GREY)
    origin = np.array([1.0217727611113592, -0.23003780827641834, -0.035576964714855296])
    direction = np.array([-0.9962543729509578, -0.08488865002048886, 0.01646637403295192])
    rays = np.tile(origin, (RAYS, 1)), np.tile(direction, (RAYS, 1))
    assert not wrong(thin, *rays, intersect([thin], *(part[None] for part in rays))[0])


def never_exact(*_: Any) -> Number:
    """A crossing that a shadow ray takes for the end of its interval."""
    return np.inf


@pytest.mark.parametrize("planted", [False, True])
def test_shadow_rays_end_where_they_end(planted: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    random = np.random.default_rng(RUN)
    targets = np.array(RING.centre) + random.uniform(-3, 3, (4000, 3))
    origins = targets + 9 * unit(random.normal(size=(4000, 3)))
    rays = with_numpy_numbers(RING.pack()), vec(origins), vec(unit(targets - origins))
    with np.errstate(all="ignore"):
        hit, t = module.intersect(*rays)
        if planted:
            monkeypatch.setattr(module, "crossing", never_exact)
        same = True
        for limit in (np.full(4000, np.inf), t, np.nextafter(t, np.inf), t * random.uniform(0.9, 1.1, 4000)):
            occluded, bound = module.intersect(*rays, limit)
            same &= np.array_equal(hit & (t < limit), occluded & (bound < limit))
    assert hit.sum() > 500
    assert same != planted, RUN
