"""The ablation tells by how much a part changes the time of a frame, and whether the picture is the same."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from math import inf, isnan

import pytest

from minirt.kernel.machine_code.library import LIBRARY
from minirt.rendering import Renderer
from minirt.rendering.needed_kernels import packing_calls
from minirt.report.measurements import ablation
from minirt.report.measurements.ablation import Ablation, Part
from minirt.report.measurements.run_times import DISTURBED_BY_OTHERS, Budget
from minirt.report.measurements.variants import Variant, without_lists
from tests.kernel.pictures import ALL
from tests.simulated_clock import Clock, packets, simulate_clock

WIDTH, HEIGHT = 32, 20
BUDGET = Budget(0.0, inf, tries=1)
DIMMER = Variant("feature", "dimmer light", "added", ALL.replace(ALL.lights[0], brightness=0.1))


@pytest.fixture(autouse=True)
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    """Simulate a clock that only rendering moves on."""
    return simulate_clock(monkeypatch)


def parts(*variants: Variant) -> list[Part]:
    return list(Ablation(ALL, WIDTH, HEIGHT, 1, BUDGET).parts(variants, lambda name: None))


@contextmanager
def slow_pictures(clock: Clock, patch: pytest.MonkeyPatch, slowness: float) -> Iterator[None]:
    """Make the pictures of variants slow."""
    draw = ablation.Frame.draw

    def slow(frame: ablation.Frame) -> None:
        clock.slowness = slowness if frame.scene is not ALL or "ChangedPacking" in str(frame.renderer.packing) else 1.0
        draw(frame)

    with patch.context() as inner:
        inner.setattr(ablation.Frame, "draw", slow)
        yield


def test_lists_change_the_time_and_not_the_picture(clock: Clock, monkeypatch: pytest.MonkeyPatch) -> None:
    with slow_pictures(clock, monkeypatch, 1.25):
        scene, *lists = parts(*without_lists(ALL))
    assert (scene.sort, scene.change, scene.valid) == ("scene", "as it is", True)
    assert scene.frame_ms == pytest.approx(packets(WIDTH, HEIGHT) * 1e-3)
    assert len(lists) == 2
    for part in lists:
        assert part.percent == pytest.approx(25)
        assert part.percent_low == pytest.approx(25)
        assert part.frame_ms == pytest.approx(1.25 * scene.frame_ms)
        assert (part.same, part.valid, part.remark) == (True, True, "")
        assert isnan(part.compile_s)


def test_a_variant_with_a_kernel_of_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    """The compiler is asked for the scene as it is and for the variant; a different picture is told."""
    seconds = {id(ALL): 4.0, id(DIMMER.scene): 5.0}
    monkeypatch.setattr(ablation, "drawing_kernel", lambda scene: seconds[id(scene)])
    monkeypatch.setattr(ablation, "compile_seconds", lambda identity: identity)
    scene, dimmer = parts(DIMMER)
    assert (scene.compile_s, dimmer.compile_s) == (4.0, 5.0)
    assert dimmer.compile_percent == pytest.approx(25)
    assert dimmer.percent == pytest.approx(0)
    assert not dimmer.same


def test_disturbed_frames_do_not_count(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ablation, "is_disturbed", lambda run, threads: True)
    for part in parts(*without_lists(ALL)):
        assert (part.valid, part.remark) == (False, DISTURBED_BY_OTHERS)


def test_a_variant_that_fails_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("minirt.report.measurements.brute_force.MOST", 1)
    _, tiles, lights = parts(*without_lists(ALL))
    assert tiles.remark.startswith("failed: 6 shapes in each of")
    assert isnan(tiles.percent)
    assert lights.valid


def test_the_compiler_is_timed_whether_or_not_the_kernel_was_there() -> None:
    """The kernel that is compiled fastest stands for all."""
    identity = min(map(LIBRARY.identity, packing_calls()), key=len)
    for _ in range(2):
        assert ablation.compile_seconds(identity) > 0
        assert LIBRARY.find(identity)


def test_each_scene_has_the_kernel_that_draws_it() -> None:
    specialised = Renderer(1).kernels.specialised
    assert ablation.drawing_kernel(ALL) in specialised(ALL)
    assert ablation.drawing_kernel(ALL) not in specialised(ALL.replace(ALL.shapes[1], mirror=0.25))
