"""Films and sweeps: pictures of many scenes in order, the same whoever renders them."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Iterator
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path
from threading import Event

import numpy as np
import pytest

import minirt
from minirt import Scene
from minirt.cluster import executor
from minirt.cluster.job import Band, Made
from minirt.cluster.worker import work
from minirt.errors import RenderError
from minirt.rendering.settings import RenderSettings
from minirt.viewer.app.replay import turntable
from tests.cluster.scenes import BALL, with_files
from tests.waiting import HANG_LIMIT

SIZE = 64, 48


def sweep(count: int) -> list[Scene]:
    return [BALL.replace(BALL.spheres[0], diameter=1 + n / 10) for n in range(count)]


def assert_same(found: Iterator[minirt.Image], scenes: list[Scene], **how: object) -> None:
    expected = [minirt.render(each, *SIZE, **how) for each in scenes]
    assert not np.array_equal(expected[0].array, expected[1].array)
    pictures = list(found)
    assert len(pictures) == len(expected)
    for one, other in zip(pictures, expected, strict=True):
        assert np.array_equal(one.array, other.array)
        assert one.tone == other.tone
        assert one.linear is None or np.array_equal(one.linear, other.linear)


@pytest.mark.parametrize("executor", [None, ThreadPoolExecutor(3)], ids=["here", "threads"])
def test_a_sweep_gives_a_picture_of_each_scene_in_order(executor: Executor | None) -> None:
    assert_same(minirt.render_all(sweep(9), *SIZE, executor=executor, samples=2), sweep(9), samples=2)


def test_processes_draw_a_turntable_with_files_and_one_is_killed(tmp_path: Path) -> None:
    views = list(turntable(with_files(tmp_path / "home"), 12))
    with ProcessPoolExecutor(2) as pool:

        def film() -> Iterator[minirt.Image]:
            for number, image in enumerate(minirt.render_all(views, *SIZE, executor=pool, linear=True)):
                if number == 3 and sys.platform != "win32":
                    os.kill(next(iter(pool._processes)), signal.SIGKILL)
                yield image

        assert_same(film(), views)


def test_results_that_come_in_another_order_are_put_in_order(monkeypatch: pytest.MonkeyPatch) -> None:
    """The first picture is ready after the second."""
    second = Event()

    def late(version: str, digest: str, camera: minirt.Camera, band: Band, data: bytes) -> Made:
        assert band.number or second.wait(HANG_LIMIT)
        made = work(version, digest, camera, band, data)
        if band.number:
            second.set()
        return made

    monkeypatch.setattr(executor, "work", late)
    views = list(turntable(BALL, 4))
    with ThreadPoolExecutor(2) as pool:
        assert_same(minirt.render_all(views, *SIZE, executor=pool), views)


def test_few_scenes_are_taken_ahead() -> None:
    taken = []

    def scenes() -> Iterator[Scene]:
        for each in sweep(50):
            taken.append(each)
            yield each

    with ThreadPoolExecutor(2) as pool:
        film = minirt.render_all(scenes(), *SIZE, executor=pool)
        next(film)
        assert len(taken) <= 2 * executor.OF_EACH
        film.close()


def test_scenes_that_differ_in_the_camera_alone_are_packed_once() -> None:
    dispatcher = executor.Dispatcher(ThreadPoolExecutor(1))
    first, second, third = (
        dispatcher.arguments(Band(0, scene, SIZE, RenderSettings()))[-1] for scene in [*turntable(BALL, 2), *sweep(1)]
    )
    assert first is second
    assert third is not first


def test_each_frame_reaches_an_error() -> None:
    for image in minirt.render_all(sweep(2), 160, 90, samples="auto", error=0.01):
        assert image.reached
        assert image.reached.is_reached


def test_wrong_arguments_are_refused() -> None:
    with pytest.raises(RenderError, match="at least 1x1"):
        list(minirt.render_all(sweep(1), 0, 5))
    with pytest.raises(TypeError, match="takes a scene"):
        list(minirt.render_all(["demo.rt"], *SIZE))  # type: ignore[list-item]
    assert list(minirt.render_all([])) == []
