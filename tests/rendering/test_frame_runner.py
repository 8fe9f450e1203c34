"""Running frames on threads: cancelling, and errors of single threads."""

from __future__ import annotations

import _thread
import gc
import os
import signal
from collections.abc import Callable
from itertools import count
from pathlib import Path
from queue import SimpleQueue
from threading import Event, Thread, current_thread, main_thread
from typing import TypeVar

import numpy as np
import pytest
from numpy.typing import NDArray

from minirt.helpers.system import gc_paused
from minirt.kernel.frame import CANCELLED
from minirt.kernel.pixels import PACKET_HEIGHT
from minirt.rendering import frame_runner, threads
from minirt.rendering.frame import sample_positions
from minirt.rendering.image import rgb_of
from minirt.rendering.renderer import Renderer
from minirt.rendering.threads import ThreadPool, usable_cores
from minirt.scene import Scene
from tests.kernel.pictures import ALL, AMBIENT, EYE, TWO, picture
from tests.waiting import HANG_LIMIT, until

Pixels = NDArray[np.uint8]
EDGE = 8  # levels by which neighbours differ at an edge


ENDLESS = (32, 65536)  # height and width: two rows of tiles, one for each thread, which are never done
SAMPLES = 50_000  # a pixel: a quarter of an hour for a thread that traces 50 million rays a second

Answer = TypeVar("Answer")


def cancelled(renderer: Renderer, work: Callable[[], Answer]) -> Answer:
    """Run `work`, which makes `renderer` render, cancel it when its first row has begun, and return its answer."""
    answers = list[Answer]()
    renderer.runner.reset_counter()
    thread = Thread(target=lambda: answers.append(work()), daemon=True)
    thread.start()
    until(lambda: renderer.runner.next_row[0] > 0, "the first row")
    assert renderer.runner.next_row.max() < CANCELLED
    renderer.cancel()
    thread.join(HANG_LIMIT)
    (answer,) = answers
    return answer


@pytest.mark.parametrize("part", [np.s_[:], np.s_[3:41, 5:30], np.s_[:0]])
def test_all_threads_copy_the_levels_of_pixels(part: tuple[slice, ...]) -> None:
    pixels = np.random.default_rng(1).integers(0, 256, (50, 37, 4), np.uint8)[part]
    assert np.array_equal(rgb_of(pixels, Renderer(2).runner.run_on_all), pixels[..., 2::-1])


def test_an_interrupt_at_the_end_of_a_job_does_not_lose_the_job(monkeypatch: pytest.MonkeyPatch) -> None:
    """The pool would wait for it for ever."""

    class Interrupted(SimpleQueue[None]):
        def get(self, block: bool = True, timeout: float | None = None) -> None:
            super().get(block, timeout)
            monkeypatch.undo()
            raise KeyboardInterrupt

    pool = ThreadPool(2)
    monkeypatch.setattr(threads, "SimpleQueue", Interrupted)
    with pytest.raises(KeyboardInterrupt):
        pool.run([lambda: None] * 2, lambda: None)


def test_cancelling_ends_a_long_frame_and_the_next_is_right() -> None:
    renderer = Renderer(2)
    expected, _ = picture(ALL, 64, 48)
    renderer.prepare(ALL)
    pixels = np.zeros((*ENDLESS, 4), np.uint8)
    assert not cancelled(renderer, lambda: renderer.render(ALL, pixels, SAMPLES))
    pixels = np.zeros((48, 64, 4), np.uint8)
    assert renderer.render(ALL, pixels)
    assert np.array_equal(pixels, expected)


def test_cancelling_when_nothing_is_rendered_does_nothing() -> None:
    renderer = Renderer(1)
    renderer.cancel()
    assert renderer.render(ALL, np.zeros((8, 8, 4), np.uint8))
    renderer.cancel()
    assert renderer.render(ALL, np.zeros((8, 8, 4), np.uint8))


def test_the_seconds_of_a_frame_are_counted_for_its_kernel(monkeypatch: pytest.MonkeyPatch) -> None:
    renderer, counted = Renderer(1), list[float]()
    renderer.prepare(ALL)
    times = iter((7.0, 7.25))
    monkeypatch.setattr(frame_runner, "perf_counter", lambda: next(times))
    monkeypatch.setattr(renderer.kernels, "count", lambda _choice, seconds: counted.append(seconds))
    assert renderer.render(ALL, np.zeros((8, 8, 4), np.uint8))
    assert counted == [0.25]


def test_the_caller_draws_only_frames_that_are_expected_to_be_brief(monkeypatch: pytest.MonkeyPatch) -> None:
    renderer, helped, run = Renderer(2), list[bool](), ThreadPool.run
    renderer.prepare(ALL)
    monkeypatch.setattr(frame_runner, "perf_counter", count(step=0.01).__next__)  # a frame takes a hundredth
    monkeypatch.setattr(ThreadPool, "run", lambda pool, *jobs, helps: (helped.append(helps), run(pool, *jobs, helps)))
    for samples in (1, 1, 9, 1, 2):
        assert renderer.render(ALL, np.zeros((48, 64, 4), np.uint8), samples)
    assert helped == [False, True, False, True, True]
    assert renderer.reach(ALL, np.zeros((48, 64, 4), np.uint8), 0.01)
    assert helped[5], "a few packets"


def test_an_error_in_one_thread_reaches_the_caller() -> None:
    renderer = Renderer(3)
    renderer.prepare(ALL)
    turns, stopped = count(1), list[int]()

    class Rows:
        def run(self, words: list[int]) -> None:
            turn = next(turns)
            if turn == 2:
                raise ValueError("out of order")
            until(lambda: renderer.runner.next_row[0] >= CANCELLED, "the end of the other threads")
            stopped.append(turn)

    choose = renderer.kernels.choose
    renderer.kernels.choose = lambda frame: choose(frame)._replace(entry=Rows())
    with pytest.raises(ValueError, match="out of order"):
        renderer.render(ALL, np.zeros((40, 40, 4), np.uint8))
    assert sorted(stopped) == [1, 3]
    renderer.kernels.choose = choose
    assert renderer.render(ALL, np.zeros((8, 8, 4), np.uint8))


# Rendering and refining with a given number of samples: only pixels near edges change, and cancelling is heard.


def refined(pixels: Pixels, *passes: int) -> Pixels:
    made = pixels.copy()
    for samples in passes:
        assert TWO.render(ALL, made, samples, edges_only=True)
    return made


def error(pixels: Pixels, fine: Pixels) -> float:
    """RMSE in levels."""
    return float(np.sqrt(((pixels.astype(float) - fine)[..., :3] ** 2).mean()))


def edge_pixels(pixels: Pixels) -> NDArray[np.bool_]:
    """Pixels that differ from the one beside, above or below in some colour as they do at an edge."""
    edge = np.zeros(pixels.shape[:2], bool)
    beside, below = (np.abs(np.diff(pixels[..., :3].astype(int), axis=axis)).max(axis=2) >= EDGE for axis in (1, 0))
    edge[:, 1:] |= beside
    edge[:, :-1] |= beside
    edge[1:] |= below
    edge[:-1] |= below
    return edge


def near_edges(pixels: Pixels) -> NDArray[np.bool_]:
    """Pixels that may change: so close to one at an edge that they may be in its packet."""
    near = np.zeros(pixels.shape[:2], bool)
    for y, x in np.argwhere(edge_pixels(pixels)):
        near[max(y - PACKET_HEIGHT, 0) : y + PACKET_HEIGHT, max(x - 7, 0) : x + 8] = True
    return near


@pytest.mark.parametrize(("width", "height"), [(64, 48), (61, 47), (5, 3), (1, 1), (3, 130)])
def test_only_packets_with_edges_change_and_get_all_their_samples(width: int, height: int) -> None:
    one, many = picture(ALL, width, height)[0], picture(ALL, width, height, 16)[0]
    made = refined(one, 16)
    far = ~near_edges(one)
    assert np.array_equal(made[far], one[far])
    edge = edge_pixels(one)
    assert np.array_equal(made[edge], many[edge])


def test_the_refined_picture_is_as_good_as_one_with_as_many_samples_everywhere() -> None:
    one, many, fine = (picture(ALL, 160, 120, samples)[0] for samples in (1, 16, 256))
    passes = refined(one, 4, 16)
    assert error(passes, fine) < 1.1 * error(many, fine)
    assert error(passes, fine) < error(refined(one, 4), fine) / 2 < error(one, fine) / 4
    assert (passes == one).all(axis=2).mean() > 0.5  # and most of it was not rendered again


def test_refining_leaves_a_picture_without_edges_alone() -> None:
    pixels = np.full((40, 50, 4), 77, np.uint8)
    pixels[20:, :, 1] += EDGE - 1
    before = pixels.copy()
    assert TWO.render(ALL, pixels, 4, edges_only=True)
    assert np.array_equal(pixels, before)
    pixels[20:, :, 1] += 1
    assert TWO.render(ALL, pixels, 4, edges_only=True)
    assert not np.array_equal(pixels[16:24], before[16:24])


def test_pictures_without_shapes_or_pixels_are_refined_at_once() -> None:
    pixels = np.full((5, 7, 4), 100, np.uint8)
    assert TWO.render(Scene((AMBIENT, EYE)), pixels, 4, edges_only=True)
    assert (pixels == (0, 0, 0, 255)).all()
    assert TWO.render(ALL, np.zeros((0, 7, 4), np.uint8), 4, edges_only=True)


def test_a_picture_that_is_not_wanted_is_not_begun() -> None:
    pixels = picture(ALL, 30, 20)[0]
    before = pixels.copy()
    assert not TWO.render(ALL, pixels, 4, is_wanted=lambda: False, edges_only=True)
    assert not TWO.render(ALL, pixels, 4, is_wanted=lambda: False)
    assert np.array_equal(pixels, before)


def test_packets_and_rows_that_threads_take_give_the_same_bits(monkeypatch: pytest.MonkeyPatch) -> None:
    packets, rows = np.empty((2, 51, 93, 4), np.uint8)
    TWO.render(ALL, packets)
    monkeypatch.setattr(frame_runner, "FEW_ROWS", 0)
    TWO.render(ALL, rows)
    assert np.array_equal(packets, rows)


def test_a_picture_that_is_not_wanted_after_the_last_ray_is_not_done() -> None:
    answers = iter([True, False])
    assert not TWO.render(ALL, picture(ALL, 20, 15)[0], is_wanted=lambda: next(answers))


def test_a_cancel_before_the_first_packet_is_heard() -> None:
    renderer = Renderer(2)
    renderer.prepare(ALL)
    pixels = picture(ALL, 200, 150)[0]
    before = pixels.copy()

    def is_wanted() -> bool:
        renderer.cancel()
        return True

    assert not renderer.render(ALL, pixels, 4, is_wanted=is_wanted, edges_only=True)
    assert np.array_equal(pixels, before)
    assert renderer.render(ALL, pixels, 4, edges_only=True)
    assert not np.array_equal(pixels, before)


def test_cancelling_ends_a_long_pass() -> None:
    renderer = Renderer(2)
    renderer.prepare(ALL)
    pixels = np.random.default_rng(1).integers(0, 256, (*ENDLESS, 4), np.uint8)  # all of its pixels differ
    assert not cancelled(renderer, lambda: renderer.render(ALL, pixels, SAMPLES, edges_only=True))


# Positions of the samples in a pixel.


@pytest.mark.parametrize("samples", [1, 2, 3, 16, 64])
def test_samples_lie_evenly_in_the_pixel(samples: int) -> None:
    positions = sample_positions(samples)
    assert positions.shape == (samples, 2)
    assert ((positions >= 0) & (positions < 1)).all()
    assert np.abs(positions.mean(axis=0) - 0.5).max() <= (0 if samples == 1 else 0.5 / samples)
    assert len(np.unique(positions[:, 0])) == len(np.unique(positions[:, 1])) == samples
    quarters = np.histogram2d(positions[:, 0], positions[:, 1], bins=2, range=[[0, 1], [0, 1]])[0]
    assert np.ptp(quarters) <= max(1, samples / 8)


# The threads that run jobs, and their number.


@pytest.mark.parametrize("helps", [False, True])
def test_an_error_of_a_job_is_raised_and_cancels_the_others(helps: bool) -> None:
    cancelled, ran = Event(), list[bool]()

    def fail() -> None:
        ran.append(current_thread() is main_thread())
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        ThreadPool(3).run([fail, lambda: cancelled.wait(HANG_LIMIT)], cancelled.set, helps)
    assert cancelled.is_set()
    assert ran == [helps]


def test_ctrl_c_just_before_the_wait_is_seen() -> None:
    """`interrupt_main` does what the handler of a signal does, but ends no wait of the main thread."""
    cancelled, seen = Event(), list[bool]()
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background jobs ignore it

    def job() -> None:
        _thread.interrupt_main()
        seen.append(cancelled.wait(HANG_LIMIT))

    try:
        # Python drops what is raised in callbacks of the collector, as that of hypothesis.
        with gc_paused(freeze=False), pytest.raises(KeyboardInterrupt):
            ThreadPool(1).run([job], cancelled.set)
    finally:
        signal.signal(signal.SIGINT, before)
    assert seen == [True]


def test_the_threads_of_a_dropped_pool_end() -> None:
    pool = ThreadPool(2)
    threads = pool.threads
    del pool
    gc.collect()
    for thread in threads:
        thread.join(HANG_LIMIT)
        assert not thread.is_alive()


# The number of usable processors: affinity of the process, limit of its container.


@pytest.fixture
def machine(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """A machine with eight processors, and the file that limits its container."""
    monkeypatch.setattr(os, "sched_getaffinity", lambda pid: set(range(8)), raising=False)
    monkeypatch.setattr(threads, "QUOTA", tmp_path / "cpu.max")
    return tmp_path / "cpu.max"


@pytest.mark.parametrize(
    ("quota", "expected"),
    [
        ("max 100000", 8),
        ("200000 100000", 2),
        ("350000 100000", 4),
        ("50000 100000", 1),
        ("1000 100000", 1),
        ("1600000 100000", 8),
        ("150000 50000\n", 3),
        ("", 8),
        ("what is this", 8),
    ],
)
def test_a_container_limits_the_number(machine: Path, quota: str, expected: int) -> None:
    machine.write_text(quota)
    assert usable_cores() == expected


@pytest.mark.usefixtures("machine")
def test_without_a_container_all_processors_count() -> None:
    assert usable_cores() == 8


@pytest.mark.usefixtures("machine")
def test_the_affinity_of_the_process_limits_the_number(monkeypatch: pytest.MonkeyPatch) -> None:
    own = {0: {3, 5}}  # 0 stands for the calling process
    monkeypatch.setattr(os, "sched_getaffinity", own.__getitem__)
    assert usable_cores() == 2


@pytest.mark.usefixtures("machine")
@pytest.mark.parametrize(("count", "expected"), [(6, 6), (None, 1)])
def test_without_affinities_all_processors_count(
    monkeypatch: pytest.MonkeyPatch, count: int | None, expected: int
) -> None:
    monkeypatch.delattr(os, "sched_getaffinity")
    monkeypatch.setattr(os, "cpu_count", lambda: count)
    assert usable_cores() == expected
