"""Pictures are in single precision only while something moves, and where that shows the same."""

from __future__ import annotations

from math import inf
from threading import Semaphore

import numpy as np
import pytest

from minirt.rendering.renderer import Renderer
from minirt.scene import Scene, parse
from minirt.viewer.display.jobs import Painted
from minirt.viewer.display.painter import BackgroundPainter
from minirt.viewer.display.precision import MovingPrecision
from minirt.viewer.display.refinement import Refinement
from tests.paths import ROOT
from tests.viewer.fake import TEXT, FakeRenderer
from tests.waiting import HANG_LIMIT

SIZE = 96, 64
BALL = "A 0.2 255,255,255\nC 0,0,10 0,0,-1 90\nsp 0,0,0 2 255,0,0"  # of one kind: its kernels compile sooner
MOST_LEVELS = ROOT / "scenes" / "eval-shadows-many.rt"  # where rounding decides levels of many pixels


def pictures(text: str, samples: int, precision: str = "double") -> list[Painted]:
    """Move the camera of a scene from picture to picture, then stop; return all pictures."""
    scene, done, found = parse(text).scene, Semaphore(0), []
    Renderer(1, "single").prepare(scene)
    painter = BackgroundPainter(Renderer(2, precision), done.release)
    painter.renderer.kernels.specialised_after = inf  # generic kernels do
    refinement = Refinement(painter, samples)
    x, y, z = scene.camera.position
    steps = [scene.replace(scene.camera, position=(x + step / 8, y, z)) for step in range(12)]
    while not (refinement.complete and scene is steps[-1]):
        scene = steps[min(len(found), len(steps) - 1)]
        refinement.request_missing(scene, SIZE, moving=scene is not steps[-1])
        assert done.acquire(timeout=HANG_LIMIT)
        assert not refinement.collect()
        assert refinement.latest
        found.append(refinement.latest)
    assert painter.close(HANG_LIMIT)
    return found


def settled(scene: Scene, samples: int) -> np.ndarray:
    """Return the picture of a scene that a window shows at rest, in double precision."""
    pixels, renderer = np.zeros((SIZE[1], SIZE[0], 4), np.uint8), Renderer(2)
    for count in [each for each in (1, 4, 16) if each <= samples]:
        assert renderer.render(scene, pixels, count, edges_only=count > 1)
    return pixels


@pytest.mark.parametrize("samples", [1, 16])
def test_what_moves_is_single_and_what_has_settled_is_double_bit_for_bit(samples: int) -> None:
    found = pictures(MOST_LEVELS.read_text(), samples)
    single, last = [each for each in found if each.single], found[-1]
    assert not found[0].single
    assert not next(each for each in found if each.job.urgent).single  # so that a tap does not wait
    assert single
    assert all(each.job.urgent and not each.is_final for each in single)
    assert last.job.samples == samples
    assert np.array_equal(last.pixels, settled(last.job.scene, samples))
    fine = [each for each in single if each.job.divisor == 1]
    assert all((each.pixels != settled(each.job.scene, 1)).any() for each in fine)  # the bits tell the precisions apart


@pytest.mark.parametrize(
    ("text", "precision"),
    [
        (TEXT, "single"),  # by the user's wish: there is one renderer
        (f"{TEXT}sp 0,0,-1000 0.0001 255,255,255", "double"),  # stiff: small for its distance
        (f"{BALL} mirror:0.5", "double"),
        (f"{BALL}\ndl 0,-1,0 0.1 255,255,255" + "\nsp 0,3,0 1 255,255,255" * 9, "double"),  # its shadows need a BVH
    ],
)
def test_scenes_that_single_precision_cannot_show_move_in_double(text: str, precision: str) -> None:
    assert not any(each.single for each in pictures(text, 1, precision))


def test_single_precision_is_left_where_it_is_not_faster() -> None:
    precision = MovingPrecision(FakeRenderer())
    precision.allowed = True
    for costs in ((1.0, 2.0), (2.0, 1.0)):
        for single, cost in enumerate(costs):
            precision.costs[single] = cost
        is_single = costs[1] < costs[0]
        used = [precision.is_single(urgent=urgent) for urgent in (False, *[True] * 9)]
        expected = [False, False, *[each ^ is_single for each in (1, 0, 1, 0, 0, 0, 1, 0)]]  # trials
        assert used == expected
        precision.record(50.0, single=is_single)  # another program had the processor
        assert precision.is_single(urgent=True) == is_single
