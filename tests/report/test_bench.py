"""`--bench` measures frames that keep the lists of the last one, and frames that need new ones."""

from __future__ import annotations

from itertools import groupby
from typing import Any

import numpy as np
import pytest

from minirt import load
from minirt.rendering import Renderer, scene_packing
from minirt.report import bench
from minirt.scene import Scene
from tests.paths import ROOT

PATH = ROOT / "scenes" / "demo.rt"
SIZE = (16, 9)


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Log each frame and, before it, the making of the lists that it needs."""
    log: list[str] = []

    lists, render = scene_packing.seen_by_eye, Renderer.render

    def logged_lists(*arguments: Any) -> Any:
        log.append("lists")
        return lists(*arguments)

    def logged_render(renderer: Renderer, scene: Scene, pixels: np.ndarray) -> None:
        render(renderer, scene, pixels)
        if pixels.shape[:2] == SIZE[::-1]:  # not the pixel for which the kernel is prepared
            log.append("frame")

    monkeypatch.setattr(scene_packing, "seen_by_eye", logged_lists)
    monkeypatch.setattr(Renderer, "render", logged_render)
    monkeypatch.setattr(bench, "LEAST_SECONDS", 0.0)
    return log


def test_an_eye_at_rest_keeps_the_lists_and_a_moving_one_needs_new_ones_for_each_frame(made: list[str]) -> None:
    bench.measure(str(PATH), load(PATH), SIZE, 1, "double")
    rest, *moving = (len([*group]) for entry, group in groupby(made) if entry == "frame")
    assert rest == 1 + bench.LEAST_FRAMES  # the first one is not counted
    assert moving == [1] * (1 + bench.LEAST_FRAMES)
    assert bench.moved(load(PATH)).camera.position == pytest.approx(np.add(load(PATH).camera.position, (1e-3, 0, 0)))
