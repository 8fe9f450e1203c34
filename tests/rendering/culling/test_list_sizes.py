"""Lists of shapes that would take too much memory are made of coarser cells, and the picture stays the same."""

from __future__ import annotations

import numpy as np
import pytest

import minirt
from minirt.errors import RenderError
from minirt.helpers import system
from minirt.kernel import interpreted
from minirt.rendering.culling import visibility
from minirt.rendering.renderer import Renderer
from minirt.rendering.scene_packing import Packing
from minirt.scene import Scene, parse

SCENE = "A 0.2 255,255,255\nC 0,0,-9 0,0,1 60\nL 2,5,-6 0.7 255,255,255\npl 0,-3,0 0,1,0 90,120,150\n"
BALLS = [f"sp {x},{y},{(x * y) % 3} 1.2 255,{20 * x + 120},90" for x in range(-4, 5) for y in range(-3, 4)]


def scene() -> Scene:
    """Return a scene of overlapping spheres, whose light buffer has 32 cells along an edge."""
    return parse(SCENE + "\n".join(BALLS) + "\n", "x.rt").scene


def light_of(scene: Scene) -> tuple[np.ndarray, int]:
    """Return the light of a picture of the scene, and the cells of its light buffers."""
    renderer, light = Renderer(threads=1), np.zeros((48, 64, 3))
    assert renderer.render(scene, np.empty((48, 64, 4), np.uint8), 1, light)
    assert renderer.packing.last is not None
    return light, int(renderer.packing.last[2].light_buffer_cells)


def test_coarser_cells_give_the_same_picture(monkeypatch: pytest.MonkeyPatch) -> None:
    expected, cells = light_of(scene())
    monkeypatch.setattr(system, "SMALL", 0)
    monkeypatch.setattr(visibility, "QUICKLY_BUILT", 20_000)
    coarse, fewer = light_of(scene())
    assert fewer < cells
    assert np.array_equal(coarse, expected)


def test_lists_that_no_cells_make_small_enough_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(system, "SMALL", 0)
    monkeypatch.setattr(system, "room", lambda: 64 * 48 * 4)  # enough for the picture
    with pytest.raises(RenderError, match=r"the lists of shapes in view need about .* of memory, allowed 0 MiB"):
        minirt.render(scene(), 64, 48, linear=False)


def test_the_estimate_is_near_the_lists_that_are_built(monkeypatch: pytest.MonkeyPatch) -> None:
    needs: list[int] = []
    monkeypatch.setattr(system, "SMALL", 0)
    monkeypatch.setattr(system, "check_memory", lambda needed, *_: needs.append(needed))
    arrays = Packing(interpreted).pack(scene(), 64, 48)
    starts = sum(group.light_starts.nbytes for group in arrays.groups)
    _, tiles, estimate, members = needs
    assert (tiles, members) == (arrays.tile_shapes.nbytes, arrays.light_shapes.nbytes)
    assert (members + starts) / 2 < estimate < 2 * (members + starts)
