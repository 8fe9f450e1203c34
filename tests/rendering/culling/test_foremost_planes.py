"""Planes that are hidden wherever one looks are left out of the lists of a crowd, and no picture changes by that."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import minirt
from minirt.kernel.binning import Grid
from minirt.rendering.culling import dual_hull, foremost_planes, hidden_planes
from minirt.rendering.scene_packing import Packing
from tests.rendering.culling.test_hidden_planes import HEIGHT, WIDTH, cull_all, light_of

EYE = np.array([1.0, 2.0, -3.0])
FOCUS = "A 0.2 255,255,255\nC 1,2,-3 0.2,0.1,1 80 lens:0.3 focus:6\n"
HEAD = "A 0.2 255,255,255\nC 1,2,-3 0.2,0.1,1 80\n"
LIGHTS = "L 4,2,-1 0.6 255,255,255\nl -3,3,-5 0.5 255,200,100\nl 9,-50,-60 0.5 255,200,100\n"
PLANES = 120
AXES = np.concatenate([np.eye(3), -np.eye(3)])


def unit(vectors: np.ndarray) -> np.ndarray:
    """Return vectors (n, 3) with the length 1."""
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1)[:, None])


def families() -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Return the points and the normals of planes of which most are never seen, by name."""
    rng = np.random.default_rng(1)
    tilted = np.tile(unit(np.array([[0.1, 1.0, 0.05]])), (PLANES, 1))
    sides, signs = AXES[rng.integers(0, 6, PLANES)], rng.choice([-1.0, 1.0], (2, PLANES))
    up = np.tile([0.0, 1.0, 0.0], (PLANES, 1))
    heights = up * 9 * (signs[0] * rng.uniform(1, 9, PLANES))[:, None]
    coincident = -9 * up * (1 + 1e-15 * rng.integers(0, 99, PLANES))[:, None]
    coincident[:, 0] = 1e-9 * rng.integers(0, 2, PLANES)
    normals = unit(rng.normal(size=(PLANES, 3)))
    return {
        "repeated": (-up, tilted),
        "box": (EYE + 9 * sides, sides),  # all sides as far away
        "parallel": (heights, tilted * signs[1][:, None]),
        "nearly parallel": (heights, unit(tilted + rng.normal(0, 1e-3, (PLANES, 3)))),
        "nearly the same": (-9 * up * (1 + 1e-9 * rng.integers(0, 9, PLANES))[:, None], tilted),
        "same within rounding": (coincident, tilted),
        "through the eye": (np.tile(EYE, (PLANES, 1)), normals[rng.integers(0, 5, PLANES)]),
        "around": (EYE + normals * rng.uniform(6, 60, PLANES)[:, None], normals),
    }


FAMILIES = families()


def scene_of(name: str, head: str = HEAD, look: str = "") -> minirt.Scene:
    """Return a scene of a family of planes of different colours, each third one with another look, and a sphere."""
    lines = []
    for i, plane in enumerate(zip(*FAMILIES[name], strict=True)):
        point, normal = (",".join(map(repr, each.tolist())) for each in plane)
        lines.append(f"pl {point} {normal} {i % 256},90,{255 - i % 256}{'' if i % 3 else look}\n")
    return minirt.loads(head + LIGHTS + "".join(lines) + "sp 1,1,2 0.7 255,255,255\n")


def cull_as_crowd(monkeypatch: pytest.MonkeyPatch) -> None:
    """Treat planes as a crowd that culling in the cells leaves too many of."""
    cull_all(monkeypatch)
    monkeypatch.setattr(foremost_planes, "PER_CELL", 0)


@pytest.mark.parametrize("name", FAMILIES)
@pytest.mark.parametrize(("head", "look"), [(HEAD, ""), (HEAD, " glass:1.2,0.5"), (FOCUS, "")])
def test_the_picture_is_that_of_all_planes(name: str, head: str, look: str, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = scene_of(name, head, look)
    expected = light_of(scene)
    cull_as_crowd(monkeypatch)
    assert np.array_equal(light_of(scene), expected)


@pytest.mark.parametrize(
    ("name", "head", "most"),
    [
        ("repeated", HEAD, 1),
        ("repeated", FOCUS, 1),
        ("box", HEAD, 6),
        ("box", FOCUS, 6),
        ("parallel", HEAD, 2),
        ("parallel", FOCUS, 2),
        ("nearly parallel", HEAD, 40),
    ],
)
def test_few_planes_are_left(name: str, head: str, most: int, monkeypatch: pytest.MonkeyPatch) -> None:
    cull_as_crowd(monkeypatch)
    listed = np.unique(Packing().pack(scene_of(name, head), WIDTH, HEIGHT).tile_shapes)
    assert 0 < np.sum(listed < PLANES) <= most


def test_cells_of_planes_that_hide_none_are_given_up_soon(monkeypatch: pytest.MonkeyPatch) -> None:
    looked_at: list[int] = []
    original = hidden_planes.unhidden

    def unhidden(grid: Grid, block: hidden_planes.Block, *arguments: Any) -> np.ndarray:
        looked_at.append(len(block.planes))
        return original(grid, block, *arguments)

    monkeypatch.setattr(hidden_planes, "unhidden", unhidden)
    cull_as_crowd(monkeypatch)
    monkeypatch.setattr(foremost_planes, "FIRST_WORK", 0)
    scene = scene_of("repeated")
    Packing().pack(scene.remove(*scene.lights), WIDTH, HEIGHT)
    assert PLANES in looked_at
    assert sum(each for each in looked_at if each > 1) <= 5 * PLANES


def test_the_hull_of_a_cube_hides_what_is_beyond_its_corners() -> None:
    corner = unit(np.array([[1.0, 1, 1], [1, 1, 1], [1, 2, 3]]))
    normals, heights = np.concatenate([AXES, corner]), np.array([1.0] * 6 + [1.7, 1.75, 1.6])  # sqrt(3) is 1.732
    hides, error = np.ones(9, bool), np.zeros(9)
    hidden = dual_hull.within_hull(normals, heights, error, hides, ratio=1.001)
    assert hidden.tolist() == [False] * 7 + [True, False]  # the corner of the last plane is 6 / sqrt(14) = 1.604 away
    assert not dual_hull.within_hull(normals, heights, error, ~hides, ratio=1.001).any()


def test_degenerate_hulls_hide_nothing() -> None:
    flat = np.array([[1.0, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0], [1, 0, 0]])
    for heights in (np.ones(5), np.zeros(5), np.full(5, 1e-200)):
        assert not dual_hull.within_hull(flat, heights, np.zeros(5), np.ones(5, bool), ratio=1.001).any()


@pytest.mark.parametrize("name", ["nearly the same", "parallel"])
def test_too_much_culling_is_found(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = scene_of(name)
    expected = light_of(scene)
    cull_as_crowd(monkeypatch)
    monkeypatch.setattr(foremost_planes, "COINCIDENT", 0.2)
    assert not np.array_equal(light_of(scene), expected)
